// SPDX-License-Identifier: BSD-3-Clause
// Vector3 arithmetic for problem setup.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include <kacanov/mesh.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

inline Vector3 operator+(const Vector3& a, const Vector3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vector3 operator-(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vector3 operator*(double s, const Vector3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double norm(const Vector3& a) { return std::sqrt(dot(a, a)); }
inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Returns the position of a node; the third component is 0 in 2D.
inline Vector3 position(const MeshView& mesh, std::int32_t node) {
  const std::size_t dim = dimension(mesh.type);
  const double* x = mesh.coordinates.data() + static_cast<std::size_t>(node) * dim;
  return {x[0], x[1], dim == 3 ? x[2] : 0.0};
}
inline Vector3 position(const Mesh& mesh, std::int32_t node) { return position(mesh.view(), node); }

/// Formats `v` for messages: "(1, 2)" or "(1, 2, 3)".
std::string to_text(const Vector3& v, int dim);

}  // namespace kacanov
