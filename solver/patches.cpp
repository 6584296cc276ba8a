// SPDX-License-Identifier: BSD-3-Clause
// Polynomials round the corners of a part, fitted to what the quadrature points of the elements there have.
#include "patches.hpp"

#include <algorithm>
#include <cmath>

#include "field_loops.hpp"
#include "largest.hpp"
#include "law_batches.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

std::vector<double> patch_scales(const Part& part) {
  std::vector<double> of_element(part.element_count()), size(part.nodes(), 0.0);
  Body flat = part.body();
  flat.mesh.plane = PlaneState::strain;  // sizes within the plane
  field_loops(part.type).volumes(flat, of_element);
  const std::size_t nodes = nodes_per_element(part.type);
  for (std::size_t k = 0; k < part.elements.size(); ++k) size[part.elements[k]] += of_element[k / nodes];
  part.node_map.sum(size, 1);
  for (double& v : size) v = 1.0 / (part.dim() == 3 ? std::cbrt(v) : std::sqrt(v));
  return size;
}

}  // namespace

Patches::Patches(const Part& part)
    : part_(part),
      nodes_of_element_(nodes_per_element(part.type)),
      corners_of_element_(static_cast<std::size_t>(cell(part.type).corners)),
      place_of_node_(part.nodes(), -1),
      scale_(patch_scales(part)),
      batch_of_law_(law_batches(part)),
      batches_(1 + *std::max_element(batch_of_law_.begin(), batch_of_law_.end())) {
  for (std::size_t first = 0; first < part.elements.size(); first += nodes_of_element_)
    for (std::size_t k = first; k < first + corners_of_element_; ++k) {
      if (place_of_node_[part.elements[k]] >= 0) continue;
      place_of_node_[part.elements[k]] = static_cast<std::int32_t>(corners_.size());
      corners_.push_back(part.elements[k]);
    }
}

PatchFits Patches::fits(std::size_t sets) const {
  return PatchFits(corners_.size(), Monomials(static_cast<int>(part_.dim()), cell(part_.type).order), sets);
}

Patches::Polynomial Patches::polynomial(const PatchFits& fits, std::size_t set, std::size_t node) const {
  return {&fits, fits.coefficients(place(node), set), node_position(part_, node), scale_[node]};
}

void Patches::add(PatchFits& fits, std::size_t element, const Samples& samples) const {
  const std::int32_t* node = &part_.elements[element * nodes_of_element_];
  const auto add_all = [&](const auto& what) {
    for (std::size_t a = 0; a < corners_of_element_; ++a)
      fits.add(place(static_cast<std::size_t>(node[a])),
               node_position(part_, static_cast<std::size_t>(node[a])),
               scale_[static_cast<std::size_t>(node[a])], what);
  };
  if (fits.linear())
    add_all(LinearSums(samples, fits.sets()));
  else
    add_all(samples);
}

void Patches::solve(PatchFits& fits) const {
  if (part_.node_map.ranks > 1) {
    std::vector<double> one(part_.nodes(), 0.0);
    for (std::size_t k = 0; k < fits.width(); ++k) {
      for (const std::int32_t n : part_.node_map.shared)
        one[n] = place_of_node_[n] < 0 ? 0.0 : fits.sums(place(n))[k];
      part_.node_map.sum(one, 1);
      for (const std::int32_t n : part_.node_map.shared)
        if (place_of_node_[n] >= 0) fits.sums(place(n))[k] = one[n];
    }
  }
  fits.solve();
}

}  // namespace kacanov
