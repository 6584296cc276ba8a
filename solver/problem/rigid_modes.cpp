// SPDX-License-Identifier: BSD-3-Clause
// Detection of unconstrained rigid-body modes, and rest positions of bodies held by contact only.
#include "problem/rigid_modes.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include <kacanov/error.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "problem/conditions.hpp"
#include "problem/dense.hpp"
#include "problem/vector3.hpp"

namespace kacanov {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A mode is free if its constraint energy relative to the stiffest mode is below this (singular values of
/// the scaled rows: below its square root).
constexpr double free_below = 1e-12;
/// A load whose resultant is below this share of its forces is self-equilibrated, up to rounding.
constexpr double rounded_load = 1e-11;

/// A support normal with a smaller independent component adds nothing to the span of the others.
constexpr double dependent_normals = 1e-12;

/// One connected component of the mesh: elements connected by nodes.
struct Piece : LoosePiece {
  std::int64_t nodes = 0, elements = 0;
  std::size_t first_element = 0;
  Matrix6 by_contact = Matrix6::Zero();  ///< Gram matrix of its contact rows
};

Eigen::Map<Matrix6> gram_of_supports(LoosePiece& piece) {
  return Eigen::Map<Matrix6>(piece.by_displacement.data());
}
Eigen::Map<const Matrix6> gram_of_supports(const LoosePiece& piece) {
  return Eigen::Map<const Matrix6>(piece.by_displacement.data());
}

/// Work of a force along `direction` at x on the modes: rotations come first, so that reduction names them
/// first.
Vector6 row(const LoosePiece& piece, const Vector3& x, const Vector3& direction) {
  const Vector3 turn = (1.0 / piece.radius) * cross(x - piece.centre, direction);
  Vector6 values;
  values << turn[0], turn[1], turn[2], direction[0], direction[1], direction[2];
  return values;
}

/// Returns the pieces, and the piece of every node.
std::vector<Piece> find_pieces(const Mesh& mesh, std::vector<std::int32_t>& piece_of_node) {
  const MeshPieces found = connected_pieces(mesh);
  piece_of_node = found.of_node;
  std::vector<Piece> pieces(static_cast<std::size_t>(found.count));
  const auto piece_of = [&](std::int32_t node) -> Piece& { return pieces[piece_of_node[node]]; };
  const std::size_t n = nodes_per_element(mesh.type);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    Piece& piece = piece_of(mesh.elements[e * n]);
    if (piece.elements++ == 0) piece.first_element = e;
  }
  const auto nodes = static_cast<std::int32_t>(mesh.node_count());
  for (std::int32_t node = 0; node < nodes; ++node) {
    Piece& piece = piece_of(node);
    ++piece.nodes;
    piece.centre = piece.centre + position(mesh, node);
  }
  for (Piece& piece : pieces) piece.centre = (1.0 / static_cast<double>(piece.nodes)) * piece.centre;
  for (std::int32_t node = 0; node < nodes; ++node) {
    Piece& piece = piece_of(node);
    piece.radius = std::max(piece.radius, norm(position(mesh, node) - piece.centre));
  }
  return pieces;
}

void add_row(Eigen::Ref<Matrix6> gram, const Vector6& values) {
  gram.noalias() += values * values.transpose();
}

/// Returns the work of a contact point's normal and tangents on the modes of its piece.
std::array<Vector6, 3> point_rows(const Problem& problem, const Piece& piece, std::size_t i,
                                  std::span<const std::int32_t> piece_of_node) {
  const auto home = [&](std::int32_t node) { return piece_of_node[node]; };
  std::array<Vector6, 3> sums{Vector6::Zero(), Vector6::Zero(), Vector6::Zero()};
  for (const RowEntry& entry : problem.contact.entries(i)) {
    // Entries on nodes of another piece count as fixed.
    if (home(entry.node) != home(problem.contact[i].node)) continue;
    const Vector3 x = position(problem.mesh, entry.node);
    // The whole normal: its prescribed components are also in the displacement rows.
    sums[0] += row(piece, x, entry.normal);
    for (std::size_t k = 0; k < 2; ++k) sums[k + 1] += row(piece, x, entry.tangent[k]);
  }
  return sums;
}

void collect_rows(const Problem& problem, std::vector<Piece>& pieces,
                  std::span<const std::int32_t> piece_of_node) {
  const Mesh& mesh = problem.mesh;
  const std::size_t dim = mesh.dim();
  for (std::size_t k = 0; k < problem.held.size(); ++k) {
    if (problem.held[k] == 0) continue;
    const std::size_t node = k / dim;
    Piece& piece = pieces[piece_of_node[node]];
    Vector3 axis{};
    axis[k % dim] = 1.0;
    add_row(gram_of_supports(piece), row(piece, position(mesh, static_cast<std::int32_t>(node)), axis));
  }
  for (const HeldDirection& held : problem.directions) {
    Piece& piece = pieces[piece_of_node[held.node]];
    add_row(gram_of_supports(piece), row(piece, position(mesh, held.node), held.direction));
  }
  for (const NodeSpring& spring : problem.springs) {
    Piece& piece = pieces[piece_of_node[spring.node]];
    double size = 0.0;
    for (const Vector3& r : spring.stiffness) size = std::max(size, norm(r));
    if (size == 0.0) continue;
    for (const Vector3& r : spring.stiffness)
      add_row(gram_of_supports(piece), row(piece, position(mesh, spring.node), (1.0 / size) * r));
  }
  for (std::size_t i = 0; i < problem.contact.size(); ++i) {
    const ContactPoint& point = problem.contact[i];
    Piece& piece = pieces[piece_of_node[point.node]];
    const auto rows = point_rows(problem, piece, i, piece_of_node);
    for (std::size_t k = 0; k <= static_cast<std::size_t>(point.tangents); ++k)
      add_row(piece.by_contact, rows[k]);
  }
}

/// Returns the free modes as rows in reduced echelon form, so that axis-aligned motions appear as such.
Eigen::MatrixXd free_modes(const Matrix6& gram, int dim, PlaneState plane) {
  // In the plane: rotation about z, translations along x and y; axisymmetric: only the translation along the
  // axis.
  const std::vector<Eigen::Index> kept = dim == 3 ? std::vector<Eigen::Index>{0, 1, 2, 3, 4, 5}
                                         : plane == PlaneState::axisymmetric
                                             ? std::vector<Eigen::Index>{4}
                                             : std::vector<Eigen::Index>{2, 3, 4};
  const Eigen::MatrixXd reduced = gram(kept, kept);
  const SymmetricEigen eigen = symmetric_eigen(reduced);
  const double others = plane == PlaneState::axisymmetric ? gram(3, 3) : 0.0;
  const double scale = std::max({eigen.values.maxCoeff(), others, 1e-300});
  Eigen::Index count = 0;
  while (count < eigen.values.size() && eigen.values[count] <= free_below * scale) ++count;
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(count, 6);
  for (Eigen::Index m = 0; m < count; ++m) {
    for (std::size_t k = 0; k < kept.size(); ++k) {
      modes(m, kept[k]) = eigen.vectors(static_cast<Eigen::Index>(k), m);
    }
  }
  Eigen::Index lead = 0;
  for (Eigen::Index column = 0; column < 6 && lead < count; ++column) {
    Eigen::Index pivot = 0;
    const double largest = modes.col(column).tail(count - lead).cwiseAbs().maxCoeff(&pivot);
    if (largest < 1e-6) continue;
    modes.row(lead).swap(modes.row(lead + pivot));
    modes.row(lead) /= modes(lead, column);
    for (Eigen::Index other = 0; other < count; ++other) {
      if (other != lead) modes.row(other) -= modes(other, column) * modes.row(lead).eval();
    }
    ++lead;
  }
  return modes;
}

/// Returns "x", or "(0.6, 0.8, 0)" for a direction not along an axis.
std::string direction_name(Vector3 direction, int dim) {
  direction = (1.0 / norm(direction)) * direction;
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::abs(std::abs(direction[c]) - 1.0) < 1e-9) return std::string(1, "xyz"[c]);
  }
  for (double& value : direction) value = std::abs(value) < 1e-9 ? 0.0 : value;
  return to_text(direction, dim);
}

