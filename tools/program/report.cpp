// SPDX-License-Identifier: BSD-3-Clause
// What a run tells people: a line a step while it goes, a summary when it is done.
#include "program/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "problem/vector3.hpp"

namespace kacanov {
namespace {

template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  std::array<char, 256> buffer{};
  std::snprintf(buffer.data(), buffer.size(), pattern, arguments...);
  return buffer.data();
}

/// What rounding leaves of a component is 0.
std::string vector_text(const Vector3& v, int dim) {
  constexpr double rounding = 1e-12;
  const double least = rounding * norm(v);
  std::string text = "(";
  for (int c = 0; c < dim; ++c)
    text += (c > 0 ? ", " : "") + format("%.6g", std::abs(v[c]) > least ? v[c] : 0.0);
  return text + ")";
}

/// Of a moment: a number in 2D.
std::string moment_text(const Vector3& v, int dim) {
  return dim == 2 ? format("%.6g", v[2]) : vector_text(v, dim);
}

std::string count(std::int64_t n) { return std::to_string(n); }

/// The summary lists no more entries of a kind; result.json has all.
constexpr std::size_t most_lines = 8;

template <class Totals, class Line>
std::string entry_lines(const char* heading, const std::vector<Totals>& totals, const Line& line) {
  std::string text;
  for (std::size_t i = 0; i < totals.size(); ++i) {
    if (i == most_lines) return text + format("                and %zu more\n", totals.size() - i);
    text += format("  %-13s ", heading) + line(totals[i]) + "\n";
  }
  return text;
}

std::string contact_line(const ContactTotals& contact, const Model& model, int dim) {
  const ContactEntry& entry = model.contact[contact.entry];
  std::string text = entry_name(entry, static_cast<std::size_t>(contact.entry)) + ": force " +
                     vector_text(contact.total.force, dim);
  if (entry.friction) text += ", of it friction " + vector_text(contact.friction_force, dim);
  if (entry.force_controlled) text += format(", pushed by %.6g", contact.travel);
  const std::int64_t touching = contact.sticking + contact.slipping;
  if (touching == 0) return text + format(", touches nowhere, least gap %.4g", contact.least_gap);
  text += ", " + count(touching) + " of " + count(touching + contact.open) + " nodes touch";
  if (entry.friction) text += ", " + count(contact.slipping) + " of them slip";
  return text + format(", pressure up to %.6g", contact.max_pressure);
}

std::string boundary_line(const BoundaryTotals& totals, const Model& model, int dim) {
  const std::size_t i = totals.entry;
  return entry_name(model.boundary[i], i) + ": force " + vector_text(totals.total.force, dim) + ", moment " +
         moment_text(totals.total.moment, dim);
}

std::string place_text(const Extreme& extreme, int dim) {
  return format("%.4g at ", extreme.value) + vector_text(extreme.at, dim);
}

}  // namespace

void ProgressTable::operator()(const ProgressStep& step) {
  if (!headed_) {
    std::cout << format("%4s  %-10s %8s %8s %10s %12s %12s %12s %12s %9s\n", "step", "method", "contact",
                        "CG", "r", "equilibrium", "penetration", "friction", "worst", "seconds");
    headed_ = true;
  }
  std::cout << format("%4d  %-10s %8lld %8lld %10.3e %12.2e %12.2e %12.2e %12.2e %9.2f\n", step.outer,
                      step.phase.c_str(), static_cast<long long>(step.contact_iterations),
                      static_cast<long long>(step.cg_iterations), step.r, step.certificate.equilibrium,
                      step.certificate.penetration, step.certificate.friction_cone, step.certificate.worst(),
                      step.seconds)
            << std::flush;
}

std::string readable_bytes(double bytes) {
  constexpr std::array units{"B", "kB", "MB", "GB", "TB"};
  std::size_t unit = 0;
  while (bytes >= 1000.0 && unit + 1 < units.size()) {
    bytes /= 1000.0;
    ++unit;
  }
  return format(bytes < 10.0 && unit > 0 ? "%.1f %s" : "%.0f %s", bytes, units[unit]);
}

