// SPDX-License-Identifier: BSD-3-Clause
// Passes over the blocks: every thread its share, private sums where threads meet, always in the same order.
#include "operator/engine.hpp"

#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "cells/dispatch.hpp"
#include "cells/point.hpp"
#include "operator/checks.hpp"

namespace kacanov {
namespace {

/// Strain norm up to which g is constant.
double elastic_limit(const Law& law) {
  double limit = law.x0;
  if (law.kind == Law::Kind::linear) return std::numeric_limits<double>::infinity();
  if (law.kind == Law::Kind::table) return 0.0;  // left to the law itself
  return law.argument == Law::Argument::squared ? std::sqrt(limit) : limit;
}

void evaluate(const void* opaque, double x, double* g, double* slope, double* energy) {
  const Law& law = *static_cast<const Law*>(opaque);
  const Law::Moduli moduli = law.moduli(x);
  *g = moduli.secant;
  *slope = moduli.derivative;
  if (energy != nullptr) *energy = law.energy(x);
}

/// Calls run(t) for every t < threads, each by one thread where the runtime grants that many, and then, all
/// runs done, finish(t).
template <class Run, class Finish>
void in_parallel(int threads, Run&& run, Finish&& finish) {
  if (threads == 1) {
    run(std::size_t{0});
    finish(std::size_t{0});
    return;
  }
#pragma omp parallel num_threads(threads)
  {
    for (int t = omp_get_thread_num(); t < threads; t += omp_get_num_threads())
      run(static_cast<std::size_t>(t));
#pragma omp barrier
    for (int t = omp_get_thread_num(); t < threads; t += omp_get_num_threads())
      finish(static_cast<std::size_t>(t));
  }
}

}  // namespace

template <class Real>
Engine<Real>::Engine(const Body& body, int threads, simd::InstructionSet set,
                     std::span<const std::int32_t> early)
    : set_(set),
      kernels_(simd::kernels<Real>(set)),
      type_(body.mesh.type),
      dim_(dimension(body.mesh.type)),
      threads_(threads),
      unknowns_(body.unknowns()),
      points_(body.secant_count()),
      laws_(body.laws.begin(), body.laws.end()),
      layout_(make_layout(body, kernels_.lanes, threads, 4 * sizeof(Real), early)) {
  for (const Law& law : laws_)
    views_.push_back({law.bulk, law.secant(0.0), elastic_limit(law), law.mean_dilatation, &law, evaluate});
  coordinates_.resize(4 * layout_.records());
  fill_coordinates<Real>(layout_, body.mesh, coordinates_);
  secant_.resize(layout_.element_point.size());
  for (std::size_t b = 0; b < layout_.blocks.size(); ++b) {
    const BlockRange& range = layout_.blocks[b];
    const std::size_t end = b + 1 < layout_.blocks.size() ? layout_.blocks[b + 1].first_slot : secant_.size();
    for (std::size_t i = 0; i < range.group_count; ++i) {
      const simd::Group& group = layout_.groups[range.first_group + i];
      const std::size_t from = range.first_slot + group.first_slot;
      const std::size_t to = i + 1 < range.group_count
                                 ? range.first_slot + layout_.groups[range.first_group + i + 1].first_slot
                                 : end;
      std::fill(secant_.begin() + static_cast<std::ptrdiff_t>(from),
                secant_.begin() + static_cast<std::ptrdiff_t>(to),
                static_cast<Real>(views_[group.law].shear));
    }
  }
  scratch_.resize(static_cast<std::size_t>(threads));
  reserve_scratch(1);
}

template <class Real>
void Engine<Real>::reserve_scratch(int vectors) const {
  if (vectors <= scratch_vectors_) return;
  scratch_vectors_ = vectors;
  const auto count = static_cast<std::size_t>(vectors);
  for (std::size_t t = 0; t < scratch_.size(); ++t) {
    scratch_[t].u.assign(4 * layout_.largest * count, Real(0));
    scratch_[t].f.assign(4 * layout_.largest * count, Real(0));
    scratch_[t].sums.assign(3 * static_cast<std::size_t>(layout_.slots_of_thread[t]) * count, Real(0));
  }
}

template <class Real>
std::size_t Engine<Real>::bytes() const noexcept {
  std::size_t sum = layout_.bytes() +
                    (coordinates_.size() + secant_.size() + tangent_secant_.size()) * sizeof(Real) +
                    tangent_.size() * sizeof(float);
  for (const Scratch& scratch : scratch_)
    sum += (scratch.u.size() + scratch.f.size() + scratch.sums.size()) * sizeof(Real);
  return sum;
}

template <class Real>
simd::Block<Real> Engine<Real>::block(std::size_t b) const {
  const BlockRange& range = layout_.blocks[b];
  return {layout_.groups.data() + range.first_group,
          range.group_count,
          views_.data(),
          layout_.index.data() + range.first_index,
          coordinates_.data() + 4 * range.first_record,
          secant_.data() + range.first_slot,
          tangent_.empty() ? nullptr : tangent_.data() + simd::tangent_floats * range.first_slot,
          layout_.nodes.data() + range.first_node,
          layout_.shared.data() + range.first_shared,
          range.first,
          range.again,
          range.count,
          layout_.padding};
}

template <class Real>
void Engine<Real>::get_secant(std::span<double> g) const {
  for (std::size_t slot = 0; slot < secant_.size(); ++slot)
    if (const std::int32_t point = layout_.element_point[slot]; point >= 0)
      g[static_cast<std::size_t>(point)] = static_cast<double>(secant_[slot]);
}

template <class Real>
void Engine<Real>::detach_tangent() {
  if (has_tangent() && tangent_secant_.empty()) tangent_secant_ = secant_;
}

template <class Real>
void Engine<Real>::forget_tangent() noexcept {
  Aligned<float>().swap(tangent_);  // assigning {} would keep the memory
  Aligned<Real>().swap(tangent_secant_);
}

template <class Real>
void Engine<Real>::set_secant(std::span<const double> g) {
  detach_tangent();
  for (std::size_t slot = 0; slot < secant_.size(); ++slot)
    if (const std::int32_t point = layout_.element_point[slot]; point >= 0)
      secant_[slot] = static_cast<Real>(g[static_cast<std::size_t>(point)]);
}

template <class Real>
void Engine<Real>::add_interface(Real* y, int vectors, std::size_t begin, std::size_t end) const {
  const auto dim = static_cast<std::size_t>(dim_);
  for (std::size_t v = 0; v < static_cast<std::size_t>(vectors); ++v)
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < dim; ++k) {
        Real sum = 0;
        for (std::uint32_t c = layout_.interface_first[i]; c < layout_.interface_first[i + 1]; ++c) {
          const auto thread = static_cast<std::size_t>(layout_.contributions[c].thread);
          const auto slot = v * static_cast<std::size_t>(layout_.slots_of_thread[thread]) +
                            static_cast<std::size_t>(layout_.contributions[c].slot);
          sum += scratch_[thread].sums[3 * slot + k];
        }
        y[v * unknowns_ + static_cast<std::size_t>(layout_.interface_node[i]) * dim + k] = sum;
      }
}

