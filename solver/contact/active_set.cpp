// SPDX-License-Identifier: BSD-3-Clause
// Decision of the active set of a primal–dual active set (semismooth Newton) step.
#include "contact/active_set.hpp"

#include <array>
#include <cmath>

#include "problem/dense.hpp"

namespace kacanov {
namespace {

/// Upper limit of k, in units of c, because k is unbounded at the friction bound (1e8 takes as many steps,
/// with more CG iterations per step).
constexpr double stiffest = 1e3;
/// Relative size below which the component of a vector that held normals leave free counts as zero.
constexpr double free_direction = 1e-8;
/// Imposed motion along an obstacle, relative to the local displacement scale, that exceeds rounding.
constexpr double imposed_slip = 1e-10;

/// Constraint of a tangential motion by several held normals of the node.
struct Edge {
  bool any = false;                                    ///< several normals are held
  Eigen::Matrix3d free = Eigen::Matrix3d::Identity();  ///< projector onto the directions left free
  Eigen::Vector3d imposed = Eigen::Vector3d::Zero();   ///< displacement imposed by the normals
  double scale = 0.0;                                  ///< largest displacement or gap at the node
};

Edge find_edge(const Traces& traces, const ContactState& state, const ActiveSet& set, std::size_t i) {
  const auto points = traces.points();
  std::size_t first = i;
  while (first > 0 && points[first - 1].node == points[i].node) --first;
  Eigen::Matrix<double, Eigen::Dynamic, 3> normals(0, 3);
  Eigen::VectorXd open(0);
  Edge edge;
  for (std::size_t j = first; j < points.size() && points[j].node == points[i].node; ++j) {
    if (!set.held[j].normal) continue;
    normals.conservativeResize(normals.rows() + 1, 3);
    normals.bottomRows<1>() = Eigen::Map<const Eigen::RowVector3d>(traces.entries(j)[0].trace.data());
    open.conservativeResize(open.size() + 1);
    open(open.size() - 1) = state.gap[j] - state.trace.normal[j];
    edge.scale = std::max(edge.scale, std::abs(state.gap[j]));
  }
  edge.any = normals.rows() > 1;
  if (!edge.any) return edge;
  const Eigen::MatrixXd back = pseudo_inverse(normals, free_direction);
  edge.free -= back * normals;
  Eigen::Vector3d u = Eigen::Vector3d::Zero();
  const std::size_t dim = traces.part().dim();
  for (std::size_t c = 0; c < dim; ++c)
    u(static_cast<Eigen::Index>(c)) = state.u[static_cast<std::size_t>(points[i].node) * dim + c];
  edge.scale = std::max(edge.scale, u.cwiseAbs().maxCoeff());
  edge.imposed = back * (normals * u + open);
  return edge;
}

/// Trial traction of friction at a point: λ_t + c Tu, restricted to the directions that held normals leave
/// free.
struct Pull {
  std::array<double, 2> s{};
  double bound = 0.0;   ///< bound for the predicted pressure
  bool driven = false;  ///< whether other normals of its node force it to slip
  bool edge = false;    ///< whether several normals of its node are held
};

/// `pushed`: λ_n + c(Nu − ρ).
Pull pull_of(const Traces& traces, const ContactState& state, double c, double pushed, std::size_t i,
             const ActiveSet& set) {
  const ContactPoint& point = traces.points()[i];
  const double* lambda = &state.lambda.tangential[2 * i];
  const double* w = &state.trace.tangential[2 * i];
  Pull pull;
  pull.s = {lambda[0] + c * w[0], lambda[1] + c * w[1]};
  pull.bound = point.coulomb > 0.0 ? point.friction_bound(std::max(pushed, 0.0)) : state.bound[i];
  if (traces.entries(i).size() > 1) return pull;
  const Edge edge = find_edge(traces, state, set, i);
  pull.edge = edge.any;
  if (!edge.any) return pull;
  const auto& tangent = traces.entries(i)[0].tangent;
  const Eigen::Map<const Eigen::Vector3d> along(tangent[0].data()), across(tangent[1].data());
  Eigen::Vector2d moved(along.dot(edge.imposed), across.dot(edge.imposed));
  if (!state.origin.empty()) {  // slip is measured from this origin
    const Eigen::Vector3d from = state.origin[2 * i] * along + state.origin[2 * i + 1] * across;
    const Eigen::Vector3d dictated = from - edge.free * from;
    moved -= Eigen::Vector2d(along.dot(dictated), across.dot(dictated));
  }
  pull.driven = moved.norm() > imposed_slip * edge.scale;
  // Otherwise the normals already constrain these directions, where no friction acts in addition.
  const Eigen::Vector3d left =
      edge.free * (pull.driven ? w[0] * along + w[1] * across : pull.s[0] * along + pull.s[1] * across);
  pull.s = {along.dot(left), across.dot(left)};
  if (pull.driven) pull.s = {pull.s[0] + moved(0), pull.s[1] + moved(1)};
  return pull;
}

/// Points of one node that stick or slip together: in the direction left free by their normals they share one
/// force, however it is distributed.
struct SharedPull {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), friction = Eigen::Vector3d::Zero();
  double bound = 0.0, mass = 0.0;