/// Describes the motion of a mode in words; the axis is given by its point nearest to the centre.
std::string describe(const LoosePiece& piece, const Eigen::VectorXd& mode, int dim) {
  const Vector3 turn{mode[0], mode[1], mode[2]};
  const Vector3 shift{mode[3] * piece.radius, mode[4] * piece.radius, mode[5] * piece.radius};
  if (norm(turn) < 1e-6) return "translation along " + direction_name(shift, dim);
  // In piece sizes: for an axis farther away the direction of motion is more informative.
  constexpr double far_off = 100.0;
  if (norm(shift) > far_off * piece.radius * norm(turn))
    return "translation along " + direction_name(shift, dim) + " with next to no rotation";
  const double squared = dot(turn, turn);
  const Vector3 along = (dot(shift, turn) / squared) * turn;
  Vector3 through = piece.centre + (1.0 / squared) * cross(turn, shift);
  for (double& value : through) value = std::abs(value) < 1e-9 * piece.radius ? 0.0 : value;
  std::string text = "rotation about " + (dim == 2 ? "z" : direction_name(turn, dim));
  if (norm(shift) > 1e-6 * piece.radius) text += " through " + to_text(through, dim);
  if (norm(along) > 1e-6 * piece.radius) text += " together with a translation along its axis";
  return text;
}

