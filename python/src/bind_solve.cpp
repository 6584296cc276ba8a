// SPDX-License-Identifier: BSD-3-Clause
// Python bindings of cases and their solutions.
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "case/json_node.hpp"
#include "module.hpp"
#include "program/loaded_case.hpp"
#include "program/memory_model.hpp"
#include "program/plain_locale.hpp"
#include "program/solve_case.hpp"
#include "run_case.hpp"

namespace py = pybind11;

namespace kacanov::python {
namespace {

/// Returns the sizes, memory estimate and warnings of `kacanov check`, without MPI.
py::dict check_case(const std::string& text, const std::string& path,
                    const std::optional<std::string>& mesh) {
  std::vector<std::string> warnings;
  py::dict found;
  double memory = 0.0;
  std::optional<Problem> problem;
  {
    const py::gil_scoped_release release;
    const PlainLocale locale;
    const Case input = read_case(text, path, mesh);
    problem = load_problem(input, {1, 0});
    warnings = input.warnings;
    warnings.insert(warnings.end(), problem->warnings.begin(), problem->warnings.end());
    ProblemSize size = size_of(problem->mesh, input.model);
    size.contact_points = static_cast<double>(problem->contact.size());
    memory = estimated_memory(size, 1);
  }
  found["element"] = std::string(cell(problem->mesh.type).name);
  found["nodes"] = problem->mesh.node_count();
  found["elements"] = problem->mesh.element_count();
  found["unknowns"] = problem->mesh.coordinates.size();
  found["contact_nodes"] = problem->contact.size();
  found["estimated_memory_bytes"] = memory;
  found["warnings"] = warnings;
  return found;
}

/// Returns the document as strict JSON: parse_json() drops comments and rejects repeated keys.
std::string normal(const std::string& text, const std::string& path) { return parse_json(text, path).dump(); }

std::string with_override(const std::string& text, const std::string& path, const std::string& assignment) {
  nlohmann::json document = parse_json(text, path);
  apply_override(document, assignment);
  return document.dump();
}

/// Returns a read-only view of an array that `owner` keeps alive.
template <class T>
py::array view(const py::object& owner, std::span<const T> values, std::ptrdiff_t width = 1) {
  const auto count = static_cast<std::ptrdiff_t>(values.size());
  std::vector<std::ptrdiff_t> shape{count / width};
  if (width > 1) shape.push_back(width);
  py::array array(py::dtype::of<T>(), shape, values.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// Returns the user's numbers of nodes or elements.
py::array numbers(const py::object& owner, const std::vector<std::int64_t>& tags, std::size_t count) {
  if (!tags.empty()) return view<std::int64_t>(owner, tags);
  return py::module_::import("numpy").attr("arange")(1, count + 1, py::arg("dtype") = "int64");
}

py::dict mesh_of(const py::object& self) {
  const Mesh& mesh = self.cast<const SolvedCase&>().problem.mesh;
  py::dict all;
  all["element"] = std::string(cell(mesh.type).name);
  all["vtk_type"] = cell(mesh.type).vtk;
  all["vtk_order"] = std::vector<int>(cell(mesh.type).vtk_order.begin(), cell(mesh.type).vtk_order.end());
  all["points"] = view<double>(self, mesh.coordinates, mesh.dim());
  all["cells"] = view<std::int32_t>(self, mesh.elements, nodes_per_element(mesh.type));
  all["facets"] = view<std::int32_t>(self, mesh.facets, nodes_per_facet(mesh.type));
  all["node_id"] = numbers(self, mesh.node_tags, mesh.node_count());
  all["element_id"] = numbers(self, mesh.element_tags, mesh.element_count());
  return all;
}

py::dict nodal_fields(const py::object& self) {
  const auto& solved = self.cast<const SolvedCase&>();
  py::dict all;
  all["u"] = view<double>(self, solved.displacement, solved.problem.mesh.dim());
  all["nodal_stress"] = view<double>(self, solved.nodal_stress, 6);
  all["nodal_von_mises"] = view<double>(self, solved.recovered_von_mises);
  return all;
}

/// Returns one of the stored load steps; null for the end of the run.
const StepFields* step_of(const SolvedCase& solved, std::optional<std::size_t> step) {
  return step ? &solved.steps.at(*step) : nullptr;
}

py::dict element_fields_of(const SolvedCase& solved, std::optional<std::size_t> index) {
  const StepFields* step = step_of(solved, index);
  const auto count = static_cast<std::ptrdiff_t>(solved.problem.mesh.element_count());
  py::array stress = new_array<double>({count, 6}), von_mises = new_array<double>({count}),
            strain = new_array<double>({count}), secant = new_array<double>({count}),
            plastic(py::dtype("bool"), std::vector<std::ptrdiff_t>{count});
  auto* flags = static_cast<std::uint8_t*>(plastic.mutable_data());
  const reference::ElementFields wanted{entries<double>(stress), entries<double>(von_mises),
                                        entries<double>(strain), entries<double>(secant),
                                        std::span(flags, static_cast<std::size_t>(count))};
  {
    const py::gil_scoped_release release;
    step == nullptr ? element_fields(solved, wanted) : element_fields(solved, *step, wanted);
  }
  py::dict all;
  all["stress"] = stress;
  all["von_mises"] = von_mises;
  all["dev_strain"] = strain;
  all["g"] = secant;
  all["plastic"] = plastic;
  return all;
}

py::dict contact_fields(const py::object& self, std::optional<std::size_t> index) {
  const auto& solved = self.cast<const SolvedCase&>();
  const StepFields* step = step_of(solved, index);
  const ContactFields& contact = step == nullptr ? solved.contact : step->contact;
  const auto count = static_cast<std::ptrdiff_t>(solved.problem.contact.size());
  py::array node = new_array<std::int32_t>({count}), entry = new_array<std::int32_t>({count}),
            status = new_array<std::int32_t>({count}), normal = new_array<double>({count, 3});
  const std::span<std::int32_t> nodes = entries<std::int32_t>(node), of = entries<std::int32_t>(entry),
                                states = entries<std::int32_t>(status);
  const std::span<double> normals = entries<double>(normal);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const ContactPoint& point = solved.problem.contact[i];
    nodes[i] = point.node;
    of[i] = point.entry;
    states[i] = static_cast<std::int32_t>(contact.status[i]);
    for (std::size_t c = 0; c < 3; ++c) normals[3 * i + c] = point.normal[c];
  }
  py::dict all;
  all["node"] = node;
  all["entry"] = entry;
  all["status"] = status;
  all["normal"] = normal;
  all["gap"] = view<double>(self, contact.gap);
  all["pressure"] = view<double>(self, contact.pressure);
  all["traction"] = view<double>(self, contact.traction, 3);
  return all;
}

std::vector<std::size_t> step_numbers(const SolvedCase& solved) {
  std::vector<std::size_t> numbers;
  for (const StepFields& step : solved.steps) numbers.push_back(step.number);
  return numbers;
}

py::array step_displacement(const py::object& self, std::size_t index) {
  const auto& solved = self.cast<const SolvedCase&>();
  return view<double>(self, solved.steps.at(index).displacement, solved.problem.mesh.dim());
}

std::string svg(const SolvedCase& solved) {
  const py::gil_scoped_release release;
  const PlainLocale locale;
  return deformed_picture(solved.input, solved.problem.mesh, solved.displacement, {solved.averaged_von_mises},
                          solved.result.max_von_mises);
}

}  // namespace

void bind_solve(py::module_& module) {
  py::class_<SolvedCase, std::shared_ptr<SolvedCase>>(module, "Solved")
      .def_property_readonly("json", [](const SolvedCase& solved) { return solved.json.dump(); })
      .def("mesh", &mesh_of)
      .def("nodal_fields", &nodal_fields)
      .def("error",
           [](const py::object& self) { return view<double>(self, self.cast<const SolvedCase&>().error); })
      .def("element_fields", &element_fields_of, py::arg("step") = py::none())
      .def("contact_fields", &contact_fields, py::arg("step") = py::none())
      .def("step_numbers", &step_numbers)
      .def("step_displacement", &step_displacement)
      .def("svg", &svg);
  module.def("solve", &run_case);
  module.def("check", &check_case);
  module.def("normal", &normal);
  module.def("with_override", &with_override);
}

}  // namespace kacanov::python
