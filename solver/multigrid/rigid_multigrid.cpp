// SPDX-License-Identifier: BSD-3-Clause
// Multigrid without a matrix on the fine level: Chebyshev on the operator, rigid motions of aggregates below.
#include "multigrid/rigid_multigrid.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "elements/dispatch.hpp"
#include "elements/point.hpp"
#include "error.hpp"
#include "float_operator.hpp"
#include "multigrid/aggregation.hpp"
#include "multigrid/chebyshev.hpp"
#include "multigrid/fine_level.hpp"
#include "multigrid/rigid_level.hpp"

namespace kacanov {

/// What the number of modes does not change.
struct RigidMultigrid::Hierarchy {
  virtual ~Hierarchy() = default;
  virtual void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) = 0;
  virtual void apply(std::span<const double> r, std::span<double> z) = 0;
  virtual void secant(std::span<double> g) const = 0;
};

namespace {

/// A sparse factor of the last level, the same on every rank.
template <int M>
class DirectSolve {
 public:
  explicit DirectSolve(const RigidLevel<M>& level) : level_(&level) {
    const auto size = static_cast<Eigen::Index>(level.total()) * M;
    std::vector<Eigen::Triplet<double>> triplets;
    std::vector<double> diagonal(static_cast<std::size_t>(size), 0.0);
    for (const auto& entry : level.gathered())
      for (int i = 0; i < M; ++i)
        for (int j = 0; j < M; ++j) {
          const auto row = static_cast<Eigen::Index>(entry.row) * M + i, column = static_cast<Eigen::Index>(entry.column) * M + j;
          const double v = entry.block[static_cast<std::size_t>(i * M + j)];
          triplets.emplace_back(row, column, v);
          if (row == column) diagonal[static_cast<std::size_t>(row)] += v;
        }
    // Modes that boundary conditions have emptied, and rounding: a shift far below anything that moves, unless penalties
    // so large that they swamp the body ask for more.
    const double largest = diagonal.empty() ? 1.0 : *std::max_element(diagonal.begin(), diagonal.end());
    Eigen::SparseMatrix<double> matrix(size, size), unit(size, size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    unit.setIdentity();
    for (double shift = 1e-10; shift < 1e-3; shift *= 100.0) {
      factor_.compute(matrix + (largest > 0.0 ? shift * largest : 1.0) * unit);
      if (factor_.info() == Eigen::Success) return;
    }
    throw InternalError("the coarsest matrix of the preconditioner is not definite");
  }
  /// x = A⁻¹ b on owned rows.
  void solve(std::span<const double> b, std::span<double> x) const {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(level_->total()) * M);
    const auto at = static_cast<Eigen::Index>(level_->first()) * M;
    const auto owned = static_cast<Eigen::Index>(level_->owned_size());
    for (Eigen::Index i = 0; i < owned; ++i) all[at + i] = b[static_cast<std::size_t>(i)];
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM, level_->comm());
    const Eigen::VectorXd y = factor_.solve(all);
    for (Eigen::Index i = 0; i < owned; ++i) x[static_cast<std::size_t>(i)] = y[at + i];
  }

 private:
  const RigidLevel<M>* level_;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_;
};

/// A coarse level with its smoother, its vectors and the way down.
template <int M>
struct Stage {
  RigidLevel<M> level;
  std::vector<std::int32_t> group;  ///< of each owned row in the next level; empty on the last
  std::vector<Vector3> offset;      ///< of each owned row from the centre of its group
  Chebyshev smoother;
  Vector b, x, step, image;

  explicit Stage(RigidLevel<M> l) : level(std::move(l)) {
    for (auto* v : {&b, &x, &step, &image}) v->resize(level.size());
  }
};

constexpr std::int64_t direct_rows = 400;

template <int M>
class ModesHierarchy final : public RigidMultigrid::Hierarchy {
 public:
  ModesHierarchy(const Part& part, const MultigridOptions& options) : part_(part), options_(options), fine_(part, options) {}

