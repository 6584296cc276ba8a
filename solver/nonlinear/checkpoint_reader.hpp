// SPDX-License-Identifier: BSD-3-Clause
// Numbers, fields and the history of load steps of a checkpoint.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <kacanov/checkpoint.hpp>
#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// Hands what the first rank has in a checkpoint to all. What is missing there, or out of range, that rank
/// throws as InputError. Members are collective.
class CheckpointReader {
 public:
  /// `from`: on the first rank.
  CheckpointReader(const Part& part, const Checkpoint* from);

  template <class Value>
  void operator()(const std::string& name, Value& value) const {
    // Counts beyond what the others hold could not be added to.
    constexpr std::int64_t most = std::int64_t{1} << (sizeof(Value) == 4 ? 30 : sizeof(Value) == 1 ? 0 : 50);
    value = static_cast<Value>(shared(name, std::is_integral_v<Value> ? most : 0));
  }
  template <class Value>
  Value number(const std::string& name) const {
    Value value{};
    (*this)(name, value);
    return value;
  }
  /// A whole number up to `most`.
  std::size_t length(const std::string& name, std::int64_t most) const;
  /// A number within these bounds.
  double within(const std::string& name, double least, double most) const;
  /// The same on all ranks.
  std::vector<double> values(const std::string& name, std::size_t entries) const;
  /// This rank's entries; all are finite.
  std::vector<double> contact(const std::string& name, int components) const;
  std::vector<double> nodal(const std::string& name) const;
  std::vector<double> elements(const std::string& name, int each) const;
  /// `travels`: of pushed obstacles, per load step.
  std::vector<LoadStep> load_steps(const std::string& name, std::size_t steps, std::size_t travels = 0) const;

 protected:
  const Part& part_;

 private:
  double shared(const std::string& name, std::int64_t most) const;
  std::vector<double> finite(const std::string& name, std::size_t entries) const;

  const Checkpoint* from_;
  bool here_;
};

/// The numbers of load steps in a row.
std::vector<double> numbers_of(std::vector<LoadStep> steps);

/// The counts of a result that go on after a restart.
template <class R, class Visitor>
void visit_counts(R& result, Visitor&& entry) {
  entry("outer_iterations", result.outer_iterations);
  entry("contact_iterations", result.contact_iterations);
  entry("cg_iterations", result.cg_iterations);
  entry("operator_applications", result.operator_applications);
  entry("spectrum_applications", result.spectrum_applications);
  entry("contact_applications", result.contact_applications);
  entry("lambda_min", result.lambda_min);
  entry("lambda_max", result.lambda_max);
  entry("r_star", result.r_star);
  entry("r_active", result.r_active);
  entry("unsolved_steps", result.unsolved_steps);
  entry("bound_change", result.bound_change);
  entry("load_reached", result.load_reached);
  entry("load_cuts", result.load_cuts);
}

}  // namespace kacanov
