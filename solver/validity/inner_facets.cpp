// SPDX-License-Identifier: BSD-3-Clause
// Whether a group that an entry names has facets that the body's boundary has not.
#include "validity/checks.hpp"

namespace kacanov::validity {
namespace {

void check_group(const Mesh& mesh, const Selector& on, const std::string& entry, Warnings& warnings) {
  if (on.kind != Selector::Kind::name) return;
  for (const Group& group : mesh.groups) {
    if (group.name != on.name || group.inner == 0) continue;
    warnings.push_back(entry + ": " + std::to_string(group.inner) + " facets of \"" + group.name +
                       "\" are not on the boundary of the body and are left out; " +
                       std::to_string(group.members.size()) + " are on it");
  }
}

}  // namespace

void inner_facets(const Problem& problem, const Model& model, Warnings& warnings) {
  for (std::size_t i = 0; i < model.boundary.size(); ++i)
    check_group(problem.mesh, model.boundary[i].on, entry_name(model.boundary[i], i), warnings);
  for (std::size_t i = 0; i < model.contact.size(); ++i)
    check_group(problem.mesh, model.contact[i].on, entry_name(model.contact[i], i), warnings);
}

}  // namespace kacanov::validity
