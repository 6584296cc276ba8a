// SPDX-License-Identifier: BSD-3-Clause
// Superconvergent patch recovery: patches of elements, and polynomials fitted to their strains.
#include "recovery/spr_patches.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel/exchange.hpp"
#include "partition/global_max.hpp"
#include "problem/vector3.hpp"
#include "recovery/element_batch.hpp"

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

namespace {

// Regularisation added to the diagonal, in units of one sample's weight; negligible for linear terms.
// Quadratic terms of boundary patches with few elements would extrapolate noise: 11 % too much stress at a
// hole with 1e-4, a 1 % error with this value.
constexpr double hold_linear = 1e-9, hold_quadratic = 0.1;

/// Solves with both triangular factors for six right-hand sides.
template <std::size_t n>
void substitute(const std::array<std::array<double, n>, n>& l, double* side) {
  constexpr std::size_t values = Samples::values;
  const auto take_off = [&](std::size_t i, std::size_t k, double factor) {
    for (std::size_t v = 0; v < values; ++v) side[i * values + v] -= factor * side[k * values + v];
  };
  const auto divide = [&](std::size_t i) {
    for (std::size_t v = 0; v < values; ++v) side[i * values + v] /= l[i][i];
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) take_off(i, k, l[i][k]);
    divide(i);
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) take_off(i, k, l[k][i]);
    divide(i);
  }
}

}  // namespace

Monomials::Monomials(int dim, int order) : dim_(dim), quadratic_(order > 1) {
  count_ = quadratic_ ? (dim_ + 1) * (dim_ + 2) / 2 : dim_ + 1;
}

LinearSums::LinearSums(const Samples& samples, std::size_t sets)
    : count(static_cast<double>(samples.position.size())) {
  for (const Vector3& x : samples.position) mean = mean + (1.0 / count) * x;
  for (std::size_t q = 0; q < samples.position.size(); ++q) {
    const Vector3 away = samples.position[q] - mean;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = i; j < 3; ++j) square[i][j] += away[i] * away[j];
    for (std::size_t k = 0; k < sets; ++k) {
      const double* sample = samples.set[k] + q * Samples::values;
      for (std::size_t v = 0; v < Samples::values; ++v) {
        side[k][0][v] += sample[v];
        for (std::size_t i = 0; i < 3; ++i) side[k][1 + i][v] += away[i] * sample[v];
      }
    }
  }
}

PatchFits::PatchFits(std::size_t centres, const Monomials& monomials, std::size_t sets)
    : monomials_(monomials),
      sets_(sets),
      pairs_(monomials.count() * (monomials.count() + 1) / 2),
      width_(pairs_ + sets * values * monomials.count()),
      sums_(centres * width_, 0.0) {}

void PatchFits::add(std::size_t i, const Vector3& at, double scale, const Samples& samples) {
  monomials_.with_count([&](auto count) { add_of<count()>(&sums_[i * width_], at, scale, samples); });
}

void PatchFits::add(std::size_t i, const Vector3& at, double scale, const LinearSums& sums) {
  const Vector3 from = scale * (sums.mean - at);
  if (monomials_.count() == 4)
    add_of<4>(&sums_[i * width_], from, scale, sums);
  else
    add_of<3>(&sums_[i * width_], from, scale, sums);
}

template <std::size_t n>
void PatchFits::add_of(double* sum, const Vector3& at, double scale, const Samples& samples) const {
  constexpr std::size_t some = 8;  // block size in samples: sums are read and written once per block
  for (std::size_t first = 0; first < samples.position.size(); first += some) {
    const std::size_t count = std::min(some, samples.position.size() - first);
    std::array<std::array<double, Monomials::most>, some> p;
    for (std::size_t q = 0; q < count; ++q) p[q] = monomials_.at(scale * (samples.position[first + q] - at));
    double* entry = sum;
    for (std::size_t i = 0; i < n; entry += n - i, ++i) {
      std::array<double, n> row{};
      for (std::size_t q = 0; q < count; ++q)
        for (std::size_t j = 0; j < n; ++j) row[j] += p[q][i] * p[q][j];
      for (std::size_t j = i; j < n; ++j) entry[j - i] += row[j];
    }
    for (std::size_t k = 0; k < sets_; ++k) {
      const double* sample = samples.set[k] + first * values;
      for (std::size_t i = 0; i < n; ++i, entry += values) {
        std::array<double, values> side{};
        for (std::size_t q = 0; q < count; ++q)
          for (std::size_t v = 0; v < values; ++v) side[v] += p[q][i] * sample[q * values + v];
        for (std::size_t v = 0; v < values; ++v) entry[v] += side[v];
      }
    }
  }
}

template <std::size_t n>
void PatchFits::add_of(double* sum, const Vector3& from, double scale, const LinearSums& of) const {
  *sum++ += of.count;
  for (std::size_t j = 0; j + 1 < n; ++j) *sum++ += of.count * from[j];
  for (std::size_t i = 0; i + 1 < n; ++i)
    for (std::size_t j = i; j + 1 < n; ++j)
      *sum++ += scale * scale * of.square[i][j] + of.count * from[i] * from[j];
  for (std::size_t k = 0; k < sets_; ++k) {
    for (std::size_t v = 0; v < values; ++v) *sum++ += of.side[k][0][v];
    for (std::size_t i = 0; i + 1 < n; ++i)
      for (std::size_t v = 0; v < values; ++v)
        *sum++ += scale * of.side[k][1 + i][v] + from[i] * of.side[k][0][v];
  }
}

