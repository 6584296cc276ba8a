// SPDX-License-Identifier: BSD-3-Clause
// Checks laws of the C interface and converts them to Law.
#include "c/laws.hpp"

#include <cstdint>

#include "c/sized.hpp"

namespace kacanov::c_api {
namespace {

laws::Table table_of(const kacanov_law& from, const std::string& where) {
  if (from.table_x == nullptr || from.table_s == nullptr)
    throw Fault(KACANOV_ERROR_NULL, where + "table_x, table_s: null pointer");
  return {{from.table_x, from.table_x + from.table_size}, {from.table_s, from.table_s + from.table_size}};
}

Law::Form form_of(const kacanov_law& from, const std::string& where) {
  switch (static_cast<kacanov_law_kind>(from.kind)) {
    case KACANOV_LINEAR: return laws::Linear{};
    case KACANOV_LOGARITHMIC: return laws::Logarithmic{from.x0};
    case KACANOV_LINEAR_HARDENING: return laws::LinearHardening{from.x0, from.gamma};
    case KACANOV_POWER: return laws::Power{from.x0, from.n};
    case KACANOV_SATURATING: return laws::Saturating{from.x0, from.q};
    case KACANOV_TABLE: return table_of(from, where);
    case KACANOV_RAMBERG_OSGOOD: return laws::RambergOsgood{from.x0, from.q, from.n};
    case KACANOV_USER: return laws::Linear{};  // until the callback is called
  }
  throw Fault(KACANOV_ERROR_LAW, where + "kind: there is no law " + std::to_string(from.kind));
}

void check_own(const kacanov_law& from, const std::string& where) {
  if (from.kind != KACANOV_USER) {
    if (from.evaluate != nullptr) throw Fault(KACANOV_ERROR_LAW, where + "evaluate: is for KACANOV_USER");
    return;
  }
  if (from.evaluate == nullptr) throw Fault(KACANOV_ERROR_NULL, where + "evaluate: null pointer");
  if (from.squared != 0) throw Fault(KACANOV_ERROR_LAW, where + "squared: expected 0 for KACANOV_USER");
  if (from.reserved_user != 0) throw Fault(KACANOV_ERROR_LAW, where + "reserved_user: expected 0");
  if (from.parallel != 0 && from.parallel != 1)
    throw Fault(KACANOV_ERROR_LAW, where + "parallel: expected 0 or 1");
  if (!(from.x0 >= 0.0)) throw Fault(KACANOV_ERROR_LAW, where + "x0: expected a number >= 0");
}

Law checked_law(const kacanov_law& from, const std::string& where) {
  if (from.squared != 0 && from.squared != 1)
    throw Fault(KACANOV_ERROR_LAW, where + "squared: expected 0 or 1");
  if (from.mean_dilatation != 0 && from.mean_dilatation != 1)
    throw Fault(KACANOV_ERROR_LAW, where + "mean_dilatation: expected 0 or 1");
  check_own(from, where);
  if (from.reserved != 0) throw Fault(KACANOV_ERROR_LAW, where + "reserved: expected 0");
  Law law;
  law.form = form_of(from, where);
  law.argument = from.squared != 0 ? Law::Argument::squared : Law::Argument::norm;
  law.mean_dilatation = from.mean_dilatation != 0;
  law.bulk = from.bulk;
  law.shear = from.shear;
  if (const std::string fault = validate(law); !fault.empty()) throw Fault(KACANOV_ERROR_LAW, where + fault);
  return law;
}

}  // namespace

std::vector<Law> checked_laws(std::size_t count, const kacanov_law* laws) {
  if (count > 65536) throw Fault(KACANOV_ERROR_SIZE, "laws: at most 65536, the range of law_of_element");
  const std::size_t stride = laws->struct_size;
  const auto* at = reinterpret_cast<const unsigned char*>(laws);
  std::vector<Law> out;
  out.reserve(count);
  for (std::size_t i = 0; i < count; ++i, at += stride) {
    const std::string where = "law[" + std::to_string(i) + "].";
    const auto law = read_sized<kacanov_law>(at, law_bytes, where, "kacanov_law");
    if (std::size_t size = 0; std::memcpy(&size, at, sizeof size), size != stride)
      throw Fault(KACANOV_ERROR_SIZE, where + "struct_size: differs from that of law[0]");
    out.push_back(checked_law(law, where));
  }
  return out;
}

std::vector<OwnLaw> own_laws(std::size_t count, const kacanov_law* laws) {
  const auto* at = reinterpret_cast<const unsigned char*>(laws);
  std::vector<OwnLaw> out;
  for (std::size_t i = 0; i < count; ++i, at += laws->struct_size) {
    const auto law = read_sized<kacanov_law>(at, law_bytes, "", "kacanov_law");
    out.push_back({law.evaluate, law.data, law.parallel != 0, law.x0});
  }
  return out;
}

void check_law_of_element(std::span<const std::uint16_t> law_of_element, std::size_t laws) {
  for (std::size_t e = 0; e < law_of_element.size(); ++e)
    if (law_of_element[e] >= laws)
      throw Fault(KACANOV_ERROR_LAW, "law_of_element[" + std::to_string(e) + "]: there is no law " +
                                         std::to_string(law_of_element[e]) + ", there are " +
                                         std::to_string(laws));
}

}  // namespace kacanov::c_api
