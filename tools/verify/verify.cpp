// SPDX-License-Identifier: BSD-3-Clause
// Reads the solution of a run, recomputes its certificate, and compares both with the result.
#include "verify/verify.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>

#include "verify/file.hpp"
#include "verify/residuals.hpp"
#include "verify/totals.hpp"
#include "verify/vtu.hpp"

namespace kacanov::verify {
namespace {

using nlohmann::json;

json read_result(const std::filesystem::path& file) {
  std::ifstream stream = open_file(file);
  json result = json::parse(stream, nullptr, false);
  if (result.is_discarded()) throw Failure(file.string() + ": is no JSON");
  if (result.value("status", "") == "failed") throw Failure(file.string() + ": this run has failed");
  return result;
}

const Array& array_of(const std::map<std::string, Array>& arrays, const std::string& name, std::size_t width,
                      const std::string& file) {
  const auto found = arrays.find(name);
  if (found == arrays.end() || found->second.components != width || found->second.values.size() % width != 0)
    throw Failure(file + ": expected an array " + name + " with " + std::to_string(width) + " components");
  return found->second;
}

/// Returns an array that must have one entry per node number.
const Array& array_of(const std::map<std::string, Array>& arrays, const std::string& name, std::size_t width,
                      const std::string& file, const Array& ids) {
  const Array& array = array_of(arrays, name, width, file);
  if (array.values.size() != width * ids.values.size())
    throw Failure(file + ": the array " + name + " has not as many entries as there are nodes");
  return array;
}

Vec triple(const Array& array, std::size_t i) {
  return {array.values.at(3 * i), array.values.at(3 * i + 1), array.values.at(3 * i + 2)};
}

/// Returns whether the nodes of every patch are connected through elements.
bool hang_together(const Mesh& mesh, const std::vector<std::int64_t>& patch) {
  std::vector<std::size_t> above(patch.size());
  std::iota(above.begin(), above.end(), std::size_t{0});
  const auto top = [&](std::size_t n) {
    while (above[n] != n) n = above[n] = above[above[n]];
    return n;
  };
  for (const Indices& element : mesh.elements)
    for (const auto a : element)
      for (const auto b : element)
        if (patch[a] == patch[b]) above[top(a)] = top(b);
  std::map<std::int64_t, std::size_t> seen;
  for (std::size_t n = 0; n < patch.size(); ++n)
    if (seen.emplace(patch[n], top(n)).first->second != top(n)) return false;
  return true;
}

/// Field files of the end of a load step.
struct FieldFiles {
  std::filesystem::path folder;
  std::string mark;  ///< suffix after "body" and "contact"; empty: the end of the run

