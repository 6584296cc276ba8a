// SPDX-License-Identifier: BSD-3-Clause
// Passes over the blocks: a share per thread, private sums at shared nodes, always in the same order.
#include "operator/threaded_loops.hpp"

#include <algorithm>

#include "law/plane_stress.hpp"
#include "operator/checks.hpp"
#include "operator/threads.hpp"

namespace kacanov {
namespace {

void evaluate(const void* opaque, double x, double* g, double* slope, double* energy) {
  const Law& law = *static_cast<const Law*>(opaque);
  const Moduli moduli = law.moduli(x);
  *g = moduli.secant;
  *slope = moduli.derivative;
  if (energy != nullptr) *energy = law.energy(x);
}

double across(const void* law, double xx, double yy, double xy) {
  return transverse_strain(*static_cast<const Law*>(law), xx, yy, xy);
}

/// Calls run(t) for every t < threads and then, after all of them, finish(t).
template <class Run, class Finish>
void in_parallel(int threads, Run&& run, Finish&& finish) {
  in_team(threads, run);
  in_team(threads, finish);
}

}  // namespace

template <class Real>
BasicOperator<Real>::Data::Data(const Body& body, const OperatorOptions& options, const Layout* like)
    : set(simd::choose_instruction_set(options.instruction_set)),
      kernels(simd::kernels<Real>(set)),
      type(body.mesh.type),
      plane(body.mesh.plane),
      threads(options.threads),
      unknowns(body.unknowns()),
      points(body.secant_count()),
      laws(body.laws.begin(), body.laws.end()),
      layout(make_layout(body,
                         like != nullptr ? partition_as(*like, body, sizeof(double) / sizeof(Real))
                                         : partition(body, threads, 4 * sizeof(Real)),
                         kernels.lanes, threads, options.early)) {
  for (const Law& law : laws)
    views.push_back(
        {law.bulk, law.secant(0.0), law.yield_strain(), law.mean_dilatation, &law, evaluate, across});
  coordinates.resize(4 * layout.records());
  fill_coordinates<Real>(layout, body.mesh, coordinates);
  secant.resize(layout.element_point.size());
  for (std::size_t b = 0; b < layout.blocks.size(); ++b) {
    const BlockRange& range = layout.blocks[b];
    const std::size_t end = b + 1 < layout.blocks.size() ? layout.blocks[b + 1].first_slot : secant.size();
    for (std::size_t i = 0; i < range.group_count; ++i) {
      const simd::Group& group = layout.groups[range.first_group + i];
      const std::size_t from = range.first_slot + group.first_slot;
      const std::size_t to = i + 1 < range.group_count
                                 ? range.first_slot + layout.groups[range.first_group + i + 1].first_slot
                                 : end;
      std::fill(secant.data() + from, secant.data() + to, static_cast<Real>(views[group.law].shear));
    }
  }
  if (const CornerMeans means = corner_means(body); means.size() > 0) {
    corners = make_corner_layout(body, means, layout);
    corner_volume = corner_volumes(body, means);
    for (std::size_t i = 0; i < means.size(); ++i) corner_bulk.push_back(means.bulk(i));
    weigh_corners();
  }
  scratch.resize(threads);
  reserve_scratch(1);
  start_team(threads);
}

template <class Real>
double BasicOperator<Real>::Data::bulk_at(const Law& law, double g) const {
  return plane == PlaneState::stress ? plane_stress_bulk(law.bulk, g) : law.bulk;
}

template <class Real>
void BasicOperator<Real>::Data::reserve_scratch(int vectors) {
  if (vectors <= scratch_vectors) return;
  scratch_vectors = vectors;
  const std::size_t count = vectors;
  for (std::size_t t = 0; t < scratch.size(); ++t) {
    scratch[t].u.assign(4 * layout.largest * count, Real(0));
    scratch[t].f.assign(4 * layout.largest * count, Real(0));
    scratch[t].sums.assign(3 * static_cast<std::size_t>(layout.slots_of_thread[t]) * count, Real(0));
  }
}

template <class Real>
simd::Block<Real> BasicOperator<Real>::Data::block(std::size_t b) {
  const BlockRange& range = layout.blocks[b];
  return {layout.groups.data() + range.first_group,
          range.group_count,
          views.data(),
          layout.index.data() + range.first_index,
          coordinates.data() + 4 * range.first_record,
          secant.data() + range.first_slot,
          tangent.empty() ? nullptr : tangent.data() + simd::tangent_floats * range.first_slot,
          layout.nodes.data() + range.first_node,
          layout.shared.data() + range.first_shared,
          range.first,
          range.again,
          range.count,
          {range.placed[0], range.placed[1], range.placed[2]},
          layout.padding,
          plane,
          free_strain.empty() ? nullptr : free_strain.data() + range.first_slot};
}

template <class Real>
void BasicOperator<Real>::Data::detach_tangent() {
  if (has_tangent && tangent_secant.empty()) tangent_secant = secant;
}

template <class Real>
void BasicOperator<Real>::Data::add_interface(Real* y, int vectors, std::size_t begin, std::size_t end) {
  const std::size_t stride = dim();
  for (std::size_t v = 0; v < static_cast<std::size_t>(vectors); ++v)
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t k = 0; k < stride; ++k) {
        Real sum = 0;
        for (std::uint32_t c = layout.interface_first[i]; c < layout.interface_first[i + 1]; ++c) {
          const std::size_t thread = layout.contributions[c].thread;
          const auto slot = v * layout.slots_of_thread[thread] + layout.contributions[c].slot;
          sum += scratch[thread].sums[3 * slot + k];
        }
        y[v * unknowns + layout.interface_node[i] * stride + k] = sum;
      }
}

