// SPDX-License-Identifier: BSD-3-Clause
// The `material` entries of a case: elastic constants and laws.
#include "case/case_material.hpp"

#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include <kacanov/error.hpp>
#include <kacanov/rules.hpp>

namespace kacanov {
namespace {

/// x0, or the yield stress it follows from: 2 mu x0 = sqrt(2/3) sigma_y for the norm.
double yield_strain(const Object& object, const Law& law) {
  if (object.only_one_of({"x0", "yield_stress"}) == "x0") return object.required("x0").number();
  const double stress = object.required("yield_stress").number(positive);
  const double norm = std::sqrt(2.0 / 3.0) * stress / (2.0 * law.shear);
  return law.argument == Law::Argument::squared ? norm * norm : norm;
}

laws::Table parse_table(const Node& node) {
  laws::Table table;
  for (const Node& point : node.list("a list of pairs [x, s] from [0, 0] on")) {
    const std::vector<Node> pair = point.list("a pair [x, s]");
    if (pair.size() != 2) point.expected("a pair [x, s]");
    table.x.push_back(pair[0].number());
    table.s.push_back(pair[1].number());
  }
  return table;
}

/// The keys of each form beside `type` and `argument`, and how it is read.
struct Entry {
  std::string_view name;
  Law::Form (*read)(const Node& node, const Law& law);
};

constexpr Entry law_entries[] = {
    {laws::Linear::name,
     [](const Node& node, const Law&) -> Law::Form {
       Object(node, {"type", "argument"});
       return laws::Linear{};
     }},
    {laws::Logarithmic::name,
     [](const Node& node, const Law& law) -> Law::Form {
       const Object object(node, {"type", "argument", "x0", "yield_stress"});
       return laws::Logarithmic{yield_strain(object, law)};
     }},
    {laws::LinearHardening::name,
     [](const Node& node, const Law& law) -> Law::Form {
       const Object object(node, {"type", "argument", "x0", "yield_stress", "gamma"});
       const double x0 = yield_strain(object, law);
       return laws::LinearHardening{x0, object.required("gamma").number()};
     }},
    {laws::Power::name,
     [](const Node& node, const Law& law) -> Law::Form {
       const Object object(node, {"type", "argument", "x0", "yield_stress", "n"});
       const double x0 = yield_strain(object, law);
       return laws::Power{x0, object.required("n").number()};
     }},
    {laws::Saturating::name,
     [](const Node& node, const Law& law) -> Law::Form {
       const Object object(node, {"type", "argument", "x0", "yield_stress", "q"});
       const double x0 = yield_strain(object, law);
       return laws::Saturating{x0, object.required("q").number()};
     }},
    {laws::Table::name,
     [](const Node& node, const Law&) -> Law::Form {
       const Object object(node, {"type", "argument", "points"});
       return parse_table(object.required("points"));
     }},
    {laws::RambergOsgood::name,
     [](const Node& node, const Law& law) -> Law::Form {
       const Object object(node, {"type", "sigma0", "alpha", "n"});
       const double sigma0 = object.required("sigma0").number(positive);
       const double alpha = object.required("alpha").number(positive);
       return ramberg_osgood(law, sigma0, alpha, object.required("n").number(above_one));
     }},
};
static_assert(std::size(law_entries) == std::variant_size_v<Law::Form>);

void compare_slopes(const Node& node, const Law& law, std::vector<std::string>& warnings) {
  const auto* table = std::get_if<laws::Table>(&law.form);
  if (table == nullptr || law.argument != Law::Argument::norm) return;
  const double elastic = 2.0 * law.shear, slope = table->s[1] / table->x[1];
  if (std::abs(slope - elastic) <= 0.01 * elastic) return;
  std::ostringstream text;
  text << node.path() << ".points: the table starts with the slope " << slope
       << ", young and poisson give 2 mu = " << elastic;
  warnings.push_back(text.str());
}

std::array<double, 2> parse_row(const Node& node) {
  const char* wanted = "a pair [stress, plastic strain]";
  const std::vector<Node> pair = node.list(wanted);
  if (pair.size() != 2) node.expected(wanted);
  return {pair[0].number(positive), pair[1].number(not_negative)};
}

}  // namespace

Law parse_plastic(double young, double poisson, const Node& node) {
  std::vector<std::array<double, 2>> rows;
  for (const Node& row : node.list("a list of pairs [stress, plastic strain]")) {
    const auto [stress, strain] = parse_row(row);
    if (rows.empty() && strain != 0.0) row.expected("a first plastic strain of 0");
    if (!rows.empty()) {
      const auto [last_stress, last_strain] = rows.back();
      if (!(strain > last_strain)) row.expected("a plastic strain above that of the row before");
      if (stress < last_stress)
        row.expected("a stress not below that of the row before: softening has no unique answer");
      if (last_strain > 0.0 && strain / stress < last_strain / last_stress)
        row.expected("a plastic strain over stress not below that of the row before");
    }
    rows.push_back({stress, strain});
  }
  if (rows.empty()) node.expected("at least one pair [stress, plastic strain]");
  Law law = elastic_law(young, poisson);
  law.form = plastic_table(law, rows);
  return law;
}

Law parse_bilinear(double young, double poisson, const Object& material) {
  const double yield_stress = material.required("yield_stress").number(positive);
  const Node tangent = material.required("tangent_modulus");
  const double modulus = tangent.number(positive);
  if (!(modulus < young)) tangent.expected("a number below young");
  Law law = elastic_law(young, poisson);
  law.form = bilinear(law, yield_stress, modulus);
  return law;
}

Law parse_law(double young, double poisson, const Node& node, std::vector<std::string>& warnings) {
  // Any law's key passes here, so that a wrong type is reported before keys that do not go with it.
  const Object any(
      node, {"type", "argument", "x0", "yield_stress", "gamma", "n", "q", "points", "sigma0", "alpha"});
  Law law = elastic_law(young, poisson);
  std::vector<std::string_view> names;
  for (const Entry& entry : law_entries) names.push_back(entry.name);
  const Entry& entry = law_entries[any.required("type").choice(names)];
  if (const auto argument = any.optional("argument")) {
    law.argument = argument->choice({"norm", "squared"}) == 0 ? Law::Argument::norm : Law::Argument::squared;
  }
  law.form = entry.read(node, law);
  if (const std::string fault = validate(law); !fault.empty()) throw InputError(node.path() + "." + fault);
  compare_slopes(node, law, warnings);
  return law;
}

Law parse_material_law(const Object& material, std::vector<std::string>& warnings) {
  const double young = material.required("young").number(positive);
  const double poisson = material.required("poisson").number(poisson_ratio);
  const std::string kind = material.at_most_one_of({"law", "plastic", "tangent_modulus"});
  if (const auto yield_stress = material.optional("yield_stress"); yield_stress && kind != "tangent_modulus")
    yield_stress->expected("this key beside tangent_modulus alone");
  if (kind == "law") return parse_law(young, poisson, material.required("law"), warnings);
  if (kind == "plastic") return parse_plastic(young, poisson, material.required("plastic"));
  if (kind == "tangent_modulus") return parse_bilinear(young, poisson, material);
  return elastic_law(young, poisson);
}

}  // namespace kacanov
