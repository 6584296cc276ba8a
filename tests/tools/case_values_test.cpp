// SPDX-License-Identifier: BSD-3-Clause
// Values of a case file and their defaults arrive in the model.
#include <doctest/doctest.h>

#include <cmath>

#include "case_samples.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

Case changed(const std::vector<std::string>& changes) {
  nlohmann::json document = complete_case();
  for (const std::string& change : changes) apply_override(document, change);
  return parse_case(document, "folder");
}

Law law_of(const std::string& law) { return changed({"material[0].law=" + law}).model.materials[0].law; }

}  // namespace

TEST_CASE("load steps are a number or a list of factors") {
  const auto steps = [](const std::string& value) {
    return changed({"solver.load_steps=" + value}).model.solver.load_steps;
  };
  CHECK(changed({}).model.solver.load_steps.empty());
  CHECK(steps("1") == std::vector<double>{1.0});
  CHECK(steps("4") == std::vector<double>{0.25, 0.5, 0.75, 1.0});
  CHECK(steps("[0.1, 1.5, 1]") == std::vector<double>{0.1, 1.5, 1.0});
}

TEST_CASE("the element of a box is any of the table's, of its dimension") {
  for (const ElementType type : element_types()) {
    const bool flat = dimension(type) == 2;
    const nlohmann::json box{{"size", flat ? std::vector{2, 1} : std::vector{2, 1, 1}},
                             {"cells", flat ? std::vector{4, 2} : std::vector{4, 2, 2}},
                             {"element", std::string(cell(type).name)}};
    const nlohmann::json text{{"mesh", {{"box", box}}},
                              {"material", {{{"on", "all"}, {"young", 1}, {"poisson", 0}}}}};
    CHECK(parse_case(text, "folder").mesh.box->type == type);
  }
}

TEST_CASE("every entry of the sample arrives") {
  const Case input = changed({});
  REQUIRE(input.mesh.box.has_value());
  CHECK(input.mesh.box->type == ElementType::tet4);
  CHECK(input.mesh.box->cells == std::array<int, 3>{8, 2, 2});
  const Model& model = input.model;
  REQUIRE(model.materials.size() == 1);
  CHECK(std::get<laws::Logarithmic>(model.materials[0].law.form).x0 == 0.01);
  CHECK(model.materials[0].law.shear == doctest::Approx(1.0 / 2.6));
  CHECK(model.materials[0].law.bulk == doctest::Approx(1.0 / 1.2));
  REQUIRE(model.boundary.size() == 4);
  CHECK((*model.boundary[0].displacement)[0] == 0.0);
  CHECK_FALSE((*model.boundary[0].displacement)[1].has_value());
  CHECK(model.boundary[1].on.kind == Selector::Kind::box);
  CHECK(model.boundary[1].traction == Vector3{0.0, 0.0, -0.05});
  CHECK(model.boundary[2].pressure == 0.5);
  CHECK(model.boundary[3].on.kind == Selector::Kind::all);
  CHECK(model.boundary[3].body_force == Vector3{0.0, 0.0, -1.0});
  REQUIRE(model.contact.size() == 3);
  CHECK(std::get<Plane>(model.contact[0].obstacle).normal == Vector3{0.0, 0.0, 1.0});
  CHECK(model.contact[0].friction->tresca == 0.01);
  CHECK(std::get<Sphere>(model.contact[1].obstacle).radius == 2.0);
  CHECK(std::get<ConstantGap>(model.contact[2].obstacle).gap == -0.01);
  CHECK_FALSE(model.contact[2].friction.has_value());
  const SolverOptions& solver = model.solver;
  CHECK(solver.tolerance == 1e-7);
  CHECK(solver.outer == SolverOptions::Outer::kacanov);
  CHECK(solver.contact == SolverOptions::Contact::admm);
  CHECK(solver.penalty == SolverOptions::Penalty::fixed);
  CHECK(solver.r == 0.5);
  CHECK(solver.stop == SolverOptions::Stop::paper);
  CHECK(solver.max_outer == 50);
  CHECK(solver.max_contact == 100000);
  CHECK(solver.spectrum_tolerance == 1e-3);
  CHECK(solver.coarse_amg == 5000);
  CHECK(solver.relaxation == 1.5);
  CHECK(model.probes == std::vector<Vector3>{{4.0, 0.5, 1.0}});
  CHECK_FALSE(input.output.fields);
  CHECK_FALSE(input.output.report);
}

TEST_CASE("a short case has the defaults of the structs") {
  const Case input = parse_case(
      parse_json(R"({"mesh": {"file": "a.msh"}, "material": [{"on": "body", "young": 2, "poisson": 0}]})",
                 "x"),
      "cases");
  CHECK(input.mesh.file == "cases/a.msh");
  CHECK(input.model.materials[0].on.name == "body");
  CHECK(input.model.materials[0].law.linear());
  CHECK(input.model.boundary.empty());
  CHECK(input.model.solver.tolerance == SolverOptions().tolerance);
  CHECK(input.model.solver.penalty == SolverOptions::Penalty::automatic);
  CHECK(input.output.fields);
  CHECK(input.output.report);
  CHECK(input.output.scale == 0.0);
}

TEST_CASE("absolute mesh paths stay, relative ones are taken from the case's folder") {
  const auto with_file = [](const std::string& file) {
    return parse_case(nlohmann::json{{"mesh", {{"file", file}}},
                                     {"material", {{{"on", "all"}, {"young", 1}, {"poisson", 0}}}}},
                      "folder")
        .mesh.file;
  };
  CHECK(with_file("sub/a.msh") == "folder/sub/a.msh");
  CHECK(with_file("/tmp/a.msh") == "/tmp/a.msh");
}

