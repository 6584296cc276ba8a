// SPDX-License-Identifier: BSD-3-Clause
// Galerkin's matrix over rigid motions, element by element.
#include "amg/aggregate_motions.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "amg/aggregation.hpp"
#include "cells/dispatch.hpp"
#include "cells/point.hpp"

namespace kacanov {

template <int M>
AggregateMotions<M>::AggregateMotions(const Part& part, std::span<const double> g, double size,
                                      std::string_view instruction_set)
    : part_(part), add_products_(simd::motion_products<M>(instruction_set)) {
  group_ = aggregate_nodes(part.body(), g, part.owned_nodes(), size);
  owned_ = group_.empty() ? 0 : 1 + *std::max_element(group_.begin(), group_.end());
  centre_.assign(owned_, Vector3{});
  std::vector<double> members(centre_.size(), 0.0);
  for (std::size_t n = 0; n < group_.size(); ++n) {
    const std::size_t a = group_[n];
    members[a] += 1.0;
    for (std::size_t c = 0; c < dim; ++c) centre_[a][c] += part_.coordinates[n * dim + c];
  }
  for (std::size_t a = 0; a < centre_.size(); ++a)
    for (double& c : centre_[a]) c /= members[a];
  double spread = 0.0;
  for (std::size_t n = 0; n < group_.size(); ++n) {
    const Vector3 d = offset(n);
    spread += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
  }
  length_ = std::sqrt(part_.halo.sum_all(spread) / static_cast<double>(part_.total_nodes()));
  if (!(length_ > 0.0)) length_ = 1.0;
}

template <int M>
Vector3 AggregateMotions<M>::offset(std::size_t node) const {
  const Vector3& centre = centre_[group_[node]];
  Vector3 d{};
  for (std::size_t c = 0; c < dim; ++c) d[c] = part_.coordinates[node * dim + c] - centre[c];
  return d;
}

template <int M>
RigidLevel<M> AggregateMotions<M>::make_level() {
  const IndexMap& halo = part_.halo;
  first_ = halo.sum_below(owned_);

  // Centre and number of the aggregate of every local node, ghosts from their owners.
  const std::size_t owned_nodes = group_.size();
  std::vector<std::int64_t> number(part_.nodes());
  std::vector<double> centre(dim * part_.nodes());
  for (std::size_t n = 0; n < owned_nodes; ++n) {
    const std::size_t a = group_[n];
    number[n] = first_ + group_[n];
    for (std::size_t c = 0; c < dim; ++c) centre[n * dim + c] = centre_[a][c];
  }
  halo.forward(number, 1);
  halo.forward(centre, static_cast<int>(dim));

  BlockSums<M> couplings;
  const std::size_t npe = nodes_per_element(part_.type);
  std::vector<std::int64_t> distinct;
  for (std::size_t e = 0; e < part_.element_count(); ++e) {
    distinct.clear();
    for (std::size_t a = 0; a < npe; ++a) {
      const std::int64_t id = number[part_.elements[e * npe + a]];
      if (std::find(distinct.begin(), distinct.end(), id) == distinct.end()) distinct.push_back(id);
    }
    for (const std::int64_t row : distinct)
      for (const std::int64_t column : distinct)
        if (row <= column) couplings.at(row, column);
  }
  RigidLevel<M> level(centre_, std::move(couplings), halo);

  group_.resize(part_.nodes());
  std::unordered_map<std::int64_t, std::int32_t>
      unknown;  // to the level: no element here ties them to an owned one
  number_ = level.map().ghosts;
  centre_.resize(centre_.size() + number_.size());
  const auto known = static_cast<std::int32_t>(centre_.size());
  for (std::size_t n = owned_nodes; n < group_.size(); ++n) {
    const std::int64_t id = number[n];
    std::int32_t at = level.local(id);
    if (at < 0) {
      at = unknown.try_emplace(id, known + static_cast<std::int32_t>(unknown.size())).first->second;
      centre_.resize(std::max(centre_.size(), static_cast<std::size_t>(at) + 1));
      number_.resize(centre_.size() - static_cast<std::size_t>(owned_));
    }
    group_[n] = at;
    for (std::size_t c = 0; c < dim; ++c) centre_[at][c] = centre[n * dim + c];
    number_[at - owned_] = id;
  }
  return level;
}

/// Sums of elements and blocks, into a level or, without one, into blocks of their own.
template <int M>
class AggregateMotions<M>::Sums {
  using Block = typename BlockSums<M>::Block;
  using Rows = typename simd::MotionPoint<M>::Rows;

