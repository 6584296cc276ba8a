// SPDX-License-Identifier: BSD-3-Clause
// The coarse spaces of rigid-body modes of aggregates, and of aggregates of these: Galerkin assembly and
// transfer.
#include "multigrid/aggregation/coarse_space.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>
#include <utility>

#include "cells/elements.hpp"
#include "cells/point.hpp"
#include "law/plane_stress.hpp"
#include "multigrid/aggregation/aggregates.hpp"
#include "multigrid/multigrid_body.hpp"
#include "operator/threads.hpp"
#include "simd/motion_products.hpp"

namespace kacanov {

/// Sums elements and node blocks over the motions of aggregates, into a level or, without one, into separate
/// blocks.
template <int M>
class GalerkinAssembly {
  static constexpr std::size_t dim = Aggregates<M>::dim;
  using Block = typename BlockSums<M>::Block;
  using Rows = typename simd::MotionPoint<M>::Rows;

 public:
  /// `g`: elements × points, rounded to single precision; `level` may be null. The arguments must outlive it.
  GalerkinAssembly(const Aggregates<M>& aggregates, simd::AddMotionProducts<M> add_products,
                   std::span<const double> g, BlockMatrix<M>* level)
      : aggregates_(aggregates),
        held_(aggregates.body().held),
        add_products_(add_products),
        body_(aggregates.body().body),
        g_(g),
        level_(level) {}

  /// Restricts the sums to the rows of this share; without this call all rows are summed.
  void take_share(int share, int shares) {
    const std::int64_t rows = aggregates_.size();
    first_row_ = static_cast<std::int32_t>(rows * share / shares);
    last_row_ = static_cast<std::int32_t>(rows * (share + 1) / shares);
  }

  /// Sets the held directions and the factor of the next sums.
  void choose(const ConstrainedSpace& space, double sign) {
    sign_ = sign;
    projector_.clear();
    bound_.assign(body_.mesh.node_count(), 0);
    for (const auto& entry : space.directions) {
      Eigen::Matrix3d p = Eigen::Matrix3d::Identity();
      for (int k = 0; k < entry.count; ++k) {
        const Eigen::Map<const Eigen::Vector3d> b(entry.basis[k].data());
        p -= b * b.transpose();
      }
      projector_.emplace(entry.node, p);
      bound_[entry.node] = 1;
    }
    for (std::size_t i = 0; i < held_.size(); ++i)
      if (held_[i] != 0) bound_[i / dim] = 1;
  }

  /// Adds the elements number(0), …, number(count − 1).
  void add_elements(std::size_t count, const auto& number) {
    elements::dispatch(body_.mesh.type, [&]<class E>(E) {
      if constexpr (static_cast<std::size_t>(E::dim) == dim) {
        for (std::size_t i = 0; i < count; ++i) add_element<E>(number(i));
      }
    });
  }

  void add_block(const NodeBlock& block) {
    const Rows z = rows(block.node);
    const std::int32_t a = aggregates_.of(block.node);
    if (!is_mine(a)) return;
    Block& sum = at(a, a);
    for (std::size_t i = 0; i < M; ++i)
      for (std::size_t j = 0; j < M; ++j) {
        double v = 0.0;
        for (std::size_t c = 0; c < dim; ++c)
          for (std::size_t d = 0; d < dim; ++d) v += z.row[c][i] * block.value[c * dim + d] * z.row[d][j];
        sum[i * M + j] += sign_ * v;
      }
  }

  /// Sums of blocks outside the level.
  BlockSums<M>& others() { return others_; }

