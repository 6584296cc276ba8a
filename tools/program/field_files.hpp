// SPDX-License-Identifier: BSD-3-Clause
// Writes solution fields for ParaView: the body and the contact surface.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <kacanov/element_fields.hpp>
#include <kacanov/discretisation.hpp>
#include <kacanov/part.hpp>
#include <kacanov/problem.hpp>
#include <kacanov/result.hpp>
#include "pictures/picture.hpp"
#include "program/parallel.hpp"

namespace kacanov {

/// Contact fields gathered on the first rank, numbered as Problem::contact.
struct ContactFields {
  std::vector<double> gap, pressure, status;
  std::vector<double> traction;      ///< × 3
  std::vector<double> displacement;  ///< boundary nodes × dim; set by the caller
};
/// Returns the fields without displacement; empty on other ranks. Collective.
ContactFields gather_contact_fields(const Part& part, const Solution& solution);

/// Where fields are written: the folder, and the load step that has ended; 0: the end of the run.
struct FieldPlace {
  std::filesystem::path folder;
  std::size_t step = 0;
};

/// File name of the body: body.vtu, or body_step_<step>.vtu for a load step.
std::string body_file(std::size_t step = 0);
/// Returns `name` without a trailing number that follows `mark`; unchanged if there is none.
std::string_view without_number(std::string_view name, std::string_view mark);
/// Returns whether runs write fields under this name, including older versions with one piece per rank.
bool is_field_file(std::string_view name);
/// Returns whether the file holds fields of a load step before the last.
bool is_step_file(std::string_view name);

/// Body fields that are not part of a Solution.
struct BodyFields {
  NodalStress nodal;  ///< recover_stress()
  ElementNumbers numbers;
  std::vector<double> error;                 ///< per element: shares() of estimate_error()
  std::span<const std::uint16_t> sets = {};  ///< per element: SetNumbers
};

/// Writes the whole body from all ranks. Errors are handled as in together(). Collective.
void write_body(const FieldPlace& place, const Part& part, const Solution& solution, const BodyFields& fields,
                const MpiSession& mpi);

/// Writes the contact surface, if there is one; on the first rank.
void write_surface(const FieldPlace& place, const Problem& problem, const Model& model,
                   const ContactFields& contact);

/// Returns the contact pressure at the mesh nodes, 0 where there is no contact, as in contact.vtu. If a node
/// belongs to several entries, the last one counts. On the first rank.
std::vector<double> nodal_pressure(const Problem& problem, const Model& model, const ContactFields& contact);

/// Returns the contact facets moved along ν by the gap, which shows the facing part of every obstacle except
/// planes at rest. `missing`: number of entries without a facet that faces the obstacle. On the first rank;
/// `contact` must include displacement.
std::vector<DeformedPicture::ObstacleFacet> obstacle_facets(const Problem& problem, const Model& model,
                                                            const ContactFields& contact, int& missing);

/// Writes the ParaView series (.pvd): the load steps with fields, and the end of the run.
void write_series(const std::filesystem::path& folder, const Problem& problem, const Result& result);

}  // namespace kacanov
