// SPDX-License-Identifier: BSD-3-Clause
// The body of the benchmarks of solves: a pressed beam.
#pragma once

#include <string>
#include <vector>

#include <kacanov/part.hpp>
#include <kacanov/problem.hpp>

/// A beam fixed at one end and pressed down on the far half of its top; its bottom may carry a penalty.
struct PressedBeam {
  int cells = 40;  ///< across a beam of 4 x 1 x 1 (40: 811,923 unknowns with tet4)
  std::string element = "tet4";
  bool mixed = false;  ///< mixed formulation: dilatation at corners, or B-bar
  std::string mesh;    ///< a Gmsh file instead of the beam; fixed at its lowest x, pressed from above
  double poisson = 0.3;
  double aspect = 1.0;  ///< length of a cell over its width
};

kacanov::Problem make_pressed_beam(const PressedBeam& options);

/// Returns secant moduli, elements × points, that vary smoothly by a factor `jump` over the body.
std::vector<double> varied_secant(const kacanov::Part& part, double jump);
