// SPDX-License-Identifier: BSD-3-Clause
// Python bindings of the operator and the multigrid.
#include <pybind11/stl.h>

#include "module.hpp"
#include "operator.hpp"

namespace py = pybind11;

namespace kacanov::python {
namespace {

std::shared_ptr<Operator> make_operator(const py::dict& fields) {
  Description d;
  d.points = fields["points"];
  d.cells = fields["cells"];
  d.element = fields["element"].cast<std::string>();
  d.order = fields["order"].cast<std::string>();
  d.laws = fields["laws"].cast<std::string>();
  d.own_laws = fields["own_laws"].cast<decltype(d.own_laws)>();
  d.law_of_element = fields["law_of_element"];
  d.threads = fields["threads"].cast<int>();
  d.single = fields["single"].cast<bool>();
  d.turn_inverted = fields["turn_inverted"].cast<bool>();
  d.orphans = fields["orphans"].cast<std::string>();
  d.plane = fields["plane"].cast<std::string>();
  d.instruction_set = fields["instruction_set"].cast<std::optional<std::string>>();
  return std::make_shared<Operator>(d);
}

py::dict information(Operator& op) {
  using namespace py::literals;
  const kacanov_information all = op.information();
  return py::dict("unknowns"_a = all.unknowns, "nodes"_a = all.nodes, "elements"_a = all.elements,
                  "dimension"_a = all.dimension, "points_per_element"_a = all.points_per_element,
                  "threads"_a = all.threads, "applications"_a = all.applications, "bytes"_a = all.bytes,
                  "instruction_set"_a = all.instruction_set);
}

std::vector<std::ptrdiff_t> blocks_shape(const Operator& op) {
  const std::ptrdiff_t dim = op.size().dimension;
  return {static_cast<std::ptrdiff_t>(op.size().nodes), dim, dim};
}

py::tuple cg(Operator& op, Multigrid* multigrid, const py::object& b, const py::object& x,
             const py::dict& options) {
  const kacanov_cg_result result = solve_cg(op, multigrid,
                                            {options["rtol"].cast<double>(), options["atol"].cast<double>(),
                                             options["maxiter"].cast<int>(), options["tangent"].cast<bool>()},
                                            b, x);
  return py::make_tuple(result.iterations, result.converged != 0, result.first_residual, result.residual);
}

}  // namespace

void bind_operator(py::module_& module) {
  using std::ptrdiff_t;
  const auto none = py::arg("out") = py::none();
  py::class_<Operator, std::shared_ptr<Operator>>(module, "Operator")
      .def(py::init(&make_operator))
      .def("information", &information)
      .def("update", [](Operator& op, const py::object& u) { op.freeze(kacanov_update, u); })
      .def("update_tangent", [](Operator& op, const py::object& u) { op.freeze(kacanov_update_tangent, u); })
      .def(
          "apply",
          [](Operator& op, const py::object& x, const py::object& out) {
            return op.map(kacanov_apply, x, out);
          },
          py::arg("x"), none)
      .def(
          "apply_tangent",
          [](Operator& op, const py::object& x, const py::object& out) {
            return op.map(kacanov_apply_tangent, x, out);
          },
          py::arg("x"), none)
      .def("apply_float", &Operator::map_float, py::arg("x"), none)
      .def("apply_many", &Operator::map_many)
      .def(
          "residual",
          [](Operator& op, const py::object& u, const py::object& out) {
            return op.map(kacanov_residual, u, out);
          },
          py::arg("u"), none)
      .def("energy", [](Operator& op, const py::object& u) { return op.measure(kacanov_energy, u); })
      .def("diagonal",
           [](Operator& op) {
             return op.read(kacanov_diagonal, {static_cast<ptrdiff_t>(op.size().unknowns)});
           })
      .def("diagonal_tangent",
           [](Operator& op) {
             return op.read(kacanov_diagonal_tangent, {static_cast<ptrdiff_t>(op.size().unknowns)});
           })
      .def("blocks", [](Operator& op) { return op.read(kacanov_block_diagonal, blocks_shape(op)); })
      .def("blocks_tangent",
           [](Operator& op) { return op.read(kacanov_block_diagonal_tangent, blocks_shape(op)); })
      .def("secant",
           [](Operator& op) {
             return op.read(kacanov_secant,
                            {static_cast<ptrdiff_t>(op.size().elements), op.size().points_per_element});
           })
      .def("set_secant", &Operator::set_secant)
      .def("constrain", &Operator::constrain)
      .def("set_blocks", &Operator::set_blocks)
      .def("stress", &Operator::stress)
      .def("matrix", &Operator::matrix)
      .def("locality_order", &Operator::locality_order)
      .def("cg", &cg);
  py::class_<Multigrid, std::shared_ptr<Multigrid>>(module, "Multigrid")
      .def(py::init<std::shared_ptr<Operator>, double>())
      .def("apply", &Multigrid::apply, py::arg("r"), none)
      .def("update", &Multigrid::update)
      .def("information", [](Multigrid& multigrid) {
        const kacanov_multigrid_information all = multigrid.information();
        return py::make_tuple(all.levels, all.bytes);
      });
}

}  // namespace kacanov::python