template <class Real>
template <class LoopsOnBlock>
double BasicOperator<Real>::Data::pass(const Real* x, Real* y, int vectors, bool averaged,
                                       const OnInterfaceReady& on_interface_ready, LoopsOnBlock&& loops) {
  reserve_scratch(vectors);
  const std::size_t stride = 4 * std::size_t{layout.largest};
  const std::size_t count = vectors;
  const int dimension = static_cast<int>(dim());
  std::vector<double> sums(scratch.size(), 0.0);
  const auto prepare = [&](std::size_t t) {
    std::fill_n(scratch[t].sums.begin(), 3 * static_cast<std::size_t>(layout.slots_of_thread[t]) * count,
                Real(0));
    for (std::size_t v = 0; t == 0 && y != nullptr && v < count; ++v)
      for (const std::int32_t node : layout.unreferenced_nodes)
        std::fill_n(y + v * unknowns + node * dim(), dim(), Real(0));
  };
  const auto run = [&](std::size_t t, std::size_t begin, std::size_t end) {
    Scratch& mine = scratch[t];
    const auto slots = 3 * static_cast<std::size_t>(layout.slots_of_thread[t]);
    double sum = sums[t];
    for (std::size_t b = begin; b < end; ++b) {
      const simd::Block<Real> at = block(b);
      for (std::size_t v = 0; x != nullptr && v < count; ++v)
        kernels.gather(at, dimension, x + v * unknowns, mine.u.data() + v * stride,
                       mine.f.data() + v * stride);
      if (x == nullptr) std::fill_n(mine.f.data(), 4 * std::size_t{at.count + at.padding}, Real(0));
      for (std::size_t v = 0; averaged && v < count; ++v)
        for (const BlockCorner& corner : corners.of(b))
          mine.u[v * stride + 4 * corner.node + 3] = mean[v * corners.entries + corner.entry];
      sum += loops(at, mine.u.data(), mine.f.data(), stride);
      for (std::size_t v = 0; y != nullptr && v < count; ++v)
        kernels.scatter(at, dimension, mine.f.data() + v * stride, y + v * unknowns,
                        mine.sums.data() + v * slots);
    }
    sums[t] = sum;
  };
  const auto finish = [&](std::size_t t, std::size_t begin, std::size_t end) {
    const std::size_t team = scratch.size(), size = end - begin;
    if (y != nullptr) add_interface(y, vectors, begin + size * t / team, begin + size * (t + 1) / team);
  };
  // The blocks have the same order with and without the early step: the results have the same bits.
  const std::size_t interface_size = layout.interface_node.size();
  if (on_interface_ready) {
    in_parallel(
        threads, [&](std::size_t t) { prepare(t), run(t, layout.share[t], layout.early[t]); },
        [&](std::size_t t) { finish(t, 0, layout.early_interface); });
    on_interface_ready();
    in_parallel(
        threads, [&](std::size_t t) { run(t, layout.early[t], layout.share[t + 1]); },
        [&](std::size_t t) { finish(t, layout.early_interface, interface_size); });
  } else {
    in_parallel(
        threads, [&](std::size_t t) { prepare(t), run(t, layout.share[t], layout.share[t + 1]); },
        [&](std::size_t t) { finish(t, 0, interface_size); });
  }
  double total = 0.0;
  for (const double sum : sums) total += sum;
  return total;
}

