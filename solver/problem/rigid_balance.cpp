// SPDX-License-Identifier: BSD-3-Clause
// Bodies that contact alone holds, as rigid ones: whether their loads can be in balance, and where they come
// to rest.
#include "problem/rigid_balance.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace kacanov {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Share of the load that a balance may miss. Well below what a friction coefficient wrong by 1e-6 leaves.
constexpr double balanced = 1e-10;
/// Reactions that are tried; each lessens what is out of balance.
constexpr int most_reactions = 2000;

/// Reactions that have been found so far, a column each, and how much of each there is. Those of Tresca's
/// friction have a last entry: their shares may add up to one and no more.
struct Reactions {
  MatrixXd column;
  VectorXd share;
  std::vector<std::ptrdiff_t> point;  ///< −1: Tresca's friction of all points

  void add(const VectorXd& next, std::ptrdiff_t of) {
    column.conservativeResize(next.size(), column.cols() + 1);
    column.rightCols<1>() = next;
    share.conservativeResize(share.size() + 1);
    share(share.size() - 1) = 0.0;
    point.push_back(of);
  }
  void drop_unused() {
    Index kept = 0;
    for (Index k = 0; k < share.size(); ++k) {
      if (!(share(k) > 0.0)) continue;
      column.col(kept) = column.col(k).eval();
      share(kept) = share(k);
      point[kept++] = point[k];
    }
    column.conservativeResize(Eigen::NoChange, kept);
    share.conservativeResize(kept);
    point.resize(kept);
  }
  /// Least squares with shares ≥ 0, from those there are (Lawson and Hanson's inner loop).
  void fit(const VectorXd& load) {
    while (share.size() > 0) {
      const VectorXd best = column.colPivHouseholderQr().solve(load);
      double step = 1.0;
      for (Index k = 0; k < share.size(); ++k)
        if (best(k) <= 0.0) step = std::min(step, share(k) / (share(k) - best(k) + 1e-300));
      share += step * (best - share);
      if (step == 1.0) return;
      // Those that have run out go; the first of them does in any case.
      const double least = share.minCoeff();
      for (double& value : share)
        if (value <= std::max(least, 1e-14 * share.maxCoeff())) value = 0.0;
      drop_unused();
    }
  }
};

/// The reaction of all points that works most against `motion`, of Coulomb's friction along its cone.
VectorXd strongest(const RigidContact& point, const VectorXd& motion, double friction, double& work) {
  VectorXd reaction = point.normal;
  if (point.coulomb > 0.0) {
    VectorXd along = VectorXd::Zero(motion.size());
    double length = 0.0;
    for (const VectorXd& t : point.tangent) {
      along += t.dot(motion) * t;
      length += t.dot(motion) * t.dot(motion);
    }
    if (length > 0.0) reaction += friction * point.coulomb / std::sqrt(length) * along;
  }
  work = reaction.dot(motion);
  return reaction;
}

VectorXd tresca_friction(const std::vector<RigidContact>& points, const VectorXd& motion, double friction) {
  VectorXd sum = VectorXd::Zero(motion.size());
  for (const RigidContact& point : points) {
    if (point.tresca == 0.0) continue;
    VectorXd along = VectorXd::Zero(motion.size());
    double length = 0.0;
    for (const VectorXd& t : point.tangent) {
      along += t.dot(motion) * t;
      length += t.dot(motion) * t.dot(motion);
    }
    if (length > 0.0) sum += friction * point.mass * point.tresca / std::sqrt(length) * along;
  }
  return sum;
}

}  // namespace

