// SPDX-License-Identifier: BSD-3-Clause
// Checks type, shape and layout of numpy arrays, and uses them without a copy.
#include "arrays.hpp"

#include <algorithm>

#include <kacanov/error.hpp>
#include "errors.hpp"

namespace py = pybind11;

namespace kacanov::python {
namespace {

std::string shape_text(const std::vector<std::ptrdiff_t>& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    if (i > 0) text += ", ";
    text += shape[i] < 0 ? "any" : std::to_string(shape[i]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

std::string wanted_text(const Wanted& wanted, const std::string& type) {
  std::string text = std::string(wanted.name) + ": expected a " + (wanted.writable ? "writable " : "") +
                     (wanted.contiguous ? "C-contiguous " : "") + type + " array of shape ";
  for (std::size_t i = 0; i < wanted.any.size(); ++i)
    text += (i == 0 ? "" : i + 1 < wanted.any.size() ? ", " : " or ") + shape_text(wanted.any[i]);
  return text;
}

bool fits(const std::vector<std::ptrdiff_t>& shape, const std::vector<std::ptrdiff_t>& wanted) {
  return std::equal(shape.begin(), shape.end(), wanted.begin(), wanted.end(),
                    [](std::ptrdiff_t is, std::ptrdiff_t want) { return want < 0 || is == want; });
}

}  // namespace

template <>
const char* type_name<double>() {
  return "float64";
}
template <>
const char* type_name<float>() {
  return "float32";
}
template <>
const char* type_name<std::int32_t>() {
  return "int32";
}
template <>
const char* type_name<std::uint16_t>() {
  return "uint16";
}

std::vector<std::ptrdiff_t> shape_of(const py::array& array) {
  return {array.shape(), array.shape() + array.ndim()};
}

template <class T>
py::array wanted_array(py::handle object, const Wanted& wanted) {
  const std::string expected = wanted_text(wanted, type_name<T>());
  if (!py::isinstance<py::array>(object))
    throw WrongType(expected + ", got " + std::string(py::str(py::type::of(object).attr("__name__"))));
  auto array = py::reinterpret_borrow<py::array>(object);
  const std::vector<std::ptrdiff_t> shape = shape_of(array);
  const std::string got =
      ", got " + std::string(py::str(py::object(array.attr("dtype")))) + " of shape " + shape_text(shape);
  if (!py::isinstance<py::array_t<T>>(array)) throw WrongType(expected + got);
  if (std::none_of(wanted.any.begin(), wanted.any.end(), [&](const auto& one) { return fits(shape, one); }))
    throw InputError(expected + got);
  if (wanted.contiguous && (array.flags() & py::array::c_style) == 0)
    throw InputError(expected + got + ", not C-contiguous: numpy.ascontiguousarray makes a copy that is");
  if (reinterpret_cast<std::uintptr_t>(array.data()) % alignof(T) != 0)
    throw InputError(expected + got + ", not aligned: numpy.array makes a copy that is");
  if (wanted.writable && !array.writeable()) throw InputError(expected + got + ", read-only");
  return array;
}

template py::array wanted_array<double>(py::handle, const Wanted&);
template py::array wanted_array<float>(py::handle, const Wanted&);
template py::array wanted_array<std::int32_t>(py::handle, const Wanted&);
template py::array wanted_array<std::uint16_t>(py::handle, const Wanted&);

}  // namespace kacanov::python