void PatchFits::solve() {
  monomials_.with_count([&](auto count) { solve_of<count()>(); });
}

template <std::size_t n>
void PatchFits::solve_of() {
  std::array<std::array<double, n>, n> l;
  for (std::size_t centre = 0; centre * width_ < sums_.size(); ++centre) {
    if (!has(centre)) continue;
    const double* sum = &sums_[centre * width_];
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i; j < n; ++j) l[j][i] = *sum++;
    for (std::size_t i = 1; i < n; ++i) l[i][i] += i < monomials_.linear() ? hold_linear : hold_quadratic;
    // Cholesky factorisation, then both triangular solves.
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double rest = l[i][j];
        for (std::size_t k = 0; k < j; ++k) rest -= l[i][k] * l[j][k];
        l[i][j] = i == j ? std::sqrt(rest) : rest / l[j][j];
      }
    for (std::size_t k = 0; k < sets_; ++k) substitute(l, &sums_[centre * width_ + pairs_ + k * values * n]);
  }
}

namespace {

/// A law at a node.
using At = std::pair<std::int32_t, std::uint16_t>;
/// Pairs of laws that share a node, in both orders.
using CornerPair = std::pair<std::uint16_t, std::uint16_t>;

template <class T>
void keep_each_once(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Gathers pairs packed into integers, because gathered() requires trivially copyable types.
template <class Pair>
std::vector<Pair> gathered_pairs(const std::vector<Pair>& mine, const Communicator& comm) {
  std::vector<std::int64_t> packed;
  for (const Pair& pair : mine) packed.push_back(std::int64_t{pair.first} << 16 | pair.second);
  std::vector<Pair> all;
  for (const std::int64_t value : gathered(packed, comm))
    all.emplace_back(static_cast<typename Pair::first_type>(value >> 16),
                     static_cast<std::uint16_t>(value & 0xffff));
  keep_each_once(all);
  return all;
}

/// Returns the laws at nodes with several laws, and at nodes shared with other ranks; other nodes impose no
/// separation.
std::vector<At> laws_at_nodes(const Part& part) {
  constexpr std::int32_t none = -1;
  const std::size_t nodes = nodes_per_element(part.type);
  std::vector<std::int32_t> first(part.nodes(), none);
  std::vector<At> at;
  for (std::size_t k = 0; k < part.elements.size(); ++k) {
    const std::int32_t node = part.elements[k];
    const std::uint16_t law = part.law_of_element[k / nodes];
    if (first[node] == none) first[node] = law;
    if (first[node] != law) at.emplace_back(node, law), at.emplace_back(node, first[node]);
  }
  for (const std::int32_t node : part.node_map.shared)
    if (first[node] != none) at.emplace_back(node, first[node]);
  keep_each_once(at);
  return at;
}

void join(std::vector<CornerPair>& edges, const std::vector<At>& at) {
  for (auto first = at.begin(); first != at.end();) {
    const auto last =
        std::find_if(first, at.end(), [&](const At& other) { return other.first != first->first; });
    for (auto a = first; a != last; ++a)
      for (auto b = first; b != last; ++b)
        if (a != b) edges.emplace_back(a->second, b->second);
    first = last;
  }
  keep_each_once(edges);
}

/// Returns the laws at nodes shared by ranks, with node numbers of the whole mesh.
std::vector<At> laws_at_shared_nodes(const Part& part, const std::vector<At>& at) {
  std::vector<At> shared;
  for (const std::int32_t node : part.node_map.shared)
    for (auto a = std::lower_bound(at.begin(), at.end(), At{node, 0}); a != at.end() && a->first == node; ++a)
      shared.emplace_back(part.node_index[node], a->second);
  return gathered_pairs(shared, part.node_map);
}

}  // namespace

std::vector<std::int32_t> law_batches(const Part& part) {
  std::vector<std::int32_t> batch(part.laws.size(), -1);
  if (part.laws.size() == 1) return {0};
  const std::vector<At> at = laws_at_nodes(part);
  std::vector<CornerPair> edges;
  join(edges, at);
  if (part.node_map.ranks > 1) {
    join(edges, laws_at_shared_nodes(part, at));
    edges = gathered_pairs(edges, part.node_map);
  }
  std::vector<std::size_t> taken_for(batch.size() + 1,
                                     batch.size());  // last law that found each batch taken
  auto edge = edges.begin();
  for (std::size_t law = 0; law < batch.size(); ++law) {
    for (; edge != edges.end() && edge->first == law; ++edge)
      if (batch[edge->second] >= 0) taken_for[batch[edge->second]] = law;
    batch[law] = 0;
    while (taken_for[batch[law]] == law) ++batch[law];
  }
  return batch;
}

}  // namespace kacanov
