// SPDX-License-Identifier: BSD-3-Clause
// Terminal output of a run: one line per step and a summary.
#include "program/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "formats/printable.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  std::array<char, 256> buffer{};
  std::snprintf(buffer.data(), buffer.size(), pattern, arguments...);
  return buffer.data();
}

/// Relative to the largest number printed beside it, smaller values are round-off.
constexpr double rounding = 1e-12;

/// Components that are round-off, relative to the vector itself and `scale`, print as 0.
std::string vector_text(const Vector3& v, int dim, double scale = 0.0) {
  const double least = rounding * std::max(norm(v), scale);
  std::string text = "(";
  for (int c = 0; c < dim; ++c)
    text += (c > 0 ? ", " : "") + format("%.6g", std::abs(v[c]) > least ? v[c] : 0.0);
  return text + ")";
}

/// Formats a moment: one number in 2D.
std::string moment_text(const Vector3& v, int dim, double scale) {
  if (dim == 2) return format("%.6g", std::abs(v[2]) > rounding * scale ? v[2] : 0.0);
  return vector_text(v, dim, scale);
}

/// Prints negligible values, such as 3.6e-228, as 0.
std::string residual_text(double value) {
  constexpr double nothing = 1e-30;
  return std::abs(value) < nothing ? "0" : format("%.1e", value);
}

/// Magnitudes relative to which a component of a force or a moment counts as 0.
struct Scales {
  double force = 0.0, moment = 0.0;
};

Scales scales_of(const Result& result) {
  Scales scales;
  const auto take = [&](const Resultant& total) {
    scales.force = std::max(scales.force, norm(total.force));
    scales.moment = std::max(scales.moment, norm(total.moment));
  };
  for (const BoundaryTotals& totals : result.load) take(totals.total);
  for (const BoundaryTotals& totals : result.reaction) take(totals.total);
  for (const ContactTotals& totals : result.contact) take(totals.total);
  scales.moment = std::max(scales.moment, scales.force * result.body.size);
  return scales;
}

std::string count(std::int64_t n) { return std::to_string(n); }

/// Limit of entries per kind in the summary; result.json has all.
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

std::string contact_line(const ContactTotals& contact, const Model& model, int dim, const Scales& scales) {
  const ContactEntry& entry = model.contact[contact.entry];
  std::string text = entry_name(entry, static_cast<std::size_t>(contact.entry)) + ": force " +
                     vector_text(contact.total.force, dim, scales.force);
  if (entry.friction) text += ", of it friction " + vector_text(contact.friction_force, dim, scales.force);
  if (entry.force_controlled) text += format(", pushed by %.6g", contact.travel);
  const std::int64_t touching = contact.sticking + contact.slipping;
  if (touching == 0) return text + format(", touches nowhere, least gap %.4g", contact.least_gap);
  text += ", " + count(touching) + " of " + count(touching + contact.open) + " nodes touch";
  if (entry.friction) text += ", " + count(contact.slipping) + " of them slip";
  return text + format(", pressure up to %.6g", contact.max_pressure);
}

std::string boundary_line(const BoundaryTotals& totals, const Model& model, int dim, const Scales& scales) {
  const std::size_t i = totals.entry;
  return entry_name(model.boundary[i], i) + ": force " + vector_text(totals.total.force, dim, scales.force) +
         ", moment " + moment_text(totals.total.moment, dim, scales.moment);
}

std::string place_text(const Extreme& extreme, int dim) {
  return format("%.4g at ", extreme.value) + vector_text(extreme.at, dim);
}

/// Error estimates, relative to the estimated quantities.
std::string discretisation_line(const Result& result) {
  const Discretisation& error = result.discretisation;
  std::string text = format("  mesh error    about %.2g %% in the energy norm", 100.0 * error.energy);
  const auto add = [&](const Vector3& of, const Vector3& value, const std::string& what) {
    if (norm(value) > 0.0) text += format(", %.2g %% of ", 100.0 * norm(of) / norm(value)) + what;
  };
  if (error.contact_force) add(*error.contact_force, result.contact_force, "the contact force");
  for (std::size_t i = 0; i < std::min<std::size_t>(error.probe.size(), 3); ++i)
    add(error.probe[i], result.probe[i], "probe " + std::to_string(i));
  return text + "\n";
}

}  // namespace

void ProgressTable::head() {
  if (headed_) return;
  std::cout << coloured(terminal_, Colour::grey,
                        format("%4s %-10s %7s %6s", "step", "method", "contact", "CG") +
                            (terminal_.width >= 90 ? format(" %8s", "r") : "") +
                            format(" %7s %7s %7s %7s %7s %8s", "equil.", "penetr.", "frict.", "worst",
                                   "seconds", "left"))
            << "\n";
  headed_ = true;
}

void ProgressTable::stage(const std::string& name) {
  head();
  std::cout << coloured(terminal_, Colour::grey, printable(name)) << "\n" << std::flush;
  worst_ = 0.0;
}