std::string readable_seconds(double seconds) {
  if (seconds < 10.0) return format("%.2g s", seconds);
  if (seconds < 120.0) return format("%.0f s", seconds);
  if (seconds < 7200.0) return format("%.0f min", seconds / 60.0);
  return format("%.1f h", seconds / 3600.0);
}

namespace {

std::string headline(Status status) {
  switch (status) {
    case Status::converged: return "converged: ";
    case Status::limited_by_rounding: return "LIMITED BY ROUNDING: ";
    case Status::interrupted: return "INTERRUPTED: ";
    case Status::not_converged: break;
  }
  return "NOT CONVERGED: ";
}

}  // namespace

std::string summary(const Result& result, const RunFigures& figures, const Model& model, int dim) {
  std::string text = headline(result.status) + result.message + "\n";
  text +=
      "  size          " + count(result.unknowns) + " unknowns, " + count(result.elements) + " elements\n";
  text += "  iterations    " + count(result.outer_iterations) + " outer, " +
          count(result.contact_iterations) + " contact, " + count(result.cg_iterations) + " CG\n";
  if (result.contact_nodes > 0) {
    text += "  contact       " + count(result.active_nodes) + " of " + count(result.contact_nodes) +
            " nodes touch";
    if (std::any_of(model.contact.begin(), model.contact.end(),
                    [](const auto& c) { return c.friction.has_value(); })) {
      text += ", " + count(result.slip_nodes) + " slip";
    }
    text += format(", pressure up to %.6g\n", result.max_contact_pressure);
    text += "  forces        normal " + vector_text(result.contact_force, dim) + ", friction " +
            vector_text(result.friction_force, dim) + "\n";
    text += format("  penalty       r* = %.3g, adapted %.3g (rough lambda %.4g to %.4g)\n", result.r_star,
                   result.r_active, result.lambda_min, result.lambda_max);
  }
  if (result.load_cuts > 0)
    text += format("  load          reached the factor %.4g, ", result.load_reached) +
            count(result.load_cuts) +
            (result.load_cuts == 1 ? " load step was halved\n" : " load steps were halved\n");
  text += format("  stress        von Mises up to %.6g in elements, ", result.max_von_mises) +
          place_text(result.max_von_mises_nodal, dim) + " of nodes\n";
  text += "  yield         " + count(result.plastic_elements) + " elements beyond it" +
          format(", %.3g %% of the volume\n", 100.0 * result.plastic_share);
  text += "  displacement  up to " + place_text(result.max_displacement, dim) +
          format(", %.2g of the body's size\n", result.max_displacement.value / result.body.size);
  text += "  strain        up to " + place_text(result.max_strain, dim) +
          format(", rotation up to %.3g\n", result.max_rotation.value);
  const auto of_boundary = [&](const BoundaryTotals& totals) { return boundary_line(totals, model, dim); };
  text += entry_lines("load", result.load, of_boundary);
  text += entry_lines("support", result.reaction, of_boundary);
  text += entry_lines("obstacle", result.contact,
                      [&](const ContactTotals& totals) { return contact_line(totals, model, dim); });
  for (std::size_t i = 0; i < result.probe.size(); ++i) {
    text += "  probe         " + vector_text(model.probes[i], dim) + " moves by " +
            vector_text(result.probe[i], dim) + "\n";
  }
  for (const std::string& warning : result.warnings) text += "  warning       " + warning + "\n";
  const Certificate& c = result.certificate;
  text += format("  certificate   equilibrium %.1e, penetration %.1e, tension %.1e, complementarity %.1e,\n",
                 c.equilibrium, c.penetration, c.tension, c.complementarity);
  text += format("                friction cone %.1e, force balance %.1e, duality gap %.1e\n",
                 c.friction_cone, c.force_balance, c.duality_gap);
  text += format("                rounding alone leaves up to %.1e\n", c.rounding.worst());
  text += "  cost          " + readable_seconds(figures.total) + ", " +
          readable_bytes(static_cast<double>(figures.peak_memory_bytes)) + ", " + count(result.ranks) +
          (result.ranks == 1 ? " rank x " : " ranks x ") + count(result.threads) +
          (result.threads == 1 ? " thread" : " threads") + " (" + result.instruction_set + ")\n";
  return text;
}

}  // namespace kacanov
