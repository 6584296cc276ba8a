// SPDX-License-Identifier: BSD-3-Clause
// Visible output of a run: boundary fields, pictures and obstacles, with reasons for missing ones.
#pragma once

#include <string>
#include <vector>

#include "case/case_file.hpp"
#include "pictures/picture.hpp"
#include "program/field_files.hpp"

namespace kacanov {

struct ShownRun {
  struct Field {
    std::string name;
    std::vector<double> values;  ///< one per mesh node
  };
  std::vector<Field> fields;
  std::size_t first = 0;               ///< index into `fields` of output.quantity
  std::string picture;                 ///< SVG: the deformed body
  std::string pressure_picture;        ///< SVG: contact pressure, seen from the obstacles; may be empty
  std::vector<std::string> not_shown;  ///< one sentence per missing part
  std::vector<DeformedPicture::ObstacleFacet> obstacles;
};

/// On the first rank. `von_mises` and, if elements are plastic, `plastic` are nodal values on the problem's
/// mesh; `contact` must include displacement.
ShownRun show_run(const Case& input, const Problem& problem, const ContactFields& contact,
                  const std::vector<double>& von_mises, const std::vector<double>& plastic,
                  double largest_von_mises);

}  // namespace kacanov