template <class Real>
template <class LoopsOnBlock>
double Engine<Real>::pass(const Real* x, Real* y, int vectors, const WhenEarly& when_early,
                          LoopsOnBlock&& loops) const {
  reserve_scratch(vectors);
  const std::size_t stride = 4 * std::size_t{layout_.largest};
  const auto count = static_cast<std::size_t>(vectors);
  std::vector<double> sums(scratch_.size(), 0.0);
  const auto prepare = [&](std::size_t t) {
    std::fill_n(scratch_[t].sums.begin(), 3 * static_cast<std::size_t>(layout_.slots_of_thread[t]) * count,
                Real(0));
    const auto dim = static_cast<std::size_t>(dim_);
    for (std::size_t v = 0; t == 0 && y != nullptr && v < count; ++v)
      for (const std::int32_t node : layout_.lonely)
        std::fill_n(y + v * unknowns_ + static_cast<std::size_t>(node) * dim, dim, Real(0));
  };
  const auto run = [&](std::size_t t, std::size_t begin, std::size_t end) {
    Scratch& scratch = scratch_[t];
    const auto slots = 3 * static_cast<std::size_t>(layout_.slots_of_thread[t]);
    double sum = sums[t];
    for (std::size_t b = begin; b < end; ++b) {
      const simd::Block<Real> at = block(b);
      for (std::size_t v = 0; v < count; ++v)
        kernels_.gather(at, dim_, x + v * unknowns_, scratch.u.data() + v * stride,
                        scratch.f.data() + v * stride);
      sum += loops(at, scratch.u.data(), scratch.f.data(), stride);
      for (std::size_t v = 0; y != nullptr && v < count; ++v)
        kernels_.scatter(at, dim_, scratch.f.data() + v * stride, y + v * unknowns_,
                         scratch.sums.data() + v * slots);
    }
    sums[t] = sum;
  };
  const auto finish = [&](std::size_t t, std::size_t begin, std::size_t end) {
    const std::size_t team = scratch_.size(), size = end - begin;
    if (y != nullptr) add_interface(y, vectors, begin + size * t / team, begin + size * (t + 1) / team);
  };
  // The same blocks in the same order with and without the pause, so the same bits.
  const std::size_t interface_size = layout_.interface_node.size();
  if (when_early) {
    in_parallel(
        threads_, [&](std::size_t t) { prepare(t), run(t, layout_.share[t], layout_.early[t]); },
        [&](std::size_t t) { finish(t, 0, layout_.early_interface); });
    when_early();
    in_parallel(
        threads_, [&](std::size_t t) { run(t, layout_.early[t], layout_.share[t + 1]); },
        [&](std::size_t t) { finish(t, layout_.early_interface, interface_size); });
  } else {
    in_parallel(
        threads_, [&](std::size_t t) { prepare(t), run(t, layout_.share[t], layout_.share[t + 1]); },
        [&](std::size_t t) { finish(t, 0, interface_size); });
  }
  double total = 0.0;
  for (const double sum : sums) total += sum;
  return total;
}