TEST_CASE("a yield stress becomes the strain at which the norm of the deviator reaches it") {
  const double young = 1.0, mu = young / 2.6, stress = 0.02;
  const double norm = std::sqrt(2.0 / 3.0) * stress / (2.0 * mu);
  CHECK(law_of(R"({"type":"logarithmic","yield_stress":0.02})").yield_strain() ==
        doctest::Approx(norm).epsilon(1e-14));
  const Law squared = law_of(R"({"type":"saturating","yield_stress":0.02,"q":2,"argument":"squared"})");
  CHECK(squared.yield_strain() == doctest::Approx(norm).epsilon(1e-14));
  // Uniaxial stress sigma has ‖dev tau‖ = sqrt(2/3) sigma: the law yields exactly there.
  CHECK(squared.plastic(norm * 1.000001));
  CHECK_FALSE(squared.plastic(norm * 0.999999));
  CHECK(2.0 * squared.secant(norm) * norm == doctest::Approx(std::sqrt(2.0 / 3.0) * stress));
}

TEST_CASE("every law takes its own constants") {
  CHECK(law_of(R"({"type":"linear"})").linear());
  CHECK(std::get<laws::LinearHardening>(law_of(R"({"type":"linear_hardening","x0":0.01,"gamma":0.1})").form)
            .gamma == 0.1);
  CHECK(std::get<laws::Power>(law_of(R"({"type":"power","x0":0.01,"n":0.2})").form).n == 0.2);
  CHECK(std::get<laws::Saturating>(law_of(R"({"type":"saturating","x0":0.01,"q":3})").form).q == 3.0);
  const Law table = law_of(R"({"type":"table","points":[[0,0],[0.01,0.0076923],[0.1,0.02]]})");
  CHECK(std::get<laws::Table>(table.form).x == std::vector<double>{0.0, 0.01, 0.1});
  CHECK(table.secant(0.1) == doctest::Approx(0.1));
}

TEST_CASE("names, total forces, gravity and B-bar arrive") {
  const Case plain = changed({});
  CHECK(entry_name(plain.model.boundary[1], 1) == "boundary[1]");
  CHECK(entry_name(plain.model.contact[2], 2) == "contact[2]");
  CHECK_FALSE(plain.model.materials[0].bbar.has_value());
  const Case input = changed({"boundary[1].name=lid", "contact[0].name=floor", "material[0].bbar=false",
                              R"(boundary[2]={"on":"right","total_force":[1,2,3]})",
                              R"(boundary[3]={"on":"all","density":7.85e-9,"acceleration":[0,0,-9810]})"});
  const Model& model = input.model;
  CHECK(entry_name(model.boundary[1], 1) == "lid");
  CHECK(entry_name(model.contact[0], 0) == "floor");
  CHECK(model.materials[0].bbar == false);
  CHECK(model.boundary[2].total_force == Vector3{1, 2, 3});
  CHECK((*model.boundary[3].body_force)[2] == doctest::Approx(-7.85e-9 * 9810));
}

TEST_CASE("materials by tests in tension become laws") {
  const auto law = [](const std::string& keys) {
    return changed({"material[0]={\"on\":\"all\",\"young\":200,\"poisson\":0.3," + keys + "}"})
        .model.materials[0]
        .law;
  };
  const double mu = 200 / 2.6;
  const Law rows = law(R"("plastic":[[1,0],[2,0.1]])");
  CHECK(rows.yield_strain() == doctest::Approx(std::sqrt(2.0 / 3.0) / (2 * mu)));
  const double x = std::sqrt(2.0 / 3.0) * 2 / (2 * mu) + std::sqrt(1.5) * 0.1;
  CHECK(std::sqrt(1.5) * 2 * rows.secant(x) * x == doctest::Approx(2.0));
  CHECK(std::get<laws::LinearHardening>(law(R"("yield_stress":1,"tangent_modulus":2)").form).gamma ==
        doctest::Approx((400.0 / 198) / (400.0 / 198 + 3 * mu)));
  const Law ramberg = law(R"("law":{"type":"ramberg_osgood","sigma0":1,"alpha":0.5,"n":5})");
  CHECK(std::get<laws::RambergOsgood>(ramberg.form).a == doctest::Approx(3 * mu * 0.5 / 200));
}

TEST_CASE("a table that contradicts the elastic constants is warned of") {
  CHECK(changed({R"(material[0].law={"type":"table","points":[[0,0],[0.01,0.0077],[0.1,0.02]]})"})
            .warnings.empty());
  CHECK(changed({R"(material[0].law={"type":"table","points":[[0,0],[0.01,0.5],[0.1,0.6]]})"})
            .warnings.size() == 1);
}

TEST_CASE("overrides change, add and take any JSON value or a plain word") {
  const Case input =
      changed({"solver.tolerance=1e-9", "contact[0].friction.tresca=0.02", "contact[1].friction.tresca=0.5",
               "boundary[2].on=left", "probe=[[1,2,3],[4,5,6]]", "solver.r=auto"});
  CHECK(input.model.solver.tolerance == 1e-9);
  CHECK(input.model.contact[0].friction->tresca == 0.02);
  CHECK(input.model.contact[1].friction->tresca == 0.5);
  CHECK(input.model.boundary[2].on.name == "left");
  CHECK(input.model.probes.size() == 2);
  CHECK(input.model.solver.penalty == SolverOptions::Penalty::automatic);
}
