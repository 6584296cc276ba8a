// SPDX-License-Identifier: BSD-3-Clause
// Checks of sizes, options and bodies.
#include "operator/checks.hpp"

#include <stdexcept>
#include <string>

#include "operator/mesh_check.hpp"

namespace kacanov {

void expect_size(std::size_t actual, std::size_t wanted, const char* what) {
  if (actual != wanted)
    throw std::invalid_argument(std::string(what) + ": expected " + std::to_string(wanted) +
                                " entries, got " + std::to_string(actual));
}

const Body& checked(const Body& body, const OperatorOptions& options) {
  if (const std::string fault = mesh_fault(body.mesh); !fault.empty()) throw std::invalid_argument(fault);
  check_options(body, options);
  check_laws(body);
  return body;
}

void check_options(const Body& body, const OperatorOptions& options) {
  if (options.threads < 1) throw std::invalid_argument("threads: expected at least 1");
  for (const std::int32_t node : options.early)
    if (node < 0 || static_cast<std::size_t>(node) >= body.mesh.node_count())
      throw std::invalid_argument("early: there is no node " + std::to_string(node));
}

void check_laws(const Body& body) {
  if (body.laws.empty()) throw std::invalid_argument("laws: expected at least 1");
  if (!body.law_of_element.empty())
    expect_size(body.law_of_element.size(), body.mesh.element_count(), "law_of_element");
  for (const std::uint16_t law : body.law_of_element)
    if (law >= body.laws.size())
      throw std::invalid_argument("law_of_element: there is no law " + std::to_string(law));
  for (const Law& law : body.laws)
    if (law.mean_dilatation && !cell(body.mesh.type).mean_dilatation &&
        !cell(body.mesh.type).corner_dilatation)
      throw std::invalid_argument(
          "laws: mean dilatation is for " +
          element_names([](const Cell& c) { return c.mean_dilatation || c.corner_dilatation; }) + " only");
  for (const Law& law : body.laws)
    if (law.mean_dilatation && body.mesh.plane == PlaneState::stress)
      throw std::invalid_argument("laws: mean dilatation (B-bar) is not for plane stress");
}

}  // namespace kacanov
