// SPDX-License-Identifier: BSD-3-Clause
// Parses the `material` entries of a case: elastic constants and laws.
#include "case/case_material.hpp"

#include <array>
#include <cmath>
#include <utility>

#include <kacanov/error.hpp>
#include <kacanov/model.hpp>
#include "case/case_schema.hpp"
#include "case/case_words.hpp"
#include "mesh/classic_locale_stream.hpp"

namespace kacanov {
namespace {

/// Returns x0, given or from the yield stress: 2 mu x0 = sqrt(2/3) sigma_y for the norm.
double yield_strain(const Object& object, const Law& law) {
  if (const auto x0 = object.optional("x0")) return x0->number();
  const double stress = object.required("yield_stress").number();
  const double norm = std::sqrt(2.0 / 3.0) * stress / (2.0 * law.shear);
  return law.argument == Law::Argument::squared ? norm * norm : norm;
}

laws::Table parse_table(const Object& object) {
  laws::Table table;
  for (const Node& point : object.required("points").entries()) {
    const std::vector<Node> pair = point.entries();
    table.x.push_back(pair[0].number());
    table.s.push_back(pair[1].number());
  }
  return table;
}

/// A form of law: its keys beside `type`, and its parser.
struct LawEntry {
  std::string_view name;
  KeySet (*keys)();
  Law::Form (*read)(const Object& object, const Law& law);
};

Key argument_key() {
  return may("argument", one_of(words::argument), "whether formulas take x = ‖dev ε‖ or x²",
             word_of(Law().argument, words::argument));
}

/// Keys of a form that starts at x0.
KeySet from_x0(std::vector<Key> more = {}) {
  KeySet set{{argument_key(), may("x0", Number{positive}, "‖dev ε‖ up to which the body is elastic"),
              may("yield_stress", Number{positive}, "the yield stress in tension, in place of x0")},
             {{{"x0", "yield_stress"}}}};
  set.keys.insert(set.keys.end(), more.begin(), more.end());
  return set;
}

KeySet of_table() {
  const char* expected = "a list of pairs [x, s] from [0, 0] on";
  const Schema points =
      ListOf{Tuple{{Number{}, Number{}}, "a pair [x, s]"}, expected, 2, ListOf::any_number, expected};
  return {{argument_key(), must("points", points, "pairs of x = ‖dev ε‖ and s = ‖dev τ‖, from [0, 0] on")}};
}

constexpr LawEntry law_entries[] = {
    {laws::Linear::name, [] { return KeySet{{argument_key()}}; },
     [](const Object&, const Law&) -> Law::Form { return laws::Linear{}; }},
    {laws::Logarithmic::name, [] { return from_x0(); },
     [](const Object& object, const Law& law) -> Law::Form {
       return laws::Logarithmic{yield_strain(object, law)};
     }},
    {laws::LinearHardening::name,
     [] { return from_x0({must("gamma", Number{up_to_one}, "tangent over elastic modulus")}); },
     [](const Object& object, const Law& law) -> Law::Form {
       return laws::LinearHardening{yield_strain(object, law), object.required("gamma").number()};
     }},
    {laws::Power::name, [] { return from_x0({must("n", Number{up_to_one}, "the exponent")}); },
     [](const Object& object, const Law& law) -> Law::Form {
       return laws::Power{yield_strain(object, law), object.required("n").number()};
     }},
    {laws::Saturating::name,
     [] { return from_x0({must("q", Number{positive}, "what stress may gain beyond x0, over that at x0")}); },
     [](const Object& object, const Law& law) -> Law::Form {
       return laws::Saturating{yield_strain(object, law), object.required("q").number()};
     }},
    {laws::Table::name, of_table,
     [](const Object& object, const Law&) -> Law::Form { return parse_table(object); }},
    {laws::RambergOsgood::name,
     [] {
       return KeySet{{must("sigma0", Number{positive}, "σ₀, a stress"),
                      must("alpha", Number{positive}, "α, what at σ₀ the plastic is to the elastic strain"),
                      must("n", Number{above_one}, "the exponent")}};
     },
     [](const Object& object, const Law& law) -> Law::Form {
       return ramberg_osgood(law, object.required("sigma0").number(), object.required("alpha").number(),
                             object.required("n").number());
     }},
};
static_assert(std::size(law_entries) == std::variant_size_v<Law::Form>);

Schema law_schema() {
  Kinds kinds{"type", {}};
  for (const LawEntry& entry : law_entries) {
    KeySet set = entry.keys();
    set.keys.insert(set.keys.begin(), must("type", Word{{std::string(entry.name)}}, "the form of the law"));
    kinds.kinds.emplace_back(entry.name, std::move(set));
  }
  return kinds;
}

void compare_slopes(const Node& node, const Law& law, std::vector<std::string>& warnings) {
  const auto* table = std::get_if<laws::Table>(&law.form);
  if (table == nullptr || law.argument != Law::Argument::norm) return;
  const double elastic = 2.0 * law.shear, slope = table->s[1] / table->x[1];
  if (std::abs(slope - elastic) <= 0.01 * elastic) return;
  PlainText text;
  text << node.path() << ".points: the table starts with the slope " << slope
       << ", young and poisson give 2 mu = " << elastic;
  warnings.push_back(text.str());
}

/// Strains above 1 violate the small-strain assumption and are usually percentages.
void ask_for_per_cent(const std::string& path, double strain, std::vector<std::string>& warnings) {
  if (!(strain > 1.0)) return;
  PlainText text;
  text << path << ": strains above 1, up to " << strain
       << ": are they per cent? A strain of 1 per cent is written 0.01";
  warnings.push_back(text.str());
}

}  // namespace

KeySet material_law_keys() {
  const Schema row = Tuple{{Number{positive}, Number{not_negative}}, "a pair [stress, plastic strain]"};
  const Schema rows = ListOf{row, "a list of pairs [stress, plastic strain]", 1, ListOf::any_number,
                             "at least one pair [stress, plastic strain]"};
  return {{must("young", Number{positive}, "Young's modulus, a stress"),
           must("poisson", Number{poisson_ratio}, "Poisson's ratio"),
           may("law", law_schema(), "another law than linear elasticity"),
           may("plastic", rows, "rows of true stress and plastic strain in tension, the first strain 0"),
           may("yield_stress", Number{positive}, "in tension, beside tangent_modulus"),
           may("tangent_modulus", Number{positive}, "beyond the yield stress, a stress below young"),
           may("bbar", Flag{},
               "hex8 and quad4: the bulk modulus acts on the mean volumetric strain of each element")},
          {{{"law", "plastic", "tangent_modulus"}, false}},
          {{"yield_stress", "tangent_modulus", true}}};
}

Law parse_plastic(double young, double poisson, const Node& node) {
  std::vector<std::array<double, 2>> rows;
  for (const Node& row : node.entries()) {
    const std::vector<Node> pair = row.entries();
    const double stress = pair[0].number(), strain = pair[1].number();
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
  Law law = elastic_law(young, poisson);
  law.form = plastic_table(law, rows);
  return law;
}

Law parse_bilinear(double young, double poisson, const Object& material) {
  const double yield_stress = material.required("yield_stress").number();
  const Node tangent = material.required("tangent_modulus");
  const double modulus = tangent.number();
  if (!(modulus < young)) tangent.expected("a number below young");
  Law law = elastic_law(young, poisson);
  law.form = bilinear(law, yield_stress, modulus);
  return law;
}

Law parse_law(double young, double poisson, const Node& node, std::vector<std::string>& warnings) {
  const Object object(node);
  Law law = elastic_law(young, poisson);
  if (const auto argument = object.optional("argument")) law.argument = value_of(*argument, words::argument);
  const std::string type = object.required("type").text();
  for (const LawEntry& entry : law_entries)
    if (entry.name == type) law.form = entry.read(object, law);
  if (const std::string fault = validate(law); !fault.empty()) throw InputError(node.path() + "." + fault);
  compare_slopes(node, law, warnings);
  if (const auto* table = std::get_if<laws::Table>(&law.form)) {
    const double last = table->x.back();
    ask_for_per_cent(node.path() + ".points", law.argument == Law::Argument::squared ? std::sqrt(last) : last,
                     warnings);
  }
  return law;
}

Law parse_material_law(const Object& material, std::vector<std::string>& warnings) {
  const double young = material.required("young").number();
  const double poisson = material.required("poisson").number();
  if (const auto law = material.optional("law")) return parse_law(young, poisson, *law, warnings);
  if (const auto plastic = material.optional("plastic")) {
    Law law = parse_plastic(young, poisson, *plastic);
    ask_for_per_cent(plastic->path(), plastic->entries().back().entries()[1].number(), warnings);
    return law;
  }
  if (material.optional("tangent_modulus")) return parse_bilinear(young, poisson, material);
  return elastic_law(young, poisson);
}

}  // namespace kacanov
