// SPDX-License-Identifier: BSD-3-Clause
// hypre's BoomerAMG on the assembled penalised secant stiffness.
#include "amg.hpp"

#include <HYPRE.h>
#include <HYPRE_IJ_mv.h>
#include <HYPRE_parcsr_ls.h>

#include <array>
#include <limits>
#include <string>

#include "assembly.hpp"
#include "error.hpp"

namespace kacanov {
namespace {

void check(HYPRE_Int code, const char* what) {
  if (code == 0) return;
  std::array<char, 256> text{};
  HYPRE_DescribeError(code, text.data());
  HYPRE_ClearAllErrors();
  throw InternalError(std::string("hypre: ") + what + " failed: " + text.data());
}

/// hypre keeps global state; the first user starts it, and it lives as long as MPI.
void start_hypre() {
  static const bool started = [] {
    check(HYPRE_Init(), "HYPRE_Init");
    return true;
  }();
  static_cast<void>(started);
}

struct IjVector {
  HYPRE_IJVector handle = nullptr;
  HYPRE_ParVector vector = nullptr;
  IjVector() = default;
  IjVector(const IjVector&) = delete;
  IjVector& operator=(const IjVector&) = delete;
  ~IjVector() {
    if (handle != nullptr) HYPRE_IJVectorDestroy(handle);
  }
  void create(MPI_Comm comm, HYPRE_BigInt first, HYPRE_BigInt last) {
    check(HYPRE_IJVectorCreate(comm, first, last, &handle), "IJVectorCreate");
    check(HYPRE_IJVectorSetObjectType(handle, HYPRE_PARCSR), "IJVectorSetObjectType");
    check(HYPRE_IJVectorInitialize(handle), "IJVectorInitialize");
    check(HYPRE_IJVectorAssemble(handle), "IJVectorAssemble");
    void* object = nullptr;
    check(HYPRE_IJVectorGetObject(handle, &object), "IJVectorGetObject");
    vector = static_cast<HYPRE_ParVector>(object);
  }
};

}  // namespace

struct Amg::Implementation {
  const Part& part;
  BlockMatrix matrix;
  std::vector<double> diagonal;   ///< of B summed over the ranks, for decoupled rows
  HYPRE_BigInt first = 0, count = 0;
  HYPRE_IJMatrix handle = nullptr;
  HYPRE_Solver solver = nullptr;
  IjVector right, left;
  int setups = 0;
  double seconds = 0.0;

  explicit Implementation(const Part& p) : part(p), matrix(node_graph(p.body())) {
    start_hypre();
    const std::int64_t dim = part.dim();
    if (part.total_nodes * dim > std::numeric_limits<HYPRE_BigInt>::max())
      throw InputError("the problem has " + std::to_string(part.total_nodes * dim) +
                       " unknowns; Debian's hypre is a 32-bit build and takes at most " +
                       std::to_string(std::numeric_limits<HYPRE_BigInt>::max()));
    first = static_cast<HYPRE_BigInt>(part.first_owned * dim);
    count = static_cast<HYPRE_BigInt>(part.owned_unknowns());
    right.create(part.halo.comm, first, first + count - 1);
    left.create(part.halo.comm, first, first + count - 1);
  }
  ~Implementation() { release(); }
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  void release() {
    if (solver != nullptr) HYPRE_BoomerAMGDestroy(solver);
    if (handle != nullptr) HYPRE_IJMatrixDestroy(handle);
    solver = nullptr;
    handle = nullptr;
  }

  void fill_matrix();
  void create_solver();
};

void Amg::Implementation::fill_matrix() {
  const auto dim = static_cast<std::size_t>(part.dim());
  check(HYPRE_IJMatrixCreate(part.halo.comm, first, first + count - 1, first, first + count - 1, &handle),
        "IJMatrixCreate");
  check(HYPRE_IJMatrixSetObjectType(handle, HYPRE_PARCSR), "IJMatrixSetObjectType");
  std::vector<HYPRE_Int> sizes(part.owned_unknowns());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::size_t n = i / dim;
    sizes[i] = static_cast<HYPRE_Int>(dim) * static_cast<HYPRE_Int>(matrix.start[n + 1] - matrix.start[n]);
  }
  check(HYPRE_IJMatrixSetRowSizes(handle, sizes.data()), "IJMatrixSetRowSizes");
  check(HYPRE_IJMatrixInitialize(handle), "IJMatrixInitialize");