 private:
  /// Displacement of a node for each motion of its aggregate, projected onto the space.
  Rows rows(std::int32_t node) const {
    const std::size_t n = node;
    const auto motion = RigidMotion<M>::rows(aggregates_.offset(n).data(), 1.0 / aggregates_.length());
    Rows z{};
    for (std::size_t c = 0; c < dim; ++c)
      for (std::size_t m = 0; m < M; ++m) z.row[c][m] = motion[c][m];
    if (bound_[n] == 0) return z;
    for (std::size_t c = 0; c < dim; ++c)
      if (held_[n * dim + c] != 0) std::fill_n(z.row[c], M, 0.0);
    if (const auto held = projector_.find(node); held != projector_.end()) {
      const Rows free = z;
      for (std::size_t c = 0; c < dim; ++c)
        for (std::size_t m = 0; m < M; ++m) {
          z.row[c][m] = 0.0;
          for (std::size_t k = 0; k < dim; ++k)
            z.row[c][m] +=
                held->second(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)) * free.row[k][m];
        }
    }
    return z;
  }

  bool is_mine(std::int32_t row) const { return row >= first_row_ && row < last_row_; }
  bool is_in_level(std::int32_t a, std::int32_t b) const {
    return level_ != nullptr && (aggregates_.is_owned(a) || aggregates_.is_owned(b));
  }
  /// Whether block (a, b) is stored, not (b, a).
  bool in_order(std::int32_t a, std::int32_t b) const {
    return is_in_level(a, b) ? a <= b : aggregates_.number(a) <= aggregates_.number(b);
  }
  Block& at(std::int32_t a, std::int32_t b) {
    return is_in_level(a, b) ? level_->block(a, b) : others_.at(aggregates_.number(a), aggregates_.number(b));
  }

  /// A rigid motion does not strain an element within a single aggregate, unless a node is bound or the body
  /// is axisymmetric. (Deriving the diagonal blocks from the others, because a global motion strains nothing,
  /// would save half of the products but loses too many digits on stretched meshes.)
  template <class E>
  void add_element(std::size_t e) {
    constexpr std::size_t npe = E::nodes;
    const std::int32_t* node = body_.mesh.connectivity.data() + e * npe;
    std::array<std::int32_t, npe> which{};  // the aggregates of its nodes
    std::array<std::size_t, npe> local{};   // index of each node's aggregate in `which`
    std::size_t count = 0;
    bool rigid = body_.mesh.plane != PlaneState::axisymmetric;
    for (std::size_t a = 0; a < npe; ++a) {
      rigid = rigid && bound_[node[a]] == 0;
      const std::int32_t group = aggregates_.of(node[a]);
      std::size_t k = 0;
      while (k < count && which[k] != group) ++k;
      if (k == count) which[count++] = group;
      local[a] = k;
    }
    if (rigid && count == 1) return;

    std::array<simd::MotionPair, npe*(npe + 1) / 2> pairs;
    std::size_t pair_count = 0;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a; b < count; ++b) {
        const bool ordered = in_order(which[a], which[b]);
        const std::size_t row = ordered ? a : b, column = ordered ? b : a;
        if (!is_mine(which[row])) continue;
        pairs[pair_count++] = {row, column, at(which[row], which[column]).data()};
      }
    if (pair_count == 0) return;

    elements::Nodal<E> x;
    std::array<Rows, npe> z;
    for (std::size_t a = 0; a < npe; ++a) {
      z[a] = rows(node[a]);
      for (std::size_t c = 0; c < dim; ++c)
        x[a * dim + c] = body_.mesh.coordinates[static_cast<std::size_t>(node[a]) * dim + c];
    }
    const Law& law = body_.law(e);
    const auto points = elements::points_of<E>(x, law.mean_dilatation, body_.mesh.plane);
    for (std::size_t q = 0; q < E::points; ++q) {
      const auto& point = points[q];
      const auto g = static_cast<double>(static_cast<float>(g_[e * static_cast<std::size_t>(E::points) + q]));
      const double volume = sign_ * point.volume, shear = 2.0 * g * volume,
                   modulus =
                       body_.mesh.plane == PlaneState::stress ? plane_stress_bulk(law.bulk, g) : law.bulk,
                   bulk = modulus * volume;
      add_products_({npe, count, point.gradient[0], point.dilatation[0],
                     body_.mesh.plane == PlaneState::axisymmetric ? point.hoop : nullptr, z.data(),
                     local.data(), shear, bulk},
                    pairs.data(), pair_count);
    }
  }

  const Aggregates<M>& aggregates_;
  std::span<const std::uint8_t> held_;
  simd::AddMotionProducts<M> add_products_;
  Body body_;
  std::span<const double> g_;
  BlockMatrix<M>* level_;
  BlockSums<M> others_;
  double sign_ = 1.0;
  std::int32_t first_row_ = 0, last_row_ = std::numeric_limits<std::int32_t>::max();
  std::vector<std::uint8_t> bound_;
  std::unordered_map<std::int32_t, Eigen::Matrix3d> projector_;
};

