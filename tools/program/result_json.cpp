// SPDX-License-Identifier: BSD-3-Clause
// Writes result.json, the numbers of a run.
#include "program/result_json.hpp"

namespace kacanov {
namespace {

using nlohmann::ordered_json;

ordered_json entries(const Vector3& v, int dim) {
  ordered_json list = ordered_json::array();
  for (int c = 0; c < dim; ++c) list.push_back(v[c]);
  return list;
}

ordered_json residuals_json(const KktResiduals& residuals) {
  ordered_json json = ordered_json::object();
  for (const auto& [name, entry] : residual_names) json[name] = residuals.*entry;
  return json;
}

ordered_json extreme_json(const Extreme& extreme, const char* what, int dim) {
  return {{"value", extreme.value}, {"at", entries(extreme.at, dim)}, {what, extreme.tag}};
}

ordered_json contact_json(const ContactTotals& contact, const Model& model, int dim) {
  ordered_json json{{"force", entries(contact.total.force, dim)},
                    {"normal_force", entries(contact.normal_force, dim)},
                    {"friction_force", entries(contact.friction_force, dim)},
                    {"moment", contact.total.moment},
                    {"area", contact.area},
                    {"max_pressure", contact.max_pressure},
                    {"sticking", contact.sticking},
                    {"slipping", contact.slipping},
                    {"open", contact.open},
                    {"least_gap", contact.least_gap}};
  if (model.contact[contact.entry].force_controlled) json["travel"] = contact.travel;
  return json;
}

ordered_json boundary_json(std::span<const BoundaryTotals> totals, const Model& model, int dim) {
  ordered_json json = ordered_json::object();
  for (const BoundaryTotals& total : totals)
    json[entry_name(model.boundary[total.entry], total.entry)] = {{"force", entries(total.total.force, dim)},
                                                                  {"moment", total.total.moment}};
  return json;
}

ordered_json mesh_json(const Result& result, const MeshSource& source, const Mesh& mesh) {
  const int dim = mesh.dim();
  ordered_json json = ordered_json::object();
  if (source.file) json["file"] = *source.file;
  json["element"] = cell(mesh.type).name;
  json["nodes"] = result.unknowns / dim;
  json["elements"] = result.elements;
  json["boundary_facets"] = mesh.facet_count();
  json["lower"] = entries(result.body.lower, dim);
  json["upper"] = entries(result.body.upper, dim);
  json["size"] = result.body.size;
  json["volume"] = result.body.volume;
  return json;
}

ordered_json estimate_json(const SpectrumResult& result) {
  return {{"traces", result.friction ? "normal and tangential" : "normal"},
          {"rows", result.traces},
          {"lambda_min", result.lambda_min},
          {"lambda_min_bound", result.bound_min},
          {"lambda_max", result.lambda_max},
          {"lambda_max_bound", result.bound_max},
          {"r_star", result.r_star},
          {"converged", result.converged},
          {"products", result.products},
          {"cg_iterations", result.cg_iterations},
          {"operator_applications", result.operator_applications},
          {"seconds", result.seconds}};
}

/// Omits the quantities that need more than one mesh.
ordered_json discretisation_json(const Discretisation& error, int dim) {
  ordered_json json{{"energy", error.energy}, {"meshes", error.meshes}};
  if (!error.probe.empty()) json["probe"] = ordered_json::array();
  for (const Vector3& probe : error.probe) json["probe"].push_back(entries(probe, dim));
  if (error.contact_force) json["contact_force"] = entries(*error.contact_force, dim);
  return json;
}

}  // namespace

const char* status_name(Status status) {
  switch (status) {
    case Status::converged: return "converged";
    case Status::not_converged: return "not_converged";
    case Status::limited_by_rounding: return "limited_by_rounding";
    case Status::interrupted: break;
  }
  return "interrupted";
}

ordered_json result_json(const Result& result, const RunFigures& figures, const Case& input,
                         const Mesh& mesh) {
  const int dim = mesh.dim();
  ordered_json json = ordered_json::object();
  json["status"] = status_name(result.status);
  json["message"] = result.message;
  json["warnings"] = result.warnings;
  json["unknowns"] = result.unknowns;
  json["elements"] = result.elements;
  json["contact_nodes"] = result.contact_nodes;
  json["active_nodes"] = result.active_nodes;
  json["slip_nodes"] = result.slip_nodes;
  json["outer_iterations"] = result.outer_iterations;
  if (result.restarted_after >= 0) json["restarted_after"] = result.restarted_after;
  json["contact_iterations"] = result.contact_iterations;
  json["cg_iterations"] = result.cg_iterations;
  json["operator_applications"] = result.operator_applications;
  json["applications"] = {
      {"spectrum", result.spectrum_applications},
      {"contact", result.contact_applications},
      {"outer", result.operator_applications - result.spectrum_applications - result.contact_applications}};
  json["r"] = result.r;
  json["lambda_min"] = result.lambda_min;
  json["lambda_max"] = result.lambda_max;
  json["r_star"] = result.r_star;
  json["r_star_estimated"] = input.model.solver.penalty != SolverOptions::Penalty::paper;
  json["r_active"] = result.r_active;
  json["contact_force"] = entries(result.contact_force, dim);
  json["friction_force"] = entries(result.friction_force, dim);
  json["bound_change"] = result.bound_change;
  json["max_contact_pressure"] = result.max_contact_pressure;
  json["max_von_mises"] = result.max_von_mises;
  json["max_von_mises_nodal"] = result.max_von_mises_nodal.value;
  json["max_von_mises_at"] = entries(result.max_von_mises_nodal.at, dim);
  json["plastic_elements"] = result.plastic_elements;
  json["plastic_share"] = result.plastic_share;
  json["softening_elements"] = result.softening_elements;
  json["load_reached"] = result.load_reached;
  json["load_factor"] = result.load_factor;
  json["load_cuts"] = result.load_cuts;
  json["max_displacement"] = extreme_json(result.max_displacement, "node", dim);
  json["max_displacement"]["relative"] = result.max_displacement.value / result.body.size;
  json["max_strain"] = extreme_json(result.max_strain, "element", dim);
  json["max_flow"] = extreme_json(result.max_flow, "element", dim);
  json["max_rotation"] = extreme_json(result.max_rotation, "element", dim);
  json["contact"] = ordered_json::object();
  for (const ContactTotals& contact : result.contact)
    json["contact"][entry_name(input.model.contact[contact.entry], contact.entry)] =
        contact_json(contact, input.model, dim);
  json["reaction"] = boundary_json(result.reaction, input.model, dim);
  json["load"] = boundary_json(result.load, input.model, dim);
  json["probe"] = ordered_json::array();
  for (const Vector3& u : result.probe) json["probe"].push_back(entries(u, dim));
  json["discretisation"] = discretisation_json(result.discretisation, dim);
  if (!result.load_steps.empty()) json["load_steps"] = ordered_json::array();
  for (const LoadStep& step : result.load_steps) {
    ordered_json line{{result.by_time ? "time" : "factor", step.factor},
                      {"outer_iterations", step.outer_iterations},
                      {"cg_iterations", step.cg_iterations},
                      {"active_nodes", step.active_nodes},
                      {"slip_nodes", step.slip_nodes},
                      {"contact_force", entries(step.contact_force, dim)},
                      {"friction_force", entries(step.friction_force, dim)},
                      {"max_contact_pressure", step.max_contact_pressure},
                      {"plastic_elements", step.plastic_elements},
                      {"worst_residual", step.worst_residual},
                      {"probe", ordered_json::array()}};
    for (const Vector3& u : step.probe) line["probe"].push_back(entries(u, dim));
    for (std::size_t e = 0; e < step.travel.size(); ++e)
      if (input.model.contact[e].force_controlled)
        line["travel"][entry_name(input.model.contact[e], e)] = step.travel[e];
    json["load_steps"].push_back(line);
  }
  json["mesh"] = mesh_json(result, input.mesh, mesh);
  if (!figures.sets.empty()) json["mesh"]["sets"] = figures.sets;
  json["certificate"] = residuals_json(result.certificate);
  json["certificate"]["rounding"] = residuals_json(result.certificate.rounding);
  const PhaseSeconds& seconds = result.seconds;
  json["seconds"] = {{"total", figures.total},
                     {"read", figures.read},
                     {"distribute", figures.distribute},
                     {"solver", seconds.total},
                     {"prepare", seconds.prepare},
                     {"spectrum", seconds.spectrum},
                     {"preconditioner_setup", seconds.preconditioner_setup},
                     {"solve", seconds.solve},
                     {"checkpoint", seconds.checkpoint},
                     {"certificate", seconds.certificate},
                     {"output", figures.output}};
  if (!figures.nested.empty()) json["nested"] = ordered_json::array();
  for (const CoarseLevel& level : figures.nested) {
    json["nested"].push_back({{"unknowns", level.unknowns},
                              {"outer_iterations", level.outer_iterations},
                              {"cg_iterations", level.cg_iterations},
                              {"operator_applications", level.operator_applications},
                              {"seconds", level.seconds}});
    if (level.error > 0.0) json["nested"].back()["error"] = level.error;
  }
  json["peak_memory_bytes"] = figures.peak_memory_bytes;
  json["ranks"] = result.ranks;
  json["threads"] = result.threads;
  json["instruction_set"] = result.instruction_set;
  json["version"] = KACANOV_VERSION;
  json["case"] = ordered_json(input.document);
  return json;
}

ordered_json failure_json(const std::string& message) {
  return {{"status", "failed"}, {"message", message}, {"version", KACANOV_VERSION}};
}

ordered_json spectrum_json(std::span<const SpectrumResult> results, std::int64_t unknowns,
                           std::int64_t contact_nodes) {
  ordered_json json = ordered_json::object();
  json["unknowns"] = unknowns;
  json["contact_nodes"] = contact_nodes;
  const SpectrumResult& decisive = results.back();
  json["lambda_min"] = decisive.lambda_min;
  json["lambda_max"] = decisive.lambda_max;
  json["r_star"] = decisive.r_star;
  json["spectrum"] = ordered_json::array();
  for (const SpectrumResult& result : results) json["spectrum"].push_back(estimate_json(result));
  json["version"] = KACANOV_VERSION;
  return json;
}

}  // namespace kacanov
