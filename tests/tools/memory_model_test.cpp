// SPDX-License-Identifier: BSD-3-Clause
// The memory model: its terms against the sizes of the arrays.
#include <doctest/doctest.h>

#include <kacanov/operator.hpp>
#include <kacanov/part.hpp>
#include "program/memory_model.hpp"

using namespace kacanov;

namespace {

template <class... Arrays>
double bytes_of(const Arrays&... arrays) {
  return (0.0 + ... + static_cast<double>(sizeof(arrays[0]) * arrays.size()));
}

/// A body fixed at one end.
Model clamped() {
  Model model;
  MaterialEntry all;
  all.law = elastic_law(1.0, 0.3);
  model.materials.push_back(all);
  BoundaryEntry left;
  left.on.kind = Selector::Kind::name;
  left.on.name = "left";
  left.displacement = {0.0, 0.0, 0.0};
  model.boundary.push_back(left);
  return model;
}

/// A box large enough for its surface not to matter.
BoxSpec box_of(ElementType type) {
  const int n = dimension(type) == 2 ? 100 : type == ElementType::tet10 ? 12 : 24;
  return {{1, 1, 1}, {n, n, n}, type};
}

}  // namespace

TEST_CASE("mesh, problem and part: byte by byte") {
  for (const ElementType type :
       {ElementType::tri3, ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    CAPTURE(static_cast<int>(type));
    const Model model = clamped();
    const Problem problem = build_problem(make_box(box_of(type)), model);
    const MemoryShares shares = memory_shares(size_of(problem.mesh, model));
    CHECK(shares.mesh == bytes_of(problem.mesh.coordinates, problem.mesh.elements));
    CHECK(shares.problem == bytes_of(problem.load, problem.prescribed, problem.held, problem.law_of_element));
    split(problem, 1, [&](int, Part&& part) {
      CHECK(shares.part == bytes_of(part.coordinates, part.node_index, part.held, part.elements));
    });
  }
}

TEST_CASE("operators and tangent within a fifth: what they fill of their lanes depends on the mesh") {
  for (const ElementType type :
       {ElementType::tri3, ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    CAPTURE(static_cast<int>(type));
    const Model model = clamped();
    const Problem problem = build_problem(make_box(box_of(type)), model);
    ProblemSize size = size_of(problem.mesh, model);
    CHECK(!size.nonlinear);
    CHECK(memory_shares(size).tangent == 0.0);
    size.nonlinear = true;
    const MemoryShares shares = memory_shares(size);
    const Body body{{type, problem.mesh.coordinates, problem.mesh.elements}, problem.laws, {}};
    Operator exact(body);
    const FloatOperator rough(body);
    const double frozen = static_cast<double>(exact.bytes());
    CHECK(frozen + static_cast<double>(rough.bytes()) == doctest::Approx(shares.operators).epsilon(0.2));
    exact.update_tangent(std::vector<double>(exact.unknowns(), 0.0));
    CHECK(static_cast<double>(exact.bytes()) - frozen == doctest::Approx(shares.tangent).epsilon(0.2));
  }
}

TEST_CASE("the box of a case file has the size of the mesh that is made of it") {
  for (const ElementType type :
       {ElementType::tri3, ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    CAPTURE(static_cast<int>(type));
    const Model model = clamped();
    const ProblemSize foreseen = size_of(box_of(type), model), made = size_of(make_box(box_of(type)), model);
    CHECK(foreseen.nodes == made.nodes);
    CHECK(foreseen.elements == made.elements);
  }
}

TEST_CASE("pressures of tetrahedra take memory, and hexahedra have none beside their displacements") {
  Model plain = clamped(), mixed = clamped();
  mixed.materials[0].formulation = MaterialEntry::Formulation::mixed;
  for (const ElementType type : {ElementType::tet4, ElementType::tet10, ElementType::hex8}) {
    const bool tetrahedra = type != ElementType::hex8;
    const double more =
        estimated_memory(size_of(box_of(type), mixed), 1) - estimated_memory(size_of(box_of(type), plain), 1);
    CHECK((more > 0.0) == tetrahedra);
    CHECK(size_of(make_box(box_of(type)), mixed).pressures == tetrahedra);
  }
}

TEST_CASE("hexahedra that average and yield may come to have pressures, as the case says") {
  Model model = clamped();
  CHECK_FALSE(size_of(box_of(ElementType::hex8), model).may_flow);
  model.materials[0].law.form = laws::Logarithmic{0.01};
  const ProblemSize size = size_of(box_of(ElementType::hex8), model);
  CHECK(size.may_flow);
  CHECK_FALSE(size.pressures);
  CHECK(memory_shares(flowing(size)).multigrid > memory_shares(size).multigrid);
  for (const ElementType type : {ElementType::tet4, ElementType::tet10, ElementType::quad4})
    CHECK_FALSE(size_of(box_of(type), model).may_flow);
  model.materials[0].bbar = false;
  CHECK_FALSE(size_of(box_of(ElementType::hex8), model).may_flow);
  model.materials[0].bbar.reset();
  model.materials[0].formulation = MaterialEntry::Formulation::displacement;
  CHECK_FALSE(size_of(box_of(ElementType::hex8), model).may_flow);
}

TEST_CASE("a run that would not fit if it flowed is told so, and not refused") {
  Model model = clamped();
  model.materials[0].law.form = laws::Logarithmic{0.01};
  ProblemSize size = size_of(BoxSpec{{1, 1, 1}, {100, 100, 100}, ElementType::hex8}, model);
  CHECK_FALSE(may_outgrow(size, 1, 1));
  const double available = available_memory();
  REQUIRE(available > 0.0);
  // Needs a tenth less than the available memory.
  const double factor = 0.9 * available / estimated_memory(size, 1);
  size.nodes *= factor, size.elements *= factor;
  CHECK_NOTHROW(refuse_what_cannot_fit(size, 1, 1));
  CHECK(may_outgrow(size, 1, 1));
  CHECK(outgrown_memory_message(size, 1, 1).find("are available") != std::string::npos);
  size.may_flow = false;
  CHECK_FALSE(may_outgrow(size, 1, 1));
}

TEST_CASE("the estimate is the largest sum at one time, and each rank adds what a process takes") {
  ProblemSize size;
  size.nodes = 1e6;
  size.elements = 5.8e6;
  const auto alone = [&](bool nonlinear) {
    size.nonlinear = nonlinear;
    return estimated_memory(size, 1);
  };
  const MemoryShares shares = memory_shares(size);
  const double solving = shares.part + shares.operators + shares.loops + shares.multigrid;
  CHECK(alone(true) > solving + shares.step + shares.tangent);
  CHECK(alone(true) < 1.1 * (solving + shares.step + shares.tangent + shares.setup));
  CHECK(alone(false) < alone(true));
  const double one = estimated_memory(size, 1), two = estimated_memory(size, 2),
               four = estimated_memory(size, 4);
  CHECK(two > one);
  CHECK(four > two);
  // Distribution needs the mesh beside one part; the solve is divided among the ranks without duplicates.
  CHECK(four < 2.0 * one);
  size.nodes *= 2.0;
  size.elements *= 2.0;
  CHECK(estimated_memory(size, 1) == doctest::Approx(2.0 * one).epsilon(0.05));
}
