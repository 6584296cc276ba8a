// SPDX-License-Identifier: BSD-3-Clause
// Load curves of a model, entry by entry.
#include "problem/load_curves.hpp"

#include <algorithm>
#include <cmath>

#include <kacanov/error.hpp>
#include "problem/model_checks.hpp"

namespace kacanov {
namespace {

/// Returns the factor of the entry with that name or place; null if no entry matches.
double* factor_of(const Model& model, LoadFactors& factors, const std::string& name) {
  const auto in = [&](const auto& entries, auto unnamed, std::vector<double>& values) -> double* {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (name == entry_name(entries[i], i) || name == entry_name(unnamed, i)) return &values[i];
    return nullptr;
  };
  if (double* found = in(model.boundary, BoundaryEntry(), factors.boundary)) return found;
  return in(model.contact, ContactEntry(), factors.contact);
}

/// Sets factors to 0 that are rounding errors relative to the entry's largest, such as that of sin π.
template <class Entries>
void clear_rounding(std::vector<LoadFactors>& curves, std::vector<double> LoadFactors::*values,
                    const Entries& entries) {
  for (std::size_t i = 0; i < entries.size(); ++i) {
    double largest = 0.0;
    for (const LoadFactors& factors : curves) largest = std::max(largest, std::abs((factors.*values)[i]));
    if (largest > 0.0 && largest < smallest_factor)
      throw InputError("steps: expected factors of \"" + entry_name(entries[i], i) +
                       "\" of which one has a magnitude ≥ 1e-15, got at most " + shown(largest));
    for (LoadFactors& factors : curves)
      if (std::abs((factors.*values)[i]) < smallest_factor * largest) (factors.*values)[i] = 0.0;
  }
}

}  // namespace

std::vector<LoadFactors> load_curves(const Model& model) {
  if (model.steps.empty()) return {};
  LoadFactors now{0.0, std::vector<double>(model.boundary.size(), 1.0),
                  std::vector<double>(model.contact.size(), 1.0)};
  for (std::size_t i = 0; i < model.steps.size(); ++i)
    for (const auto& [name, factor] : model.steps[i].factors) {
      double* start = factor_of(model, now, name);
      if (start == nullptr)
        throw InputError("steps[" + std::to_string(i) +
                         "].factors: expected names of entries, or places such as \"boundary[0]\" (of " +
                         std::to_string(model.boundary.size()) + ") or \"contact[0]\" (of " +
                         std::to_string(model.contact.size()) + "), got \"" + name + "\"");
      *start = 0.0;
    }
  std::vector<LoadFactors> curves{now};
  for (const LoadStage& step : model.steps) {
    now.time = step.time;
    for (const auto& [name, factor] : step.factors) *factor_of(model, now, name) = factor;
    curves.push_back(now);
  }
  clear_rounding(curves, &LoadFactors::boundary, model.boundary);
  clear_rounding(curves, &LoadFactors::contact, model.contact);
  return curves;
}

LoadFactors factors_at(const std::vector<LoadFactors>& curves, double time) {
  const auto after = std::lower_bound(curves.begin(), curves.end(), time,
                                      [](const LoadFactors& f, double t) { return f.time < t; });
  if (after == curves.end()) return curves.back();
  if (after == curves.begin() || after->time == time) return *after;
  const LoadFactors& before = *(after - 1);
  const double share = (time - before.time) / (after->time - before.time);
  LoadFactors now = before;
  now.time = time;
  const auto mix = [share](std::vector<double>& values, const std::vector<double>& next) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] += share * (next[i] - values[i]);
  };
  mix(now.boundary, after->boundary);
  mix(now.contact, after->contact);
  return now;
}

bool same_course(const std::vector<LoadFactors>& curves, std::size_t entry, std::size_t other) {
  return std::all_of(curves.begin(), curves.end(), [&](const LoadFactors& factors) {
    return factors.boundary[entry] == factors.boundary[other];
  });
}

}  // namespace kacanov
