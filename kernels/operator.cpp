// SPDX-License-Identifier: BSD-3-Clause
// The operator behind its interface: checks what it is given, keeps the frozen state.
#include "operator.hpp"

#include <stdexcept>
#include <string>
#include <vector>

namespace kacanov {

struct Operator::Implementation {
  ElementType type;
  std::vector<double> coordinates;
  std::vector<std::int32_t> connectivity;
  std::vector<Law> laws;
  std::vector<std::uint16_t> law_of_element;
  std::vector<double> g, tangent_at;
  std::uint64_t applications = 0;

  Body body() const { return {{type, coordinates, connectivity}, laws, law_of_element}; }
};

Operator::Operator(const Body& body, const OperatorOptions& options) {
  if (options.threads < 1) throw std::invalid_argument("threads: expected at least 1");
  const MeshView& mesh = body.mesh;
  if (body.law_of_element.size() != mesh.element_count())
    throw std::invalid_argument("law_of_element: expected one entry an element");
  for (const std::int32_t node : mesh.connectivity)
    if (node < 0 || static_cast<std::size_t>(node) >= mesh.node_count())
      throw std::invalid_argument("connectivity: node " + std::to_string(node) + " does not exist");
  for (const std::uint16_t law : body.law_of_element)
    if (law >= body.laws.size())
      throw std::invalid_argument("law " + std::to_string(law) + " does not exist");
  impl_ = std::make_unique<Implementation>();
  impl_->type = mesh.type;
  impl_->coordinates.assign(mesh.coordinates.begin(), mesh.coordinates.end());
  impl_->connectivity.assign(mesh.connectivity.begin(), mesh.connectivity.end());
  impl_->laws.assign(body.laws.begin(), body.laws.end());
  impl_->law_of_element.assign(body.law_of_element.begin(), body.law_of_element.end());
  impl_->g.resize(body.secant_count());
  update(std::vector<double>(unknowns(), 0.0));
}

Operator::~Operator() = default;
Operator::Operator(Operator&&) noexcept = default;
Operator& Operator::operator=(Operator&&) noexcept = default;

std::size_t Operator::unknowns() const noexcept { return impl_->coordinates.size(); }

void Operator::update(std::span<const double> omega) { reference::secant(impl_->body(), omega, impl_->g); }

void Operator::secant(std::span<double> g) const { std::copy(impl_->g.begin(), impl_->g.end(), g.begin()); }

void Operator::set_secant(std::span<const double> g) { impl_->g.assign(g.begin(), g.end()); }

void Operator::apply(std::span<const double> x, std::span<double> y) const {
  ++impl_->applications;
  reference::apply(impl_->body(), impl_->g, x, y);
}

double Operator::apply_dot(std::span<const double> x, std::span<double> y) const {
  apply(x, y);
  double sum = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
  return sum;
}

void Operator::update_tangent(std::span<const double> omega) {
  update(omega);
  impl_->tangent_at.assign(omega.begin(), omega.end());
}

void Operator::apply_tangent(std::span<const double> x, std::span<double> y) const {
  ++impl_->applications;
  reference::apply_tangent(impl_->body(), impl_->tangent_at, x, y);
}

void Operator::diagonal(std::span<double> d) const { reference::diagonal(impl_->body(), impl_->g, d); }

void Operator::block_diagonal(std::span<double> blocks) const {
  reference::block_diagonal(impl_->body(), impl_->g, blocks);
}

void Operator::residual(std::span<const double> omega, std::span<double> f) const {
  reference::residual(impl_->body(), omega, f);
}

double Operator::energy(std::span<const double> omega) const {
  return reference::energy(impl_->body(), omega);
}

double Operator::residual_energy_update(std::span<const double> omega, std::span<double> f) {
  update(omega);
  residual(omega, f);
  return energy(omega);
}

std::string_view Operator::instruction_set() const noexcept { return "plain"; }

std::size_t Operator::bytes() const noexcept {
  return impl_->coordinates.size() * sizeof(double) + impl_->connectivity.size() * sizeof(std::int32_t) +
         impl_->law_of_element.size() * sizeof(std::uint16_t) +
         (impl_->g.size() + impl_->tangent_at.size()) * sizeof(double);
}

std::uint64_t Operator::applications() const noexcept { return impl_->applications; }

}  // namespace kacanov
