// SPDX-License-Identifier: BSD-3-Clause
// Threaded loops over the blocks: a share per thread, private sums at shared nodes, always in the same order.
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
typename BasicOperator<Real>::Data::Machine BasicOperator<Real>::Data::machine_of(
    const OperatorOptions& options) {
  const simd::InstructionSet set = simd::choose_instruction_set(options.instruction_set);
  return {set, simd::kernels<Real>(set), options.threads};
}

template <class Real>
BasicOperator<Real>::Data::Data(const Body& body, const OperatorOptions& options, const Layout* like)
    : machine(machine_of(options)),
      mesh{body.mesh.type, body.mesh.plane, body.unknowns(), body.secant_count()},
      materials{{body.laws.begin(), body.laws.end()}, {}},
      layout(make_layout(body,
                         like != nullptr ? partition_as(*like, body, sizeof(double) / sizeof(Real))
                                         : partition(body, machine.threads, 4 * sizeof(Real)),
                         machine.kernels.lanes, machine.threads, options.early)) {
  for (const Law& law : materials.laws)
    materials.views.push_back(
        {law.bulk, law.secant(0.0), law.yield_strain(), law.mean_dilatation, &law, evaluate, across});
  coordinates.resize(4 * layout.records());
  fill_coordinates<Real>(layout, body.mesh, coordinates);
  values.secant.resize(layout.element_point.size());
  for (std::size_t b = 0; b < layout.blocks.size(); ++b) {
    const BlockRange& range = layout.blocks[b];
    const std::size_t end =
        b + 1 < layout.blocks.size() ? layout.blocks[b + 1].first_slot : values.secant.size();
    for (std::size_t i = 0; i < range.group_count; ++i) {
      const simd::Group& group = layout.groups[range.first_group + i];
      const std::size_t from = range.first_slot + group.first_slot;
      const std::size_t to = i + 1 < range.group_count
                                 ? range.first_slot + layout.groups[range.first_group + i + 1].first_slot
                                 : end;
      std::fill(values.secant.data() + from, values.secant.data() + to,
                static_cast<Real>(materials.views[group.law].shear));
    }
  }
  if (const CornerMeans means = corner_means(body); means.size() > 0) {
    nodal.corners = make_corner_layout(body, means, layout);
    nodal.volume = corner_volumes(body, means);
    for (std::size_t i = 0; i < means.size(); ++i) nodal.bulk.push_back(means.bulk(i));
    weigh_corners();
  }
  workspace.of_thread.resize(machine.threads);
  reserve_scratch(1);
  start_team(machine.threads);
}

template <class Real>
double BasicOperator<Real>::Data::bulk_at(const Law& law, double g) const {
  return mesh.plane == PlaneState::stress ? plane_stress_bulk(law.bulk, g) : law.bulk;
}

template <class Real>
void BasicOperator<Real>::Data::reserve_scratch(int vectors) {
  if (vectors <= workspace.vectors) return;
  workspace.vectors = vectors;
  const std::size_t count = vectors;
  for (std::size_t t = 0; t < workspace.of_thread.size(); ++t) {
    workspace.of_thread[t].u.assign(4 * layout.largest * count, Real(0));
    workspace.of_thread[t].f.assign(4 * layout.largest * count, Real(0));
    workspace.of_thread[t].sums.assign(3 * static_cast<std::size_t>(layout.slots_of_thread[t]) * count,
                                       Real(0));
  }
}

template <class Real>
simd::Block<Real> BasicOperator<Real>::Data::block(std::size_t b) {
  const BlockRange& range = layout.blocks[b];
  return {layout.groups.data() + range.first_group,
          range.group_count,
          materials.views.data(),
          layout.index.data() + range.first_index,
          coordinates.data() + 4 * range.first_record,
          values.secant.data() + range.first_slot,
          tangent.floats.empty() ? nullptr : tangent.floats.data() + simd::tangent_floats * range.first_slot,
          layout.nodes.data() + range.first_node,
          layout.shared.data() + range.first_shared,
          range.first,
          range.again,
          range.count,
          {range.placed[0], range.placed[1], range.placed[2]},
          layout.padding,
          mesh.plane,
          values.free_strain.empty() ? nullptr : values.free_strain.data() + range.first_slot};
}