  void add(const Traces& traces, const ContactState& state, std::size_t i, const Pull& pull) {
    const auto& tangent = traces.entries(i)[0].tangent;
    const double m = traces.points()[i].mass;
    for (std::size_t k = 0; k < 2; ++k) {
      const Eigen::Map<const Eigen::Vector3d> t(tangent[k].data());
      force += m * pull.s[k] * t;
      friction += m * state.lambda.tangential[2 * i + k] * t;
    }
    bound += m * pull.bound;
    mass += m;
  }
};

/// Decides stick or slip for the points first to last, which are all points of one node. `pushed`: one value
/// per point.
void decide_friction(const Traces& traces, const ContactState& state, double c, const Vector& pushed,
                     std::size_t first, std::size_t last, ActiveSet& set) {
  const auto points = traces.points();
  std::vector<Pull> pulls(last - first);
  SharedPull shared;
  const auto shares = [&](std::size_t i) {
    return pulls[i - first].edge && !pulls[i - first].driven && set.held[i].normal;
  };
  for (std::size_t i = first; i < last; ++i) {
    if (points[i].tangents == 0) continue;
    pulls[i - first] = pull_of(traces, state, c, pushed[i], i, set);
    if (shares(i)) shared.add(traces, state, i, pulls[i - first]);
  }
  for (std::size_t i = first; i < last; ++i) {
    const ContactPoint& point = points[i];
    if (point.tangents == 0) continue;
    const auto& [s, bound, driven, edge] = pulls[i - first];
    const double* lambda = &state.lambda.tangential[2 * i];
    const bool together = shares(i) && shared.mass > 0.0;
    const double own = std::hypot(s[0], s[1]);
    const double length = together ? shared.force.norm() / shared.mass : own;
    const double most = together ? shared.bound / shared.mass : bound;
    // A point pushed back by its own friction sticks before it may slip the other way; otherwise friction
    // beyond what a yielding body carries would make it oscillate.
    const bool turned =
        (together ? shared.force.dot(shared.friction) : lambda[0] * s[0] + lambda[1] * s[1]) < 0.0;
    set.held[i].tangential = most > 0.0 && !driven && (length <= most || turned);
    if (set.held[i].tangential || length == 0.0) continue;
    std::array<double, 2> direction{};
    for (std::size_t k = 0; k < 2; ++k)
      direction[k] =
          together
              ? shared.force.dot(Eigen::Map<const Eigen::Vector3d>(traces.entries(i)[0].tangent[k].data())) /
                    shared.force.norm()
              : s[k] / length;
    const bool follows = point.coulomb > 0.0;
    if (follows && set.held[i].normal) set.coulomb[i] = point.coulomb;
    for (std::size_t k = 0; k < 2; ++k) {
      set.slip_direction[2 * i + k] = direction[k];
      set.slip_force[2 * i + k] = (follows ? point.tresca : bound) * direction[k];
    }
    if (point.tangents == 2)
      set.slip_stiffness[i] = std::min(driven ? bound / length : c * bound / (length - most), stiffest * c);
  }
}

}  // namespace

ActiveSet decide(const Traces& traces, const ContactState& state, double c) {
  const auto points = traces.points();
  ActiveSet set(points.size());
  Vector pushed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    pushed[i] = state.lambda.normal[i] + c * (state.trace.normal[i] - state.gap[i]);
    set.held[i].normal = pushed[i] > 0.0;
  }
  for (std::size_t first = 0, last; first < points.size(); first = last) {
    last = first + 1;
    while (last < points.size() && points[last].node == points[first].node) ++last;
    decide_friction(traces, state, c, pushed, first, last, set);
  }
  return set;
}

}  // namespace kacanov