template <class Real>
void BasicOperator<Real>::Data::weigh_corners() {
  weight.assign(corner_volume.begin(), corner_volume.end());
  if (sum_corners) sum_corners(weight);
  for (Real& w : weight) w = Real(1) / w;
}

template <class Real>
void BasicOperator<Real>::Data::find_changes(const Real* x, int vectors) {
  if (corners.entries == 0) return;
  reserve_scratch(vectors);
  const std::size_t stride = 4 * std::size_t{layout.largest}, count = vectors;
  change.assign(corners.places * count, Real(0));
  in_team(threads, [&](int thread) {
    const std::size_t t = thread;
    Scratch& mine = scratch[t];
    for (std::size_t b = layout.share[t]; b < layout.share[t + 1]; ++b) {
      if (corners.of(b).empty()) continue;
      const simd::Block<Real> block_here = block(b);
      for (std::size_t v = 0; v < count; ++v)
        kernels.gather(block_here, 3, x + v * unknowns, mine.u.data() + v * stride,
                       mine.f.data() + v * stride);
      kernels.corner_changes(block_here, {mine.u.data(), mine.f.data(), vectors, stride});
      for (std::size_t v = 0; v < count; ++v)
        for (const BlockCorner& corner : corners.of(b))
          change[v * corners.places + corner.place] += mine.f[v * stride + 4 * corner.node + 3];
    }
  });
  for (std::size_t v = 0; v < count; ++v) {
    const auto all = std::span(change).subspan(v * corners.places, corners.places);
    for (std::size_t i = 0; i < corners.shared_entry.size(); ++i)
      for (std::size_t k = corners.shared_first[i]; k < corners.shared_first[i + 1]; ++k)
        all[corners.shared_entry[i]] += all[corners.shared_place[k]];
  }
}

template <class Real>
void BasicOperator<Real>::Data::apply_deviator(const Real* x, Real* y,
                                               const OnInterfaceReady& on_interface_ready) {
  pass(x, y, 1, false, on_interface_ready,
       [&](const simd::Block<Real>& at, const Real* u, Real* f, std::size_t stride) {
         kernels.apply(at, {u, f, 1, stride});  // gather sets the averages to zero
         return 0.0;
       });
}

template <class Real>
void BasicOperator<Real>::Data::apply_pressure(const Real* x, const Real* p, Real* y,
                                               const OnInterfaceReady& on_interface_ready) {
  mean.assign(p, p + corners.entries);
  // The loops over displacements multiply averages by k0.
  for (std::size_t i = 0; x != nullptr && i < mean.size(); ++i) mean[i] /= static_cast<Real>(corner_bulk[i]);
  pass(x, y, 1, corners.entries > 0, on_interface_ready,
       [&](const simd::Block<Real>& at, const Real* u, Real* f, std::size_t stride) {
         if (x != nullptr)
           kernels.apply(at, {u, f, 1, stride});
         else
           kernels.corner_forces(at, {u, f, 1, stride});
         return 0.0;
       });
}

