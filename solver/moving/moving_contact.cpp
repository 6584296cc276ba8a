// SPDX-License-Identifier: BSD-3-Clause
// The contact rows of a part whose obstacles move.
#include "moving/moving_contact.hpp"

#include <algorithm>

#include <kacanov/error.hpp>
#include "partition/body_extent.hpp"
#include "problem/contact_points.hpp"

namespace kacanov {

/// What double precision leaves of a sum of lengths.
constexpr double some_roundings = 1e-15;

/// How a node faces an obstacle that has moved.
struct MovingContact::View {
  Vector3 normal{};
  double gap = 0.0;
  Vector3 carried{}, step{};  ///< how far the touched point of the obstacle has come: in all, in this step
  double unknown = 0.0;       ///< of the gap
  double kind = 0.0;          ///< 0 faced, 1 out of its way, 2 undecided
  static constexpr int numbers = 12;
};

MovingContact::MovingContact(Part& part, const Model& model)
    : part_(part),
      model_(model),
      there_(part.contact),
      far_(10.0 * body_extent(part)),
      travel_(model.contact.size()),
      faced_at_(model.contact.size()),
      gap_(part.contact.size()),
      origin_(part.contact.size()) {}

Vector3 MovingContact::direction(const ContactEntry& entry) {
  const Vector3& d = entry.force_controlled->direction;
  return (1.0 / norm(d)) * d;
}

MovingContact::View MovingContact::view(const ContactEntry& entry, const SurfacePoint& at, const Vector3& u,
                                        const std::array<double, 2>& times, double travel) const {
  const Vector3& x = at.x;
  RigidPose start, now;
  if (entry.motion) {
    start = RigidPose::at(*entry.motion, times[0]);
    now = RigidPose::at(*entry.motion, times[1]);
  } else if (entry.force_controlled) {
    start.shift = now.shift = travel * direction(entry);
  }
  // Faced anew, the node is where the step before has left it, and the obstacle where it is now; otherwise
  // both are where the case has them, and the obstacle carries what the node has found there along.
  const Vector3 seen = entry.relinearise ? now.back(x + u) : x;
  const Vector3 outer = entry.relinearise ? now.turned(at.outer, -1.0) : at.outer;
  const Facing facing = std::visit(
      [&](const auto& kind) {
        return kind.project({seen, outer});
      },
      entry.obstacle);
  if (facing.kind == Facing::Kind::missed) return {{}, far_, {}, {}, 0.0, 1.0};
  if (facing.kind == Facing::Kind::undecided) return {{}, 0.0, {}, {}, 0.0, 2.0};
  const Vector3 foot = seen + facing.gap * facing.normal;
  View view;
  view.carried = now.carried(foot);
  view.step = view.carried - start.carried(foot);
  const double turned = std::min(norm(now.rotation), 2.0) * norm(foot - now.centre);
  view.unknown = facing.unknown + some_roundings * (norm(now.shift) + turned);
  if (entry.relinearise) {
    view.unknown += some_roundings * (norm(x) + norm(u) + norm(now.centre));
    view.normal = now.turned(facing.normal);
    view.gap = facing.gap + dot(view.normal, u);
  } else {
    view.normal = facing.normal;
    view.gap = facing.gap + dot(view.normal, view.carried);
  }
  return view;
}

void MovingContact::face(double time, double before, std::span<const double> u) {
  const std::size_t dim = part_.dim(), points = part_.contact.size();
  const auto at = [dim](std::span<const double> values, std::int32_t node) {
    Vector3 v{};
    for (std::size_t c = 0; c < dim; ++c) v[c] = values[node * dim + c];
    return v;
  };
  constexpr std::size_t numbers = 10;
  std::vector<double> local;
  for (const ContactPoint& point : part_.contact) {
    const Vector3 x = at(part_.coordinates, point.node), moved = at(u, point.node);
    local.push_back(static_cast<double>(point.entry));
    local.insert(local.end(), x.begin(), x.end());
    local.insert(local.end(), moved.begin(), moved.end());
    // Of two faces that are equally near, the one that the case has.
    const Vector3& outer = there_[local.size() / numbers].normal;
    local.insert(local.end(), outer.begin(), outer.end());
  }
  const std::vector<double> all = gather_contact(part_, local, numbers);
  std::vector<double> views;
  for (std::size_t i = 0; numbers * i < all.size(); ++i) {
    const double* p = &all[numbers * i];
    const auto index = static_cast<std::size_t>(p[0]);
    const ContactEntry& entry = model_.contact[index];
    View v;
    if (entry.moves())
      v = view(entry, {{p[1], p[2], p[3]}, {p[7], p[8], p[9]}}, {p[4], p[5], p[6]}, {before, time},
               travel_[index]);
    for (const Vector3* vector : {&v.normal, &v.carried, &v.step})
      views.insert(views.end(), vector->begin(), vector->end());
    views.insert(views.end(), {v.gap, v.unknown, v.kind});
  }
  views = scatter_contact(part_, views, View::numbers);
  double lost = 0.0;  // a contact entry, from 1, one of whose nodes is lost
  for (std::size_t i = 0; i < points; ++i)
    if (views[View::numbers * i + 11] == 2.0) lost = static_cast<double>(part_.contact[i].entry) + 1.0;
  lost = part_.node_map.max_all(lost);
  if (lost > 0.0)
    throw InputError("contact[" + std::to_string(static_cast<int>(lost) - 1) +
                     "].obstacle: a node has come to lie where no direction leads out of the obstacle");
  faced_at_ = travel_;
  // Rows are built again: those that are there cannot be written.
  ConstraintRows rows;
  part_.slip_origin.assign(2 * points, 0.0);
  for (std::size_t i = 0; i < points; ++i) {
    const double* p = &views[View::numbers * i];
    const View v{{p[0], p[1], p[2]}, p[9], {p[3], p[4], p[5]}, {p[6], p[7], p[8]}, p[10], p[11]};
    ContactPoint there = there_[i], point = there;
    const bool moves = model_.contact[point.entry].moves();
    if (!moves && point.since_step) count_from(i, u);
    const auto row = moves ? take(i, v, u, point) : std::nullopt;
    if (moves) there.tresca = 0.0;  // out of reach there is no film either
    if (row)
      rows.push_back(point, {&*row, 1});
    else
      rows.push_back(there, there_.entries(i));
  }
  part_.contact = std::move(rows);
  for (std::size_t e = 0; e < model_.contact.size(); ++e)
    if (model_.contact[e].moves()) push(e, travel_[e]);
}

void MovingContact::count_from(std::size_t i, std::span<const double> u) {
  const std::size_t dim = part_.dim();
  for (const RowEntry& entry : there_.entries(i))
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t c = 0; c < dim; ++c)
        part_.slip_origin[2 * i + k] +=
            entry.tangent[k][c] * u[static_cast<std::size_t>(entry.node) * dim + c];
}

