// SPDX-License-Identifier: BSD-3-Clause
// Internal forces and energy of the body, and the frozen secant or tangent operator.
#include "nonlinear/body_response.hpp"

#include <malloc.h>
#include <algorithm>
#include <cmath>
#include <string>

#include <kacanov/error.hpp>
#include "mesh/classic_locale_stream.hpp"

namespace kacanov {

Vector lumped_volume(const Part& part) {
  Vector volume(part.nodes(), 0.0), element(part.element_count());
  reference::volumes(part.body(), element);
  const std::size_t npe = nodes_per_element(part.type);
  for (std::size_t k = 0; k < part.elements.size(); ++k)
    volume[part.elements[k]] += element[k / npe] / static_cast<double>(npe);
  part.node_map.sum(volume, 1);
  return volume;
}

void refuse_beyond_floats(const Part& part, std::span<const float> diagonal) {
  constexpr double most = 1e30, least = 1e-30;  // leaves a margin of eight digits for products
  double stiffest = 0.0, softest = HUGE_VAL;
  for (const float d : diagonal) {
    stiffest = std::max(stiffest, static_cast<double>(d));
    softest = std::min(softest, static_cast<double>(d));
  }
  stiffest = part.node_map.max_all(stiffest);
  softest = -part.node_map.max_all(-softest);
  if (stiffest <= most && softest >= least) return;
  PlainText text;
  text << "material: the stiffness of nodes (modulus times width) goes from " << softest << " to " << stiffest
       << " of the middle one, expected " << least << " to " << most
       << ", which single precision holds: a part 1e8 times as stiff as another is rigid";
  throw InputError(text.str());
}

BodyResponse::BodyResponse(const Part& part, int threads, const std::string& instruction_set)
    : part_(&part),
      op_(part, threads, instruction_set),
      diagonal_(op_.diagonal()),
      internal_(part.unknowns()),
      linear_(std::all_of(part.laws.begin(), part.laws.end(), [](const Law& law) { return law.linear(); })) {}

void BodyResponse::set_free_strain(std::span<const double> of_element) {
  if (linear_ || (of_element.empty() && !stretched_)) return;
  op_.set_free_strain(of_element);
  stretched_ = !of_element.empty();
  current_ = false;
}

bool BodyResponse::at_rest(std::span<const double> u) const {
  const bool moved = stretched_ || std::any_of(u.begin(), u.end(), [](double value) { return value != 0.0; });
  return !part_->node_map.any(moved);
}

void BodyResponse::evaluate(std::span<const double> u) {
  current_ = false;
  if (at_rest(u)) {
    std::fill(internal_.begin(), internal_.end(), 0.0);
    energy_ = 0.0;
    return;
  }
  op_.residual(u, internal_);
  energy_ = op_.energy(u);
}

void BodyResponse::take_elastic_force(std::span<const double> u) {
  if (at_rest(u))
    std::fill(internal_.begin(), internal_.end(), 0.0);
  else
    op_.apply(u, internal_);
}

void BodyResponse::evaluate_and_freeze(std::span<const double> u) {
  energy_ = op_.residual_energy_update(u, internal_);
  current_ = true;
  elastic_ = linear_;
}

void BodyResponse::resume(std::span<const double> u, const Frozen& frozen) {
  if (frozen.here)
    evaluate_and_freeze(u);
  else
    evaluate(u);
  elastic_ = frozen.elastic;
}

bool BodyResponse::freeze_elastic() {
  if (elastic_) return false;
  const Vector rest(part_->unknowns(), 0.0);
  if (stretched_) {
    Vector g(part_->body().secant_count());
    reference::secant(part_->body(), rest, g);
    op_.set_secant(g);
  } else {
    op_.update(rest);
  }
  elastic_ = true;
  current_ = false;
  return true;
}

void BodyResponse::freeze_secant(std::span<const double> u) {
  if (linear_ || current_) return;
  op_.update(u);
  elastic_ = false;
}

void BodyResponse::freeze_tangent(std::span<const double> u) {
  make_room(5 * sizeof(float) * part_->body().secant_count());
  op_.update_tangent(u);
}

void BodyResponse::unbalanced(const LoadPath& path, std::span<double> f) const {
  for (std::size_t i = 0; i < internal_.size(); ++i) f[i] = -internal_[i];
  path.add_load(f);
}

void BodyResponse::unbalanced(const LoadPath& path, std::span<const double> u, std::span<double> f) {
  op_.residual(u, f);
  for (double& value : f) value = -value;
  path.add_load(f);
}

Vector BodyResponse::secant() const {
  Vector g(part_->body().secant_count());
  op_.local().secant(g);
  return g;
}

void make_room(std::size_t bytes) {
  constexpr std::size_t large = std::size_t{64} << 20;
  if (bytes >= large) malloc_trim(0);
}

}  // namespace kacanov
