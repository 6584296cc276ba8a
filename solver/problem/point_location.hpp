// SPDX-License-Identifier: BSD-3-Clause
// Locates points in the elements of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <kacanov/mesh_view.hpp>
#include <kacanov/model.hpp>

namespace kacanov {

/// Returns the reference coordinates of x in the element with these nodes, by Newton's method (one step for
/// affine elements); empty if it does not converge, as for points far outside a distorted element.
std::optional<Vector3> reference_point(const MeshView& mesh, std::span<const std::int32_t> nodes,
                                       const Vector3& x);

/// Returns the distance of a point from the reference cell, in reference coordinates; negative inside.
double outside(const Cell& type, const Vector3& at);

/// Whether x lies in a box that bounds the whole element, including curved sides.
bool near_element(const MeshView& mesh, std::span<const std::int32_t> nodes, const Vector3& x);

/// Locates points in a mesh with a grid of boxes. The result depends on mesh and point only, so all ranks
/// agree.
class PointLocator {
 public:
  struct Place {
    std::int32_t element = 0;
    Vector3 at{};  ///< reference coordinates, outside the cell for points outside the body
  };
  /// The mesh needs at least one element; the data of the view must outlive the locator.
  explicit PointLocator(const MeshView& mesh);
  /// Returns the first element that contains the point, or else the nearby element with the smallest distance
  /// in its reference coordinates.
  Place find(const Vector3& x) const;

 private:
  using Cells = std::array<std::int64_t, 3>;
  /// Bounding box of an element.
  struct Bounds {
    Vector3 low{}, high{};
    bool has(const Vector3& x, std::size_t dim) const;
  };
  Cells box_of(const Vector3& x) const;
  std::span<const std::int32_t> nodes(std::int32_t element) const;
  struct Ring {
    std::int64_t away = 0;   ///< distance in boxes
    bool only_near = false;  ///< only elements whose bounding box contains the point
  };
  /// Updates `best` if an element in these boxes is closer.
  void search_ring(const Vector3& x, const Ring& where, double& least, std::optional<Place>& best) const;

  MeshView mesh_;
  std::vector<Bounds> bounds_;
  Vector3 low_{}, inverse_{};        ///< lowest corner; boxes per length
  Cells count_{1, 1, 1};             ///< number of boxes along each axis
  std::vector<std::int64_t> start_;  ///< elements of each box, compressed rows
  std::vector<std::int32_t> element_;
};

}  // namespace kacanov