template <class Real>
double Engine<Real>::apply(const Real* x, Real* y, int vectors, bool with_dot,
                           const WhenEarly& when_early) const {
  return pass(x, y, vectors, when_early,
              [&](const simd::Block<Real>& at, const Real* u, Real* f, std::size_t stride) {
                kernels_.apply(at, u, f, vectors, stride);
                double sum = 0.0;
                for (std::size_t v = 0; with_dot && v < static_cast<std::size_t>(vectors); ++v)
                  sum += kernels_.dot(at, u + v * stride, f + v * stride);
                return sum;
              });
}

template <class Real>
void Engine<Real>::apply_many(std::span<const Real> x, std::span<Real> y, int vectors) const {
  if (vectors < 1) throw std::invalid_argument("vectors: expected at least 1");
  expect_size(x.size(), unknowns_ * static_cast<std::size_t>(vectors), "x");
  expect_size(y.size(), unknowns_ * static_cast<std::size_t>(vectors), "y");
  for (int done = 0; done < vectors;) {
    const int left = vectors - done, step = left >= 4 ? 4 : left >= 2 ? 2 : 1;
    const std::size_t offset = unknowns_ * static_cast<std::size_t>(done);
    apply(x.data() + offset, y.data() + offset, step, false);
    done += step;
  }
}

template <class Real>
double Engine<Real>::apply_tangent(const Real* x, Real* y, bool with_dot, const WhenEarly& when_early) const {
  return pass(x, y, 1, when_early, [&](simd::Block<Real> at, const Real* u, Real* f, std::size_t) {
    if (!tangent_secant_.empty())
      at.secant = const_cast<Real*>(tangent_secant_.data()) + (at.secant - secant_.data());
    kernels_.apply_tangent(at, u, f);
    return with_dot ? kernels_.dot(at, u, f) : 0.0;
  });
}

