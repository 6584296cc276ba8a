// SPDX-License-Identifier: BSD-3-Clause
// SVG pictures of a run: the deformed body coloured by a nodal quantity, and a sweep over the penalty.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// Input of a picture of the deformed body. Owns nothing; arrays follow the mesh numbering. In 3D only the
/// boundary is read.
struct DeformedPicture {
  std::string title;
  const Mesh* mesh = nullptr;
  std::span<const double> displacement;  ///< nodes × dim
  std::span<const double> values;        ///< one per node; they select the colour
  double largest_von_mises = 0.0;        ///< largest element value, for the caption
  /// A flat obstacle: a point on it and its normal to the body's side (in 2D the third entries are 0).
  struct Plane {
    std::array<double, 3> point{}, normal{};
  };
  std::vector<Plane> planes;
  double scale = 0.0;  ///< displacement scale; 0: chosen automatically and stated in the caption
  std::array<std::string, 2> quantity{"von Mises", "stress"};  ///< name of the values, in two short lines
  /// Facets of a curved obstacle that face the body: triangles in 3D; in 2D segments from the first corner to
  /// the second. The normal points to the body.
  struct ObstacleFacet {
    std::array<std::array<double, 3>, 3> corners{};
    std::array<double, 3> normal{};
  };
  std::vector<ObstacleFacet> obstacles;
  /// A supported or loaded node. Where marks are close together, only some are drawn.
  struct Mark {
    enum class Kind { support, spring, load } kind = Kind::support;
    std::int32_t node = 0;
    std::array<double, 3> direction{};  ///< of a load, any length; zero: unknown
  };
  std::vector<Mark> marks;
  std::array<double, 3> view{};  ///< 3D: from the body to the eye; zero: chosen automatically
};

/// Draws the deformed body over the outline of the undeformed one, with a colour bar: all triangles in 2D,
/// the boundary seen from above in 3D. The file size stops growing with the mesh above about 20,000 visible
/// facets. Throws InternalError if the arrays do not fit the mesh.
std::string deformed_svg(const DeformedPicture& picture);

/// Iterations and time over the penalty r. The vectors have one entry per run.
struct SweepPicture {
  std::string title;
  std::vector<double> r;  ///< > 0, in any order
  std::vector<double> iterations;
  std::vector<double> seconds;
  std::vector<bool> converged;
  struct Mark {
    std::string name;  ///< text after an underscore becomes a subscript: "r_A"
    double value;      ///< not drawn unless > 0
  };
  std::vector<Mark> marks;  ///< vertical lines
};

/// Returns the SVG. Throws InternalError if the vectors are empty or differ in length, or an r is not
/// positive.
std::string sweep_svg(const SweepPicture& picture);

}  // namespace kacanov
