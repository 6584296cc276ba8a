// SPDX-License-Identifier: BSD-3-Clause
// The fields of a solution as files for ParaView: the body, and the contact surface.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <kacanov/element_fields.hpp>
#include <kacanov/nodal_stress.hpp>
#include <kacanov/part.hpp>
#include <kacanov/problem.hpp>
#include <kacanov/result.hpp>
#include "pictures/picture.hpp"
#include "program/parallel.hpp"

namespace kacanov {

/// Contact fields gathered on the first rank, in the numbering of Problem::contact.
struct ContactFields {
  std::vector<double> gap, pressure, status;
  std::vector<double> traction;      ///< × 3
  std::vector<double> displacement;  ///< nodes × dim, of the boundary's nodes; by the caller
};
/// Collective; empty on other ranks. Without displacement.
ContactFields gather_contact_fields(const Part& part, const Solution& solution);

/// Where fields are written: the folder, and the load step they are the end of; 0: the end of the run.
struct FieldPlace {
  std::filesystem::path folder;
  std::size_t step = 0;
};

/// Name of the body's file: body.vtu; body_step_<step>.vtu of a load step.
std::string body_file(std::size_t step = 0);
/// `name` without a number at its end that follows `mark`; the same where it does not end so.
std::string_view without_number(std::string_view name, std::string_view mark);
/// Whether a run writes fields under this name, or one of a version did that wrote a piece a rank.
bool is_field_file(std::string_view name);
/// Whether it does so for a load step before the last.
bool is_step_file(std::string_view name);

/// What its fields are besides those of a Solution.
struct BodyFields {
  NodalStress nodal;  ///< recover_stress()
  ElementNumbers numbers;
  std::vector<double> error;                 ///< elements: shares() of estimate_error()
  std::span<const std::uint16_t> sets = {};  ///< elements: SetNumbers
};

/// Writes the body, whole whatever the ranks. Collective; what fails ends as together() says.
void write_body(const FieldPlace& place, const Part& part, const Solution& solution, const BodyFields& fields,
                const MpiSession& mpi);

/// Writes the contact surface where there is one; on the first rank.
void write_surface(const FieldPlace& place, const Problem& problem, const Model& model,
                   const ContactFields& contact);

/// Contact pressure at the nodes of the mesh, 0 where there is no contact; as in contact.vtu. Of nodes of
/// several entries it is the last one's. On the first rank.
std::vector<double> nodal_pressure(const Problem& problem, const Model& model, const ContactFields& contact);

/// What of the obstacles that no Plane at rest stands for faces the body: its contact facets, moved along ν
/// by the gap. `missing`: entries of which no facet faces the obstacle. On the first rank; `contact` with
/// displacement.
std::vector<DeformedPicture::ObstacleFacet> obstacle_facets(const Problem& problem, const Model& model,
                                                            const ContactFields& contact, int& missing);

/// The series for ParaView: the load steps that fields are there of, and the end of the run.
void write_series(const std::filesystem::path& folder, const Problem& problem, const Result& result);

}  // namespace kacanov
