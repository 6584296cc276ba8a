// SPDX-License-Identifier: BSD-3-Clause
// Enumerated words of the case file and the values they stand for.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include <kacanov/model.hpp>
#include "case/case_file.hpp"
#include "case/schema.hpp"

namespace kacanov {

template <class Value, std::size_t count>
using Words = std::array<std::pair<std::string_view, Value>, count>;

/// Returns the value of the word at a node; throws InputError for any other word.
template <class Value, std::size_t count>
Value value_of(const Node& node, const Words<Value, count>& words) {
  std::vector<std::string_view> list;
  for (const auto& word : words) list.push_back(word.first);
  return words[node.choice(list)].second;
}

/// Returns the word of a value.
template <class Value, std::size_t count>
std::string word_of(Value value, const Words<Value, count>& words) {
  for (const auto& word : words)
    if (word.second == value) return std::string(word.first);
  return {};
}

/// Returns the schema of a key that takes one of the words.
template <class Value, std::size_t count>
Word one_of(const Words<Value, count>& words) {
  Word schema;
  for (const auto& word : words) schema.words.emplace_back(word.first);
  return schema;
}

namespace words {

using Options = SolverOptions;
inline constexpr Words<Options::Outer, 3> outer{{{"auto", Options::Outer::automatic},
                                                 {"kacanov", Options::Outer::kacanov},
                                                 {"newton", Options::Outer::newton}}};
inline constexpr Words<Options::Contact, 4> contact{{{"auto", Options::Contact::automatic},
                                                     {"admm", Options::Contact::admm},
                                                     {"dual_admm", Options::Contact::dual_admm},
                                                     {"active_set", Options::Contact::active_set}}};
inline constexpr Words<Options::Penalty, 6> penalty{
    {{"auto", Options::Penalty::automatic},
     {"paper", Options::Penalty::paper},
     {"residual_balancing", Options::Penalty::residuals},
     {"relative_balancing", Options::Penalty::relative_residuals},
     {"osqp", Options::Penalty::osqp},
     {"spectral", Options::Penalty::spectral}}};
inline constexpr Words<Options::Stop, 2> stop{{{"kkt", Options::Stop::kkt}, {"paper", Options::Stop::paper}}};
inline constexpr Words<Options::Preconditioner, 3> preconditioner{
    {{"multigrid", Options::Preconditioner::multigrid},
     {"elasticity", Options::Preconditioner::elasticity},
     {"cholesky", Options::Preconditioner::cholesky}}};
inline constexpr Words<Friction::Reference, 2> reference{
    {{"start", Friction::Reference::start}, {"step", Friction::Reference::step}}};
inline constexpr Words<Law::Argument, 2> argument{
    {{"norm", Law::Argument::norm}, {"squared", Law::Argument::squared}}};
inline constexpr Words<PlaneState, 3> plane{{{"strain", PlaneState::strain},
                                             {"stress", PlaneState::stress},
                                             {"axisymmetric", PlaneState::axisymmetric}}};
inline constexpr Words<bool, 2> body_above{{{"above", true}, {"below", false}}};
inline constexpr Words<bool, 2> fields{{{"vtu", true}, {"none", false}}};
inline constexpr Words<Quantity, 4> quantity{{{"von_mises", Quantity::von_mises},
                                              {"displacement", Quantity::displacement},
                                              {"contact_pressure", Quantity::contact_pressure},
                                              {"plastic", Quantity::plastic}}};

}  // namespace words
}  // namespace kacanov
