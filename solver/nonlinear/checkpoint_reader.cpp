// SPDX-License-Identifier: BSD-3-Clause
// Reader for numbers, fields and load-step history of a checkpoint.
#include "nonlinear/checkpoint_reader.hpp"

#include <algorithm>
#include <cmath>

#include <kacanov/error.hpp>
#include <kacanov/part.hpp>

namespace kacanov {
namespace {

template <class Visitor>
void visit_load_step(LoadStep& step, Visitor&& entry) {
  entry(step.factor);
  entry(step.outer_iterations);
  entry(step.cg_iterations);
  entry(step.active_nodes);
  entry(step.slip_nodes);
  entry(step.max_contact_pressure);
  entry(step.plastic_elements);
  entry(step.worst_residual);
  for (double& value : step.contact_force) entry(value);
  for (double& value : step.friction_force) entry(value);
  for (Vector3& probe : step.probe)
    for (double& value : probe) entry(value);
  for (double& value : step.travel) entry(value);
}

}  // namespace

CheckpointReader::CheckpointReader(const Part& part, const Checkpoint* from)
    : part_(part), from_(from), here_(part.node_map.rank == 0) {}

/// `most`: limit of a count; 0: any number.
double CheckpointReader::shared(const std::string& name, std::int64_t most) const {
  double number = 0.0;
  if (here_) number = most > 0 ? static_cast<double>(from_->count(name, most)) : from_->number(name);
  part_.node_map.expect_all_here();
  if (part_.node_map.ranks > 1) MPI_Bcast(&number, 1, MPI_DOUBLE, 0, mpi_of(part_.node_map));
  return number;
}

std::size_t CheckpointReader::length(const std::string& name, std::int64_t most) const {
  return static_cast<std::size_t>(shared(name, most));
}

double CheckpointReader::within(const std::string& name, double least, double most) const {
  const double value = here_ ? from_->number(name) : least;
  if (!(value >= least && value <= most))
    throw InputError("the checkpoint's number \"" + name + "\" is " + std::to_string(value) +
                     ", expected one from " + std::to_string(least) + " to " + std::to_string(most));
  return shared(name, 0);
}

std::vector<double> CheckpointReader::values(const std::string& name, std::size_t entries) const {
  std::vector<double> all(entries);
  if (here_) all = from_->field(name, entries);
  part_.node_map.expect_all_here(CallSite(), static_cast<std::int64_t>(entries));
  if (part_.node_map.ranks > 1)
    MPI_Bcast(all.data(), static_cast<int>(entries), MPI_DOUBLE, 0, mpi_of(part_.node_map));
  return all;
}

/// Returns a field on the first rank after checking that all entries are finite.
std::vector<double> CheckpointReader::finite(const std::string& name, std::size_t entries) const {
  if (!here_) return {};
  const std::vector<double>& field = from_->field(name, entries);
  if (!std::all_of(field.begin(), field.end(), [](double v) { return std::isfinite(v); }))
    throw InputError("the checkpoint's field \"" + name + "\" has an entry that is not finite");
  return field;
}

std::vector<double> CheckpointReader::contact(const std::string& name, int components) const {
  const auto points = static_cast<std::size_t>(part_.total_contact);
  return scatter_contact(part_, finite(name, points * static_cast<std::size_t>(components)), components);
}

std::vector<double> CheckpointReader::nodal(const std::string& name) const {
  const auto unknowns = static_cast<std::size_t>(part_.total_nodes()) * static_cast<std::size_t>(part_.dim());
  return scatter_nodal(part_, finite(name, unknowns), part_.dim());
}

std::vector<double> CheckpointReader::elements(const std::string& name, int each) const {
  const auto entries = static_cast<std::size_t>(part_.total_elements) * static_cast<std::size_t>(each);
  return scatter_elements(part_, finite(name, entries), each);
}

std::vector<LoadStep> CheckpointReader::load_steps(const std::string& name, std::size_t steps,
                                                   std::size_t travels) const {
  std::vector<LoadStep> all(steps);
  for (LoadStep& step : all) step.probe.resize(part_.total_probes), step.travel.resize(travels);
  const std::vector<double> numbers = values(name, numbers_of(all).size());
  auto next = numbers.begin();
  for (LoadStep& step : all)
    visit_load_step(
        step, [&](auto& value) { value = static_cast<std::remove_reference_t<decltype(value)>>(*next++); });
  return all;
}

std::vector<double> numbers_of(std::vector<LoadStep> steps) {
  std::vector<double> all;
  for (LoadStep& step : steps)
    visit_load_step(step, [&](auto& value) { all.push_back(static_cast<double>(value)); });
  return all;
}

}  // namespace kacanov