  std::vector<HYPRE_BigInt> columns;
  std::vector<double> values;
  for (std::size_t n = 0; n < matrix.rows(); ++n)
    for (std::size_t i = 0; i < dim; ++i) {
      const std::size_t row = n * dim + i;
      columns.clear();
      values.clear();
      if (part.held[row]) {
        if (n >= static_cast<std::size_t>(part.owned_nodes)) continue;
        columns.push_back(static_cast<HYPRE_BigInt>(part.global_node[n]) * static_cast<HYPRE_BigInt>(dim) +
                          static_cast<HYPRE_BigInt>(i));
        values.push_back(diagonal[row]);
      } else {
        for (auto k = matrix.start[n]; k < matrix.start[n + 1]; ++k) {
          const auto m = static_cast<std::size_t>(matrix.column[static_cast<std::size_t>(k)]);
          for (std::size_t j = 0; j < dim; ++j) {
            if (part.held[m * dim + j]) continue;
            const double v = matrix.value[static_cast<std::size_t>(k) * dim * dim + i * dim + j];
            columns.push_back(static_cast<HYPRE_BigInt>(part.global_node[m]) * static_cast<HYPRE_BigInt>(dim) +
                              static_cast<HYPRE_BigInt>(j));
            values.push_back(v);
          }
        }
      }
      HYPRE_Int entries = static_cast<HYPRE_Int>(columns.size());
      const auto global_row = static_cast<HYPRE_BigInt>(part.global_node[n]) * static_cast<HYPRE_BigInt>(dim) +
                              static_cast<HYPRE_BigInt>(i);
      check(HYPRE_IJMatrixAddToValues(handle, 1, &entries, &global_row, columns.data(), values.data()),
            "IJMatrixAddToValues");
    }
  check(HYPRE_IJMatrixAssemble(handle), "IJMatrixAssemble");
}

void Amg::Implementation::create_solver() {
  check(HYPRE_BoomerAMGCreate(&solver), "BoomerAMGCreate");
  check(HYPRE_BoomerAMGSetPrintLevel(solver, 0), "SetPrintLevel");
  check(HYPRE_BoomerAMGSetMaxIter(solver, 1), "SetMaxIter");
  check(HYPRE_BoomerAMGSetTol(solver, 0.0), "SetTol");
  check(HYPRE_BoomerAMGSetNumFunctions(solver, part.dim()), "SetNumFunctions");
  check(HYPRE_BoomerAMGSetCoarsenType(solver, 10), "SetCoarsenType");  // HMIS
  check(HYPRE_BoomerAMGSetInterpType(solver, 6), "SetInterpType");     // extended+i
  check(HYPRE_BoomerAMGSetPMaxElmts(solver, 4), "SetPMaxElmts");
  check(HYPRE_BoomerAMGSetStrongThreshold(solver, part.dim() == 3 ? 0.5 : 0.25), "SetStrongThreshold");
  check(HYPRE_BoomerAMGSetRelaxType(solver, 8), "SetRelaxType");  // l1 symmetric Gauss–Seidel
  // One aggressive level in 3D: 1.4 s and 11.7 s against 3.5 s and 15.9 s (setup, solve), 812k unknowns.
  if (part.dim() == 3) check(HYPRE_BoomerAMGSetAggNumLevels(solver, 1), "SetAggNumLevels");
  void* object = nullptr;
  check(HYPRE_IJMatrixGetObject(handle, &object), "IJMatrixGetObject");
  check(HYPRE_BoomerAMGSetup(solver, static_cast<HYPRE_ParCSRMatrix>(object), right.vector, left.vector),
        "BoomerAMGSetup");
}

Amg::Amg(const Part& part) : impl_(std::make_unique<Implementation>(part)) {}
Amg::~Amg() = default;
Amg::Amg(Amg&&) noexcept = default;
Amg& Amg::operator=(Amg&&) noexcept = default;

void Amg::setup(std::span<const double> g, std::span<const NodeBlock> blocks) {
  auto& self = *impl_;
  const double start = MPI_Wtime();
  self.release();
  assemble(self.part.body(), g, self.matrix);
  const auto dim = static_cast<std::size_t>(self.part.dim());
  for (const auto& b : blocks) {
    double* to = self.matrix.block(b.node, b.node);
    for (std::size_t k = 0; k < dim * dim; ++k) to[k] += b.value[k];
  }
  self.diagonal.resize(self.part.unknowns());
  for (std::size_t n = 0; n < self.matrix.rows(); ++n) {
    const double* block = self.matrix.block(static_cast<std::int32_t>(n), static_cast<std::int32_t>(n));
    for (std::size_t i = 0; i < dim; ++i) self.diagonal[n * dim + i] = block[i * dim + i];
  }
  self.part.halo.sum(self.diagonal, self.part.dim());
  self.fill_matrix();
  self.create_solver();
  ++self.setups;
  self.seconds += MPI_Wtime() - start;
}

void Amg::apply(std::span<const double> r, std::span<double> z) const {
  const auto& self = *impl_;
  check(HYPRE_IJVectorSetValues(self.right.handle, self.count, nullptr, r.data()), "IJVectorSetValues");
  check(HYPRE_ParVectorSetConstantValues(self.left.vector, 0.0), "ParVectorSetConstantValues");
  void* object = nullptr;
  check(HYPRE_IJMatrixGetObject(self.handle, &object), "IJMatrixGetObject");
  check(HYPRE_BoomerAMGSolve(self.solver, static_cast<HYPRE_ParCSRMatrix>(object), self.right.vector,
                             self.left.vector),
        "BoomerAMGSolve");
  check(HYPRE_IJVectorGetValues(self.left.handle, self.count, nullptr, z.data()), "IJVectorGetValues");
  self.part.halo.copy_from_owner(z, self.part.dim());
}

int Amg::setups() const noexcept { return impl_->setups; }
double Amg::setup_seconds() const noexcept { return impl_->seconds; }

}  // namespace kacanov
