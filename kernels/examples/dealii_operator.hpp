// SPDX-License-Identifier: BSD-3-Clause
// Adapters that let deal.II's solvers use the operator and the multigrid, and the operator as a deal.II
// matrix.
#pragma once

#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

#include <kacanov/kacanov.h>

using Vector = dealii::Vector<double>;

/// Deleter of a handle for unique_ptr.
template <auto free>
struct FreeWith {
  template <class Handle>
  void operator()(Handle* handle) const {
    free(handle);
  }
};

/// B(g).
class Operator {
 public:
  explicit Operator(const kacanov_description& body) {
    char message[256];
    kacanov_operator* made = nullptr;
    if (kacanov_create(&body, &made, message, sizeof message) != KACANOV_OK)
      throw std::runtime_error(message);
    op_.reset(made);
  }

  void vmult(Vector& y, const Vector& x) const {
    check(kacanov_apply(op_.get(), x.size(), x.begin(), y.begin()));
  }
  /// Replaces the rows of these unknowns by those of the identity.
  void constrain(const std::vector<std::int32_t>& held) {
    check(kacanov_constrain(op_.get(), held.size(), held.data()));
  }
  void check(int code) const {
    if (code != KACANOV_OK) throw std::runtime_error(kacanov_message(op_.get()));
  }
  kacanov_operator* get() const { return op_.get(); }

 private:
  std::unique_ptr<kacanov_operator, FreeWith<kacanov_destroy>> op_;
};

/// Approximates the inverse of B(g) with its constraints.
class Multigrid {
 public:
  explicit Multigrid(const Operator& op) {
    kacanov_multigrid* made = nullptr;
    op.check(kacanov_multigrid_create(op.get(), nullptr, &made));
    multigrid_.reset(made);
  }
  void vmult(Vector& z, const Vector& r) const {
    if (kacanov_multigrid_apply(multigrid_.get(), r.size(), r.begin(), z.begin()) != KACANOV_OK)
      throw std::runtime_error(kacanov_multigrid_message(multigrid_.get()));
  }

 private:
  std::unique_ptr<kacanov_multigrid, FreeWith<kacanov_multigrid_destroy>> multigrid_;
};

/// The operator as a deal.II matrix of n rows, condensed by `constraints` unless that is null.
class Matrix {
 public:
  Matrix(const Operator& op, std::size_t n, const dealii::AffineConstraints<double>* constraints = nullptr) {
    std::size_t entries = 0;
    op.check(kacanov_matrix_entries(op.get(), n, &entries));
    std::vector<std::int64_t> first(n + 1);
    std::vector<std::int32_t> column(entries);
    std::vector<double> value(entries);
    op.check(kacanov_matrix(op.get(), n, nullptr, entries, first.data(), column.data(), value.data()));
    const auto size = static_cast<unsigned>(n);
    const auto every = [&](const auto& visit) {
      for (unsigned i = 0; i < size; ++i)
        for (auto k = static_cast<std::size_t>(first[i]); k < static_cast<std::size_t>(first[i + 1]); ++k)
          visit(i, static_cast<unsigned>(column[k]), value[k]);
    };
    dealii::DynamicSparsityPattern rows(size, size);
    every([&](unsigned i, unsigned j, double) { rows.add(i, j); });
    if (constraints != nullptr) constraints->condense(rows);
    pattern_.copy_from(rows);
    matrix_.reinit(pattern_);
    every([&](unsigned i, unsigned j, double entry) { matrix_.set(i, j, entry); });
    if (constraints != nullptr) constraints->condense(matrix_);
  }
  const dealii::SparseMatrix<double>& get() const { return matrix_; }

 private:
  dealii::SparsityPattern pattern_;
  dealii::SparseMatrix<double> matrix_;
};