std::string list_modes(const LoosePiece& piece, const Eigen::MatrixXd& modes, int dim) {
  std::string text;
  for (Eigen::Index m = 0; m < modes.rows(); ++m) {
    text += (m > 0 ? ", " : "") + describe(piece, modes.row(m), dim);
  }
  return text;
}

/// Contact points and load of one piece, expressed in an orthonormal basis (columns) of its loose motions.
struct RigidPiece {
  Eigen::MatrixXd basis;
  std::vector<RigidContact> points;
  Eigen::VectorXd load;
};

/// Returns the work of a load on the loose motions of a piece (columns of the basis).
Eigen::VectorXd load_of(const Problem& problem, const Piece& piece, std::int32_t number,
                        std::span<const std::int32_t> piece_of_node, std::span<const double> load,
                        const Eigen::MatrixXd& basis) {
  const Mesh& mesh = problem.mesh;
  const std::size_t dim = mesh.dim();
  Vector6 sum = Vector6::Zero();
  double forces = 0.0;
  for (std::size_t n = 0; n < mesh.node_count(); ++n) {
    if (piece_of_node[n] != number) continue;
    Vector3 force{};
    for (std::size_t c = 0; c < dim; ++c) force[c] = load[n * dim + c];
    sum += row(piece, position(mesh, static_cast<std::int32_t>(n)), force);
    forces += norm(force);
  }
  Eigen::VectorXd work = basis.transpose() * sum;
  if (work.norm() <= rounded_load * forces) work.setZero();
  return work;
}

RigidPiece collect(const Problem& problem, const Piece& piece, std::int32_t number,
                   std::span<const std::int32_t> piece_of_node, const Eigen::MatrixXd& loose) {
  RigidPiece rigid;
  rigid.basis = orthonormal_basis(loose.transpose());
  for (std::size_t i = 0; i < problem.contact.size(); ++i) {
    const ContactPoint& point = problem.contact[i];
    if (piece_of_node[point.node] != number) continue;
    const auto rows = point_rows(problem, piece, i, piece_of_node);
    RigidContact contact;
    contact.normal = rigid.basis.transpose() * rows[0];
    for (std::size_t k = 0; k < static_cast<std::size_t>(point.tangents); ++k)
      contact.tangent.push_back(rigid.basis.transpose() * rows[k + 1]);
    contact.gap = point.gap;
    contact.mass = point.mass;
    contact.coulomb = point.coulomb;
    contact.tresca = point.tresca;
    rigid.points.push_back(std::move(contact));
  }
  rigid.load = load_of(problem, piece, number, piece_of_node, problem.load, rigid.basis);
  return rigid;
}

