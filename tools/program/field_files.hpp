// SPDX-License-Identifier: BSD-3-Clause
// The fields of a solution as files for ParaView: the body in one piece a rank, the contact surface in one.
#pragma once

#include <filesystem>
#include <string>

#include <kacanov/nodal_stress.hpp>
#include <kacanov/part.hpp>
#include <kacanov/problem.hpp>
#include <kacanov/result.hpp>
#include "program/parallel.hpp"

namespace kacanov {

/// Contact fields gathered on the first rank, in the numbering of Problem::contact.
struct ContactFields {
  std::vector<double> gap, pressure, status;
  std::vector<double> traction;  ///< × 3
};
/// Collective; empty on other ranks.
ContactFields gather_contact_fields(const Part& part, const Solution& solution);

/// Name of a rank's piece of the body: body.vtu, or body_<rank>.vtu where there are several.
std::string body_file(int rank, int ranks);

/// Writes this rank's piece. `nodal`: recover_stress() of the solution.
void write_body(const std::filesystem::path& folder, const Part& part, const Solution& solution,
                const NodalStress& nodal);

/// What ties the pieces together, and the contact surface; on the first rank.
void write_collection(const std::filesystem::path& folder, const Problem& problem, const Model& model,
                      const ContactFields& contact, int ranks);

}  // namespace kacanov
