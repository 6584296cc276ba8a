// SPDX-License-Identifier: BSD-3-Clause
// Projection onto a constrained space.
#include "multigrid/held_space.hpp"

namespace kacanov {
namespace {

template <class S>
void project_out(std::span<const HeldDirections> held, std::size_t dim, std::span<S> x) {
  for (const HeldDirections& entry : held) {
    S* u = x.data() + static_cast<std::size_t>(entry.node) * dim;
    for (int k = 0; k < entry.count; ++k) {
      const auto& b = entry.basis[k];
      double s = 0.0;
      for (std::size_t c = 0; c < dim; ++c) s += b[c] * static_cast<double>(u[c]);
      for (std::size_t c = 0; c < dim; ++c) u[c] = static_cast<S>(static_cast<double>(u[c]) - s * b[c]);
    }
  }
}

}  // namespace

void HeldSpace::project(std::size_t dim, std::span<double> x) const {
  project_out(std::span(directions), dim, x);
  if (rows) rows->project(x);
}

void HeldSpace::project(std::size_t dim, std::span<float> x) const {
  project_out(std::span(directions), dim, x);
  if (!rows) return;
  std::vector<double> exact(x.begin(), x.end());
  rows->project(exact);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<float>(exact[i]);
}

}  // namespace kacanov
