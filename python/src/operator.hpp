// SPDX-License-Identifier: BSD-3-Clause
// Python classes for the handles of the C interface, with numpy arrays.
#pragma once

#include "arrays.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <kacanov/kacanov.h>
#include "errors.hpp"
#include "own_law.hpp"

namespace kacanov::python {

/// Python equivalent of kacanov_description.
struct Description {
  pybind11::object points, cells;
  std::string element;
  std::string order = "gmsh";
  std::string laws;                                                ///< JSON, see CLaws
  std::vector<std::pair<std::size_t, pybind11::object>> own_laws;  ///< kacanov.OwnLaw by index of the law
  pybind11::object law_of_element = pybind11::none();
  int threads = 1;
  bool single = false, turn_inverted = false;
  std::string orphans = "zero", plane = "strain";
  std::optional<std::string> instruction_set;
};

/// Guards a handle against concurrent use: a second thread gets a StateError.
class InUse {
 public:
  explicit InUse(std::atomic<bool>& flag) : flag_(flag) {
    if (flag_.exchange(true)) throw CodeError(KACANOV_ERROR_STATE, "in use by another thread");
  }
  ~InUse() { flag_ = false; }
  InUse(const InUse&) = delete;
  InUse& operator=(const InUse&) = delete;

 private:
  std::atomic<bool>& flag_;
};

/// A kacanov_operator. Vectors are C-contiguous arrays of shape (n,), (n, 1) or (nodes, dim), with n = nodes
/// × dim; results have the shape of the input. Calls release the GIL.
class Operator {
 public:
  explicit Operator(const Description& description);
  ~Operator() { kacanov_destroy(handle_); }
  Operator(const Operator&) = delete;
  Operator& operator=(const Operator&) = delete;

  kacanov_operator* handle() const noexcept { return handle_; }
  std::atomic<bool>& busy() noexcept { return busy_; }
  const kacanov_information& size() const noexcept { return size_; }
  /// Current information, including `applications` and `bytes`.
  kacanov_information information();

  Wanted vector(const char* name) const;
  Wanted output() const;

  template <class Real>
  using Mapping = int (*)(kacanov_operator*, std::size_t, const Real*, Real*);
  using Call = Mapping<double>;
  /// Computes y = call(x), into `out` unless it is None.
  pybind11::array map(Call call, const pybind11::object& x, const pybind11::object& out);
  pybind11::array map_float(const pybind11::object& x, const pybind11::object& out);
  /// (k, n) arrays: one input vector per row.
  pybind11::array map_many(const pybind11::object& x);
  /// Wraps calls that take a vector and return a number, or nothing.
  double measure(int (*call)(kacanov_operator*, std::size_t, const double*, double*),
                 const pybind11::object& u);
  void freeze(int (*call)(kacanov_operator*, std::size_t, const double*), const pybind11::object& u);
  /// Wraps calls that fill an array of this shape.
  pybind11::array read(int (*call)(kacanov_operator*, std::size_t, double*),
                       const std::vector<std::ptrdiff_t>& shape);
  void set_secant(const pybind11::object& g);
  void constrain(const pybind11::object& unknowns);
  void set_blocks(const pybind11::object& nodes, const pybind11::object& blocks);
  pybind11::dict stress(const pybind11::object& u);
  pybind11::tuple matrix(const pybind11::object& u);
  pybind11::tuple locality_order();

 private:
  template <class Real>
  pybind11::array map_in(Mapping<Real> call, const pybind11::object& x, const pybind11::object& out);

  /// Runs one call without the GIL.
  template <class Work>
  void run(const Work& work) {
    int code = KACANOV_OK;
    const InUse use(busy_);
    {
      const pybind11::gil_scoped_release release;
      code = work();
    }
    if (code != KACANOV_OK)
      for (const auto& law : own_laws_) law->raise();
    check(code, kacanov_message(handle_));
  }

  std::vector<std::unique_ptr<OwnLaw>> own_laws_;
  kacanov_operator* handle_ = nullptr;
  kacanov_information size_{};
  std::atomic<bool> busy_ = false;
};

/// A kacanov_multigrid, which keeps its operator alive.
class Multigrid {
 public:
  Multigrid(std::shared_ptr<Operator> op, double aggregate);
  ~Multigrid() { kacanov_multigrid_destroy(handle_); }
  Multigrid(const Multigrid&) = delete;
  Multigrid& operator=(const Multigrid&) = delete;

  kacanov_multigrid* handle() const noexcept { return handle_; }
  Operator& op() noexcept { return *op_; }
  pybind11::array apply(const pybind11::object& r, const pybind11::object& out);
  void update();
  kacanov_multigrid_information information();

 private:
  std::shared_ptr<Operator> op_;
  kacanov_multigrid* handle_ = nullptr;
  std::atomic<bool> busy_ = false;
};

struct CgOptions {
  double relative = 0.0, absolute = 0.0;
  int most_iterations = 0;
  bool tangent = false;
};
/// Solves into `x`, which is overwritten; returns the result of kacanov_cg().
kacanov_cg_result solve_cg(Operator& op, Multigrid* multigrid, const CgOptions& options,
                           const pybind11::object& b, const pybind11::object& x);

}  // namespace kacanov::python