RigidBalance balance(const std::vector<RigidContact>& points, const VectorXd& load, double friction) {
  RigidBalance result;
  const Index motions = load.size();
  const double size = load.norm();
  result.motion = VectorXd::Zero(motions);
  if (!(size > 0.0)) return result;
  const bool tresca =
      std::any_of(points.begin(), points.end(), [](const RigidContact& p) { return p.tresca > 0.0; });
  VectorXd target = VectorXd::Zero(motions + 1);
  target.head(motions) = load / size;
  target(motions) = tresca ? 1.0 : 0.0;
  Reactions reactions{MatrixXd(motions + 1, 0), VectorXd(0), {}};
  VectorXd rest = target;
  for (int k = 0; k < most_reactions && rest.norm() > balanced; ++k) {
    const VectorXd motion = rest.head(motions);
    VectorXd next = VectorXd::Zero(motions + 1);
    double most = balanced * rest.norm();
    std::ptrdiff_t of = -2;
    for (std::size_t i = 0; i < points.size(); ++i) {
      double work = 0.0;
      const VectorXd reaction = strongest(points[i], motion, friction, work);
      const double length = reaction.norm();
      if (!(length > 0.0) || work / length <= most) continue;
      most = work / length;
      next.head(motions) = reaction / length;
      of = static_cast<std::ptrdiff_t>(i);
    }
    if (tresca) {
      VectorXd sum(motions + 1);
      sum << tresca_friction(points, motion, friction) / size, 1.0;
      if (sum.dot(rest) / sum.norm() > most) {
        next = sum;
        next(motions) = 1.0;
        of = -1;
      }
    }
    if (of == -2) break;
    const double before = rest.norm();
    reactions.add(next, of);
    reactions.fit(target);
    rest = target - reactions.column * reactions.share;
    if (!(rest.norm() < before * (1.0 - 1e-14))) break;
  }
  for (const std::ptrdiff_t of : reactions.point)
    if (of >= 0) result.supports.push_back(of);
  result.exists = rest.norm() <= 10.0 * balanced;
  if (!result.exists) result.motion = rest.head(motions);
  return result;
}

double friction_needed(const std::vector<RigidContact>& points, const VectorXd& load) {
  double low = 0.0, high = 1.0;
  while (!balance(points, load, high).exists) {
    low = high;
    high *= 4.0;
    if (high > 1e5) return HUGE_VAL;
  }
  while (high - low > 1e-7 * high) {
    const double middle = 0.5 * (low + high);
    (balance(points, load, middle).exists ? high : low) = middle;
  }
  return high;
}

VectorXd rest_on_springs(const std::vector<RigidContact>& points, const VectorXd& load, double stiffness) {
  const Index motions = load.size();
  // Springs that hold what no contact does yet, too soft to matter beside those of the contact.
  constexpr double soft = 1e-9;
  constexpr int most_passes = 8, most_steps = 200;
  MatrixXd weak = MatrixXd::Zero(motions, motions);
  for (const RigidContact& point : points) {
    weak += point.mass * point.normal * point.normal.transpose();
    for (const VectorXd& t : point.tangent) weak += point.mass * t * t.transpose();
  }
  weak = soft * stiffness *
         (weak + weak.trace() / static_cast<double>(motions) * MatrixXd::Identity(motions, motions));
  VectorXd at = VectorXd::Zero(motions);
  std::vector<bool> sticks(points.size(), false);
  const auto energy = [&](const VectorXd& y) {
    double sum = 0.5 * y.dot(weak * y) - load.dot(y);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double in = std::max(points[i].normal.dot(y) - points[i].gap, 0.0);
      sum += 0.5 * stiffness * points[i].mass * in * in;
      if (!sticks[i]) continue;
      for (const VectorXd& t : points[i].tangent)
        sum += 0.5 * stiffness * points[i].mass * t.dot(y) * t.dot(y);
    }
    return sum;
  };
  for (int pass = 0; pass < most_passes; ++pass) {
    // Newton's method on a convex, piecewise quadratic energy.
    for (int step = 0; step < most_steps; ++step) {
      MatrixXd matrix = weak;
      VectorXd force = load - weak * at;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const RigidContact& p = points[i];
        const double in = p.normal.dot(at) - p.gap, k = stiffness * p.mass;
        if (in > 0.0) {
          matrix += k * p.normal * p.normal.transpose();
          force -= k * in * p.normal;
        }
        if (!sticks[i]) continue;
        for (const VectorXd& t : p.tangent) {
          matrix += k * t * t.transpose();
          force -= k * t.dot(at) * t;
        }
      }
      const VectorXd move = matrix.ldlt().solve(force);
      const double before = energy(at), slope = force.dot(move);
      double share = 1.0;
      while (share > 1e-12 && !(energy(at + share * move) <= before - 1e-4 * share * slope)) share *= 0.5;
      at += share * move;
      if (share * move.norm() <= 1e-12 * at.norm()) break;
    }
    bool changed = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool now = points[i].normal.dot(at) > points[i].gap && !points[i].tangent.empty();
      changed = changed || now != sticks[i];
      sticks[i] = now;
    }
    if (!changed) break;
  }
  return at;
}

}  // namespace kacanov