std::optional<RowEntry> MovingContact::take(std::size_t i, const View& view, std::span<const double> u,
                                            ContactPoint& point) {
  const std::size_t dim = part_.dim(), base = point.node * dim;
  gap_[i] = far_;
  origin_[i] = {};
  if (view.kind != 0.0) return std::nullopt;
  const auto row = row_along(view.normal, point);
  if (!row) return std::nullopt;
  gap_[i] = view.gap;
  point.unknown_gap = view.unknown;
  origin_[i] = view.carried;
  if (point.since_step) {
    origin_[i] = view.step;
    for (std::size_t c = 0; c < dim; ++c) origin_[i][c] += u[base + c];
  }
  return row;
}

std::optional<RowEntry> MovingContact::row_along(const Vector3& normal, ContactPoint& point) const {
  const std::size_t dim = part_.dim(), base = point.node * dim;
  NodeFreedom freedom;
  for (std::size_t c = 0; c < dim; ++c) freedom.free[c] = part_.held[base + c] == 0;
  freedom.held = directions_of(part_.directions, point.node);
  point.normal = normal;
  return narrow_row(point, freedom, point.tresca > 0.0 || point.coulomb > 0.0);
}

void MovingContact::push(std::size_t entry, double travel) {
  const ContactEntry& pushed = model_.contact[entry];
  travel_[entry] = travel;
  const Vector3 way = pushed.force_controlled ? (travel - faced_at_[entry]) * direction(pushed) : Vector3{};
  const std::size_t dim = part_.dim();
  for (std::size_t i = 0; i < part_.contact.size(); ++i) {
    ContactPoint& point = part_.contact[i];
    if (static_cast<std::size_t>(point.entry) != entry) continue;
    point.gap = gap_[i];
    if (gap_[i] != far_) point.gap += dot(point.normal, way);
    for (std::size_t c = 0; c < dim; ++c) {
      const std::size_t k = point.node * dim + c;
      if (part_.held[k] != 0)
        point.gap -= point.normal[c] * part_.prescribed[part_.prescribed_place(k)].value;
    }
    for (const HeldDirection& held : directions_of(part_.directions, point.node))
      point.gap -= dot(point.normal, held.direction) * held.value;
    for (int k = 0; k < point.tangents; ++k)
      part_.slip_origin[2 * i + static_cast<std::size_t>(k)] = dot(point.tangent[k], origin_[i] + way);
  }
}

void MovingContact::withdraw(std::size_t entry) {
  for (std::size_t i = 0; i < part_.contact.size(); ++i)
    if (static_cast<std::size_t>(part_.contact[i].entry) == entry) {
      gap_[i] = far_;
      part_.contact[i].tresca = 0.0;
    }
  push(entry, 0.0);
}

double MovingContact::touch(std::size_t entry) const {
  const Vector3 d = direction(model_.contact[entry]);
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < gap_.size(); ++i) {
    const ContactPoint& point = part_.contact[i];
    const double closing = -dot(point.normal, d);
    if (static_cast<std::size_t>(point.entry) != entry || gap_[i] == far_ || closing < 0.1) continue;
    least = std::min(least, gap_[i] / closing);
  }
  least = -part_.node_map.max_all(-least);
  return faced_at_[entry] + (std::isfinite(least) ? least : 0.0);
}

}  // namespace kacanov