 public:
  Sums(const AggregateMotions& motions, std::span<const double> g, RigidLevel<M>* level)
      : motions_(motions), part_(motions.part_), body_(part_.body()), g_(g), level_(level) {}

  /// Whose directions the next sums respect, and by what they are multiplied.
  void choose(const Space& space, double sign) {
    sign_ = sign;
    projector_.clear();
    bound_.assign(part_.nodes(), 0);
    for (const auto& entry : space.held_directions()) {
      Eigen::Matrix3d p = Eigen::Matrix3d::Identity();
      for (int k = 0; k < entry.count; ++k) {
        const Eigen::Map<const Eigen::Vector3d> b(entry.basis[k].data());
        p -= b * b.transpose();
      }
      projector_.emplace(entry.node, p);
      bound_[entry.node] = 1;
    }
    for (const auto& entry : part_.prescribed) bound_[static_cast<std::size_t>(entry.component) / dim] = 1;
  }

  /// Adds number(0), …, number(count − 1).
  void add_elements(std::size_t count, const auto& number) {
    elements::dispatch(part_.type, [&]<class E>(E) {
      if constexpr (static_cast<std::size_t>(E::dim) == dim) {
        for (std::size_t i = 0; i < count; ++i) add_element<E>(number(i));
      }
    });
  }

  void add_block(const NodeBlock& block) {
    const Rows z = rows(block.node);
    const std::int32_t a = motions_.group_[block.node];
    Block& sum = at(a, a);
    for (std::size_t i = 0; i < M; ++i)
      for (std::size_t j = 0; j < M; ++j) {
        double v = 0.0;
        for (std::size_t c = 0; c < dim; ++c)
          for (std::size_t d = 0; d < dim; ++d) v += z.row[c][i] * block.value[c * dim + d] * z.row[d][j];
        sum[i * M + j] += sign_ * v;
      }
  }

  /// What is not in the level.
  BlockSums<M>& others() { return others_; }

 private:
  /// Displacement of a node for each motion of its aggregate, in the space.
  Rows rows(std::int32_t node) const {
    const std::size_t n = node;
    const auto motion = RigidMotion<M>::rows(motions_.offset(n).data(), 1.0 / motions_.length_);
    Rows z{};
    for (std::size_t c = 0; c < dim; ++c)
      for (std::size_t m = 0; m < M; ++m) z.row[c][m] = motion[c][m];
    if (bound_[n] == 0) return z;
    for (std::size_t c = 0; c < dim; ++c)
      if (part_.held[n * dim + c]) std::fill_n(z.row[c], M, 0.0);
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

  bool is_owned(std::int32_t a) const { return a < motions_.owned_; }
  bool is_in_level(std::int32_t a, std::int32_t b) const {
    return level_ != nullptr && (is_owned(a) || is_owned(b));
  }
  std::int64_t number(std::int32_t a) const {
    return is_owned(a) ? motions_.first_ + a : motions_.number_[a - motions_.owned_];
  }
  /// Whether block (a, b) is the one that is kept, not (b, a).
  bool in_order(std::int32_t a, std::int32_t b) const {
    return is_in_level(a, b) ? a <= b : number(a) <= number(b);
  }
  Block& at(std::int32_t a, std::int32_t b) {
    return is_in_level(a, b) ? level_->block(a, b) : others_.at(number(a), number(b));
  }

  /// One within a single aggregate strains nothing, unless some node is bound. (To take the diagonal blocks
  /// from the others, as a motion of the whole strains nothing, saves half of the products and loses too many
  /// digits on stretched meshes.)
  template <class E>
  void add_element(std::size_t e) {
    constexpr std::size_t npe = E::nodes;
    const std::int32_t* node = body_.mesh.connectivity.data() + e * npe;
    std::array<std::int32_t, npe> which{};  // the aggregates it touches
    std::array<std::size_t, npe> local{};   // that of each node
    std::size_t count = 0;
    bool rigid = true;
    for (std::size_t a = 0; a < npe; ++a) {
      rigid = rigid && bound_[node[a]] == 0;
      const std::int32_t group = motions_.group_[node[a]];
      std::size_t k = 0;
      while (k < count && which[k] != group) ++k;
      if (k == count) which[count++] = group;
      local[a] = k;
    }
    if (rigid && count == 1) return;

    elements::Nodal<E> x;
    std::array<Rows, npe> z;
    for (std::size_t a = 0; a < npe; ++a) {
      z[a] = rows(node[a]);
      for (std::size_t c = 0; c < dim; ++c)
        x[a * dim + c] = body_.mesh.coordinates[static_cast<std::size_t>(node[a]) * dim + c];
    }
    std::array<simd::MotionPair, npe*(npe + 1) / 2> pairs;
    std::size_t pair_count = 0;
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a; b < count; ++b) {
        const bool ordered = in_order(which[a], which[b]);
        const std::size_t row = ordered ? a : b, column = ordered ? b : a;
        pairs[pair_count++] = {row, column, at(which[row], which[column]).data()};
      }

    const Law& law = body_.law(e);
    const auto points = elements::points_of<E>(x, law.mean_dilatation);
    for (std::size_t q = 0; q < E::points; ++q) {
      const auto& point = points[q];
      const auto g = static_cast<double>(static_cast<float>(g_[e * static_cast<std::size_t>(E::points) + q]));
      const double volume = sign_ * point.volume, shear = 2.0 * g * volume, bulk = law.bulk * volume;
      motions_.add_products_(
          {npe, count, point.gradient[0], point.dilatation[0], z.data(), local.data(), shear, bulk},
          pairs.data(), pair_count);
    }
  }

