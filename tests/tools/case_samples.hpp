// SPDX-License-Identifier: BSD-3-Clause
// A complete sample case, and the error messages of changed copies.
#pragma once

#include <string>

#include <kacanov/error.hpp>
#include "case/case_file.hpp"
#include "case/json_node.hpp"

namespace kacanov::testing {

/// A case with every kind of entry.
inline nlohmann::json complete_case() {
  return parse_json(R"({
    "mesh": {"box": {"size": [4, 1, 1], "cells": [8, 2, 2], "element": "tet4"}},
    "material": [{"on": "all", "young": 1.0, "poisson": 0.3, "law": {"type": "logarithmic", "x0": 0.01}}],
    "boundary": [{"on": "left", "displacement": [0, null, 0]},
                 {"on": {"box": [[2, 0, 1], [4, 1, 1]]}, "traction": [0, 0, -0.05]},
                 {"on": "right", "pressure": 0.5},
                 {"on": "all", "body_force": [0, 0, -1]}],
    "contact": [{"on": "bottom", "obstacle": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
                 "friction": {"tresca": 0.01}},
                {"on": "front", "obstacle": {"sphere": {"centre": [0, -9, 0], "radius": 2, "direction": [0, -1, 0]}}},
                {"on": "back", "obstacle": {"gap": -0.01}}],
    "solver": {"tolerance": 1e-7, "outer": "kacanov", "contact": "admm", "r": 0.5, "stop": "paper", "max_outer": 50,
               "max_contact": 1e5, "coarse_amg": 5000, "spectrum_tolerance": 1e-3, "relaxation": 1.5},
    "probe": [[4, 0.5, 1]],
    "output": {"fields": "none", "report": false}
  })",
                    "sample.json");
}

/// Returns the error message of parse_case for the sample after one change, empty if it accepts the case.
inline std::string complaint(const std::string& change) {
  nlohmann::json document = complete_case();
  try {
    apply_override(document, change);
    parse_case(document, "");
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

}  // namespace kacanov::testing
