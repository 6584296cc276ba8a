// SPDX-License-Identifier: BSD-3-Clause
// Which way a point faces an obstacle that is equally near in several directions (theory: equal-distance).
#include "problem/equal_faces.hpp"

#include <algorithm>

#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Unit vectors and cosines as near to each other as this are the same.
constexpr double same_direction = 1e-6;
/// Cosine with the outer normal above which a face looks at the body: that of facet_orientation, the other
/// way.
constexpr double looks_at_body = 0.05;

bool same(const Vector3& a, const Vector3& b) { return norm(a - b) <= same_direction; }

/// By their first components that differ.
bool is_before(const Vector3& a, const Vector3& b) {
  for (std::size_t c = 0; c < 3; ++c)
    if (std::abs(a[c] - b[c]) > same_direction) return a[c] < b[c];
  return false;
}

}  // namespace

FaceChoice choose_face(std::span<const Vector3> directions, const Vector3& outer) {
  const double length = norm(outer);
  const auto cosine = [&](const Vector3& nu) { return length > 0.0 ? dot(nu, outer) / length : 0.0; };
  double most = -1.0;
  for (const Vector3& nu : directions) most = std::max(most, cosine(nu));
  FaceChoice choice;
  Vector3 sum{};
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const Vector3& nu = directions[k];
    const bool is_known = std::any_of(choice.chosen.begin(), choice.chosen.end(),
                                      [&](std::size_t other) { return same(directions[other], nu); });
    if (is_known) continue;
    if (cosine(nu) < most - same_direction) {
      choice.decides = choice.decides || (cosine(nu) > looks_at_body && most < 1.0 - same_direction);
      continue;
    }
    choice.chosen.push_back(k);
    sum = sum + nu;
  }
  if (choice.chosen.size() < 2) return choice;
  choice.decides = true;
  if (norm(sum) > same_direction * static_cast<double>(choice.chosen.size())) return choice;
  choice.chosen = {*std::max_element(
      choice.chosen.begin(), choice.chosen.end(),
      [&](std::size_t a, std::size_t b) { return is_before(directions[a], directions[b]); })};
  return choice;
}

}  // namespace kacanov
