// SPDX-License-Identifier: BSD-3-Clause
// The fine level of the multigrid: B(g) and node blocks in single precision, with block Jacobi.
#include "multigrid/fine_level.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <utility>

#include "multigrid/cycle.hpp"
#include "multigrid/multigrid.hpp"
#include "multigrid/multigrid_body.hpp"
#include "operator/nodal_pressure.hpp"
#include "operator/threads.hpp"
#include "simd/node_blocks.hpp"

namespace kacanov {
namespace {

FloatOperator make_operator(const MultigridBody& body, const OperatorOptions& options) {
  return body.like != nullptr ? FloatOperator(body.body, options, *body.like)
                              : FloatOperator(body.body, options);
}

/// The laws without the volumetric part that pressures represent.
std::vector<Law> without_means(std::span<const Law> laws) {
  std::vector<Law> rest(laws.begin(), laws.end());
  for (Law& law : rest)
    if (law.mean_dilatation) law.bulk = 0.0, law.mean_dilatation = false;
  return rest;
}

}  // namespace

FineLevel::FineLevel(const MultigridBody& body, const MultigridOptions& options, FinePart part,
                     const CornerMeans* means)
    : body_(body),
      threads_(options.threads),
      part_(part),
      laws_(part == FinePart::deviator && averages_over_elements(body.body) ? without_means(body.body.laws)
                                                                            : std::vector<Law>()),
      op_(make_operator(laws_.empty() ? body : with_laws(body, laws_),
                        {options.threads, options.instruction_set, body.node_map->shared})),
      sum_(*body.node_map, static_cast<int>(body.dim())) {
  body_.like = nullptr;  // may be destroyed
  if (!laws_.empty()) body_.body.laws = laws_, of_elements_.emplace(body.body, *means, threads_);
  if (body.node_map->ranks > 1 && !corner_moduli(body.body).empty())
    op_.set_corner_sum(CornerSum<float>(means != nullptr ? *means : corner_means(body.body), *body.node_map));
}

void FineLevel::setup(std::span<const double> g, const NodeSupports& supports) {
  op_.set_secant(g);
  take_supports(supports);
  held_.clear();
  for (std::size_t i = 0; i < body_.held.size(); ++i)
    if (body_.held[i] != 0) held_.push_back(static_cast<std::int32_t>(i));
  held_stiffness_.resize(held_.size());
  inverse_.resize(body_.nodes() * body_.dim() * (body_.dim() + 1) / 2);
  std::vector<float> diagonal = node_blocks({});
  take_own_stiffness(diagonal);
  take_diagonal(diagonal, {});
}

std::pair<std::vector<NodeBlock>, ConstrainedSpace> FineLevel::update(const NodeSupports& supports) {
  std::pair before(std::move(blocks_), std::move(space_));
  std::vector<NodeBlock> both = before.first;
  both.insert(both.end(), supports.blocks.begin(), supports.blocks.end());
  const std::vector<char> touched = touched_by(both);
  take_supports(supports);
  std::vector<float> diagonal = node_blocks(touched);
  take_diagonal(diagonal, touched);
  return before;
}

/// One flag per node, on every rank that has the node.
std::vector<char> FineLevel::touched_by(std::span<const NodeBlock> blocks) const {
  std::vector<std::int32_t> flag(body_.nodes(), 0);
  for (const NodeBlock& b : blocks) flag[b.node] = 1;
  body_.node_map->forward(flag, 1);
  return {flag.begin(), flag.end()};
}

void FineLevel::take_supports(const NodeSupports& supports) {
  space_ = supports.space;
  blocks_.assign(supports.blocks.begin(), supports.blocks.end());
  std::vector<char> is_shared(body_.nodes(), 0);
  for (const std::int32_t node : body_.node_map->shared) is_shared[node] = 1;
  const auto rest = std::stable_partition(blocks_.begin(), blocks_.end(),
                                          [&](const NodeBlock& b) { return is_shared[b.node] != 0; });
  shared_blocks_ = static_cast<std::size_t>(rest - blocks_.begin());
}

/// This rank's contribution to the operator's own diagonal blocks.
std::vector<float> FineLevel::node_blocks(std::span<const char> wanted) const {
  std::vector<float> blocks(body_.nodes() * body_.dim() * body_.dim());
  if (part_ == FinePart::deviator && !of_elements_)
    op_.block_diagonal_deviator(blocks, wanted);
  else
    op_.block_diagonal(blocks, wanted);
  return blocks;
}

/// Updates D and dependent data, from the nodes' own blocks, at the renewed nodes or, if none is named, at
/// all.
void FineLevel::take_diagonal(std::span<float> blocks, std::span<const char> renewed) {
  const std::size_t dim = body_.dim(), packed = dim * (dim + 1) / 2;
  for (const auto& b : blocks_)
    for (std::size_t k = 0; k < dim * dim; ++k)
      blocks[static_cast<std::size_t>(b.node) * dim * dim + k] += static_cast<float>(b.value[k]);
  body_.node_map->sum(blocks, static_cast<int>(dim * dim));
  const auto stays = [&](std::size_t node) { return !renewed.empty() && renewed[node] == 0; };
  for (std::size_t k = 0; k < held_.size(); ++k)
    if (const std::size_t i = held_[k]; !stays(i / dim)) held_stiffness_[k] = blocks[i * dim + i % dim];
  in_shares(threads_, body_.nodes(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      if (stays(n)) continue;
      Eigen::Matrix3d d = Eigen::Matrix3d::Identity();
      for (std::size_t i = 0; i < dim; ++i)
        for (std::size_t j = 0; j < dim; ++j)
          if (body_.held[n * dim + i] == 0 && body_.held[n * dim + j] == 0)
            d(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                static_cast<double>(blocks[(n * dim + i) * dim + j]);
      const Eigen::Matrix3d inverse = d.inverse();
      float* to = &inverse_[n * packed];
      for (std::size_t i = 0; i < dim; ++i)
        for (std::size_t j = i; j < dim; ++j)
          *to++ = static_cast<float>(inverse(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
    }
  });
}

/// From blocks without additions.
void FineLevel::take_own_stiffness(std::span<const float> blocks) {
  const std::size_t dim = body_.dim();
  own_stiffness_.assign(body_.nodes(), 0.0F);
  for (std::size_t n = 0; n < body_.nodes(); ++n)
    for (std::size_t i = 0; i < dim; ++i)
      own_stiffness_[n] += blocks[(n * dim + i) * dim + i] / static_cast<float>(dim);
  body_.node_map->sum(std::span<float>(own_stiffness_), 1);
}

void FineLevel::add_blocks(std::span<const NodeBlock> blocks, std::span<const float> x,
                           std::span<float> y) const {
  const std::size_t dim = body_.dim();
  for (const auto& b : blocks) {
    const auto at = static_cast<std::size_t>(b.node) * dim;
    for (std::size_t i = 0; i < dim; ++i)
      for (std::size_t j = 0; j < dim; ++j) y[at + i] += static_cast<float>(b.value[i * dim + j]) * x[at + j];
  }
}

/// y = result of apply(on_interface_ready) plus the blocks' forces, over all ranks; without x no blocks.
template <class Apply>
void FineLevel::product(const Apply& apply, std::span<const float> x, std::span<float> y) {
  const auto blocks = x.empty() ? std::span<NodeBlock>() : std::span(blocks_);
  const std::size_t shared = std::min(shared_blocks_, blocks.size());
  if (body_.node_map->ranks > 1) {
    apply([&, this] {
      add_blocks(blocks.first(shared), x, y);
      sum_.start_sum(y);
    });
    add_blocks(blocks.subspan(shared), x, y);
    sum_.finish_sum(y);
  } else {
    apply(OnInterfaceReady());
    add_blocks(blocks, x, y);
  }
  hold(y);
}

void FineLevel::multiply(std::span<const float> x, std::span<float> y) {
  if (part_ == FinePart::deviator) return multiply(x, {}, y);
  product([&](const OnInterfaceReady& early) { op_.apply(x, y, early); }, x, y);
}

void FineLevel::multiply(std::span<const float> x, std::span<const float> p, std::span<float> y) {
  product(
      [&](const OnInterfaceReady& early) {
        if (!of_elements_) return op_.apply_deviator(x, p, y, early);
        op_.apply(x, y);
        if (!p.empty()) of_elements_->add_force(p, y);
        if (early) early();
      },
      x, y);
}

void FineLevel::volume_change(std::span<const float> x, std::span<float> q) {
  if (of_elements_) return of_elements_->volume_change(x, q);
  op_.volume_change(x, q);
}

void FineLevel::pressure_force(std::span<const float> p, std::span<float> y) {
  product(
      [&](const OnInterfaceReady& early) {
        if (!of_elements_) return op_.pressure_force(p, y, early);
        std::fill(y.begin(), y.end(), 0.0F);
        of_elements_->add_force(p, y);
        if (early) early();
      },
      {}, y);
}

void FineLevel::add_scaled(float factor, std::span<const float> b, std::span<const float> image,
                           std::span<float> x) const {
  constexpr std::size_t piece = 128;
  const std::size_t dim = body_.dim();
  in_shares(threads_, body_.nodes(), [&](std::size_t begin, std::size_t end) {
    std::array<float, 3 * piece> residual;
    std::array<float, 3 * piece + 1> scaled;
    for (std::size_t node = begin; node < end; node += piece) {
      const std::size_t nodes = std::min(piece, end - node), at = node * dim, count = nodes * dim;
      for (std::size_t i = 0; i < count; ++i)
        residual[i] = image.empty() ? b[at + i] : b[at + i] - image[at + i];
      simd::scale_by_blocks(static_cast<int>(dim), &inverse_[node * dim * (dim + 1) / 2], residual.data(),
                            nodes, scaled.data());
      for (std::size_t i = 0; i < count; ++i) x[at + i] += factor * scaled[i];
    }
  });
}

void FineLevel::relax(const ChebyshevStep<float>& weights, std::span<const float> b,
                      std::span<const float> image, std::span<float> step, std::span<float> x) const {
  // Pieces that stay in the first-level cache during the three loops.
  constexpr std::size_t piece = 128;
  const std::size_t dim = body_.dim();
  weights.visit([&]<bool zero, bool first>() {
    in_shares(threads_, body_.nodes(), [&](std::size_t begin, std::size_t end) {
      std::array<float, 3 * piece> residual;
      std::array<float, 3 * piece + 1> scaled;
      for (std::size_t node = begin; node < end; node += piece) {
        const std::size_t nodes = std::min(piece, end - node), at = node * dim, count = nodes * dim;
        for (std::size_t i = 0; i < count; ++i) residual[i] = zero ? b[at + i] : b[at + i] - image[at + i];
        simd::scale_by_blocks(static_cast<int>(dim), &inverse_[node * dim * (dim + 1) / 2], residual.data(),
                              nodes, scaled.data());
        for (std::size_t i = 0; i < count; ++i)
          weights.template take<zero, first>(scaled[i], step[at + i], x[at + i]);
      }
    });
  });
}

void FineLevel::smooth(bool from_zero, const SmootherVectors<float>& on) {
  smoother_.smooth<float>(
      from_zero, on, [this](std::span<const float> x, std::span<float> y) { multiply(x, y); },
      [this](const ChebyshevStep<float>& weights, std::span<const float> b, std::span<const float> image,
             std::span<float> step, std::span<float> x) { relax(weights, b, image, step, x); });
}

void FineLevel::residual(std::span<const float> b, std::span<const float> x, std::span<const float> p,
                         std::span<float> r) {
  if (p.empty())
    multiply(x, r);
  else
    multiply(x, p, r);
  each_in_shares(threads_, r.size(), [&](std::size_t i) { r[i] = b[i] - r[i]; });
  project(r);
}

void FineLevel::add_correction(std::span<float> u, std::span<float> x) const {
  body_.node_map->forward(u, static_cast<int>(body_.dim()));
  project(u);
  each_in_shares(threads_, x.size(), [&](std::size_t i) { x[i] += u[i]; });
}

void FineLevel::load(double factor, std::span<const double> r, std::span<float> b) const {
  each_in_shares(threads_, r.size(), [&](std::size_t i) { b[i] = static_cast<float>(factor * r[i]); });
  hold(b);
}

void FineLevel::store(double factor, std::span<const float> x, std::span<double> z) const {
  each_in_shares(threads_, z.size(), [&](std::size_t i) { z[i] = factor * static_cast<double>(x[i]); });
}

void FineLevel::hold(std::span<float> x) const {
  for (const std::int32_t component : held_) x[component] = 0.0F;
}

void FineLevel::project(std::span<float> x) const {
  hold(x);
  space_.project(body_.dim(), x);
}

void FineLevel::choose_smoother(int degree, double range) {
  std::vector<float> x = scattered<float>(*body_.node_map, body_.dim());
  hold(x);
  const auto owned = body_.owned_unknowns();
  const double largest = largest_eigenvalue(
      x, [this](std::span<const float> p, std::span<float> q) { multiply(p, q); },
      [&](std::span<const float> p, std::span<float> q) {
        relax({0.0F, 1.0F, true, true}, p, p, q, q);
      },
      [&](const std::vector<float>& p, const std::vector<float>& q) {
        const double sum = sum_shares(threads_, owned, [&](std::size_t begin, std::size_t end) {
          double s = 0.0;
          for (std::size_t i = begin; i < end; ++i)
            s += static_cast<double>(p[i]) * static_cast<double>(q[i]);
          return s;
        });
        return body_.node_map->sum_all(sum);
      });
  smoother_ = {degree, largest / range, largest};
}

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

void ConstrainedSpace::project(std::size_t dim, std::span<double> x) const {
  project_out(std::span(directions), dim, x);
  if (rows) rows->project(x);
}

void ConstrainedSpace::project(std::size_t dim, std::span<float> x) const {
  project_out(std::span(directions), dim, x);
  if (!rows) return;
  std::vector<double> exact(x.begin(), x.end());
  rows->project(exact);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = static_cast<float>(exact[i]);
}

}  // namespace kacanov