  void build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) override {
    stages_.clear();
    direct_.reset();
    fine_.build(g, blocks, space);
    if (group_.empty()) group_nodes(g);
    stages_.emplace_back(first_level(g, blocks, space));
    while (stages_.back().level.total() > direct_rows) {
      auto& stage = stages_.back();
      const std::int64_t before = stage.level.total();
      stage.group = aggregate(stage.level.couplings(), options_.coarse_size);
      RigidLevel<M> next = stage.level.coarsened(stage.group, length_);
      if (next.total() > before / 2) {
        stage.group.clear();
        break;
      }
      const auto centres = stage.level.centres();
      for (std::size_t i = 0; i < stage.group.size(); ++i) {
        const auto& c = next.centres()[static_cast<std::size_t>(stage.group[i])];
        stage.offset.push_back({centres[i][0] - c[0], centres[i][1] - c[1], centres[i][2] - c[2]});
      }
      stages_.emplace_back(std::move(next));
    }
    direct_.emplace(stages_.back().level);
    for (auto& stage : stages_) {
      const double largest = stage.level.largest_eigenvalue();
      stage.smoother = {options_.coarse_degree, largest / options_.coarse_range, largest};
    }
    fine_.choose_smoother(options_.fine_degree, options_.fine_range);
    for (auto* v : {&b_, &x_, &step_, &image_}) v->resize(part_.unknowns());
  }

  void secant(std::span<double> g) const override { fine_.secant(g); }

  void apply(std::span<const double> r, std::span<double> z) override {
    for (std::size_t i = 0; i < r.size(); ++i) b_[i] = static_cast<float>(r[i]);
    fine_.hold(b_);
    const auto multiply = [this](std::span<const float> x, std::span<float> y) { fine_.multiply(x, y); };
    const auto scale = [this](std::span<const float> x, std::span<float> y) { fine_.scale(x, y); };
    fine_.smoother().template smooth<float>(true, b_, x_, step_, image_, multiply, scale);
    fine_.multiply(x_, image_);
    for (std::size_t i = 0; i < b_.size(); ++i) image_[i] = b_[i] - image_[i];
    fine_.project(image_);
    restrict_to_first();
    cycle(0);
    prolong_from_first();
    fine_.smoother().template smooth<float>(false, b_, x_, step_, image_, multiply, scale);
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = static_cast<double>(x_[i]);
  }

 private:
  /// stages_[k].x = a cycle from zero on stages_[k].b.
  void cycle(std::size_t k) {
    Stage<M>& stage = stages_[k];
    const std::size_t owned = stage.level.owned_size();
    const auto first = [owned](Vector& v) { return std::span(v).first(owned); };
    if (k + 1 == stages_.size()) {
      direct_->solve(first(stage.b), first(stage.x));
      return;
    }
    const auto multiply = [&](std::span<const double>, std::span<double> y) { stage.level.multiply(stage.x, y); };
    const auto scale = [&](std::span<const double> x, std::span<double> y) { stage.level.scale(x, y); };
    const auto smooth = [&](bool from_zero) {
      stage.smoother.template smooth<double>(from_zero, first(stage.b), first(stage.x), first(stage.step), first(stage.image), multiply, scale);
    };
    smooth(true);
    Stage<M>& next = stages_[k + 1];
    for (int c = 0; c < options_.cycles; ++c) {
      if (c > 0 && k + 2 == stages_.size()) break;  // the last level is solved exactly
      stage.level.multiply(stage.x, stage.image);
      std::fill(next.b.begin(), next.b.end(), 0.0);
      for (std::size_t i = 0; i < stage.group.size(); ++i) {
        std::array<double, M> force{};
        for (std::size_t m = 0; m < M; ++m) force[m] = stage.b[i * M + m] - stage.image[i * M + m];
        double* to = next.b.data() + static_cast<std::size_t>(stage.group[i]) * M;
        RigidMotion<M>::add_from_part(force.data(), stage.offset[i].data(), 1.0 / length_, to);
      }
      cycle(k + 1);
      for (std::size_t i = 0; i < stage.group.size(); ++i) {
        const double* from = next.x.data() + static_cast<std::size_t>(stage.group[i]) * M;
        double* to = stage.x.data() + i * M;
        std::array<double, M> scaled{};
        for (std::size_t m = 0; m < M; ++m) scaled[m] = options_.coarse_gain * from[m];
        RigidMotion<M>::add_to_part(scaled.data(), stage.offset[i].data(), 1.0 / length_, to);
      }
    }
    smooth(false);
  }

  void restrict_to_first() {
    constexpr auto dim = static_cast<std::size_t>(RigidMotion<M>::dim);
    auto& b = stages_.front().b;
    std::fill(b.begin(), b.end(), 0.0);
    for (std::size_t n = 0; n < group_.size(); ++n) {
      const auto a = static_cast<std::size_t>(group_[n]);
      const Vector3 d = offset_of(n, centre_[a]);
      std::array<double, dim> force{};
      for (std::size_t c = 0; c < dim; ++c) force[c] = static_cast<double>(image_[n * dim + c]);
      RigidMotion<M>::add_force(force.data(), d.data(), 1.0 / length_, b.data() + a * M);
    }
  }
  void prolong_from_first() {
    constexpr auto dim = static_cast<std::size_t>(RigidMotion<M>::dim);
    const auto& x = stages_.front().x;
    std::fill(image_.begin(), image_.end(), 0.0F);
    for (std::size_t n = 0; n < group_.size(); ++n) {
      const auto a = static_cast<std::size_t>(group_[n]);
      const Vector3 d = offset_of(n, centre_[a]);
      std::array<double, dim> u{};
      RigidMotion<M>::add_motion(x.data() + a * M, d.data(), 1.0 / length_, u.data());
      for (std::size_t c = 0; c < dim; ++c) image_[n * dim + c] = static_cast<float>(options_.fine_gain * u[c]);
    }
    part_.halo.copy_from_owner(std::span<float>(image_), part_.dim());
    fine_.project(image_);
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += image_[i];
  }

  Vector3 offset_of(std::size_t node, const Vector3& centre) const {
    constexpr auto dim = static_cast<std::size_t>(RigidMotion<M>::dim);
    Vector3 d{};
    for (std::size_t c = 0; c < dim; ++c) d[c] = part_.coordinates[node * dim + c] - centre[c];
    return d;
  }

  /// Aggregates of the owned nodes, their centres, and a length that makes rotations comparable to translations.
  void group_nodes(std::span<const double> g) {
    constexpr auto dim = static_cast<std::size_t>(RigidMotion<M>::dim);
    group_ = aggregate_nodes(part_.body(), g, part_.owned_nodes, options_.fine_size);
    const std::int32_t groups = group_.empty() ? 0 : 1 + *std::max_element(group_.begin(), group_.end());
    centre_.assign(static_cast<std::size_t>(groups), Vector3{});
    std::vector<double> members(centre_.size(), 0.0);
    for (std::size_t n = 0; n < group_.size(); ++n) {
      const auto a = static_cast<std::size_t>(group_[n]);
      members[a] += 1.0;
      for (std::size_t c = 0; c < dim; ++c) centre_[a][c] += part_.coordinates[n * dim + c];
    }
    for (std::size_t a = 0; a < centre_.size(); ++a)
      for (double& c : centre_[a]) c /= members[a];
    double spread = 0.0;
    for (std::size_t n = 0; n < group_.size(); ++n) {
      const Vector3 d = offset_of(n, centre_[static_cast<std::size_t>(group_[n])]);
      spread += d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    }
    length_ = std::sqrt(part_.halo.sum_all(spread) / static_cast<double>(part_.total_nodes));
    if (!(length_ > 0.0)) length_ = 1.0;
  }

  RigidLevel<M> first_level(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) const;

  const Part& part_;
  MultigridOptions options_;
  FineLevel fine_;
  std::vector<std::int32_t> group_;
  std::vector<Vector3> centre_;
  double length_ = 1.0;
  std::vector<Stage<M>> stages_;
  std::optional<DirectSolve<M>> direct_;
  std::vector<float> b_, x_, step_, image_;
};