template <int M>
void AggregateMotions<M>::setup(std::span<const double> g, const NodeSupports& held,
                                BlockMatrix<M>& level) const {
  level.clear();
  // Every thread adds only to its own rows, so that results do not depend on the number of threads.
  const int threads = aggregates_.threads();
  std::vector<BlockSums<M>> others(threads);
  in_team(threads, [&](int t) {
    GalerkinAssembly<M> sums(aggregates_, add_products_, g, &level);
    sums.take_share(t, threads);
    sums.choose(held.space, 1.0);
    sums.add_elements(body().body.mesh.element_count(), [](std::size_t i) { return i; });
    for (const NodeBlock& block : held.blocks) sums.add_block(block);
    others[t] = std::move(sums.others());
  });
  for (int t = 1; t < threads; ++t)
    for (const auto& entry : others[t].entries()) others[0].at(entry.row, entry.column) = entry.block;
  level.complete(std::move(others[0]));
}

template <int M>
void AggregateMotions<M>::update(std::span<const double> g, const NodeSupports& before,
                                 const NodeSupports& after, BlockMatrix<M>& level) const {
  const MeshView& mesh = body().body.mesh;
  std::vector<std::uint8_t> moved(body().nodes(), 0);  // nodes whose held directions differ
  std::unordered_map<std::int32_t, const HeldDirections*> gone;
  for (const auto& entry : before.space.directions) gone.emplace(entry.node, &entry);
  for (const auto& entry : after.space.directions) {
    const auto old = gone.find(entry.node);
    if (old != gone.end() && old->second->count == entry.count && old->second->basis == entry.basis)
      gone.erase(old);
    else
      moved[entry.node] = 1;
  }
  for (const auto& [node, entry] : gone) moved[node] = 1;

  const std::size_t npe = nodes_per_element(mesh.type);
  std::vector<std::size_t> elements;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    if (std::any_of(&mesh.connectivity[e * npe], &mesh.connectivity[e * npe] + npe,
                    [&](std::int32_t n) { return moved[n] != 0; }))
      elements.push_back(e);
  GalerkinAssembly<M> sums(aggregates_, add_products_, g, nullptr);
  for (const auto& [held, sign] : {std::pair{&before, -1.0}, std::pair{&after, 1.0}}) {
    sums.choose(held->space, sign);
    sums.add_elements(elements.size(), [&](std::size_t i) { return elements[i]; });
    for (const NodeBlock& block : held->blocks) sums.add_block(block);
  }
  level.add(sums.others());
}

template <int M>
void AggregateMotions<M>::share_out() {
  const std::size_t owned = body().owned_nodes(), team = aggregates_.threads();
  std::int32_t groups = 0;
  for (std::size_t n = 0; n < owned; ++n) groups = std::max(groups, aggregates_.of(n) + 1);
  for (std::size_t t = 0; t < team; ++t)
    shares_.push_back({static_cast<std::int32_t>(groups * t / team),
                       static_cast<std::int32_t>(groups * (t + 1) / team), owned, 0});
  for (std::size_t n = 0; n < owned; ++n)
    for (Share& share : shares_)
      if (aggregates_.of(n) >= share.begin && aggregates_.of(n) < share.end) {
        share.first_node = std::min(share.first_node, n);
        share.last_node = n + 1;
      }
}

