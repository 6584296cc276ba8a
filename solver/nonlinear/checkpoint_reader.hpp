// SPDX-License-Identifier: BSD-3-Clause
// Reader for numbers, fields and load-step history of a checkpoint.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <kacanov/checkpoint.hpp>
#include <kacanov/part.hpp>
#include <kacanov/result.hpp>

namespace kacanov {

/// Distributes the first rank's checkpoint data to all ranks. Throws InputError on the first rank for entries
/// that are missing or out of range. Members are collective.
class CheckpointReader {
 public:
  /// `from`: the checkpoint on the first rank.
  CheckpointReader(const Part& part, const Checkpoint* from);

  template <class Value>
  void operator()(const std::string& name, Value& value) const {
    // The limit leaves room for further counting in the type.
    constexpr std::int64_t most = std::int64_t{1} << (sizeof(Value) == 4 ? 30 : sizeof(Value) == 1 ? 0 : 50);
    value = static_cast<Value>(shared(name, std::is_integral_v<Value> ? most : 0));
  }
  template <class Value>
  Value number(const std::string& name) const {
    Value value{};
    (*this)(name, value);
    return value;
  }
  /// Returns an integer from 0 to `most`.
  std::size_t length(const std::string& name, std::int64_t most) const;
  /// Returns a number within these bounds.
  double within(const std::string& name, double least, double most) const;
  /// Returns the same vector on all ranks.
  std::vector<double> values(const std::string& name, std::size_t entries) const;
  /// These return this rank's entries of a field, all finite.
  std::vector<double> contact(const std::string& name, int components) const;
  std::vector<double> nodal(const std::string& name) const;
  std::vector<double> elements(const std::string& name, int each) const;
  /// `travels`: number of pushed obstacles per load step.
  std::vector<LoadStep> load_steps(const std::string& name, std::size_t steps, std::size_t travels = 0) const;

 protected:
  const Part& part_;

 private:
  double shared(const std::string& name, std::int64_t most) const;
  std::vector<double> finite(const std::string& name, std::size_t entries) const;

  const Checkpoint* from_;
  bool here_;
};

/// Returns the numbers of load steps as one vector.
std::vector<double> numbers_of(std::vector<LoadStep> steps);

/// Visits the counts of a result that accumulate over a restart.
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
