// SPDX-License-Identifier: BSD-3-Clause
// Python classes for the handles of the C interface, with numpy arrays.
#include "operator.hpp"

#include <array>
#include <utility>

#include <kacanov/cells.hpp>
#include <kacanov/error.hpp>
#include "laws.hpp"

namespace py = pybind11;

namespace kacanov::python {
namespace {

/// Returns the stride in entries of T; 0 along an axis with fewer than two entries, where numpy's is
/// meaningless. Throws InputError if it is negative or not a multiple of the entry size.
template <class T>
std::size_t stride(const py::array& array, int axis, const char* name) {
  if (array.shape(axis) < 2) return 0;
  const std::ptrdiff_t bytes = array.strides(axis);
  if (bytes < 0 || bytes % static_cast<std::ptrdiff_t>(sizeof(T)) != 0)
    throw InputError(std::string(name) + ": expected strides that are multiples of " +
                     std::to_string(sizeof(T)) + " bytes, got " + std::to_string(bytes));
  return static_cast<std::size_t>(bytes) / sizeof(T);
}

kacanov_orphans orphans_of(const std::string& word) {
  if (word == "zero") return KACANOV_ORPHANS_ZERO;
  if (word == "refused") return KACANOV_ORPHANS_REFUSED;
  if (word == "unit") return KACANOV_ORPHANS_UNIT;
  throw InputError("orphans: expected \"zero\", \"refused\" or \"unit\", got \"" + word + "\"");
}

kacanov_plane plane_of(const std::string& word) {
  if (word == "strain") return KACANOV_PLANE_STRAIN;
  if (word == "stress") return KACANOV_PLANE_STRESS;
  if (word == "axisymmetric") return KACANOV_AXISYMMETRIC;
  throw InputError("plane: expected \"strain\", \"stress\" or \"axisymmetric\", got \"" + word + "\"");
}

template <class T>
T sized() {
  T value{};
  value.struct_size = sizeof value;
  return value;
}

}  // namespace

Operator::Operator(const Description& from) {
  const std::optional<ElementType> type = element_type(from.element);
  if (!type)
    throw InputError("element: expected " +
                     element_names([](const Cell& c) { return bool(element_type(c)); }) + ", got \"" +
                     from.element + "\"");
  const std::ptrdiff_t dim = dimension(*type), npe = nodes_per_element(*type);
  const py::array points = wanted_array<double>(from.points, {"points", {{-1, dim}}, false});
  const py::array cells = wanted_array<std::int32_t>(from.cells, {"cells", {{-1, npe}}, false});
  auto body = sized<kacanov_description>();
  body.element = static_cast<std::int32_t>(*type);
  body.threads = from.threads;
  body.nodes = static_cast<std::size_t>(points.shape(0));
  body.coordinates = static_cast<const double*>(points.data());
  body.node_stride = stride<double>(points, 0, "points");
  body.component_stride = stride<double>(points, 1, "points");
  body.elements = static_cast<std::size_t>(cells.shape(0));
  body.connectivity = static_cast<const std::int32_t*>(cells.data());
  body.element_stride = stride<std::int32_t>(cells, 0, "cells");
  if (stride<std::int32_t>(cells, 1, "cells") != 1)
    throw InputError(
        "cells: expected the nodes of an element one after another: "
        "numpy.ascontiguousarray makes a copy that is so");
  CLaws laws(from.laws);
  for (const auto& [index, law] : from.own_laws) {
    own_laws_.push_back(std::make_unique<OwnLaw>(law, index));
    own_laws_.back()->enter(laws.law(index));
  }
  body.laws = laws.laws().size();
  body.law = laws.laws().data();
  py::array law_of_element;
  if (!from.law_of_element.is_none()) {
    law_of_element = wanted_array<std::uint16_t>(from.law_of_element, {"law_of_element", {{cells.shape(0)}}});
    body.law_of_element = static_cast<const std::uint16_t*>(law_of_element.data());
  }
  body.single = from.single ? 1 : 0;
  body.turn_inverted = from.turn_inverted ? 1 : 0;
  body.orphans = orphans_of(from.orphans);
  body.plane = plane_of(from.plane);
  const bool own_order = from.order == "kacanov";
  body.node_order = own_order ? nullptr : from.order.c_str();
  if (from.instruction_set) body.instruction_set = from.instruction_set->c_str();
  std::array<char, 512> message{};
  int code = KACANOV_OK;
  {
    const py::gil_scoped_release release;
    code = kacanov_create(&body, &handle_, message.data(), message.size());
  }
  check(code, message.data());
  size_ = information();
}

kacanov_information Operator::information() {
  auto all = sized<kacanov_information>();
  run([&] { return kacanov_inspect(handle_, &all); });
  return all;
}

Wanted Operator::vector(const char* name) const {
  const auto n = static_cast<std::ptrdiff_t>(size_.unknowns);
  return {name, {{n}, {n, 1}, {static_cast<std::ptrdiff_t>(size_.nodes), size_.dimension}}};
}

Wanted Operator::output() const {
  Wanted wanted = vector("out");
  wanted.writable = true;
  return wanted;
}

template <class Real>
py::array Operator::map_in(Mapping<Real> call, const py::object& x, const py::object& out) {
  const py::array in = wanted_array<Real>(x, vector("x"));
  py::array result = out.is_none() ? new_array<Real>(shape_of(in)) : wanted_array<Real>(out, output());
  const Real* from = entries<Real>(in).data();
  Real* to = entries<Real>(result).data();
  run([&] { return call(handle_, size_.unknowns, from, to); });
  return result;
}

py::array Operator::map(Call call, const py::object& x, const py::object& out) {
  return map_in<double>(call, x, out);
}

py::array Operator::map_float(const py::object& x, const py::object& out) {
  return map_in<float>(kacanov_apply_float, x, out);
}

py::array Operator::map_many(const py::object& x) {
  const py::array in = wanted_array<double>(x, {"x", {{-1, static_cast<std::ptrdiff_t>(size_.unknowns)}}});
  py::array result = new_array<double>(shape_of(in));
  const auto count = static_cast<std::int32_t>(in.shape(0));
  if (count == 0) return result;
  const double* from = entries<double>(in).data();
  double* to = entries<double>(result).data();
  run([&] { return kacanov_apply_many(handle_, size_.unknowns, count, from, to); });
  return result;
}

double Operator::measure(Call call, const py::object& u) {
  const py::array in = wanted_array<double>(u, vector("u"));
  const double* from = entries<double>(in).data();
  double value = 0.0;
  run([&] { return call(handle_, size_.unknowns, from, &value); });
  return value;
}

void Operator::freeze(int (*call)(kacanov_operator*, std::size_t, const double*), const py::object& u) {
  const py::array in = wanted_array<double>(u, vector("u"));
  const double* from = entries<double>(in).data();
  run([&] { return call(handle_, size_.unknowns, from); });
}

py::array Operator::read(int (*call)(kacanov_operator*, std::size_t, double*),
                         const std::vector<std::ptrdiff_t>& shape) {
  py::array result = new_array<double>(shape);
  const std::span<double> to = entries<double>(result);
  run([&] { return call(handle_, to.size(), to.data()); });
  return result;
}

void Operator::set_secant(const py::object& g) {
  const py::array in = wanted_array<double>(
      g, {"g", {{static_cast<std::ptrdiff_t>(size_.elements), size_.points_per_element}}});
  const std::span<const double> from = entries<double>(in);
  run([&] { return kacanov_set_secant(handle_, from.size(), from.data()); });
}

void Operator::constrain(const py::object& unknowns) {
  const py::array in = wanted_array<std::int32_t>(unknowns, {"unknowns", {{-1}}});
  const std::span<const std::int32_t> from = entries<std::int32_t>(in);
  run([&] { return kacanov_constrain(handle_, from.size(), from.data()); });
}

void Operator::set_blocks(const py::object& nodes, const py::object& blocks) {
  const py::array at = wanted_array<std::int32_t>(nodes, {"nodes", {{-1}}});
  const std::ptrdiff_t dim = size_.dimension;
  const py::array in = wanted_array<double>(blocks, {"blocks", {{at.shape(0), dim, dim}}});
  const std::span<const std::int32_t> node = entries<std::int32_t>(at);
  const double* block = entries<double>(in).data();
  run([&] { return kacanov_set_blocks(handle_, node.size(), node.data(), block); });
}

py::dict Operator::stress(const py::object& u) {
  const py::array in = wanted_array<double>(u, vector("u"));
  const auto elements = static_cast<std::ptrdiff_t>(size_.elements);
  py::array stress = new_array<double>({elements, 6}), von_mises = new_array<double>({elements}),
            strain = new_array<double>({elements}), secant = new_array<double>({elements}),
            plastic = py::array(py::dtype("bool"), std::vector<std::ptrdiff_t>{elements});
  auto fields = sized<kacanov_fields>();
  fields.elements = size_.elements;
  fields.stress = entries<double>(stress).data();
  fields.von_mises = entries<double>(von_mises).data();
  fields.dev_strain = entries<double>(strain).data();
  fields.secant = entries<double>(secant).data();
  fields.plastic = static_cast<std::uint8_t*>(plastic.mutable_data());
  const double* from = entries<double>(in).data();
  run([&] { return kacanov_stress(handle_, size_.unknowns, from, &fields); });
  py::dict all;
  all["stress"] = stress;
  all["von_mises"] = von_mises;
  all["dev_strain"] = strain;
  all["secant"] = secant;
  all["plastic"] = plastic;
  return all;
}

py::tuple Operator::matrix(const py::object& u) {
  const std::size_t n = size_.unknowns;
  py::array in;
  const double* from = nullptr;
  if (!u.is_none()) {
    in = wanted_array<double>(u, vector("u"));
    from = entries<double>(std::as_const(in)).data();
  }
  std::size_t count = 0;
  run([&] { return kacanov_matrix_entries(handle_, n, &count); });
  py::array first = new_array<std::int64_t>({static_cast<std::ptrdiff_t>(n) + 1});
  py::array column = new_array<std::int32_t>({static_cast<std::ptrdiff_t>(count)});
  py::array value = new_array<double>({static_cast<std::ptrdiff_t>(count)});
  auto* first_data = entries<std::int64_t>(first).data();
  auto* column_data = entries<std::int32_t>(column).data();
  double* value_data = entries<double>(value).data();
  run([&] { return kacanov_matrix(handle_, n, from, count, first_data, column_data, value_data); });
  return py::make_tuple(value, column, first);
}

py::tuple Operator::locality_order() {
  py::array nodes = new_array<std::int32_t>({static_cast<std::ptrdiff_t>(size_.nodes)});
  py::array elements = new_array<std::int32_t>({static_cast<std::ptrdiff_t>(size_.elements)});
  auto* node = entries<std::int32_t>(nodes).data();
  auto* element = entries<std::int32_t>(elements).data();
  run([&] { return kacanov_locality_order(handle_, size_.nodes, node, size_.elements, element); });
  return py::make_tuple(nodes, elements);
}

Multigrid::Multigrid(std::shared_ptr<Operator> op, double aggregate) : op_(std::move(op)) {
  auto options = sized<kacanov_multigrid_options>();
  options.aggregate = aggregate;
  const InUse use(op_->busy());
  int code = KACANOV_OK;
  {
    const py::gil_scoped_release release;
    code = kacanov_multigrid_create(op_->handle(), &options, &handle_);
  }
  check(code, kacanov_message(op_->handle()));
}

py::array Multigrid::apply(const py::object& r, const py::object& out) {
  const py::array in = wanted_array<double>(r, op_->vector("r"));
  py::array result =
      out.is_none() ? new_array<double>(shape_of(in)) : wanted_array<double>(out, op_->output());
  const double* from = entries<double>(in).data();
  double* to = entries<double>(result).data();
  const InUse use(busy_);
  int code = KACANOV_OK;
  {
    const py::gil_scoped_release release;
    code = kacanov_multigrid_apply(handle_, op_->size().unknowns, from, to);
  }
  check(code, kacanov_multigrid_message(handle_));
  return result;
}

void Multigrid::update() {
  const InUse use(busy_), of_operator(op_->busy());
  int code = KACANOV_OK;
  {
    const py::gil_scoped_release release;
    code = kacanov_multigrid_update(handle_);
  }
  check(code, kacanov_multigrid_message(handle_));
}

kacanov_multigrid_information Multigrid::information() {
  auto all = sized<kacanov_multigrid_information>();
  const InUse use(busy_);
  check(kacanov_multigrid_inspect(handle_, &all), kacanov_multigrid_message(handle_));
  return all;
}

kacanov_cg_result solve_cg(Operator& op, Multigrid* multigrid, const CgOptions& options, const py::object& b,
                           const py::object& x) {
  const py::array right = wanted_array<double>(b, op.vector("b"));
  Wanted start = op.vector("x0");
  start.writable = true;
  py::array solution = wanted_array<double>(x, start);
  auto c_options = sized<kacanov_cg_options>();
  c_options.relative = options.relative;
  c_options.absolute = options.absolute;
  c_options.most_iterations = options.most_iterations;
  c_options.tangent = options.tangent ? 1 : 0;
  auto result = sized<kacanov_cg_result>();
  const double* from = entries<double>(right).data();
  double* to = entries<double>(solution).data();
  const InUse use(op.busy());
  int code = KACANOV_OK;
  {
    const py::gil_scoped_release release;
    code = kacanov_cg(op.handle(), multigrid == nullptr ? nullptr : multigrid->handle(), &c_options,
                      op.size().unknowns, from, to, &result);
  }
  check(code, kacanov_message(op.handle()));
  return result;
}

}  // namespace kacanov::python