void ProgressTable::operator()(const ProgressStep& step) {
  const bool wide = terminal_.width >= 90;
  head();
  const Certificate& c = step.certificate;
  const double worst = c.worst();
  std::cout << format("%4d %-10s %7lld %6lld", step.outer, step.phase.c_str(),
                      static_cast<long long>(step.contact_iterations),
                      static_cast<long long>(step.cg_iterations))
            << (wide ? format(" %8.2g", step.r) : "");
  for (const double residual : {c.equilibrium, c.penetration, c.friction_cone, worst})
    std::cout << format(" %7s", residual_text(residual).c_str());
  std::cout << format(" %7.*f %8s\n", step.seconds < 1000.0 ? 2 : 0, step.seconds, left(step).c_str())
            << std::flush;
  worst_ = worst;
  seconds_ = step.seconds;
}

/// Estimates the time until the tolerance is reached if the residual continues to fall as in this step.
std::string ProgressTable::left(const ProgressStep& step) const {
  const double worst = step.certificate.worst(), gained = std::log(worst_ / worst);
  constexpr double least = 0.1;  // natural logarithm; a smaller reduction gives no useful estimate
  if (!(worst > tolerance_ && gained > least)) return "";
  const double seconds = (step.seconds - seconds_) * std::log(worst / tolerance_) / gained;
  return seconds < 1.0 ? "" : readable_seconds(seconds);
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

std::string readable_share(double share) { return format("%.2g %%", 100.0 * share); }

std::string readable_seconds(double seconds) {
  if (seconds < 10.0) return format("%.2g s", seconds);
  if (seconds < 120.0) return format("%.0f s", seconds);
  if (seconds < 7200.0) return format("%.0f min", seconds / 60.0);
  return format("%.1f h", seconds / 3600.0);
}

namespace {

std::string first_words(Status status) {
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
  const Scales scales = scales_of(result);
  std::string text = first_words(result.status) + result.message + "\n";
  for (const std::string& warning : result.warnings) text += "  warning       " + warning + "\n";
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
    text += "  forces        normal " + vector_text(result.contact_force, dim, scales.force) + ", friction " +
            vector_text(result.friction_force, dim, scales.force) + "\n";
    if (result.r_star > 0.0)
      text += format("  penalty       r* = %.3g", result.r_star) +
              (result.r_active > 0.0 ? format(", adapted %.3g", result.r_active) : "") +
              (model.solver.penalty == SolverOptions::Penalty::paper ? " (" : " (estimated, ") +
              format("lambda %.4g to %.4g)\n", result.lambda_min, result.lambda_max);
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
  const double still = rounding * result.max_displacement.value / result.body.size;
  if (result.max_strain.value > still)
    text += "  strain        up to " + place_text(result.max_strain, dim) +
            format(", rotation up to %.3g\n", result.max_rotation.value);
  else
    text += "  strain        0\n";
  const auto of_boundary = [&](const BoundaryTotals& totals) {
    return boundary_line(totals, model, dim, scales);
  };
  text += entry_lines("load", result.load, of_boundary);
  text += entry_lines("support", result.reaction, of_boundary);
  text += entry_lines("obstacle", result.contact,
                      [&](const ContactTotals& totals) { return contact_line(totals, model, dim, scales); });
  for (std::size_t i = 0; i < result.probe.size(); ++i) {
    text += "  probe         " + vector_text(model.probes[i], dim) + " moves by " +
            vector_text(result.probe[i], dim) + "\n";
  }
  text += discretisation_line(result);
  const Certificate& c = result.certificate;
  text += "  certificate   equilibrium " + residual_text(c.equilibrium) + ", penetration " +
          residual_text(c.penetration) + ", tension " + residual_text(c.tension) + ", complementarity " +
          residual_text(c.complementarity) + ", friction cone " + residual_text(c.friction_cone) +
          ", force balance " + residual_text(c.force_balance) + ", duality gap " +
          residual_text(c.duality_gap) + "\n";
  text += "                rounding alone leaves up to " + residual_text(c.rounding.worst()) + "\n";
  text += "  cost          " + readable_seconds(figures.total) + ", " +
          readable_bytes(static_cast<double>(figures.peak_memory_bytes)) + ", " + count(result.ranks) +
          (result.ranks == 1 ? " rank x " : " ranks x ") + count(result.threads) +
          (result.threads == 1 ? " thread" : " threads") + " (" + result.instruction_set + ")\n";
  return printable(text);
}

std::string shown(const Terminal& terminal, Status status, const std::string& summary) {
  constexpr int behind_headings = 16;
  std::string text = wrapped(summary, terminal.width, behind_headings);
  if (!terminal.colour) return text;
  const std::string first = first_words(status);
  const Colour colour = status == Status::converged ? Colour::green : Colour::red;
  text = coloured(terminal, colour, first) + text.substr(first.size());
  const std::string warning = "\n  warning ";
  const std::string yellow = "\n  " + coloured(terminal, Colour::yellow, "warning") + " ";
  for (std::size_t at = 0; (at = text.find(warning, at)) != std::string::npos; at += yellow.size())
    text.replace(at, warning.size(), yellow);
  return text;
}

}  // namespace kacanov