template <int M>
void AggregateMotions<M>::restrict_forces(std::span<const float> force, std::span<double> b) const {
  std::fill(b.begin(), b.end(), 0.0);
  in_team(aggregates_.threads(), [&](int t) {
    const Share& mine = shares_[t];
    for (std::size_t n = mine.first_node; n < mine.last_node; ++n) {
      if (aggregates_.of(n) < mine.begin || aggregates_.of(n) >= mine.end) continue;
      std::array<double, dim> f{};
      for (std::size_t c = 0; c < dim; ++c) f[c] = static_cast<double>(force[n * dim + c]);
      RigidMotion<M>::add_force(f.data(), aggregates_.offset(n).data(), 1.0 / length(),
                                b.data() + static_cast<std::size_t>(aggregates_.of(n)) * M);
    }
  });
}

template <int M>
void AggregateMotions<M>::prolong(std::span<const double> x, double gain, std::span<float> u) const {
  in_shares(aggregates_.threads(), body().owned_nodes(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      std::array<double, dim> motion{};
      RigidMotion<M>::add_motion(x.data() + static_cast<std::size_t>(aggregates_.of(n)) * M,
                                 aggregates_.offset(n).data(), 1.0 / length(), motion.data());
      for (std::size_t c = 0; c < dim; ++c) u[n * dim + c] = static_cast<float>(gain * motion[c]);
    }
  });
  std::fill(u.begin() + static_cast<std::ptrdiff_t>(body().owned_unknowns()), u.end(), 0.0F);
}

template class AggregateMotions<3>;
template class AggregateMotions<6>;

namespace {

constexpr std::int64_t direct_rows = 400;

/// The whole matrix of a level, on every rank. Collective.
template <int M>
LastMatrix whole_matrix(const BlockMatrix<M>& level) {
  LastMatrix all{level.first() * M, static_cast<Eigen::Index>(level.owned_size()), level.total() * M, {}, {}};
  std::vector<double> diagonal(static_cast<std::size_t>(all.total), 0.0);
  for (const auto& entry : level.gathered())
    for (int i = 0; i < M; ++i)
      for (int j = 0; j < M; ++j) {
        const Eigen::Index row = entry.row * M + i, column = entry.column * M + j;
        const double v = entry.block[static_cast<std::size_t>(i * M + j)];
        all.entries.emplace_back(row, column, v);
        if (row == column) diagonal[static_cast<std::size_t>(row)] += v;
      }
  const double largest = diagonal.empty() ? 1.0 : *std::max_element(diagonal.begin(), diagonal.end());
  all.scale.assign(diagonal.size(), largest > 0.0 ? largest : 1e10);
  return all;
}

}  // namespace

template <int M>
AggregationSpace<M>::AggregationSpace(const MultigridBody& body, const MultigridOptions& options)
    : body_(body), options_(options) {
  body_.like = nullptr;  // may be destroyed
}

template <int M>
void AggregationSpace<M>::setup(std::span<const double> g, const NodeSupports& supports, const FineLevel&) {
  if (!motions_) {
    motions_.emplace(body_, g, options_);
    levels_.emplace_back(motions_->make_level());
  }
  forget_coarser();
  motions_->setup(g, supports, levels_.front().matrix);
  set_up_coarser();
}

template <int M>
void AggregationSpace<M>::update(const NodeSupports& before, const NodeSupports& after,
                                 const FineLevel& fine) {
  forget_coarser();
  Vector g(body_.body.secant_count());
  fine.secant(g);
  motions_->update(g, before, after, levels_.front().matrix);
  set_up_coarser();
}

template <int M>
void AggregationSpace<M>::forget_coarser() {
  direct_.reset();
  coarse_.reset();
  levels_.erase(levels_.begin() + 1, levels_.end());
}