template <class Real>
double BasicOperator<Real>::Data::find_means(const Real* x, int vectors) {
  find_changes(x, vectors);
  const std::size_t count = vectors;
  mean.resize(corners.entries * count);
  double energy = 0.0;
  for (std::size_t v = 0; v < count; ++v) {
    const auto all = std::span(change).subspan(v * corners.places, corners.places);
    const auto means = std::span(mean).subspan(v * corners.entries, corners.entries);
    std::copy_n(all.begin(), means.size(), means.begin());
    if (sum_corners) sum_corners(means);
    for (std::size_t i = 0; i < means.size(); ++i) means[i] *= weight[i];
    for (std::size_t i = 0; v == 0 && i < means.size(); ++i)
      energy += 0.5 * corner_bulk[i] * static_cast<double>(all[i]) * static_cast<double>(means[i]);
  }
  return energy;
}

template <class Real>
double BasicOperator<Real>::Data::dots(const simd::Block<Real>& at, const simd::Vectors<Real>& vectors) {
  double sum = 0.0;
  for (std::size_t v = 0; v < static_cast<std::size_t>(vectors.count); ++v)
    sum += kernels.dot(at, vectors.u + v * vectors.stride, vectors.f + v * vectors.stride);
  return sum;
}

template <class Real>
double BasicOperator<Real>::Data::apply(const Real* x, Real* y, int vectors, bool with_dot,
                                        const OnInterfaceReady& on_interface_ready) {
  if (averages()) find_means(x, vectors);
  return pass(x, y, vectors, corners.entries > 0, on_interface_ready,
              [&](const simd::Block<Real>& at, const Real* u, Real* f, std::size_t stride) {
                kernels.apply(at, {u, f, vectors, stride});
                return with_dot ? dots(at, {u, f, vectors, stride}) : 0.0;
              });
}

template <class Real>
double BasicOperator<Real>::Data::apply_tangent(const Real* x, Real* y, int vectors, bool with_dot,
                                                const OnInterfaceReady& on_interface_ready) {
  if (averages()) find_means(x, vectors);
  return pass(x, y, vectors, corners.entries > 0, on_interface_ready,
              [&](simd::Block<Real> at, const Real* u, Real* f, std::size_t stride) {
                if (!tangent_secant.empty()) at.secant = tangent_secant.data() + (at.secant - secant.data());
                kernels.apply_tangent(at, {u, f, vectors, stride});
                return with_dot ? dots(at, {u, f, vectors, stride}) : 0.0;
              });
}

template <class Real>
const Real* BasicOperator<Real>::Data::by_slot(std::span<const double> values, Aligned<Real>& slots) const {
  if (values.empty()) return nullptr;
  slots.resize(secant.size());
  for (std::size_t slot = 0; slot < slots.size(); ++slot) {
    const std::int32_t point = layout.element_point[slot];
    slots[slot] = point < 0 ? Real(0) : static_cast<Real>(values[point]);
  }
  return slots.data();
}

template <class Real>
double BasicOperator<Real>::Data::nonlinear(const Real* u, Real* f, simd::Nonlinear keep,
                                            const simd::Outside<Real>& outside) {
  if (keep.keep_tangent) {
    has_tangent = true;
    tangent.resize(simd::tangent_floats * secant.size());
    Aligned<Real>().swap(tangent_secant);
  } else if (keep.keep_secant) {
    detach_tangent();
  }
  // Without forces and energy only the deviator matters.
  const bool volume_counts = f != nullptr || keep.sum_energy || outside.energy != nullptr;
  const double of_volume = averages() && volume_counts ? find_means(u, 1) : 0.0;
  const bool averaged = corners.entries > 0 && volume_counts;
  const double energy =
      pass(u, f, 1, averaged, {}, [&](simd::Block<Real> at, const Real* local, Real* forces, std::size_t) {
        simd::Nonlinear out = keep;
        at.outside = outside.from(static_cast<std::size_t>(at.secant - secant.data()));
        kernels.nonlinear(at, local, forces, &out);
        return out.energy();
      });
  return of_volume + energy;
}

template struct BasicOperator<double>::Data;
template struct BasicOperator<float>::Data;

}  // namespace kacanov
