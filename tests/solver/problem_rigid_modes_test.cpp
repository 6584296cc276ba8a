// SPDX-License-Identifier: BSD-3-Clause
// Unconstrained rigid-body modes are detected and named; unknown groups too.
#include <doctest/doctest.h>

#include "problem_models.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

constexpr auto none = std::nullopt;

/// Two copies of a mesh side by side that share no node.
Mesh twice(const Mesh& one, double offset) {
  Mesh two = one;
  const std::size_t dim = one.dim();
  const auto nodes = static_cast<std::int32_t>(one.node_count());
  for (std::size_t k = 0; k < one.coordinates.size(); ++k) {
    two.coordinates.push_back(one.coordinates[k] + (k % dim == 0 ? offset : 0.0));
  }
  for (const std::int32_t node : one.elements) two.elements.push_back(node + nodes);
  two.groups.clear();
  find_boundary(two);
  return two;
}

}  // namespace

TEST_CASE("a body without any hold: all motions are named") {
  const std::string solid = refusal(box_mesh(ElementType::tet4), elastic_model());
  for (const char* motion :
       {"nothing holds the body against", "translation along x", "translation along y", "translation along z",
        "rotation about x", "rotation about y", "rotation about z"}) {
    CHECK(mentions(solid, motion));
  }
  const std::string plane = refusal(box_mesh(ElementType::tri3), elastic_model());
  CHECK(mentions(plane, "rotation about z, translation along x, translation along y"));
  CHECK_FALSE(mentions(plane, "rotation about x"));
}

TEST_CASE("only what is free is named") {
  const Mesh mesh = box_mesh(ElementType::hex8);
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("bottom"), {none, none, 0.0}));
  const std::string message = refusal(mesh, model);
  CHECK(mentions(message, "rotation about z, translation along x, translation along y;"));
  model.boundary.push_back(displacement(named("left"), {0.0, none, none}));
  CHECK(mentions(refusal(mesh, model), "against translation along y;"));
  model.boundary.push_back(displacement(named("front"), {none, 0.0, none}));
  const Problem problem = build_problem(mesh, model);
  CHECK(problem.loose_modes == 0);
  CHECK(problem.warnings.empty());
}

TEST_CASE("a hinge is a rotation about its own line") {
  Mesh mesh = box_mesh(ElementType::tet4);
  std::vector<std::int32_t> edge;
  for (std::size_t node = 0; node < mesh.node_count(); ++node) {
    if (mesh.coordinates[3 * node] == 2.0 && mesh.coordinates[3 * node + 2] == 0.0) {
      edge.push_back(static_cast<std::int32_t>(node));
    }
  }
  mesh.groups.push_back({"hinge", 1, edge});
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("hinge"), {0.0, 0.0, 0.0}));
  CHECK(mentions(refusal(mesh, model), "against rotation about y through (2, 0.5, 0);"));
}

TEST_CASE("modes that the contact alone holds are counted and warned of") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("left"), {0.0, none, none}));
  model.boundary.push_back(displacement(named("front"), {none, 0.0, none}));
  CHECK(mentions(refusal(mesh, model), "against translation along z;"));
  model.contact.push_back({named("bottom"), Plane{{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}, none});
  const Problem problem = build_problem(mesh, model);
  CHECK(problem.loose_modes == 1);
  REQUIRE(problem.warnings.size() == 1);
  CHECK(mentions(problem.warnings[0], "only the contact holds the body against translation along z"));
}

TEST_CASE("friction holds what a frictionless plane does not") {
  const Mesh mesh = box_mesh(ElementType::tri3);
  Model model = elastic_model();
  const Plane floor{{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
  model.contact.push_back({named("bottom"), floor, none});
  CHECK(mentions(refusal(mesh, model), "against translation along x;"));
  model.contact[0].friction = Friction{0.0, 0.0};
  CHECK(mentions(refusal(mesh, model), "against translation along x;"));
  model.contact[0].friction = Friction{0.1, 0.0};
  CHECK(build_problem(mesh, model).loose_modes == 3);
}

TEST_CASE("every piece of a mesh must be held") {
  const Mesh mesh = twice(box_mesh(ElementType::tet4), 5.0);
  Model model = elastic_model();
  model.boundary.push_back(displacement(box({0.0, 0.0, 0.0}, {0.0, 1.0, 1.0}), {0.0, 0.0, 0.0}));
  const std::string message = refusal(mesh, model);
  CHECK(mentions(message,
                 "the piece of the body with element 97 (96 of 192 elements; the mesh falls into 2 pieces)"));
  model.boundary.push_back(displacement(box({5.0, 0.0, 0.0}, {5.0, 1.0, 1.0}), {0.0, 0.0, 0.0}));
  CHECK(build_problem(mesh, model).loose_modes == 0);
}

TEST_CASE("unknown parts are refused with those that exist, and a guess") {
  const Mesh mesh = box_mesh(ElementType::tet4);
  Model model = elastic_model();
  model.boundary.push_back(displacement(named("lfet"), {0.0, 0.0, 0.0}));
  CHECK(refusal(mesh, model) ==
        "boundary[0].on: no part is called \"lfet\" (did you mean \"left\"?); there are: all, back, bottom, "
        "front, "
        "left, right, top");
  model.boundary[0].on = named("left");
  model.materials[0].on = named("left");
  CHECK(mentions(refusal(mesh, model),
                 "material[0].on: the part \"left\" is made of boundary facets, expected elements"));
}
