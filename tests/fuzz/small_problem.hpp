// SPDX-License-Identifier: BSD-3-Clause
// A small problem whose part has every kind of field, for targets that read files.
#pragma once

#include <mpi.h>

#include <kacanov/solve.hpp>
#include "case/case_file.hpp"

namespace kacanov::fuzz {

/// Initialises MPI on one rank until the process ends. Leaks of its plugins cannot be suppressed by name:
/// targets that call this run without leak detection.
inline void start_mpi() { MPI_Init(nullptr, nullptr); }

inline const Case& small_case() {
  static const Case input = parse_case(CaseText{"small.json", R"({
    "mesh": {"box": {"size": [2, 1], "cells": [4, 2], "element": "tri3"}},
    "material": [{"on": "all", "young": 1.0, "poisson": 0.3, "law": {"type": "logarithmic", "x0": 0.01}},
                 {"on": {"box": [[0, 0], [0.6, 1.1]]}, "young": 2.0, "poisson": 0.3,
                  "law": {"type": "table", "points": [[0, 0], [0.01, 0.015], [0.1, 0.05]]}}],
    "boundary": [{"on": "left", "displacement": [0, 0]}, {"on": "top", "traction": [0, -0.01]}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, -0.001], "normal": [0, 1]}},
                 "friction": {"coulomb": 0.3}}],
    "solver": {"max_outer": 3, "max_contact": 20, "max_cg": 50, "load_steps": [0.5, 1]},
    "probe": [[2, 1], [1, 0.5]]})"},
                                       {});
  return input;
}

inline Problem small_problem() { return build_problem(make_box(*small_case().mesh.box), small_case().model); }

}  // namespace kacanov::fuzz
