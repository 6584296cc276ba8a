// SPDX-License-Identifier: BSD-3-Clause
// Warnings about likely mistakes in a model, check by check, and none for sound models.
#include <doctest/doctest.h>

#include "problem/vector3.hpp"
#include "problem/warnings.hpp"
#include "support.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// Steel in N and mm, fixed on the left and pressed on a floor.
Model sound_model() {
  Model model;
  model.materials.push_back({everything(), elastic_law(210e3, 0.3)});
  model.boundary.push_back(moved(named("left"), 3));
  model.boundary.push_back(traction(named("top"), {0, 0, -20.0}));
  model.contact.push_back(on_plane(named("bottom"), {}, {0, 0, 1}));
  return model;
}

Mesh block() { return box_mesh(ElementType::tet4); }

template <class Check, class... Arguments>
std::string said(const Check& check, const Arguments&... arguments) {
  validity::Warnings warnings;
  check(arguments..., warnings);
  return warnings.empty() ? std::string() : warnings[0];
}

}  // namespace

TEST_CASE("a sound problem and its result are not complained of") {
  const Model model = sound_model();
  const Run run = run_alone(block(), model);
  CHECK(examine(build_problem(block(), model), model).empty());
  CHECK(examine(run.result(), model).empty());
}

TEST_CASE("nothing acts") {
  Model model = sound_model();
  const auto found = [&] { return said(validity::no_load, build_problem(block(), model), model); };
  CHECK(found().empty());
  model.boundary[1].traction = Vector3{};
  CHECK(mentions(found(), "nothing acts on the body"));
  model.contact[0].obstacle = Plane{{0, 0, 0.01}, {0, 0, 1}};
  CHECK(found().empty());
  model.contact.clear();
  model.boundary[0] = moved(named("left"), 3, {0.1, 0, 0});
  CHECK(found().empty());
}

TEST_CASE("units that do not go together") {
  Model model = sound_model();
  const auto found = [&] { return said(validity::mixed_units, build_problem(block(), model), model); };
  Law& law = model.materials[0].law;
  law.form = bilinear(law, 250.0, 2e3);
  CHECK(found().empty());
  law.form = bilinear(law, 0.25, 2e3);
  CHECK(mentions(found(), "material[0]: it yields at a stress of 0.25"));
  law.form = bilinear(law, 250e3, 2e3);
  CHECK(mentions(found(), "material[0]"));
  law.form = ramberg_osgood(law, 250.0, 0.4, 5.0);
  CHECK(found().empty());
  model.boundary[1].traction = Vector3{0, 0, -20e3};  // kN instead of N
  CHECK(mentions(found(), "boundary[1]: it comes to a stress of 2e+04, 80 times the stress 250 at which"));
  model.boundary[1].traction = Vector3{0, 0, -20e6};
  model.boundary[1].name = "lid";
  CHECK(mentions(found(), "lid: it comes to a stress of 2e+07"));
  model.boundary[1].traction = Vector3{0, 0, -1e-5};
  CHECK(mentions(found(), "less than a billionth of Young's modulus"));
  model.boundary[1] = traction(named("top"), {});
  model.boundary[1].traction.reset();
  model.boundary[1].total_force = Vector3{0, 0, -1e5};  // on an area of 2
  CHECK(mentions(found(), "boundary[1]: it comes to a stress of 5e+04"));
  model.boundary[1] = body_force(everything(), {0, 0, -7850 * 9.81});
  CHECK(mentions(found(), "boundary[1]"));
}

TEST_CASE("facets that look away from their obstacle") {
  Model model = sound_model();
  const auto found = [&] { return said(validity::facet_orientation, build_problem(block(), model), model); };
  CHECK(found().empty());
  model.contact[0].obstacle = Plane{{0, 0, 0}, {0, 0, -1}};
  CHECK(mentions(found(), "contact[0]: 16 of its 16 facets look away from the obstacle"));
  model.contact[0].obstacle = Sphere{{1, 0.5, -3}, 3.0, {}};
  CHECK(found().empty());
  model.contact[0].obstacle = Sphere{{1, 0.5, -3}, 3.0, Vector3{0, 0, 1}};
  CHECK(mentions(found(), "look away"));
  CHECK(mentions(likely_cause({"something else", found()}), "look away"));
  CHECK(likely_cause({"something else"}).empty());
  // The whole boundary: the gap decides.
  model.contact[0] = on_plane(everything(), {}, {0, 0, 1});
  CHECK(found().empty());
}

