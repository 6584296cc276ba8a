// SPDX-License-Identifier: BSD-3-Clause
// Prescribed displacements on the mesh, by component and along directions.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <kacanov/error.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "problem/conditions.hpp"
#include "problem/integration.hpp"
#include "problem/load_curves.hpp"
#include "problem/model_checks.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

/// Facets whose normals differ by more are not flat; directions closer to an axis count as that axis.
constexpr double flat_to = 1e-6, axis_to = 1e-12;
/// A direction whose component orthogonal to the node's other directions is smaller depends on them.
constexpr double dependent = 1e-8;

/// Long double keeps the digits of small differences between nearly parallel directions.
using LongVector = std::array<long double, 3>;

long double long_dot(const LongVector& a, const LongVector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
void subtract_share(LongVector& from, long double share, const LongVector& v) {
  for (std::size_t c = 0; c < 3; ++c) from[c] -= share * v[c];
}
LongVector long_unit(const LongVector& v) {
  const long double length = std::sqrt(long_dot(v, v));
  return {v[0] / length, v[1] / length, v[2] / length};
}

/// A prescribed displacement along a unit vector.
struct Given {
  LongVector direction{};
  double value = 0.0;
};

/// A direction and value prescribed at a node; later orthogonalised against the node's other directions.
struct Slanting {
  std::int32_t node = 0, entry = 0;
  LongVector direction{};
  long double value = 0.0;
};

/// Returns the common outer normal of a flat group of facets.
LongVector normal_of(const Mesh& mesh, const std::vector<std::int32_t>& facets, const std::string& path) {
  LongVector sum{};
  std::vector<Vector3> normals;
  for (const std::int32_t f : facets) {
    const FacetWeights weights = lumped_weights(mesh, f);  // for quadratic facets, of the mid-side nodes
    for (std::size_t k = 0; k < mesh.facet(f).size(); ++k) {
      const double length = norm(weights.normal[k]);
      if (length == 0.0) continue;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += weights.normal[k][c];
      normals.push_back((1.0 / length) * weights.normal[k]);
    }
  }
  const bool none = long_dot(sum, sum) == 0;
  if (!none) sum = long_unit(sum);
  const Vector3 mean{static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])};
  for (const Vector3& n : normals)
    if (none || norm(n - mean) > flat_to)
      throw InputError(path +
                       ".normal: expected flat facets, whose outer normals are one; take an entry for each "
                       "plane");
  return sum;
}

std::vector<Given> given_by(const BoundaryEntry& entry, const Mesh& mesh, const Selection& selection,
                            const std::string& path) {
  const std::size_t dim = mesh.dim();
  std::vector<Given> given;
  if (entry.normal) {
    given.push_back({normal_of(mesh, selection.facets(entry.on, path), path), *entry.normal});
  } else {
    for (std::size_t c = 0; c < dim; ++c) {
      if (!(*entry.displacement)[c]) continue;
      LongVector axis{};
      axis[c] = 1.0;
      if (entry.frame) {
        const Vector3& given_axis = (*entry.frame)[c];
        axis = long_unit({given_axis[0], given_axis[1], given_axis[2]});
      }
      given.push_back({axis, *(*entry.displacement)[c]});
    }
  }
  return given;
}

/// Returns the axis that a direction is parallel to, of either sign; empty if it is oblique.
std::optional<std::size_t> axis_of(const LongVector& direction) {
  for (std::size_t c = 0; c < 3; ++c)
    if (std::abs(direction[c]) >= 1.0 - axis_to) return c;
  return std::nullopt;
}

class Holder {
 public:
  Holder(Problem& problem) : problem_(problem), dim_(problem.mesh.dim()), holder_(problem.held.size(), -1) {}

  void hold(std::size_t entry, std::int32_t node, std::size_t c, double value) {
    const std::size_t k = node * dim_ + c;
    if (problem_.held[k] != 0 && problem_.prescribed[k] != value) {
      PlainText text;
      text << "xyz"[c] << " = " << value << " here and " << problem_.prescribed[k] << " by ";
      refuse(entry, node, text.str() + at("boundary", static_cast<std::size_t>(holder_[k])));
    }
    if (problem_.held[k] != 0 && value != 0.0 && !problem_.steps.empty() &&
        !same_course(problem_.steps, entry, static_cast<std::size_t>(holder_[k])))
      refuse(entry, node,
             std::string(1, "xyz"[c]) + " here with other factors in steps than by " +
                 at("boundary", static_cast<std::size_t>(holder_[k])));
    problem_.held[k] = 1;
    problem_.prescribed[k] = value;
    holder_[k] = static_cast<std::int32_t>(entry);
    problem_.supports.push_back({node, static_cast<std::int32_t>(c), static_cast<std::int32_t>(entry)});
  }