  const AggregateMotions& motions_;
  const Part& part_;
  Body body_;
  std::span<const double> g_;
  RigidLevel<M>* level_;
  BlockSums<M> others_;
  double sign_ = 1.0;
  std::vector<std::uint8_t> bound_;
  std::unordered_map<std::int32_t, Eigen::Matrix3d> projector_;
};

template <int M>
void AggregateMotions<M>::sum(std::span<const double> g, const Held& held, RigidLevel<M>& level) const {
  level.clear();
  Sums sums(*this, g, &level);
  sums.choose(held.space, 1.0);
  sums.add_elements(part_.element_count(), [](std::size_t i) { return i; });
  for (const NodeBlock& block : held.blocks) sums.add_block(block);
  level.complete(std::move(sums.others()));
}

template <int M>
void AggregateMotions<M>::change(std::span<const double> g, const Held& before, const Held& after,
                                 RigidLevel<M>& level) const {
  std::vector<std::uint8_t> moved(part_.nodes(), 0);  // nodes whose held directions are others
  std::unordered_map<std::int32_t, const Space::HeldDirections*> gone;
  for (const auto& entry : before.space.held_directions()) gone.emplace(entry.node, &entry);
  for (const auto& entry : after.space.held_directions()) {
    const auto old = gone.find(entry.node);
    if (old != gone.end() && old->second->count == entry.count && old->second->basis == entry.basis)
      gone.erase(old);
    else
      moved[entry.node] = 1;
  }
  for (const auto& [node, entry] : gone) moved[node] = 1;

  const std::size_t npe = nodes_per_element(part_.type);
  std::vector<std::size_t> elements;
  for (std::size_t e = 0; e < part_.element_count(); ++e)
    if (std::any_of(&part_.elements[e * npe], &part_.elements[e * npe] + npe,
                    [&](std::int32_t n) { return moved[n] != 0; }))
      elements.push_back(e);
  Sums sums(*this, g, nullptr);
  for (const auto& [held, sign] : {std::pair{&before, -1.0}, std::pair{&after, 1.0}}) {
    sums.choose(held->space, sign);
    sums.add_elements(elements.size(), [&](std::size_t i) { return elements[i]; });
    for (const NodeBlock& block : held->blocks) sums.add_block(block);
  }
  level.add(sums.others());
}

template <int M>
void AggregateMotions<M>::restrict_forces(std::span<const float> force, std::span<double> b) const {
  std::fill(b.begin(), b.end(), 0.0);
  for (std::size_t n = 0; n < static_cast<std::size_t>(part_.owned_nodes()); ++n) {
    std::array<double, dim> f{};
    for (std::size_t c = 0; c < dim; ++c) f[c] = static_cast<double>(force[n * dim + c]);
    RigidMotion<M>::add_force(f.data(), offset(n).data(), 1.0 / length_,
                              b.data() + static_cast<std::size_t>(group_[n]) * M);
  }
}

template <int M>
void AggregateMotions<M>::prolong(std::span<const double> x, double gain, std::span<float> u) const {
  for (std::size_t n = 0; n < static_cast<std::size_t>(part_.owned_nodes()); ++n) {
    std::array<double, dim> motion{};
    RigidMotion<M>::add_motion(x.data() + static_cast<std::size_t>(group_[n]) * M, offset(n).data(),
                               1.0 / length_, motion.data());
    for (std::size_t c = 0; c < dim; ++c) u[n * dim + c] = static_cast<float>(gain * motion[c]);
  }
  std::fill(u.begin() + static_cast<std::ptrdiff_t>(part_.owned_unknowns()), u.end(), 0.0F);
}

template class AggregateMotions<3>;
template class AggregateMotions<6>;

}  // namespace kacanov