/// Sets up all levels below the first one, and the smoothers of all.
template <int M>
void AggregationSpace<M>::set_up_coarser() {
  while (levels_.back().matrix.total() > direct_rows) {
    Level& level = levels_.back();
    if (options_.make_coarse && level.matrix.total() <= options_.coarse_rows) {
      coarse_ = options_.make_coarse(coarse_matrix(level.matrix, motions_->length()));
      break;
    }
    const std::int64_t before = level.matrix.total();
    level.group = aggregate(level.matrix.couplings(), options_.coarse_size);
    BlockMatrix<M> next = level.matrix.coarsened(level.group, motions_->length());
    if (next.total() > before / 2) {
      level.group.clear();
      break;
    }
    const auto centres = level.matrix.centres();
    level.offset.clear();
    for (std::size_t i = 0; i < level.group.size(); ++i) {
      const auto& c = next.centres()[static_cast<std::size_t>(level.group[i])];
      level.offset.push_back({centres[i][0] - c[0], centres[i][1] - c[1], centres[i][2] - c[2]});
    }
    levels_.emplace_back(std::move(next));
  }
  if (!coarse_) direct_.emplace(whole_matrix(levels_.back().matrix), levels_.back().matrix.map());
  for (std::size_t k = 0; !is_last(k); ++k) {
    const double largest = levels_[k].matrix.largest_eigenvalue();
    levels_[k].smoother = {options_.coarse_degree, largest / options_.coarse_range, largest};
  }
}

template <int M>
void AggregationSpace<M>::smooth(std::size_t k, bool before) {
  Level& level = levels_[k];
  level.smoother.template smooth<double>(
      before, {level.owned(level.b), level.owned(level.x), level.owned(level.step), level.owned(level.image)},
      [&](std::span<const double>, std::span<double> y) { level.matrix.multiply(level.x, y); },
      [&](const ChebyshevStep<double>& weights, std::span<const double> b, std::span<const double> image,
          std::span<double> step, std::span<double> x) { level.matrix.relax(weights, b, image, step, x); });
}

template <int M>
void AggregationSpace<M>::restrict_residual(std::size_t k) {
  Level &level = levels_[k], &next = levels_[k + 1];
  level.matrix.multiply(level.x, level.image);
  std::fill(next.b.begin(), next.b.end(), 0.0);
  for (std::size_t i = 0; i < level.group.size(); ++i) {
    std::array<double, M> force{};
    for (std::size_t m = 0; m < M; ++m) force[m] = level.b[i * M + m] - level.image[i * M + m];
    double* to = next.b.data() + static_cast<std::size_t>(level.group[i]) * M;
    RigidMotion<M>::add_from_part(force.data(), level.offset[i].data(), 1.0 / motions_->length(), to);
  }
}

template <int M>
void AggregationSpace<M>::add_correction(std::size_t k) {
  Level &level = levels_[k], &next = levels_[k + 1];
  for (std::size_t i = 0; i < level.group.size(); ++i) {
    const double* from = next.x.data() + static_cast<std::size_t>(level.group[i]) * M;
    std::array<double, M> scaled{};
    for (std::size_t m = 0; m < M; ++m) scaled[m] = options_.coarse_gain * from[m];
    RigidMotion<M>::add_to_part(scaled.data(), level.offset[i].data(), 1.0 / motions_->length(),
                                level.x.data() + i * M);
  }
}

template <int M>
void AggregationSpace<M>::solve_last() {
  Level& last = levels_.back();
  if (coarse_) return coarse_->solve(last.owned(last.b), last.owned(last.x));
  direct_->solve<double>(last.owned(last.b), last.owned(last.x));
}

template <int M>
std::size_t AggregationSpace<M>::bytes() const noexcept {
  std::size_t sum = (motions_ ? motions_->bytes() : 0) + (direct_ ? direct_->bytes() : 0);
  for (const Level& level : levels_)
    sum += level.matrix.bytes() + 4 * level.matrix.size() * sizeof(double) +
           level.group.size() * sizeof(std::int32_t) + level.offset.size() * sizeof(Vector3);
  return sum;
}

template class AggregationSpace<3>;
template class AggregationSpace<6>;

}  // namespace kacanov