  std::filesystem::path named(const char* field) const { return folder / (field + mark + ".vtu"); }
};

/// Reads the displacement of every node from all pieces; duplicates must agree. `patch`: patch of each node,
/// if the file has patches.
std::vector<Vec> read_displacement(const FieldFiles& files, const Mesh& mesh,
                                   std::vector<std::int64_t>& patch) {
  std::map<std::int64_t, std::size_t> index;
  for (std::size_t n = 0; n < mesh.tags.size(); ++n) index[mesh.tags[n]] = n;
  const std::string file = files.named("body").string();
  std::vector<Vec> u(mesh.nodes.size());
  std::vector<bool> known(u.size(), false);
  // File nodes have exactly the coordinates read; new ones of a finer mesh may be rounded differently.
  Real far = 0;
  for (const Vec& x : mesh.nodes) far = larger(far, norm(x));
  const Real slack = 1e-14L * mesh.size() + 4 * std::numeric_limits<double>::epsilon() * far;
  for (const auto& piece : read_body(files.folder, files.mark)) {
    const Array &ids = array_of(piece, "node_id", 1, file), &points = array_of(piece, "Points", 3, file, ids),
                &values = array_of(piece, "displacement", 3, file, ids);
    const bool patches = piece.count("pressure_patch") > 0;
    if (patches) patch.resize(u.size());
    for (std::size_t i = 0; i < ids.values.size(); ++i) {
      const auto found = index.find(static_cast<std::int64_t>(ids.values[i]));
      const std::string name = file + ": node " + std::to_string(static_cast<std::int64_t>(ids.values[i]));
      if (found == index.end()) throw Failure(name + " is not in the mesh");
      const std::size_t n = found->second;
      Vec away = triple(points, i) - mesh.nodes[n];
      if (mesh.dim() == 2) away[2] = 0;
      if (!(norm(away) <= slack)) throw Failure(name + " lies elsewhere in the mesh");
      const Vec value = triple(values, i);
      if (patches)
        patch[n] = static_cast<std::int64_t>(array_of(piece, "pressure_patch", 1, file, ids).values[i]);
      if (known[n] && u[n] != value) throw Failure(name + " moves differently on two ranks");
      u[n] = value;
      known[n] = true;
    }
  }
  if (!std::all_of(known.begin(), known.end(), [](bool b) { return b; }))
    throw Failure(file + ": there are nodes of the mesh that it does not have");
  if (!patch.empty() && !hang_together(mesh, patch))
    throw Failure(file + ": pressure_patch: there are patches of nodes that do not hang together");
  return u;
}

void read_multipliers(const FieldFiles& files, Problem& problem, Answer& answer) {
  if (problem.rows.empty()) return;
  const std::string file = files.named("contact").string();
  const auto arrays = read_point_data(file);
  const Array &ids = array_of(arrays, "node_id", 1, file),
              &pressure = array_of(arrays, "pressure", 1, file, ids),
              &traction = array_of(arrays, "tangential_traction", 3, file, ids),
              &status = array_of(arrays, "status", 1, file, ids);
  if (ids.values.size() != problem.surface_tags.size())
    throw Failure(file + ": has " + std::to_string(ids.values.size()) + " nodes, expected " +
                  std::to_string(problem.surface_tags.size()) + ", as the contact entries select");
  for (std::size_t i = 0; i < ids.values.size(); ++i)
    if (static_cast<std::int64_t>(ids.values[i]) != problem.surface_tags[i])
      throw Failure(file + ": expected node " + std::to_string(problem.surface_tags[i]) + " in place " +
                    std::to_string(i));
  std::erase_if(problem.rows,
                [&](const ContactRow& row) { return row.grazing && status.values[row.written[0]] < 0; });
  for (const ContactRow& row : problem.rows) {
    answer.pressure.push_back(pressure.values[row.written[0]]);
    answer.traction.push_back(triple(traction, row.written[0]));
    answer.status.push_back(static_cast<int>(status.values[row.written[0]]));
    if (answer.status.back() > 2 || (answer.status.back() == 0 && answer.pressure.back() > 0))
      throw Failure(file + ": node " + std::to_string(problem.surface_tags[row.written[0]]) +
                    " bears pressure, and is marked as open");
    for (const std::size_t i : row.written) {
      if (status.values[i] < 0)
        throw Failure(file + ": node " + std::to_string(problem.surface_tags[i]) +
                      " is a contact node, and is marked as none");
      if (pressure.values[i] != answer.pressure.back() || triple(traction, i) != answer.traction.back())
        throw Failure(file + ": node " + std::to_string(problem.surface_tags[i]) +
                      " is one contact node of two entries, and has two pressures");
    }
  }
}

/// Returns the force of a force-controlled entry on the body along its direction, divided by the prescribed
/// force.
Real share_of_force(const Problem& problem, const Answer& answer, const json& entry, std::size_t index) {
  const Vec way = read_vector(entry.at("force_controlled").at("direction"));
  Vec force{};
  for (std::size_t i = 0; i < problem.rows.size(); ++i) {
    const ContactRow& row = problem.rows[i];
    if (row.entry == index)
      force = force + row.mass * (answer.traction[i] - answer.pressure[i] * row.shares[0].normal);
  }
  return dot(force, way) / norm(way) /
         (problem.contact_factor[index] * Real(entry.at("force_controlled").at("force").get<double>()));
}

/// Returns the largest relative error of the force-controlled entries.
Real off_forces(const Problem& problem, const Answer& answer, const json& contact) {
  Real worst = 0;
  for (std::size_t i = 0; i < contact.size(); ++i)
    if (contact[i].contains("force_controlled") && problem.contact_factor[i] > 0)
      worst = larger(worst, std::abs(share_of_force(problem, answer, contact[i], i) - 1));
  return worst;
}

/// Builds the table, and records whether the result agrees with the recomputed values.
class Comparison {
 public:
  Comparison(const json& result, Real tolerance) : result_(result), tolerance_(tolerance) {
    text_ = "                        the result says      recomputed        rounding\n";
  }