TEST_CASE("facets of a group inside the body") {
  Mesh mesh = block();
  const auto bottom = std::find_if(mesh.groups.begin(), mesh.groups.end(),
                                   [](const Group& group) { return group.name == "bottom"; });
  Model model = sound_model();
  CHECK(said(validity::inner_facets, build_problem(mesh, model), model).empty());
  bottom->inner = 7;
  CHECK(mentions(said(validity::inner_facets, build_problem(mesh, model), model),
                 "contact[0]: 7 facets of \"bottom\" are not on the boundary of the body and are left out"));
}

namespace {

/// Appends the nodes and elements of another mesh.
void append(Mesh& mesh, const Mesh& other, const Vector3& shift) {
  const auto first = static_cast<std::int32_t>(mesh.node_count());
  for (std::size_t i = 0; i < other.coordinates.size(); ++i)
    mesh.coordinates.push_back(other.coordinates[i] + shift[i % static_cast<std::size_t>(mesh.dim())]);
  for (const std::int32_t node : other.elements) mesh.elements.push_back(first + node);
  mesh.groups.clear();
  find_boundary(mesh);
}

Problem only_mesh(Mesh mesh) {
  Problem problem;
  problem.mesh = std::move(mesh);
  return problem;
}

}  // namespace

TEST_CASE("nodes that lie at one place and are not one") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const bool flat = dimension(type) == 2;
    const auto all_said = [](const Mesh& mesh) {
      validity::Warnings warnings;
      validity::unmerged_nodes(only_mesh(mesh), warnings);
      return warnings;
    };
    const Mesh box = make_box({{1, 1, 1}, {2, 2, 2}, type});
    CHECK(all_said(box).empty());
    const std::size_t on_face = flat ? 3 : type == ElementType::tet10 ? 25 : 9;
    for (const double gap : {0.0, 1e-8, 1e-4, 0.5}) {
      CAPTURE(gap);
      for (const double far : {0.0, 1000.0}) {  // single-precision coordinates there are accurate to 1e-4
        Mesh pair = box;
        append(pair, box, {0, 1 + gap, 0});
        for (double& x : pair.coordinates) x += far;
        const auto warnings = all_said(pair);
        REQUIRE(warnings.size() == (gap <= 1e-8 ? 1u : 0u));
        if (warnings.empty()) continue;
        CHECK(mentions(warnings[0], "the mesh is in 2 pieces, and " + std::to_string(on_face) +
                                        " pairs of nodes lie at one place, the first nodes "));
      }
    }
    // Shared nodes along one part of the face, duplicate nodes along the rest: a slit.
    Mesh slit = box;
    append(slit, box, {0, 1, 0});
    std::vector<std::int32_t> other(slit.node_count());
    for (std::size_t n = 0; n < other.size(); ++n) {
      other[n] = static_cast<std::int32_t>(n);
      const Vector3 x = position(slit, static_cast<std::int32_t>(n));
      if (n < box.node_count() || std::abs(x[1] - 1) > 1e-12 || x[0] > 0.6) continue;
      for (std::size_t m = 0; m < box.node_count(); ++m)
        if (norm(position(slit, static_cast<std::int32_t>(m)) - x) < 1e-12)
          other[n] = static_cast<std::int32_t>(m);
    }
    for (std::int32_t& node : slit.elements) node = other[node];
    find_boundary(slit);
    const auto warnings = all_said(slit);
    REQUIRE(warnings.size() == 1);
    CHECK(mentions(warnings[0], "within one piece of the mesh "));
    CHECK(mentions(warnings[0], "the body is slit there"));
  }
}

TEST_CASE("a hundred thousand pairs of nodes in one plane are found in seconds") {
  // Many nodes with one coordinate in common.
  Mesh plate = make_box({{1, 1, 0.01}, {300, 300, 1}, ElementType::hex8});
  append(plate, make_box({{1, 1, 0.01}, {300, 300, 1}, ElementType::hex8}), {0, 0, 0.01});
  const double start = MPI_Wtime();
  CHECK(mentions(said(validity::unmerged_nodes, only_mesh(plate)), "90601 pairs of nodes lie at one place"));
  CHECK(MPI_Wtime() - start < 20.0);
}

