// SPDX-License-Identifier: BSD-3-Clause
// Explains why a run did not converge.
#include "nonlinear/convergence_diagnosis.hpp"

#include "mesh/classic_locale_stream.hpp"
#include "partition/global_max.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Number of changes within the window that counts as oscillation.
constexpr int to_and_fro = 4;

const char* largest_residual(const Certificate& c) {
  const double worst = c.worst();
  for (const auto& [name, entry] : residual_names)
    if (c.*entry >= worst) return name;
  return residual_names.back().name;
}

}  // namespace

std::string who_cycles(const Part& part, const ContactChanges& changes, double length) {
  GlobalMax most;
  std::int64_t cycling = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(part.owned_contact); ++i) {
    const std::int32_t node = part.contact[i].node;
    if (changes.count(i) < to_and_fro) continue;
    ++cycling;
    most.take(changes.count(i), node, part.node_index[node]);
  }
  cycling = part.node_map.sum_all(cycling);
  const Extreme worst = agree_on_node(part, most);
  if (cycling == 0) return {};
  PlainText text;
  text << "contact does not settle: node " << worst.tag << " at " << to_text(length * worst.at, part.dim())
       << " changed between open, stick and slip in " << worst.value << " of the last "
       << ContactChanges::window << " steps";
  if (cycling > 1) text << ", and " << cycling - 1 << " contact points more did so";
  return text.str();
}

std::string diagnose_convergence(const OuterLoop& loop) {
  const Part& part = loop.context().part;
  const std::string cycles = who_cycles(part, loop.contact_changes(), loop.units().length);
  if (!cycles.empty())
    return cycles + "; smaller load steps (solver.load_steps) or a finer mesh there may help";
  std::string text = std::string("largest is ") + largest_residual(loop.certify().certificate);
  if (part.total_contact > 0) text += "; no contact node goes to and fro";
  if (!loop.context().body.linear()) text += "; smaller load steps (solver.load_steps) may help";
  return text;
}

}  // namespace kacanov
