// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a run as SVG: the deformed body with its von Mises stress, and a sweep over the penalty.
#pragma once

#include <array>
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
  std::span<const double> von_mises;     ///< nodes
  double largest_von_mises = 0.0;        ///< of an element, for the caption
  /// A flat obstacle: a point on it and its normal to the body's side (in 2D the third entries are 0).
  struct Plane {
    std::array<double, 3> point{}, normal{};
  };
  std::vector<Plane> planes;
  double scale = 0.0;  ///< of the displacement; 0: chosen, and stated in the caption
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