/// The Galerkin matrix over the aggregates, summed element by element: with S_a the strains of aggregate a's motions in the
/// element, block (a, b) is volume · S_aᵀ D S_b. Elements within one aggregate strain nothing.
template <int M>
RigidLevel<M> ModesHierarchy<M>::first_level(std::span<const double> g, std::span<const NodeBlock> blocks,
                                             const Space& space) const {
  constexpr auto dim = static_cast<std::size_t>(RigidMotion<M>::dim);
  const Body body = part_.body();
  std::int64_t first = 0;
  const auto mine = static_cast<std::int64_t>(centre_.size());
  MPI_Exscan(&mine, &first, 1, MPI_INT64_T, MPI_SUM, part_.halo.comm);
  if (part_.halo.rank == 0) first = 0;

  // Aggregate and centre of every local node, ghosts from their owners.
  const std::size_t owned = group_.size();
  std::vector<Vector3> ghost_centre(part_.nodes() - owned);
  Vector number(part_.nodes());
  for (std::size_t c = 0; c <= dim; ++c) {  // the aggregate last: its vector stays
    for (std::size_t n = 0; n < owned; ++n) {
      const auto a = static_cast<std::size_t>(group_[n]);
      number[n] = c < dim ? centre_[a][c] : static_cast<double>(first + group_[n]);
    }
    part_.halo.copy_from_owner(std::span<double>(number), 1);
    for (std::size_t n = owned; n < number.size() && c < dim; ++n) ghost_centre[n - owned][c] = number[n];
  }
  const auto aggregate_of = [&](std::int32_t n) { return static_cast<std::int64_t>(number[static_cast<std::size_t>(n)]); };

  std::unordered_map<std::int32_t, Eigen::Matrix<double, 3, 3>> projector;
  for (const auto& entry : space.held_directions()) {
    Eigen::Matrix3d p = Eigen::Matrix3d::Identity();
    for (int k = 0; k < entry.count; ++k) {
      const Eigen::Map<const Eigen::Vector3d> b(entry.basis[static_cast<std::size_t>(k)].data());
      p -= b * b.transpose();
    }
    projector.emplace(entry.node, p);
  }
  std::vector<std::uint8_t> bound(part_.nodes(), 0);
  for (std::size_t i = 0; i < part_.held.size(); ++i) bound[i / dim] |= part_.held[i];
  for (const auto& [node, p] : projector) bound[static_cast<std::size_t>(node)] = 2;

  using Rows = std::array<std::array<double, M>, dim>;  // displacement of a node for each motion
  const auto motions = [&](std::int32_t node) {
    const auto n = static_cast<std::size_t>(node);
    const Vector3 d = offset_of(n, n < owned ? centre_[static_cast<std::size_t>(group_[n])] : ghost_centre[n - owned]);
    Rows z{};
    for (std::size_t m = 0; m < M; ++m) {
      std::array<double, M> q{};
      q[m] = 1.0;
      std::array<double, dim> u{};
      RigidMotion<M>::add_motion(q.data(), d.data(), 1.0 / length_, u.data());
      for (std::size_t c = 0; c < dim; ++c) z[c][m] = u[c];
    }
    if (bound[n] == 0) return z;
    for (std::size_t c = 0; c < dim; ++c)
      if (part_.held[n * dim + c]) z[c].fill(0.0);
    if (const auto at = projector.find(node); at != projector.end()) {
      const Rows free = z;
      for (std::size_t c = 0; c < dim; ++c)
        for (std::size_t m = 0; m < M; ++m) {
          z[c][m] = 0.0;
          for (std::size_t k = 0; k < dim; ++k)
            z[c][m] += at->second(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)) * free[k][m];
        }
    }
    return z;
  };

  BlockSums<M> sums;
  elements::dispatch(body.mesh.type, [&]<class E>(E) {
    if constexpr (static_cast<std::size_t>(E::dim) == dim) {
      constexpr auto npe = static_cast<std::size_t>(E::nodes);
      // Strain as xx, yy, zz, √2 xy, √2 yz, √2 zx, so that the product of two is that of the tensors; zz is zero in 2D.
      using Strain = std::array<std::array<double, M>, 6>;
      const double root = std::sqrt(2.0);
      std::array<std::int64_t, npe> which{};
      std::array<std::size_t, npe> local{};
      std::array<Rows, npe> z;
      elements::Nodal<E> x;
      for (std::size_t e = 0; e < body.mesh.element_count(); ++e) {
        const std::int32_t* node = body.mesh.connectivity.data() + e * npe;
        std::size_t count = 0;
        bool rigid = true;
        for (std::size_t a = 0; a < npe; ++a) {
          const std::int64_t id = aggregate_of(node[a]);
          std::size_t k = 0;
          while (k < count && which[k] != id) ++k;
          if (k == count) which[count++] = id;
          local[a] = k;
          rigid = rigid && bound[static_cast<std::size_t>(node[a])] == 0;
        }
        if (rigid && count == 1) continue;
        for (std::size_t a = 0; a < npe; ++a) {
          z[a] = motions(node[a]);
          for (std::size_t c = 0; c < dim; ++c) x[a * dim + c] = body.mesh.coordinates[static_cast<std::size_t>(node[a]) * dim + c];
        }
        const Law& law = body.laws[body.law_of_element[e]];
        const auto points = elements::points_of<E>(x, law.mean_dilatation);
        for (std::size_t q = 0; q < E::points; ++q) {
          const auto& point = points[q];
          std::array<Strain, npe> strain{};
          std::array<std::array<double, M>, npe> dilatation{};
          for (std::size_t a = 0; a < npe; ++a) {
            Strain& s = strain[local[a]];
            const double* d = point.gradient[a];
            for (std::size_t m = 0; m < M; ++m) {
              for (std::size_t c = 0; c < dim; ++c) {
                s[c][m] += d[c] * z[a][c][m];
                dilatation[local[a]][m] += point.dilatation[a][c] * z[a][c][m];
              }
              s[3][m] += (d[0] * z[a][1][m] + d[1] * z[a][0][m]) / root;
              if constexpr (dim == 3) {
                s[4][m] += (d[1] * z[a][2][m] + d[2] * z[a][1][m]) / root;
                s[5][m] += (d[2] * z[a][0][m] + d[0] * z[a][2][m]) / root;
              }
            }
          }
          const double shear = 2.0 * g[e * static_cast<std::size_t>(E::points) + q] * point.volume;
          const double bulk = law.bulk * point.volume;
          for (std::size_t a = 0; a < count; ++a) {
            for (std::size_t b = 0; b < count; ++b) {
              if (which[a] > which[b]) continue;
              auto& sum = sums.at(which[a], which[b]);
              for (std::size_t i = 0; i < M; ++i)
                for (std::size_t j = 0; j < M; ++j) {
                  const auto& r = strain[a];
                  const auto& c = strain[b];
                  double v = (r[0][i] + r[1][i] + r[2][i]) * (c[0][j] + c[1][j] + c[2][j]) / -3.0;
                  for (std::size_t k = 0; k < 6; ++k) v += r[k][i] * c[k][j];
                  v = shear * v + bulk * dilatation[a][i] * dilatation[b][j];
                  sum[i * M + j] += v;
                }
            }
          }
        }
      }
    }
  });
  for (const auto& block : blocks) {
    const Rows z = motions(block.node);
    auto& sum = sums.at(aggregate_of(block.node), aggregate_of(block.node));
    for (std::size_t i = 0; i < M; ++i)
      for (std::size_t j = 0; j < M; ++j) {
        double v = 0.0;
        for (std::size_t c = 0; c < dim; ++c)
          for (std::size_t d = 0; d < dim; ++d) v += z[c][i] * block.value[c * dim + d] * z[d][j];
        sum[i * M + j] += v;
      }
  }
  return RigidLevel<M>(centre_, std::move(sums), part_.halo.comm);
}

}  // namespace

RigidMultigrid::RigidMultigrid(const Part& part, const MultigridOptions& options) {
  if (part.dim() == 3)
    hierarchy_ = std::make_unique<ModesHierarchy<6>>(part, options);
  else
    hierarchy_ = std::make_unique<ModesHierarchy<3>>(part, options);
}

RigidMultigrid::~RigidMultigrid() = default;

void RigidMultigrid::build(std::span<const double> g, std::span<const NodeBlock> blocks, const Space& space) {
  hierarchy_->build(g, blocks, space);
}

void RigidMultigrid::secant(std::span<double> g) const { hierarchy_->secant(g); }

void RigidMultigrid::apply(std::span<const double> r, std::span<double> z) { hierarchy_->apply(r, z); }

}  // namespace kacanov