  /// Constrains nodes on the axis of an axisymmetric body in radial direction.
  void hold_axis() {
    const Mesh& mesh = problem_.mesh;
    for (std::size_t node = 0; node < mesh.node_count(); ++node) {
      const std::size_t k = 2 * node;
      if (mesh.coordinates[k] != 0.0) continue;
      if (problem_.held[k] != 0 && problem_.prescribed[k] != 0.0)
        refuse(static_cast<std::size_t>(holder_[k]), static_cast<std::int32_t>(node),
               "a displacement away from the axis that it lies on");
      problem_.held[k] = 1;
    }
  }

  void take(std::size_t entry, std::int32_t node, const Given& given) {
    slanting_.push_back({node, static_cast<std::int32_t>(entry), given.direction, given.value});
  }

  /// Called after all components are set: restricts oblique directions to the free components (theory:
  /// held-directions).
  void finish() {
    std::stable_sort(slanting_.begin(), slanting_.end(),
                     [](const Slanting& a, const Slanting& b) { return a.node < b.node; });
    for (const Slanting& raw : slanting_) add(raw);
    if (!problem_.steps.empty()) problem_.holder = std::move(holder_);
  }

 private:
  void add(Slanting d) {
    if (!kept_.empty() && kept_.front().node != d.node) kept_.clear();
    const auto take_off = [&](long double share, long double value, std::int32_t by) {
      if (share * value != 0 && !problem_.steps.empty() &&
          !same_course(problem_.steps, static_cast<std::size_t>(d.entry), static_cast<std::size_t>(by)))
        refuse(static_cast<std::size_t>(d.entry), d.node,
               "along a direction with other factors in steps than by " +
                   at("boundary", static_cast<std::size_t>(by)));
      d.value -= share * value;
    };
    long double size = std::abs(d.value);
    for (std::size_t c = 0; c < dim_; ++c) {
      const std::size_t k = d.node * dim_ + c;
      if (problem_.held[k] == 0) continue;
      size += std::abs(d.direction[c] * problem_.prescribed[k]);
      take_off(d.direction[c], problem_.prescribed[k], holder_[k]);
      d.direction[c] = 0.0;
    }
    for (int pass = 0; pass < 2; ++pass)  // twice, for orthogonality to the last digit
      for (const Slanting& other : kept_) {
        const long double share = long_dot(d.direction, other.direction);
        size += std::abs(share * other.value);
        take_off(share, other.value, other.entry);
        subtract_share(d.direction, share, other.direction);
      }
    const long double rest = std::sqrt(long_dot(d.direction, d.direction));
    if (rest < dependent) {
      if (std::abs(d.value) > 1e-6 * size)
        refuse(static_cast<std::size_t>(d.entry), d.node,
               "a displacement that other entries do not let it have");
      return;
    }
    d.direction = long_unit(d.direction);
    d.value /= rest;
    kept_.push_back(d);
    const LongVector& b = d.direction;
    problem_.directions.push_back(
        {d.node,
         d.entry,
         {static_cast<double>(b[0]), static_cast<double>(b[1]), static_cast<double>(b[2])},
         static_cast<double>(d.value)});
  }

  [[noreturn]] void refuse(std::size_t entry, std::int32_t node, const std::string& what) const {
    const Mesh& mesh = problem_.mesh;
    throw InputError(at("boundary", entry) + ".displacement: node " + std::to_string(mesh.node_tag(node)) +
                     " at " + to_text(position(mesh, node), mesh.dim()) + " is given " + what);
  }

  Problem& problem_;
  std::size_t dim_;
  std::vector<std::int32_t> holder_;
  std::vector<Slanting> slanting_, kept_;  ///< all; those kept at the current node
};

}  // namespace

void hold_displacements(Problem& problem, const Model& model, const Selection& selection) {
  Holder holder(problem);
  for (std::size_t i = 0; i < model.boundary.size(); ++i) {
    const BoundaryEntry& entry = model.boundary[i];
    if (!entry.is_support()) continue;
    const std::string path = at("boundary", i);
    const std::vector<Given> all = given_by(entry, problem.mesh, selection, path);
    for (const std::int32_t node : selection.nodes(entry.on, path))
      for (const Given& given : all)
        if (const auto axis = axis_of(given.direction))
          holder.hold(i, node, *axis, given.direction[*axis] > 0.0 ? given.value : -given.value);
        else
          holder.take(i, node, given);
  }
  if (problem.mesh.plane == PlaneState::axisymmetric) holder.hold_axis();
  holder.finish();
}

}  // namespace kacanov
