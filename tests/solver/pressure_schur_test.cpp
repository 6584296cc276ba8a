// SPDX-License-Identifier: BSD-3-Clause
// The Schur complement of the pressures, its sparse assembly, and the Chebyshev weights of its smoother.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "amg/make_preconditioner.hpp"
#include "multigrid/fine_level.hpp"
#include "multigrid/mixed/schur_complement.hpp"
#include "multigrid/sparsity_pattern.hpp"
#include "pressure_bodies.hpp"

using namespace kacanov;
using namespace kacanov::testing;

TEST_CASE("matrices summed of small ones have whole rows on their ranks, whoever adds to them") {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const Part part = bar(2, false);  // for its communicator
  const std::int64_t rows_a_rank = 7, columns_a_rank = 5;
  const std::size_t rows = 7 * static_cast<std::size_t>(ranks), columns = 5 * static_cast<std::size_t>(ranks);
  std::vector<std::int64_t> row_starts, column_starts, row_number(rows), column_number(columns);
  for (int r = 0; r <= ranks; ++r) {
    row_starts.push_back(r * rows_a_rank);
    column_starts.push_back(r * columns_a_rank);
  }
  std::iota(row_number.begin(), row_number.end(), 0);
  std::iota(column_number.begin(), column_number.end(), 0);
  // Element matrices of three rows and two columns; the last row of the matrix stays empty.
  std::vector<std::int32_t> row, column;
  std::vector<std::size_t> first_row{0}, first_column{0};
  for (std::size_t m = 0; m < 9; ++m) {
    for (std::size_t k = 0; k < 3; ++k)
      row.push_back(
          static_cast<std::int32_t>((5 * m + 2 * k + 3 * static_cast<std::size_t>(rank)) % (rows - 1)));
    for (std::size_t k = 0; k < 2; ++k) column.push_back(static_cast<std::int32_t>((m + k) % columns));
    first_row.push_back(row.size()), first_column.push_back(column.size());
  }
  const SparsityPattern pattern({row_starts, row_number, row, first_row},
                                {column_starts, column_number, column, first_column}, part.node_map, 2);
  std::vector<float> values(2 * pattern.entries(), 0.0F);
  Vector whole(2 * rows * columns, 0.0);
  for (std::size_t m = 0; m < 9; ++m)
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 2; ++j) {
        const std::int32_t r = row[3 * m + i], c = column[2 * m + j];
        const std::size_t k = pattern.entry(pattern.row(r), pattern.column(c));
        const auto value = static_cast<float>(1 + m + 10 * i + 100 * j);
        const std::size_t at = static_cast<std::size_t>(r) * columns + static_cast<std::size_t>(c);
        values[2 * k] += value, values[2 * k + 1] -= value;
        whole[2 * at] += static_cast<double>(value), whole[2 * at + 1] -= static_cast<double>(value);
      }
  pattern.complete(values, 2);
  part.node_map.sum_all(std::span(whole));
  REQUIRE(pattern.owned_rows() == 7);
  for (std::size_t r = 0; r < 7; ++r) {
    const auto begin = static_cast<std::size_t>(pattern.start()[r]);
    const auto end = static_cast<std::size_t>(pattern.start()[r + 1]);
    CHECK(std::is_sorted(pattern.column().begin() + pattern.start()[r],
                         pattern.column().begin() + pattern.start()[r + 1]));
    Vector of_row(2 * columns, 0.0);
    for (std::size_t k = begin; k < end; ++k) {
      const auto c =
          static_cast<std::size_t>(pattern.columns().number(static_cast<std::size_t>(pattern.column()[k])));
      for (std::size_t i = 0; i < 2; ++i) of_row[2 * c + i] += static_cast<double>(values[2 * k + i]);
      CHECK(values[2 * k] > 0.0F);
    }
    const std::size_t number = r + 7 * static_cast<std::size_t>(rank);
    for (std::size_t i = 0; i < 2 * columns; ++i) CHECK(of_row[i] == whole[2 * columns * number + i]);
  }
}