template <class Real>
void BasicOperator<Real>::Data::detach_tangent() {
  if (tangent.present && tangent.secant.empty()) tangent.secant = values.secant;
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
          sum += workspace.of_thread[thread].sums[3 * slot + k];
        }
        y[v * mesh.unknowns + layout.interface_node[i] * stride + k] = sum;
      }
}

template <class Real>
template <class LoopsOnBlock>
double BasicOperator<Real>::Data::loop(const CallerVectors& vectors, bool averaged,
                                       const OnInterfaceReady& on_interface_ready, LoopsOnBlock&& loops) {
  reserve_scratch(vectors.count);
  const Real* const x = vectors.x;
  Real* const y = vectors.y;
  const std::size_t stride = 4 * std::size_t{layout.largest};
  const std::size_t count = vectors.count;
  const int dimension = static_cast<int>(dim());
  std::vector<double> sums(workspace.of_thread.size(), 0.0);
  const auto prepare = [&](std::size_t t) {
    std::fill_n(workspace.of_thread[t].sums.begin(),
                3 * static_cast<std::size_t>(layout.slots_of_thread[t]) * count, Real(0));
    for (std::size_t v = 0; t == 0 && y != nullptr && v < count; ++v)
      for (const std::int32_t node : layout.unreferenced_nodes)
        std::fill_n(y + v * mesh.unknowns + node * dim(), dim(), Real(0));
  };
  const auto run = [&](std::size_t t, std::size_t begin, std::size_t end) {
    Scratch& mine = workspace.of_thread[t];
    const auto slots = 3 * static_cast<std::size_t>(layout.slots_of_thread[t]);
    double sum = sums[t];
    for (std::size_t b = begin; b < end; ++b) {
      const simd::Block<Real> at = block(b);
      for (std::size_t v = 0; x != nullptr && v < count; ++v)
        machine.kernels.gather(at, dimension, x + v * mesh.unknowns, mine.u.data() + v * stride,
                               mine.f.data() + v * stride);
      if (x == nullptr) std::fill_n(mine.f.data(), 4 * std::size_t{at.count + at.padding}, Real(0));
      for (std::size_t v = 0; averaged && v < count; ++v)
        for (const BlockCorner& corner : nodal.corners.of(b))
          mine.u[v * stride + 4 * corner.node + 3] = nodal.mean[v * nodal.corners.entries + corner.entry];
      sum += loops(at, mine.u.data(), mine.f.data(), stride);
      for (std::size_t v = 0; y != nullptr && v < count; ++v)
        machine.kernels.scatter(at, dimension, mine.f.data() + v * stride, y + v * mesh.unknowns,
                                mine.sums.data() + v * slots);
    }
    sums[t] = sum;
  };
  const auto finish = [&](std::size_t t, std::size_t begin, std::size_t end) {
    const std::size_t team = workspace.of_thread.size(), size = end - begin;
    if (y != nullptr) add_interface(y, vectors.count, begin + size * t / team, begin + size * (t + 1) / team);
  };
  // The blocks have the same order with and without the early step: the results have the same bits.
  const std::size_t interface_size = layout.interface_node.size();
  if (on_interface_ready) {
    in_parallel(
        machine.threads, [&](std::size_t t) { prepare(t), run(t, layout.share[t], layout.early[t]); },
        [&](std::size_t t) { finish(t, 0, layout.early_interface); });
    on_interface_ready();
    in_parallel(
        machine.threads, [&](std::size_t t) { run(t, layout.early[t], layout.share[t + 1]); },
        [&](std::size_t t) { finish(t, layout.early_interface, interface_size); });
  } else {
    in_parallel(
        machine.threads, [&](std::size_t t) { prepare(t), run(t, layout.share[t], layout.share[t + 1]); },
        [&](std::size_t t) { finish(t, 0, interface_size); });
  }
  double total = 0.0;
  for (const double sum : sums) total += sum;
  return total;
}

