// SPDX-License-Identifier: BSD-3-Clause
// What there is to see of a run: fields over the boundary, pictures, obstacles, and why some are not there.
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
    std::vector<double> values;  ///< nodes of the mesh
  };
  std::vector<Field> fields;
  std::size_t first = 0;               ///< of `fields`: output.quantity
  std::string picture;                 ///< SVG: the deformed body
  std::string pressure_picture;        ///< SVG: the contact pressure, seen from the obstacles; may be empty
  std::vector<std::string> not_shown;  ///< a sentence each
  std::vector<DeformedPicture::ObstacleFacet> obstacles;
};

/// On the first rank. `von_mises` and, where elements are plastic, `plastic` at the nodes of the problem's
/// mesh; `contact` with displacement.
ShownRun show_run(const Case& input, const Problem& problem, const ContactFields& contact,
                  const std::vector<double>& von_mises, const std::vector<double>& plastic,
                  double largest_von_mises);

}  // namespace kacanov