template <class Real>
double Engine<Real>::pass_nonlinear(const Real* omega, Real* f, simd::Nonlinear keep) const {
  return pass(omega, f, 1, {}, [&](const simd::Block<Real>& at, const Real* u, Real* forces, std::size_t) {
    simd::Nonlinear out = keep;
    kernels_.nonlinear(at, u, forces, &out);
    return out.energy;
  });
}

template <class Real>
double Engine<Real>::nonlinear(const Real* omega, Real* f, simd::Nonlinear keep) {
  if (keep.keep_tangent) {
    tangent_.resize(simd::tangent_floats * secant_.size());
    Aligned<Real>().swap(tangent_secant_);
  } else if (keep.keep_secant) {
    detach_tangent();
  }
  return pass_nonlinear(omega, f, keep);
}

template <class Real>
double Engine<Real>::nonlinear(const Real* omega, Real* f, bool sum_energy) const {
  return pass_nonlinear(omega, f, {.sum_energy = sum_energy});
}

template <class Real>
void Engine<Real>::block_diagonal(std::span<Real> blocks) const {
  std::fill(blocks.begin(), blocks.end(), Real(0));
  for (const BlockRange& range : layout_.blocks)
    for (std::size_t i = 0; i < range.group_count; ++i)
      elements::dispatch(
          type_, [&]<class E>(E) { add_diagonals<E>(range, layout_.groups[range.first_group + i], blocks); });
}

/// Finds the element of every slot again in its batch and adds what each of its nodes has on the diagonal.
template <class Real>
template <class E>
void Engine<Real>::add_diagonals(const BlockRange& range, const simd::Group& group,
                                 std::span<Real> blocks) const {
  using elements::Point;
  const bool fan = group.shape == simd::Shape::open_fan || group.shape == simd::Shape::closed_fan;
  const auto lanes = static_cast<std::size_t>(layout_.lanes);
  const std::size_t points = fan ? group.length : E::points, nodes = !fan ? E::nodes
                                                                     : group.shape == simd::Shape::closed_fan
                                                                         ? points + 2
                                                                         : points + 3;
  const std::uint16_t* index = layout_.index.data() + range.first_index + group.first_index;
  const Real* coordinates = coordinates_.data() + 4 * range.first_record;
  for (std::size_t batch = 0; batch < group.batches; ++batch)
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      std::array<std::size_t, E::nodes> record{};
      std::array<Point<E>, E::points> at{};  // of the element at hand
      for (std::size_t p = 0; p < points; ++p) {
        const std::size_t slot = range.first_slot + group.first_slot + (batch * points + p) * lanes + lane;
        if (layout_.element_point[slot] < 0) continue;
        if (fan || p == 0) {
          elements::Nodal<E> x;
          for (int a = 0; a < E::nodes; ++a) {
            const auto k = static_cast<std::size_t>(a);
            const std::size_t node = fan && k >= 2 ? 2 + (p + k - 2) % (nodes - 2) : k;
            record[k] = index[(batch * nodes + node) * lanes + lane];
            for (int c = 0; c < E::dim; ++c)
              x[Point<E>::at(a, c)] =
                  static_cast<double>(coordinates[record[k] + static_cast<std::size_t>(c)]);
          }
          at = elements::points_of<E>(x, laws_[group.law].mean_dilatation);
        }
        const Point<E>& point = at[fan ? 0 : p];
        for (int a = 0; a < E::nodes; ++a) {
          const std::int32_t id = layout_.nodes[range.first_node + record[static_cast<std::size_t>(a)] / 4];
          point.add_diagonal_block(a, laws_[group.law].bulk, static_cast<double>(secant_[slot]),
                                   blocks.data() + Point<E>::at(id, 0) * E::dim);
        }
      }
    }
}

template <class Real>
void Engine<Real>::diagonal(std::span<Real> d) const {
  const auto dim = static_cast<std::size_t>(dim_);
  std::vector<Real> blocks(d.size() * dim);
  block_diagonal(blocks);
  for (std::size_t i = 0; i < d.size(); ++i) d[i] = blocks[i * dim + i % dim];
}

template class Engine<double>;
template class Engine<float>;

}  // namespace kacanov
