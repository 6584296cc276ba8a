// SPDX-License-Identifier: BSD-3-Clause
// Checkpoint access and problem fingerprints.
#include <kacanov/checkpoint.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <kacanov/error.hpp>

namespace kacanov {
namespace {

std::uint64_t mix(std::uint64_t h, std::uint64_t word) {
  h ^= word;
  h *= 0x9e3779b97f4a7c15ULL;
  return h ^ (h >> 29);
}

/// Chains the hashes of the pieces of one section.
class Hash {
 public:
  template <class T>
  Hash& operator<<(const std::vector<T>& values) {
    static_assert(std::is_arithmetic_v<T>);
    const std::uint64_t count = values.size();
    value_ = hash_bytes(&count, sizeof count, value_);
    value_ = hash_bytes(values.data(), values.size() * sizeof(T), value_);
    return *this;
  }
  std::uint64_t value() const noexcept { return value_; }

 private:
  std::uint64_t value_ = 0;
};

}  // namespace

bool Checkpoint::begun() const {
  const auto before = numbers.find("before_outer");
  return number("outer_iterations") != 0.0 || (before != numbers.end() && before->second != 0.0);
}

double Checkpoint::number(const std::string& name) const {
  const auto found = numbers.find(name);
  if (found == numbers.end()) throw InputError("the checkpoint has no number \"" + name + "\"");
  return found->second;
}

std::int64_t Checkpoint::count(const std::string& name, std::int64_t most) const {
  const double value = number(name);
  if (!(value >= 0.0 && value <= static_cast<double>(most)) || value != std::floor(value))
    throw InputError("the checkpoint's number \"" + name + "\" is " + std::to_string(value) +
                     ", expected a whole number from 0 to " + std::to_string(most));
  return static_cast<std::int64_t>(value);
}

const std::vector<double>& Checkpoint::field(const std::string& name, std::size_t entries) const {
  const auto found = fields.find(name);
  if (found == fields.end()) throw InputError("the checkpoint has no field \"" + name + "\"");
  if (found->second.size() != entries) {
    throw InputError("the checkpoint's field \"" + name + "\" has " + std::to_string(found->second.size()) +
                     " entries, expected " + std::to_string(entries));
  }
  return found->second;
}

std::uint64_t hash_bytes(const void* data, std::size_t bytes, std::uint64_t seed) {
  const auto* at = static_cast<const unsigned char*>(data);
  std::uint64_t h = mix(seed, bytes);
  for (; bytes >= 8; bytes -= 8, at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, at, 8);
    h = mix(h, word);
  }
  if (bytes > 0) {
    std::uint64_t rest = 0;
    std::memcpy(&rest, at, bytes);
    h = mix(h, rest);
  }
  return h;
}

Fingerprint fingerprint(const Problem& problem) {
  Fingerprint print;
  const Mesh& mesh = problem.mesh;
  if (mesh.plane != PlaneState::strain) print.sections["plane"] = static_cast<std::uint64_t>(mesh.plane);
  print.sections["mesh"] =
      (Hash() << std::vector<int>{static_cast<int>(mesh.type)} << mesh.coordinates << mesh.elements).value();

  std::vector<double> laws;
  for (const Law& law : problem.laws) {
    laws.insert(laws.end(), {static_cast<double>(law.form.index()), static_cast<double>(law.argument),
                             law.shear, law.bulk, law.mean_dilatation ? 1.0 : 0.0});
    const auto append = [&](const auto& parameter) {
      if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(parameter)>>)
        laws.push_back(parameter);
      else
        laws.insert(laws.end(), parameter.begin(), parameter.end());
    };
    std::visit([&](const auto& form) { form.parameters(form, append); }, law.form);
  }
  print.sections["material"] = (Hash() << laws << problem.law_of_element).value();
  Hash boundary;
  boundary << problem.load << problem.held << problem.prescribed;
  std::vector<double> springs;  // and prescribed directions
  for (const NodeSpring& spring : problem.springs) {
    springs.push_back(static_cast<double>(spring.node));
    for (const Vector3& row : spring.stiffness) springs.insert(springs.end(), row.begin(), row.end());
  }
  for (const HeldDirection& held : problem.directions) {
    springs.insert(springs.end(), {static_cast<double>(held.node), held.value});
    springs.insert(springs.end(), held.direction.begin(), held.direction.end());
  }
  if (!springs.empty()) boundary << springs;
  print.sections["boundary"] = boundary.value();
  if (!problem.steps.empty()) {
    std::vector<double> curves;
    for (const LoadFactors& step : problem.steps) {
      curves.push_back(step.time);
      curves.insert(curves.end(), step.boundary.begin(), step.boundary.end());
      curves.insert(curves.end(), step.contact.begin(), step.contact.end());
    }
    for (const EntryForce& force : problem.forces)
      curves.insert(curves.end(),
                    {static_cast<double>(force.component), static_cast<double>(force.entry), force.value});
    print.sections["steps"] = (Hash() << curves << problem.holder).value();
  }

  std::vector<double> contact;
  for (std::size_t i = 0; i < problem.contact.size(); ++i) {
    const ContactPoint& point = problem.contact[i];
    contact.insert(contact.end(), {static_cast<double>(point.node), point.gap, point.mass, point.tresca,
                                   point.coulomb, static_cast<double>(point.tangents)});
    if (point.since_step) contact.push_back(1.0);
    for (const RowEntry& entry : problem.contact.entries(i)) {
      if (problem.contact.is_wide(i)) contact.push_back(static_cast<double>(entry.node));
      for (const Vector3& v : {entry.normal, entry.trace, entry.tangent[0], entry.tangent[1]})
        contact.insert(contact.end(), v.begin(), v.end());
    }
  }
  print.sections["contact"] = (Hash() << contact).value();
  return print;
}

std::vector<std::string> Fingerprint::differences(const Fingerprint& other) const {
  std::vector<std::string> names;
  for (const auto& [name, hash] : sections) {
    const auto there = other.sections.find(name);
    if (there == other.sections.end() || there->second != hash) names.push_back(name);
  }
  for (const auto& [name, hash] : other.sections)
    if (!sections.contains(name)) names.push_back(name);
  return names;
}

}  // namespace kacanov