TEST_CASE("boxes that cut through facets are said with both areas, those that end at their sides are not") {
  Model model = sound_model();
  const auto found = [&](const Mesh& mesh, const Vector3& lower, const Vector3& upper) {
    model.boundary[1].on = box(lower, upper);
    return said(validity::cut_selections, only_mesh(mesh), model);
  };
  for (const ElementType type : {ElementType::tet4, ElementType::hex8, ElementType::tet10}) {
    CAPTURE(cell(type).name);
    const Mesh block = make_box({{10, 10, 10}, {10, 10, 2}, type});
    const std::string cut = found(block, {3.75, 3.75, 10}, {6.25, 6.25, 10});
    CHECK(mentions(cut, "boundary[1].on: the box cuts through "));
    CHECK(mentions(cut, " taken have the area 4, what lies in the box has 6.25"));
    CHECK(found(block, {4, 4, 10}, {6, 6, 10}).empty());
    CHECK(found(block, {4, 4, 9}, {6, 6, 11}).empty());
    CHECK(found(block, {4 - 1e-10, 4, 9}, {6 + 1e-10, 6 + 5e-4, 11}).empty());  // a sliver
    // Around the upper face and part of the way down the sides, whose facets are taller than the box.
    CHECK(found(block, {-1, -1, 9}, {11, 11, 11}).empty());
    CHECK(
        mentions(found(block, {-1, -1, 9}, {4.5, 11, 11}), "have the area 40, what lies in the box has 45"));
    // The upper face together with its facets on one side.
    CHECK(mentions(found(block, {-1, -1, 3}, {11, 0, 11}), "have the area 50, what lies in the box has 70"));
  }
  // Lengths in plane strain; areas in axisymmetry.
  for (const PlaneState plane : {PlaneState::strain, PlaneState::axisymmetric}) {
    Mesh sheet = make_box({{4, 2, 0}, {4, 2, 0}, ElementType::quad4});
    sheet.plane = plane;
    const bool round = plane == PlaneState::axisymmetric;
    CHECK(mentions(found(sheet, {-1, 2, 0}, {1.5, 2, 0}),
                   round ? "the area 3.14, what lies in the box has 7.07"
                         : "the length 1, what lies in the box has 1.5"));
    CHECK(found(sheet, {1, 1.5, 0}, {3, 2.5, 0}).empty());
  }
}

TEST_CASE("boxes that cut through elements are said with both volumes") {
  for (const ElementType type : element_types()) {
    CAPTURE(cell(type).name);
    const bool flat = dimension(type) == 2;
    const Problem problem = only_mesh(make_box({{4, 2, 2}, {4, 2, 2}, type}));
    Model model = elastic_model();
    const auto found = [&](const Vector3& lower, const Vector3& upper) {
      model.materials[0].on = box(lower, upper);
      return said(validity::cut_selections, problem, model);
    };
    CHECK(mentions(found({0, 0, 0}, {1.25, 2, 2}), flat ? "the area 2, what lies in the box has 2.5"
                                                        : "the volume 4, what lies in the box has 5"));
    CHECK(mentions(found({0, 0, 0}, {1.25, 2, 2}), "material[0].on: the box cuts through "));
    CHECK(mentions(found({0.5, -1, -1}, {3.5, 3, 3}), flat ? "the area 4, what lies in the box has 6"
                                                           : "the volume 8, what lies in the box has 12"));
    CHECK(found({-1, -1, -1}, {2, 5, 5}).empty());
    CHECK(found({1, 1, 1}, {3, 2, 2}).empty());
    model.materials[0].on = everything();
    model.boundary.push_back(body_force(box({0, 0, 0}, {1.25, 2, 2}), {1, 0, 0}));
    CHECK(mentions(said(validity::cut_selections, problem, model), "boundary[0].on: the box cuts through "));
  }
}

TEST_CASE("thin elements") {
  for (const ElementType type : element_types()) {
    CAPTURE(static_cast<int>(type));
    const int dim = dimension(type);
    const std::size_t up = dim - 1;
    const auto found = [&](double height) {
      std::array<double, 3> size{1.0, 1.0, 1.0};
      size[up] = height;
      Problem problem;
      problem.mesh = make_box({size, {1, 1, 1}, type});
      return said(validity::thin_elements, problem);
    };
    CHECK(found(1.0).empty());
    CHECK(found(1e-5).empty());
    CHECK(mentions(found(1e-7), "thinner than a millionth of their size"));
  }
}