/// Explains why the piece cannot be in equilibrium.
std::string explain(const RigidPiece& rigid, const RigidBalance& failed, const Piece& piece,
                    const std::string& name, int dim) {
  // Friction cones are dilatant: sliding appears with a small lift-off, an artefact that is removed from the
  // text.
  Eigen::MatrixXd normals(rigid.load.size(), static_cast<Eigen::Index>(failed.supports.size()));
  for (Eigen::Index k = 0; k < normals.cols(); ++k) normals.col(k) = rigid.points[failed.supports[k]].normal;
  Eigen::VectorXd motion = failed.motion;
  if (normals.cols() > 0) {
    motion -= normals * (pseudo_inverse(normals, dependent_normals) * motion);
    if (motion.norm() < 1e-3 * failed.motion.norm()) motion = failed.motion;
  }
  const double needed = friction_needed(rigid.points, rigid.load);
  double least = HUGE_VAL, most = 0.0;
  bool coulomb = false, tresca = false;
  for (const RigidContact& point : rigid.points) {
    coulomb = coulomb || point.coulomb > 0.0;
    tresca = tresca || point.tresca > 0.0;
    if (point.tangent.empty()) continue;
    least = std::min(least, point.coulomb);
    most = std::max(most, point.coulomb);
  }
  PlainText text;
  text.precision(3);
  if (!std::isfinite(needed) || !(coulomb || tresca)) {
    text << "no equilibrium: the load lifts " << name << " off what alone holds it ("
         << describe(piece, rigid.basis * failed.motion, dim) << "), and nothing else does";
  } else {
    text << "no equilibrium: " << name << " slides (" << describe(piece, rigid.basis * motion, dim)
         << "): it needs ";
    if (coulomb && !tresca && least == most)
      text << "a friction coefficient of " << needed * most << ", and that of the contact is " << most;
    else
      text << "friction " << needed << " times as large";
  }
  return text.str();
}

std::string name_piece(const Piece& piece, const Mesh& mesh, std::size_t pieces) {
  if (pieces == 1) return "the body";
  return "the piece of the body with element " + std::to_string(mesh.element_tag(piece.first_element)) +
         " (" + std::to_string(piece.elements) + " of " + std::to_string(mesh.element_count()) +
         " elements; the mesh falls into " + std::to_string(pieces) + " pieces)";
}

/// Computes where the piece comes to rest, or why it does not.
void settle(Problem& problem, const Piece& piece, std::int32_t number, const RigidPiece& rigid,
            const std::string& name, std::span<const std::int32_t> piece_of_node) {
  const RigidBalance found = balance(rigid.points, rigid.load);
  if (!found.exists) {
    if (problem.no_equilibrium.empty())
      problem.no_equilibrium = explain(rigid, found, piece, name, problem.mesh.dim());
    return;
  }
  RigidPiece later = rigid;
  for (std::size_t step = 2; step < problem.steps.size() && problem.no_equilibrium.empty(); ++step) {
    later.load = load_of(problem, piece, number, piece_of_node, load_at(problem, step), rigid.basis);
    const RigidBalance then = balance(later.points, later.load);
    if (then.exists) continue;
    PlainText place;
    place << " (load step " << step << ", time " << problem.steps[step].time << ")";
    problem.no_equilibrium = explain(later, then, piece, name, problem.mesh.dim()) + place.str();
  }
  // A pressure p indents a body of this size by about p divided by this stiffness.
  double bulk = 0.0;
  for (const Law& law : problem.laws) bulk = std::max(bulk, law.bulk);
  const Vector6 motion = rigid.basis * rest_on_springs(rigid.points, rigid.load, 3.0 * bulk / piece.radius);
  const auto which = static_cast<std::int32_t>(problem.motions.size());
  problem.motions.push_back({piece.centre,
                             {motion[0] / piece.radius, motion[1] / piece.radius, motion[2] / piece.radius},
                             {motion[3], motion[4], motion[5]}});
  const bool alone =
      std::all_of(piece_of_node.begin(), piece_of_node.end(), [](std::int32_t p) { return p == 0; });
  if (alone) return;
  problem.motion_of_node.resize(piece_of_node.size(), -1);
  for (std::size_t n = 0; n < piece_of_node.size(); ++n)
    if (piece_of_node[n] == number) problem.motion_of_node[n] = which;
}

}  // namespace

