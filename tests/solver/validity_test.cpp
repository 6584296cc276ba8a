// SPDX-License-Identifier: BSD-3-Clause
// What looks mistaken is said, check by check; what does not is not.
#include <doctest/doctest.h>

#include "support.hpp"
#include "validity/checks.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// Steel in N and mm, held on the left and pressed on a floor.
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
  model.boundary[1].traction = Vector3{0, 0, -20e3};  // kN for N
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
  const auto found = [&] { return said(validity::looking_away, build_problem(block(), model), model); };
  CHECK(found().empty());
  model.contact[0].obstacle = Plane{{0, 0, 0}, {0, 0, -1}};
  CHECK(mentions(found(), "contact[0]: 16 of its 16 facets look away from the obstacle"));
  model.contact[0].obstacle = Sphere{{1, 0.5, -3}, 3.0, {}};
  CHECK(found().empty());
  model.contact[0].obstacle = Sphere{{1, 0.5, -3}, 3.0, Vector3{0, 0, 1}};
  CHECK(mentions(found(), "look away"));
  CHECK(mentions(likely_cause({"something else", found()}), "look away"));
  CHECK(likely_cause({"something else"}).empty());
  // All of the boundary: the gap tells.
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
  // 0.45 is on the one side of the bound, whatever the units.
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
  const auto flow = [&] { return said(validity::locked_flow, result, model); };
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
  const auto found = [&] { return said(validity::idle_contact, run_alone(block(), model).result(), model); };
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