TEST_CASE("B-bar is taken where elements lock without it, and asked for where it was declined") {
  Model model = elastic_model();
  model.boundary.push_back(moved(named("left"), 3));
  const auto problem = [&](ElementType type) { return build_problem(box_mesh(type), model); };
  const auto taken = [&](ElementType type) { return problem(type).laws[0].mean_dilatation; };
  CHECK_FALSE(taken(ElementType::hex8));
  model.materials[0].law = elastic_law(1.0, 0.49);
  CHECK(taken(ElementType::hex8));
  CHECK_FALSE(taken(ElementType::tet10));
  // 0.45 is on the same side of the bound in all units.
  for (double young = 1e-3; young < 1e12; young *= 1.7) {
    model.materials[0].law = elastic_law(young, 0.45);
    CHECK_FALSE(taken(ElementType::hex8));
  }
  model.materials[0].law = logarithmic_law(0.01);
  CHECK(taken(ElementType::hex8));
  CHECK(said(validity::locking, problem(ElementType::hex8), model).empty());
  model.materials[0].bbar = false;
  CHECK_FALSE(taken(ElementType::hex8));
  CHECK(
      mentions(said(validity::locking, problem(ElementType::hex8), model), "material[0].bbar: it is false"));
  CHECK(said(validity::locking, problem(ElementType::tet10), model).empty());
  model.materials[0].bbar = true;
  CHECK(mentions(refusal(box_mesh(ElementType::tet4), model), "material[0].bbar: expected false"));
}

TEST_CASE("strains, rotations and displacements that are not small") {
  Result result;
  result.body.size = 2.0;
  result.max_strain = {0.049, {1, 2, 3}, 17};
  result.max_rotation = {0.049, {1, 2, 3}, 17};
  result.max_displacement = {0.19, {1, 2, 3}, 5};
  CHECK(said(validity::large_strain, result).empty());
  CHECK(said(validity::large_displacement, result).empty());
  result.max_strain.value = 0.96;
  CHECK(mentions(said(validity::large_strain, result), "strains reach 0.96 (element 17 at (1, 2, 3))"));
  Model model;
  model.materials.push_back({everything(), elastic_law(1.0, 0.3)});
  const auto flow = [&] { return said(validity::tet4_locking, result, model); };
  result.max_flow.value = 10.5;
  result.max_flow.tag = 17;
  for (const ElementType type : element_types()) {
    result.element = type;
    CHECK(mentions(flow(), "10.5 times those at yield (element 17") == (type == ElementType::tet4));
  }
  result.element = ElementType::tet4;
  model.materials[0].formulation = MaterialEntry::Formulation::mixed;
  CHECK(flow().empty());
  model.materials[0].formulation.reset();
  result.max_flow.value = 10.0;
  CHECK(flow().empty());
  result.max_strain.value = 0.0;
  result.max_rotation.value = 0.06;
  CHECK(mentions(said(validity::large_strain, result), "rotations reach 0.06 radians"));
  result.max_displacement.value = 0.21;
  CHECK(mentions(said(validity::large_displacement, result), "moves by 0.21, 0.105 of its size (node 5"));
}

TEST_CASE("contact that bears nothing") {
  Model model = sound_model();
  const auto found = [&] {
    return said(validity::inactive_contact, run_alone(block(), model).result(), model);
  };
  CHECK(found().empty());
  model.boundary[1].traction = Vector3{0, 0, 20.0};
  CHECK(mentions(found(), "contact[0]: the body touches this obstacle at rest, and the loads lift it off"));
  model.contact[0].obstacle = Plane{{0, 0, -0.1}, {0, 0, 1}};
  model.contact[0].name = "floor";
  CHECK(mentions(found(), "floor: nothing reaches this obstacle; of the least gap of 0.1 at rest"));
}

TEST_CASE("contact that hardly a node bears") {
  Model model = sound_model();
  const auto found = [&](int cells) {
    const Mesh mesh = make_box({{2, 2, 1}, {cells, cells, 2}, ElementType::hex8});
    return said(validity::coarse_contact, run_alone(mesh, model).result(), model);
  };
  CHECK(found(4).empty());
  model.contact[0] = {named("bottom"), Sphere{{1, 1, -5}, 5.0, {}}, {}};
  model.contact[0].name = "ball";
  model.boundary[0] = moved(named("top"), 3, {0, 0, -0.004});
  model.boundary.resize(1);
  CHECK(mentions(found(4), "ball: only 1 of 25 nodes bear its pressure"));
  CHECK(found(20).empty());
}

TEST_CASE("Tresca's friction on nodes that are open") {
  Model model = sound_model();
  model.boundary[1].traction = Vector3{5.0, 0, -20.0};
  model.contact[0].friction = Friction{1.0, 0.0};
  const auto found = [&] { return said(validity::open_friction, run_alone(block(), model).result(), model); };
  CHECK(found().empty());
  model.boundary[1].traction = Vector3{5.0, 0, 20.0};
  CHECK(mentions(found(), "contact[0].friction: 100 % of it acts at nodes without pressure"));
  model.contact[0].friction = Friction{0.0, 0.3};
  CHECK(found().empty());
}
