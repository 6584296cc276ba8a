// SPDX-License-Identifier: BSD-3-Clause
// From the laws of the C interface to ours, checked.
#include "c/laws.hpp"

#include <cmath>

namespace kacanov::c_api {
namespace {

struct Range {
  const char* name;
  double value, low, high;
  bool low_allowed;
  const char* expected;
};

void check(const Range& r, const std::string& where) {
  if (r.value <= r.high && (r.low_allowed ? r.value >= r.low : r.value > r.low)) return;
  throw Fault(KACANOV_ERROR_LAW,
              where + r.name + ": expected " + r.expected + ", got " + std::to_string(r.value));
}

void check_positive(const char* name, double value, const std::string& where) {
  check({name, value, 0.0, 1e300, false, "a finite number > 0"}, where);
}

void take_table(const kacanov_law& from, const std::string& where, Law& law) {
  const auto fault = [&](const std::string& text) { throw Fault(KACANOV_ERROR_LAW, where + text); };
  if (from.table_x == nullptr || from.table_s == nullptr)
    throw Fault(KACANOV_ERROR_NULL, where + "table_x, table_s: null pointer");
  if (from.table_size < 2) fault("table_size: expected at least 2 points, the first (0, 0)");
  law.table_x.assign(from.table_x, from.table_x + from.table_size);
  law.table_s.assign(from.table_s, from.table_s + from.table_size);
  if (law.table_x[0] != 0.0 || law.table_s[0] != 0.0) fault("table: the first point has to be (0, 0)");
  for (std::size_t i = 1; i < from.table_size; ++i) {
    const double x = law.table_x[i], s = law.table_s[i], x_before = law.table_x[i - 1],
                 s_before = law.table_s[i - 1];
    if (!std::isfinite(x) || !std::isfinite(s) || x <= x_before || s < s_before || s <= 0.0)
      fault("table: point " + std::to_string(i) +
            " has to be finite, beyond the one before in x and not below it in s");
    if (i > 1 && s * x_before > s_before * x * (1.0 + 1e-12))
      fault("table: the secant s/x rises at point " + std::to_string(i));
  }
}

Law checked_law(const kacanov_law& from, const std::string& where) {
  if (from.kind < KACANOV_LINEAR || from.kind > KACANOV_TABLE)
    throw Fault(KACANOV_ERROR_LAW, where + "kind: there is no law " + std::to_string(from.kind));
  if (from.squared != 0 && from.squared != 1)
    throw Fault(KACANOV_ERROR_LAW, where + "squared: expected 0 or 1");
  if (from.mean_dilatation != 0 && from.mean_dilatation != 1)
    throw Fault(KACANOV_ERROR_LAW, where + "mean_dilatation: expected 0 or 1");
  check_positive("bulk", from.bulk, where);
  check_positive("shear", from.shear, where);

  Law law;
  law.argument = from.squared != 0 ? Law::Argument::squared : Law::Argument::norm;
  law.mean_dilatation = from.mean_dilatation != 0;
  law.bulk = from.bulk;
  law.shear = from.shear;
  if (from.kind != KACANOV_LINEAR && from.kind != KACANOV_TABLE) {
    check_positive("x0", from.x0, where);
    law.x0 = from.x0;
  }
  switch (static_cast<kacanov_law_kind>(from.kind)) {
    case KACANOV_LINEAR: law.kind = Law::Kind::linear; break;
    case KACANOV_LOGARITHMIC: law.kind = Law::Kind::logarithmic; break;
    case KACANOV_LINEAR_HARDENING:
      law.kind = Law::Kind::linear_hardening;
      check({"gamma", from.gamma, 0.0, 1.0, true, "a number in [0, 1]"}, where);
      law.gamma = from.gamma;
      break;
    case KACANOV_POWER:
      law.kind = Law::Kind::power;
      check({"n", from.n, 0.0, 1.0, false, "a number in (0, 1]"}, where);
      law.n = from.n;
      break;
    case KACANOV_SATURATING:
      law.kind = Law::Kind::saturating;
      check_positive("q", from.q, where);
      law.q = from.q;
      break;
    case KACANOV_TABLE:
      law.kind = Law::Kind::table;
      take_table(from, where, law);
      break;
  }
  return law;
}

}  // namespace

std::vector<Law> checked_laws(std::span<const kacanov_law> laws) {
  if (laws.size() > 65536)
    throw Fault(KACANOV_ERROR_SIZE, "laws: at most 65536, the range of law_of_element");
  std::vector<Law> out;
  out.reserve(laws.size());
  for (std::size_t i = 0; i < laws.size(); ++i)
    out.push_back(checked_law(laws[i], "law[" + std::to_string(i) + "]."));
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
