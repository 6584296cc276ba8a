// SPDX-License-Identifier: BSD-3-Clause
// Converts materials in case file syntax to laws of the C interface.
#include "laws.hpp"

#include <nlohmann/json.hpp>
#include <type_traits>
#include <variant>

#include "case/case_material.hpp"
#include "case/case_schema.hpp"
#include "case/json_node.hpp"

namespace kacanov::python {
namespace {

Law parse(const Node& node) {
  static const Schema schema = material_law_keys();
  check(node, schema);
  const Object material(node);
  std::vector<std::string> warnings;  // for tables whose first slope does not match the elastic constants
  Law law = parse_material_law(material, warnings);
  if (const auto bbar = material.optional("bbar")) law.mean_dilatation = bbar->boolean();
  return law;
}

void set_form(kacanov_law& c, const laws::Linear&) { c.kind = KACANOV_LINEAR; }
void set_form(kacanov_law& c, const laws::Logarithmic& form) {
  c.kind = KACANOV_LOGARITHMIC;
  c.x0 = form.x0;
}
void set_form(kacanov_law& c, const laws::LinearHardening& form) {
  c.kind = KACANOV_LINEAR_HARDENING;
  c.x0 = form.x0;
  c.gamma = form.gamma;
}
void set_form(kacanov_law& c, const laws::Power& form) {
  c.kind = KACANOV_POWER;
  c.x0 = form.x0;
  c.n = form.n;
}
void set_form(kacanov_law& c, const laws::Saturating& form) {
  c.kind = KACANOV_SATURATING;
  c.x0 = form.x0;
  c.q = form.q;
}
void set_form(kacanov_law& c, const laws::Table& form) {
  c.kind = KACANOV_TABLE;
  c.table_size = form.x.size();
  c.table_x = form.x.data();
  c.table_s = form.s.data();
}
void set_form(kacanov_law& c, const laws::RambergOsgood& form) {
  c.kind = KACANOV_RAMBERG_OSGOOD;
  c.x0 = form.x0;
  c.q = form.a;
  c.n = form.n;
}

kacanov_law c_law(const Law& law) {
  kacanov_law c{};
  c.struct_size = sizeof c;
  c.squared = law.argument == Law::Argument::squared ? 1 : 0;
  c.bulk = law.bulk;
  c.shear = law.shear;
  c.mean_dilatation = law.mean_dilatation ? 1 : 0;
  std::visit([&c](const auto& form) { set_form(c, form); }, law.form);
  return c;
}

}  // namespace

CLaws::CLaws(const std::string& json) {
  const nlohmann::json list = nlohmann::json::parse(json);
  for (std::size_t i = 0; i < list.size(); ++i)
    kept_.push_back(parse(Node(list[i], "law[" + std::to_string(i) + "]")));
  for (const Law& law : kept_) laws_.push_back(c_law(law));
}

}  // namespace kacanov::python
