// SPDX-License-Identifier: BSD-3-Clause
// Finds the element that a point lies in.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/mesh_view.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

/// Reference coordinates of x in the element with these nodes, by Newton's method (one step where the map is
/// affine); nothing where it does not converge, as for points far outside a distorted element.
std::optional<Vector3> reference_point(const MeshView& mesh, std::span<const std::int32_t> nodes,
                                       const Vector3& x);

/// How far outside the reference cell a point lies, in reference coordinates; negative inside.
double outside(const Cell& type, const Vector3& at);

/// True where x lies in a box round all of the element, its bulging sides included.
bool near_element(const MeshView& mesh, std::span<const std::int32_t> nodes, const Vector3& x);

/// Finds elements of a mesh by a grid of boxes. The answer depends on mesh and point alone: ranks agree.
class PointLocator {
 public:
  struct Place {
    std::int32_t element = 0;
    Vector3 at{};  ///< reference coordinates, outside the cell for points outside the body
  };
  /// Of one element at least; what the view shows has to outlive it.
  explicit PointLocator(const MeshView& mesh);
  /// The first element that has the point, or the one it lies least outside of, measured in its reference
  /// coordinates, among those near it.
  Place find(const Vector3& x) const;

 private:
  using Cells = std::array<std::int64_t, 3>;
  /// Of a box round all of an element.
  struct Bounds {
    Vector3 low{}, high{};
    bool has(const Vector3& x, std::size_t dim) const;
  };
  Cells box_of(const Vector3& x) const;
  std::span<const std::int32_t> nodes(std::int32_t element) const;
  struct Ring {
    std::int64_t away = 0;   ///< boxes
    bool only_near = false;  ///< only elements whose bounding box has the point
  };
  /// Takes over `best` where an element of these boxes is better.
  void search_ring(const Vector3& x, const Ring& where, double& least, std::optional<Place>& best) const;

  MeshView mesh_;
  std::vector<Bounds> bounds_;
  Vector3 low_{}, inverse_{};        ///< lowest corner; boxes a length
  Cells count_{1, 1, 1};             ///< boxes along each axis
  std::vector<std::int64_t> start_;  ///< elements of each box, compressed rows
  std::vector<std::int32_t> element_;
};

}  // namespace kacanov