void check_rigid_modes(Problem& problem) {
  std::vector<std::int32_t> piece_of_node;
  std::vector<Piece> pieces = find_pieces(problem.mesh, piece_of_node);
  collect_rows(problem, pieces, piece_of_node);
  const Mesh& mesh = problem.mesh;
  const int dim = mesh.dim();
  for (std::int32_t number = 0; number < static_cast<std::int32_t>(pieces.size()); ++number) {
    Piece& piece = pieces[number];
    const Eigen::MatrixXd loose = free_modes(gram_of_supports(piece), dim, mesh.plane);
    if (loose.rows() == 0) continue;
    const std::string name = name_piece(piece, problem.mesh, pieces.size());
    const Eigen::MatrixXd free = free_modes(gram_of_supports(piece) + piece.by_contact, dim, mesh.plane);
    if (free.rows() > 0) {
      throw InputError("boundary: nothing holds " + name + " against " + list_modes(piece, free, dim) +
                       "; add displacements (or contact) that do");
    }
    problem.loose_modes += static_cast<int>(loose.rows());
    piece.name = name;
    for (std::size_t i = 0; i < problem.contact.size(); ++i)
      if (piece_of_node[problem.contact[i].node] == number)
        problem.contact[i].loose_piece = static_cast<std::int32_t>(problem.loose_pieces.size());
    problem.loose_pieces.push_back(piece);
    problem.warnings.push_back("only the contact holds " + name + " against " +
                               list_modes(piece, loose, dim) +
                               "; there is a solution only if the loads press it on");
    settle(problem, piece, number, collect(problem, piece, number, piece_of_node, loose), name,
           piece_of_node);
  }
}

RigidRow rigid_row(const LoosePiece& piece, const Vector3& x, const Vector3& direction) {
  RigidRow values;
  Eigen::Map<Vector6>(values.data()) = row(piece, x, direction);
  return values;
}

std::string free_motions(const LoosePiece& piece, const RigidGram& by_contact, int dim, PlaneState plane) {
  const Matrix6 all = gram_of_supports(piece) + Eigen::Map<const Matrix6>(by_contact.data());
  return list_modes(piece, free_modes(all, dim, plane), dim);
}

std::vector<double> rigid_start(const Problem& problem, std::span<const std::int32_t> nodes) {
  if (problem.motions.empty()) return {};
  const std::size_t dim = problem.mesh.dim();
  std::vector<double> start(nodes.size() * dim);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const std::size_t node = nodes[k];
    const std::int32_t which = problem.motion_of_node.empty() ? 0 : problem.motion_of_node[node];
    if (which < 0) continue;
    const PieceMotion& motion = problem.motions[which];
    const Vector3 turned = cross(motion.turn, position(problem.mesh, nodes[k]) - motion.centre);
    for (std::size_t c = 0; c < dim; ++c) start[k * dim + c] = motion.shift[c] + turned[c];
  }
  return start;
}

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Accepted relative residual of equilibrium, well below the effect of an error of 1e-6 in the friction
/// coefficient.
constexpr double balanced = 1e-10;
/// Maximum number of reactions; each one reduces the unbalanced load.
constexpr int most_reactions = 2000;

/// Reactions found so far, one column each, and their shares. The last row is nonzero for Tresca friction
/// only: the sum of its shares is limited to one.
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
  /// Non-negative least squares on the current columns (inner loop of Lawson and Hanson's method).
  void fit(const VectorXd& load) {
    while (share.size() > 0) {
      const VectorXd best = column.colPivHouseholderQr().solve(load);
      double step = 1.0;
      for (Index k = 0; k < share.size(); ++k)
        if (best(k) <= 0.0) step = std::min(step, share(k) / (share(k) - best(k) + 1e-300));
      share += step * (best - share);
      if (step == 1.0) return;
      // Remove the shares that have become zero; the smallest one is removed in any case.
      const double least = share.minCoeff();
      for (double& value : share)
        if (value <= std::max(least, 1e-14 * share.maxCoeff())) value = 0.0;
      drop_unused();
    }
  }
};

/// Returns the point's reaction that does the most work on `motion`, with Coulomb friction on its cone.
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
  // Weak springs on motions that no contact resists yet, negligible beside those of the contact.
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