TEST_CASE(
    "S is C and what pressures do to volumes by way of the node blocks, found at once or part by part") {
  for (const ElementType type : {ElementType::tet10, ElementType::hex8}) {
    CAPTURE(cell(type).name);
    const Part part = bar(4, false, type);
    const MultigridBody body = multigrid_body(part);
    PressureRows pressures(body);
    FineLevel fine(body, {}, FinePart::deviator, &pressures.means());
    const double factor = 0.4;
    std::vector<NodeBlock> springs;
    for (std::int32_t n = 0; n < part.owned_nodes(); n += 11)
      springs.push_back({n, {4e3, 0.0, 0.0, 0.0, 2.0, 1.0, 0.0, 1.0, 3.0}});
    for (const int threads : {1, 2})
      for (const std::int64_t nodes_at_once : {10, 1 << 15}) {
        fine.setup(bent(part, 100.0), {{}, ConstrainedSpace()});
        SchurComplement schur(body, pressures, threads, nodes_at_once);
        schur.setup(fine.inverse(), factor);
        // Without springs, with springs, and without them again.
        for (const bool sprung : {false, true, false}) {
          CAPTURE(threads);
          CAPTURE(nodes_at_once);
          CAPTURE(sprung);
          const std::vector<float> before(fine.inverse().begin(), fine.inverse().end());
          fine.update({sprung ? std::span<const NodeBlock>(springs) : std::span<const NodeBlock>(),
                       ConstrainedSpace()});
          schur.update(before, fine.inverse());
          Vector p(schur.size()), of_matrix(pressures.rows()), by_sweeps(pressures.rows());
          for (std::size_t r = 0; r < pressures.rows(); ++r)
            p[r] = std::sin(0.7 * static_cast<double>(part.node_index[pressures.node(r)]));
          schur.multiply(p, of_matrix);
          std::vector<float> entries(pressures.means().size()), force(part.unknowns()), moved = force;
          pressures.spread(std::span(p).first(pressures.rows()), entries);
          fine.pressure_force(entries, force);
          fine.add_scaled(static_cast<float>(factor), force, {}, moved);
          fine.hold(moved);
          fine.volume_change(moved, entries);
          pressures.sum(entries, by_sweeps);
          double largest = 0.0, off = 0.0;
          for (std::size_t r = 0; r < pressures.rows(); ++r) {
            by_sweeps[r] += pressures.compliance()[r] * p[r];
            largest = std::max(largest, std::abs(by_sweeps[r]));
            off = std::max(off, std::abs(of_matrix[r] - by_sweeps[r]));
          }
          CHECK(off < 2e-6 * part.node_map.max_all(largest));
        }
      }
  }
}

TEST_CASE("a smoother's weights make Chebyshev's polynomial, and none is below 1") {
  for (const int steps : {2, 3, 4, 7})
    for (const double range : {3.0, 10.0}) {
      const SmootherWeights smoother = chebyshev_weights(steps, range);
      REQUIRE(smoother.weight.size() == static_cast<std::size_t>(steps));
      CHECK(*std::min_element(smoother.weight.begin(), smoother.weight.end()) == doctest::Approx(1.0));
      const auto left = [&](double eigenvalue) {  // in units of Λ
        double product = 1.0;
        for (const double weight : smoother.weight) product *= 1.0 - weight * eigenvalue / smoother.damping;
        return product;
      };
      const double bound = 1.0 / std::cosh(steps * std::acosh((range + 1.0) / (range - 1.0)));
      CHECK(left(0.0) == 1.0);
      CHECK(std::abs(left(1.0)) == doctest::Approx(bound));
      CHECK(left(1.0 / range) == doctest::Approx(bound));
      for (int i = 0; i <= 100; ++i)
        CHECK(std::abs(left(1.0 / range + (1.0 - 1.0 / range) * i / 100.0)) < bound * (1.0 + 1e-12));
    }
}