  void entry(const Entry& entry) {
    const json& says = result_.at("certificate").at(entry.name);
    const Real said = says.is_number() ? Real(says.get<double>()) : HUGE_VALL;
    // Apart from round-off, both are the same sums of the same numbers. A thousandth of the tolerance decides
    // nothing.
    const bool agrees = std::abs(said - entry.residual) <= 1e-3L * larger(said, entry.residual) +
                                                               2 * entry.rounding + 1e-14L +
                                                               1e-3L * tolerance_;
    line(entry.name, said, entry.residual, entry.rounding, agrees);
  }

  void vector(const char* name, const Vec& found, Real scale) {
    const json& says = result_.at(name);
    for (std::size_t c = 0; c < says.size(); ++c) {
      const Real said = says.at(c).get<double>();
      line(std::string(name) + "[" + "xyz"[c] + "]", said, found[c], 0,
           std::abs(said - found[c]) <= 1e-11L * scale);
    }
  }

  void number(const char* name, Real found, Real rounding) {
    const Real said = result_.at(name).get<double>();
    line(name, said, found, rounding,
         std::abs(said - found) <= 1e-11L * larger(std::abs(said), std::abs(found)) + rounding);
  }

  void count(const char* name, std::size_t found) {
    if (result_.at(name).get<std::int64_t>() != static_cast<std::int64_t>(found)) {
      agrees_ = false;
      text_ += std::string("  ") + name + ": " + std::to_string(found) + ", and the result says " +
               result_.at(name).dump() + "\n";
    }
  }

  void differing(const Difference& one) { line(one.name, one.said, one.found, one.rounding, false); }

  bool agrees() const { return agrees_; }
  const std::string& text() const { return text_; }

 private:
  void line(const std::string& name, Real said, Real found, Real rounding, bool agrees) {
    std::array<char, 160> row{};
    std::snprintf(row.data(), row.size(), "  %-22s %16.8Lg %15.8Lg %15.2Lg%s\n", name.c_str(), said, found,
                  rounding, agrees ? "" : "  differs");
    text_ += row.data();
    agrees_ = agrees_ && agrees;
  }

  const json& result_;  ///< result.json, or a line of its `load_steps`
  Real tolerance_;      ///< of the run
  std::string text_;
  bool agrees_ = true;
};

std::string scientific(Real value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2Le", value);
  return text.data();
}

/// State at the end of a load step, as read from its files.
struct State {
  Problem problem;
  Answer answer;
};

State read_state(const json& document, const std::filesystem::path& folder, const LoadPoint& point,
                 const FieldFiles& files) {
  State state{read_problem(document, folder, point), {}};
  Problem& problem = state.problem;
  find_rows(document.value("contact", json::array()), folder, problem);
  state.answer.u = read_displacement(files, problem.mesh, problem.patch);
  if (problem.mesh.shape == Shape::tet4 && problem.patch.empty() &&
      std::any_of(problem.laws.begin(), problem.laws.end(), [](const Law& law) { return law.mixed; }))
    throw Failure(files.named("body").string() + ": expected an array pressure_patch: tet4 is mixed");
  read_multipliers(files, problem, state.answer);
  return state;
}

/// Describes the fault of a load step before the last; empty if there is none. `line`: its entry in
/// `load_steps`.
std::string fault_of_step(const State& state, const json& document, const json& line, std::string& table) {
  const Problem& problem = state.problem;
  const Findings found = examine(problem, state.answer);
  Real worst = 0;
  bool small = true;
  for (const Entry& entry : found.entries) {
    worst = larger(worst, entry.residual);
    // The run also accepts a step whose residuals are round-off.
    small = small && (entry.residual <= problem.tolerance || entry.residual <= entry.rounding);
  }
  Comparison comparison(line, problem.tolerance);
  if (!problem.rows.empty()) {
    comparison.vector("contact_force", found.contact_force, found.force);
    comparison.vector("friction_force", found.friction_force, found.force);
    comparison.number("max_contact_pressure", found.pressure, 0);
  }
  const Real pushed = off_forces(problem, state.answer, document.value("contact", json::array()));
  std::string fault;
  if (found.supports > 1e-14L)
    fault = "the supports are not where they are prescribed, by " + scientific(found.supports) +
            " of the displacement";
  else if (!small)
    fault = "the answer does not meet its tolerance " + scientific(problem.tolerance) +
            ": the worst residual is " + scientific(worst);
  else if (pushed > 11 * problem.tolerance)
    fault = "the force of an obstacle that is pushed is off by " + scientific(pushed);
  else if (!comparison.agrees())
    fault = "the result says something else than is found";
  const std::string name = "load step " + std::to_string(problem.point.step + 1);
  table += "  " + name + ": the worst residual is " + scientific(worst) + "\n";
  if (!comparison.agrees()) table += comparison.text();
  return fault.empty() ? fault : name + ": " + fault;
}

/// Verifies the load steps before the last in order, and stores each displacement in the next point. Returns
/// the first fault; later steps cannot be verified then.
std::string verify_history(const json& document, const std::filesystem::path& folder,
                           const std::filesystem::path& output, std::vector<LoadPoint>& points,
                           std::string& table) {
  const json result = read_result(output / "result.json");
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const FieldFiles files{output, "_step_" + std::to_string(k + 1)};
    if (!std::filesystem::exists(files.named("body")))
      throw Failure(
          files.named("body").string() +
          ": is missing; the verifier needs the fields of each load step where slip counts from the "
          "step before or nodes face obstacles from where it has left them (output.steps)");
    const State state = read_state(document, folder, points[k], files);
    std::string fault = fault_of_step(state, document, result.at("load_steps").at(k), table);
    if (!fault.empty()) return fault;
    points[k + 1].before = state.answer.u;
  }
  return {};
}

}  // namespace