template <class Real>
void BasicOperator<Real>::Data::weigh_corners() {
  nodal.weight.assign(nodal.volume.begin(), nodal.volume.end());
  if (nodal.sum) nodal.sum(nodal.weight);
  for (Real& w : nodal.weight) w = Real(1) / w;
}

template <class Real>
void BasicOperator<Real>::Data::find_changes(const Real* x, int vectors) {
  if (nodal.corners.entries == 0) return;
  reserve_scratch(vectors);
  const std::size_t stride = 4 * std::size_t{layout.largest}, count = vectors;
  nodal.change.assign(nodal.corners.places * count, Real(0));
  in_team(machine.threads, [&](int thread) {
    const std::size_t t = thread;
    Scratch& mine = workspace.of_thread[t];
    for (std::size_t b = layout.share[t]; b < layout.share[t + 1]; ++b) {
      if (nodal.corners.of(b).empty()) continue;
      const simd::Block<Real> block_here = block(b);
      for (std::size_t v = 0; v < count; ++v)
        machine.kernels.gather(block_here, 3, x + v * mesh.unknowns, mine.u.data() + v * stride,
                               mine.f.data() + v * stride);
      machine.kernels.corner_changes(block_here, {mine.u.data(), mine.f.data(), vectors, stride});
      for (std::size_t v = 0; v < count; ++v)
        for (const BlockCorner& corner : nodal.corners.of(b))
          nodal.change[v * nodal.corners.places + corner.place] += mine.f[v * stride + 4 * corner.node + 3];
    }
  });
  for (std::size_t v = 0; v < count; ++v) {
    const auto all = std::span(nodal.change).subspan(v * nodal.corners.places, nodal.corners.places);
    for (std::size_t i = 0; i < nodal.corners.shared_entry.size(); ++i)
      for (std::size_t k = nodal.corners.shared_first[i]; k < nodal.corners.shared_first[i + 1]; ++k)
        all[nodal.corners.shared_entry[i]] += all[nodal.corners.shared_place[k]];
  }
}

template <class Real>
void BasicOperator<Real>::Data::apply_deviator(const Real* x, Real* y,
                                               const OnInterfaceReady& on_interface_ready) {
  loop({x, y}, false, on_interface_ready,
       [&](const simd::Block<Real>& at, const Real* u, Real* f, std::size_t stride) {
         machine.kernels.apply(at, {u, f, 1, stride});  // gather sets the averages to zero
         return 0.0;
       });
}

template <class Real>
void BasicOperator<Real>::Data::apply_pressure(const Real* x, const Real* p, Real* y,
                                               const OnInterfaceReady& on_interface_ready) {
  nodal.mean.assign(p, p + nodal.corners.entries);
  // The loops over displacements multiply averages by k0.
  for (std::size_t i = 0; x != nullptr && i < nodal.mean.size(); ++i)
    nodal.mean[i] /= static_cast<Real>(nodal.bulk[i]);
  loop({x, y}, nodal.corners.entries > 0, on_interface_ready,
       [&](const simd::Block<Real>& at, const Real* u, Real* f, std::size_t stride) {
         if (x != nullptr)
           machine.kernels.apply(at, {u, f, 1, stride});
         else
           machine.kernels.corner_forces(at, {u, f, 1, stride});
         return 0.0;
       });
}

