// SPDX-License-Identifier: BSD-3-Clause
// Laws of the C interface: checks, conversion to Law, and values of user-defined ones from their callbacks.
#include "c/laws.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "c/handle.hpp"
#include "c/sized.hpp"
#include "operator/threads.hpp"

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

namespace kacanov::c_api {
namespace {

/// Number of points per batch: its arrays fit in a core's own cache.
constexpr std::size_t most_points = 4096;

/// The points of the elements of one law, numbered from 0.
class PointsOfLaw {
 public:
  PointsOfLaw(const kacanov_operator& op, std::size_t law)
      : all_(op.law_of_element.empty()), points_(points_per_element(op.mesh.type)) {
    count_ = op.mesh.element_count();
    if (all_) return;
    for (std::size_t e = 0; e < count_; ++e)
      if (op.law_of_element[e] == law) elements_.push_back(static_cast<std::int32_t>(e));
    count_ = elements_.size();
  }
  std::size_t size() const { return count_ * points_; }
  std::int32_t element(std::size_t k) const {
    return all_ ? static_cast<std::int32_t>(k / points_) : elements_[k / points_];
  }
  std::int32_t point(std::size_t k) const { return static_cast<std::int32_t>(k % points_); }
  /// Index among the points of all elements.
  std::size_t place(std::size_t k) const { return element(k) * points_ + k % points_; }

 private:
  bool all_;
  std::size_t points_, count_;
  std::vector<std::int32_t> elements_;
};

/// The arrays of one callback call.
struct Batch {
  std::vector<double> x, g, slope, energy;
  std::vector<std::int32_t> element, point;
};

std::string name(std::size_t law) { return "law[" + std::to_string(law) + "].evaluate: "; }

void check(const Batch& batch, std::size_t law, const PointValues& wanted) {
  for (std::size_t i = 0; i < batch.x.size(); ++i) {
    const auto refuse = [&](const char* what, double got, const char* expected) {
      throw Fault(KACANOV_ERROR_LAW, name(law) + what + " is " + std::to_string(got) + " at element " +
                                         std::to_string(batch.element[i]) + ", point " +
                                         std::to_string(batch.point[i]) + ": expected " + expected);
    };
    if (!(batch.g[i] > 0.0) || !std::isfinite(batch.g[i])) refuse("g", batch.g[i], "a number > 0");
    if (!wanted.derivative.empty() && !std::isfinite(batch.slope[i]))
      refuse("slope", batch.slope[i], "a number");
    if (!wanted.energy.empty() && !std::isfinite(batch.energy[i]))
      refuse("energy", batch.energy[i], "a number");
  }
}

struct PointRange {
  std::size_t begin, count;
};

/// Calls the callback of a law for a range of its points.
void ask(const OwnLaw& own, std::size_t law, const PointsOfLaw& points, PointRange range,
         PointValues& values) {
  const auto [begin, count] = range;
  Batch batch;
  for (auto* array : {&batch.x, &batch.g}) array->resize(count);
  batch.element.resize(count), batch.point.resize(count);
  if (!values.derivative.empty()) batch.slope.resize(count);
  if (!values.energy.empty()) batch.energy.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    batch.x[i] = values.x[points.place(begin + i)];
    batch.element[i] = points.element(begin + i);
    batch.point[i] = points.point(begin + i);
  }
  kacanov_law_points seen{};
  seen.struct_size = sizeof seen;
  seen.count = count;
  seen.x = batch.x.data();
  seen.element = batch.element.data();
  seen.point = batch.point.data();
  seen.g = batch.g.data();
  seen.slope = batch.slope.empty() ? nullptr : batch.slope.data();
  seen.energy = batch.energy.empty() ? nullptr : batch.energy.data();
  if (const int code = own.evaluate(own.data, &seen); code != 0)
    throw Fault(KACANOV_ERROR_LAW, name(law) + "the callback returned " + std::to_string(code));
  check(batch, law, values);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = points.place(begin + i);
    values.secant[at] = batch.g[i];
    if (!batch.slope.empty()) values.derivative[at] = batch.slope[i];
    if (!batch.energy.empty()) values.energy[at] = batch.energy[i];
  }
}

void ask_own(const kacanov_operator& op, std::size_t law, const PointsOfLaw& points, PointValues& values) {
  const OwnLaw& own = op.own_laws[law];
  const std::size_t batches = (points.size() + most_points - 1) / most_points;
  const auto ask_some = [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b)
      ask(own, law, points, {b * most_points, std::min(most_points, points.size() - b * most_points)},
          values);
  };
  const std::size_t threads = op.options.threads;
  if (!own.parallel || threads == 1 || batches < 2) return ask_some(0, batches);
  in_team(op.options.threads, [&](int t) {
    const std::size_t share = t;
    ask_some(batches * share / threads, batches * (share + 1) / threads);
  });
}

void ask_built_in(const kacanov_operator& op, std::size_t law, const PointsOfLaw& points,
                  PointValues& values) {
  const Law& of = op.laws[law];
  in_shares(op.options.threads, points.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t at = points.place(k);
      const Moduli moduli = of.moduli(values.x[at]);
      values.secant[at] = moduli.secant;
      if (!values.derivative.empty()) values.derivative[at] = moduli.derivative;
      if (!values.energy.empty()) values.energy[at] = of.energy(values.x[at]);
    }
  });
}

}  // namespace

PointValues ask_laws(kacanov_operator& op, std::span<const double> u, WantedValues wanted) {
  const std::size_t count = op.body().secant_count();
  PointValues values;
  values.x.resize(count), values.secant.resize(count);
  if (wanted.derivative) values.derivative.resize(count);
  if (wanted.energy) values.energy.resize(count);
  op.fast->strain(u, values.x);
  for (std::size_t law = 0; law < op.laws.size(); ++law) {
    const PointsOfLaw points(op, law);
    if (op.law_of_element.empty() && law > 0) break;
    if (op.own_laws[law].evaluate != nullptr)
      ask_own(op, law, points, values);
    else
      ask_built_in(op, law, points, values);
  }
  return values;
}

}  // namespace kacanov::c_api
