// SPDX-License-Identifier: BSD-3-Clause
// A material law defined by a Python function.
#include "own_law.hpp"

#include <algorithm>
#include <utility>

#include <kacanov/error.hpp>
#include "arrays.hpp"
#include "errors.hpp"

namespace py = pybind11;

namespace kacanov::python {
namespace {

/// Copies the values: the function may keep its arguments, but the library's arrays are temporary.
template <class T>
py::array copied(const T* values, std::size_t count) {
  py::array array = new_array<T>({static_cast<std::ptrdiff_t>(count)});
  std::copy_n(values, count, entries<T>(array).data());
  return array;
}

}  // namespace

OwnLaw::OwnLaw(const py::object& law, std::size_t index)
    : law_(law),
      name_("law[" + std::to_string(index) + "]"),
      yield_strain_(law.attr("yield_strain").cast<double>()) {}

void OwnLaw::enter(kacanov_law& law) {
  law.kind = KACANOV_USER;
  law.x0 = yield_strain_;
  law.evaluate = &OwnLaw::evaluate;
  law.data = this;
  law.parallel = 0;  // the GIL would serialise the threads
}

void OwnLaw::raise() {
  if (raised_) std::rethrow_exception(std::exchange(raised_, nullptr));
}

int OwnLaw::evaluate(void* self, const kacanov_law_points* points) {
  auto& law = *static_cast<OwnLaw*>(self);
  const py::gil_scoped_acquire acquire;
  try {
    law.fill(*points);
    return 0;
  } catch (...) {
    law.raised_ = std::current_exception();
    return 1;
  }
}

void OwnLaw::fill(const kacanov_law_points& points) const {
  const py::object law = law_();
  if (law.is_none()) throw InternalError(name_ + ": is gone before its operator");
  const std::size_t count = points.count;
  const py::object said = law.attr("evaluate")(copied(points.x, count), copied(points.element, count),
                                               copied(points.point, count));
  if (!py::isinstance<py::sequence>(said) || py::len(said) != 3)
    throw WrongType(name_ + ": expected the function to return (g, slope, energy), got " +
                    std::string(py::str(py::type::of(said).attr("__name__"))));
  take(said[py::int_(0)], "g", count, points.g);
  if (points.slope != nullptr) take(said[py::int_(1)], "slope", count, points.slope);
  if (points.energy != nullptr) take(said[py::int_(2)], "energy", count, points.energy);
}

void OwnLaw::take(const py::object& values, const char* what, std::size_t count, double* to) const {
  const auto length = static_cast<std::ptrdiff_t>(count);
  const std::string name = name_ + ": " + what;
  const py::array array = wanted_array<double>(values, {name.c_str(), {{length}}, false});
  for (std::ptrdiff_t i = 0; i < length; ++i) to[i] = *static_cast<const double*>(array.data(i));
}

}  // namespace kacanov::python