template <class Real>
double BasicOperator<Real>::Data::find_means(const Real* x, int vectors) {
  find_changes(x, vectors);
  const std::size_t count = vectors;
  nodal.mean.resize(nodal.corners.entries * count);
  double energy = 0.0;
  for (std::size_t v = 0; v < count; ++v) {
    const auto all = std::span(nodal.change).subspan(v * nodal.corners.places, nodal.corners.places);
    const auto means = std::span(nodal.mean).subspan(v * nodal.corners.entries, nodal.corners.entries);
    std::copy_n(all.begin(), means.size(), means.begin());
    if (nodal.sum) nodal.sum(means);
    for (std::size_t i = 0; i < means.size(); ++i) means[i] *= nodal.weight[i];
    for (std::size_t i = 0; v == 0 && i < means.size(); ++i)
      energy += 0.5 * nodal.bulk[i] * static_cast<double>(all[i]) * static_cast<double>(means[i]);
  }
  return energy;
}

template <class Real>
double BasicOperator<Real>::Data::dots(const simd::Block<Real>& at, const simd::Vectors<Real>& vectors) {
  double sum = 0.0;
  for (std::size_t v = 0; v < static_cast<std::size_t>(vectors.count); ++v)
    sum += machine.kernels.dot(at, vectors.u + v * vectors.stride, vectors.f + v * vectors.stride);
  return sum;
}

template <class Real>
double BasicOperator<Real>::Data::apply(const Real* x, Real* y, int vectors, bool with_dot,
                                        const OnInterfaceReady& on_interface_ready) {
  if (averages()) find_means(x, vectors);
  return loop({x, y, vectors}, nodal.corners.entries > 0, on_interface_ready,
              [&](const simd::Block<Real>& at, const Real* u, Real* f, std::size_t stride) {
                machine.kernels.apply(at, {u, f, vectors, stride});
                return with_dot ? dots(at, {u, f, vectors, stride}) : 0.0;
              });
}

template <class Real>
double BasicOperator<Real>::Data::apply_tangent(const Real* x, Real* y, int vectors, bool with_dot,
                                                const OnInterfaceReady& on_interface_ready) {
  if (averages()) find_means(x, vectors);
  return loop({x, y, vectors}, nodal.corners.entries > 0, on_interface_ready,
              [&](simd::Block<Real> at, const Real* u, Real* f, std::size_t stride) {
                if (!tangent.secant.empty())
                  at.secant = tangent.secant.data() + (at.secant - values.secant.data());
                machine.kernels.apply_tangent(at, {u, f, vectors, stride});
                return with_dot ? dots(at, {u, f, vectors, stride}) : 0.0;
              });
}

template <class Real>
const Real* BasicOperator<Real>::Data::by_slot(std::span<const double> of_point, Aligned<Real>& slots) const {
  if (of_point.empty()) return nullptr;
  slots.resize(layout.element_point.size());  // idle lanes stay zero
  layout.for_each_point([of_point, to = slots.data()](std::size_t slot, std::size_t point) {
    to[slot] = static_cast<Real>(of_point[point]);
  });
  return slots.data();
}

template <class Real>
double BasicOperator<Real>::Data::nonlinear(const Real* u, Real* f, const simd::Nonlinear& keep,
                                            const simd::Outside<Real>& outside) {
  if (keep.keep_tangent) {
    tangent.present = true;
    tangent.floats.resize(simd::tangent_floats * values.secant.size());
    Aligned<Real>().swap(tangent.secant);
  } else if (keep.keep_secant) {
    detach_tangent();
  }
  // Without forces and energy only the deviator matters.
  const bool volume_counts = f != nullptr || keep.sum_energy || outside.energy != nullptr;
  const double of_volume = averages() && volume_counts ? find_means(u, 1) : 0.0;
  const bool averaged = nodal.corners.entries > 0 && volume_counts;
  const double energy =
      loop({u, f}, averaged, {}, [&](simd::Block<Real> at, const Real* local, Real* forces, std::size_t) {
        simd::Nonlinear out = keep;
        at.outside = outside.from(static_cast<std::size_t>(at.secant - values.secant.data()));
        machine.kernels.nonlinear(at, local, forces, &out);
        return out.energy();
      });
  return of_volume + energy;
}

template struct BasicOperator<double>::Data;
template struct BasicOperator<float>::Data;

}  // namespace kacanov