Verdict verify(json document, const std::filesystem::path& folder, const std::filesystem::path& output) {
  const json result = read_result(output / "result.json");
  // A mesh adapted by the run is in the output folder.
  if (document.at("mesh").contains("adapt"))
    document["mesh"] = {{"file", std::filesystem::absolute(output / "mesh.msh").string()}};
  Verdict verdict;
  std::vector<LoadPoint> points = load_points(document, result);
  if (has_history(document))
    verdict.sentence = verify_history(document, folder, output, points, verdict.table);
  if (!verdict.sentence.empty()) return verdict;
  const State state = read_state(document, folder, points.back(), {output, ""});
  const Problem& problem = state.problem;
  const Answer& answer = state.answer;
  const Findings found = examine(problem, answer);

  Comparison comparison(result, problem.tolerance);
  Real worst = 0, unknown = 0;
  for (const Entry& entry : found.entries) {
    comparison.entry(entry);
    worst = larger(worst, entry.residual);
    unknown = larger(unknown, entry.rounding);
  }
  if (!problem.rows.empty()) {
    comparison.vector("contact_force", found.contact_force, found.force);
    comparison.vector("friction_force", found.friction_force, found.force);
    comparison.number("max_contact_pressure", found.pressure, 0);
  }
  const Real pushed = off_forces(problem, answer, document.value("contact", json::array()));
  comparison.number("max_von_mises", found.von_mises, found.unknown_stress);
  for (const Difference& one : differing_totals(document, result, problem, answer, found.body))
    comparison.differing(one);
  const json steps = document.value("steps", json::array());
  const Real last = steps.empty() ? 1.0 : steps.back().at("time").get<double>();
  if (result.value("status", "") == "converged" && problem.time != last)
    comparison.differing({"load_factor", problem.time, last, 0});
  comparison.count("unknowns", problem.mesh.nodes.size() * problem.mesh.dim());
  comparison.count("elements", problem.mesh.elements.size());
  comparison.count("contact_nodes", problem.rows.size());

  verdict.table += comparison.text();
  const std::string status = result.value("status", ""), limit = scientific(problem.tolerance);
  const bool held = found.supports == 0, small = worst <= problem.tolerance,
             borne = pushed <= 11 * problem.tolerance, known = unknown <= problem.tolerance;
  verdict.fulfilled = status == "converged" && small && borne && known && held && comparison.agrees();
  verdict.sentence =
      !held ? "the supports are not where they are prescribed, by " + scientific(found.supports) +
                  " of the displacement"
      : !small
          ? "the answer does not meet its tolerance " + limit + ": the worst residual is " + scientific(worst)
      : !borne ? "the force of an obstacle that is pushed is off by " + scientific(pushed)
      : !known ? "rounding hides more than the tolerance " + limit + ": " + scientific(unknown)
      : !comparison.agrees()
          ? "the answer meets its tolerance " + limit + ", but the result says something else than is found"
      : status != "converged"
          ? "the answer meets its tolerance " + limit + ", but the result says " + status
          : "the answer meets its tolerance " + limit + ": the worst residual is " + scientific(worst);
  return verdict;
}

}  // namespace kacanov::verify
