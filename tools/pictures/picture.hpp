// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a run as SVG: the deformed body with its von Mises stress, and a sweep over the penalty.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <kacanov/mesh.hpp>

namespace kacanov {

/// A body to be drawn. Nothing is owned; everything in the numbering of the mesh, of which 3D needs the
/// boundary only.
struct DeformedPicture {
  std::string title;
  const Mesh* mesh = nullptr;
  std::span<const double> displacement;  ///< nodes × dim
  std::span<const double> values;        ///< nodes: what colours it
  double largest_von_mises = 0.0;        ///< of an element, for the caption
  /// A flat obstacle: a point on it and its normal to the body's side (in 2D the third entries are 0).
  struct Plane {
    std::array<double, 3> point{}, normal{};
  };
  std::vector<Plane> planes;
  double scale = 0.0;  ///< of the displacement; 0: chosen, and stated in the caption
  std::array<std::string, 2> quantity{"von Mises", "stress"};  ///< what the values are, in two short lines
  /// What of another obstacle faces the body: triangles in 3D, in 2D lines from the first corner to the
  /// second, with their normal to the body's side.
  struct ObstacleFacet {
    std::array<std::array<double, 3>, 3> corners{};
    std::array<double, 3> normal{};
  };
  std::vector<ObstacleFacet> obstacles;
  /// A node that is held or loaded. Where many are close to each other, some of them are drawn.
  struct Mark {
    enum class Kind { support, spring, load } kind = Kind::support;
    std::int32_t node = 0;
    std::array<double, 3> direction{};  ///< of a load, any length; zero: not known
  };
  std::vector<Mark> marks;
  std::array<double, 3> view{};  ///< in 3D, from the body to the eye; zero: chosen
};

/// The deformed body over the outline of the undeformed one, with a colour bar: all triangles in 2D, the
/// boundary seen from above in 3D. The size of the file does not grow with the mesh beyond some 20,000
/// visible facets. Throws InternalError if the arrays do not fit the mesh.
std::string deformed_svg(const DeformedPicture& picture);

/// Iterations and time against the penalty r. The vectors have one entry a run.
struct SweepPicture {
  std::string title;
  std::vector<double> r;  ///< > 0, in any order
  std::vector<double> iterations;
  std::vector<double> seconds;
  std::vector<bool> converged;
  struct Mark {
    std::string name;  ///< what follows an underscore becomes a subscript: "r_A"
    double value;      ///< not drawn unless > 0
  };
  std::vector<Mark> marks;  ///< vertical lines
};

/// Throws InternalError if the vectors are empty or differ in length, or an r is not positive.
std::string sweep_svg(const SweepPicture& picture);

}  // namespace kacanov
