// SPDX-License-Identifier: BSD-3-Clause
// Small meshes and models shared by the tests of build_problem.
#pragma once

#include <string>
#include <utility>

#include <kacanov/error.hpp>
#include <kacanov/problem.hpp>

namespace kacanov::testing {

inline const auto every_type = element_types();

inline Selector named(const std::string& name) {
  Selector on;
  on.kind = Selector::Kind::name;
  on.name = name;
  return on;
}

inline Selector everything() { return {}; }

inline Selector box(const Vector3& lower, const Vector3& upper) {
  Selector on;
  on.kind = Selector::Kind::box;
  on.lower = lower;
  on.upper = upper;
  return on;
}

inline Model elastic_model() {
  Model model;
  model.materials.push_back({everything(), elastic_law(1.0, 0.3)});
  return model;
}

inline BoundaryEntry displacement(Selector on, std::array<std::optional<double>, 3> value) {
  BoundaryEntry entry;
  entry.on = std::move(on);
  entry.displacement = value;
  return entry;
}

inline BoundaryEntry traction(Selector on, const Vector3& value) {
  BoundaryEntry entry;
  entry.on = std::move(on);
  entry.traction = value;
  return entry;
}

inline BoundaryEntry pressure(Selector on, double value) {
  BoundaryEntry entry;
  entry.on = std::move(on);
  entry.pressure = value;
  return entry;
}

inline BoundaryEntry body_force(Selector on, const Vector3& value) {
  BoundaryEntry entry;
  entry.on = std::move(on);
  entry.body_force = value;
  return entry;
}

inline Mesh box_mesh(ElementType type, const std::array<double, 3>& size = {2.0, 1.0, 0.5}, int cells = 2) {
  return make_box({size, {2 * cells, cells, cells}, type});
}

/// Returns the message with which build_problem rejects the model, empty if it accepts it.
inline std::string refusal(const Mesh& mesh, const Model& model) {
  try {
    build_problem(mesh, model);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

inline bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace kacanov::testing
