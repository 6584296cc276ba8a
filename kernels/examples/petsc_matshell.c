/* SPDX-License-Identifier: BSD-3-Clause */
/* A PETSc program: the operator as a MatShell, solved by KSP's conjugate gradients with the library's
 * multigrid as a shell preconditioner. A bar of trilinear hexahedra on rollers is pulled along x; the exact
 * displacement is known and linear. */
#include <petscksp.h>

#include <kacanov/kacanov.h>

typedef struct Shell {
  kacanov_operator* op;
  kacanov_multigrid* multigrid;
  size_t n;
} Shell;

#define KACANOV(op, call)                                                                                  \
  do {                                                                                                     \
    if ((call) != KACANOV_OK) SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "kacanov: %s", kacanov_message(op)); \
  } while (0)

static PetscErrorCode multiply(Mat matrix, Vec in, Vec out) {
  Shell* shell;
  const PetscScalar* x;
  PetscScalar* y;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(matrix, &shell));
  PetscCall(VecGetArrayRead(in, &x));
  PetscCall(VecGetArrayWrite(out, &y));
  KACANOV(shell->op, kacanov_apply(shell->op, shell->n, x, y));
  PetscCall(VecRestoreArrayWrite(out, &y));
  PetscCall(VecRestoreArrayRead(in, &x));
  PetscFunctionReturn(0);
}

static PetscErrorCode get_diagonal(Mat matrix, Vec diagonal) {
  Shell* shell;
  PetscScalar* d;
  PetscFunctionBeginUser;
  PetscCall(MatShellGetContext(matrix, &shell));
  PetscCall(VecGetArrayWrite(diagonal, &d));
  KACANOV(shell->op, kacanov_diagonal(shell->op, shell->n, d));
  PetscCall(VecRestoreArrayWrite(diagonal, &d));
  PetscFunctionReturn(0);
}

static PetscErrorCode precondition(PC pc, Vec in, Vec out) {
  Shell* shell;
  const PetscScalar* r;
  PetscScalar* z;
  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &shell));
  PetscCall(VecGetArrayRead(in, &r));
  PetscCall(VecGetArrayWrite(out, &z));
  if (kacanov_multigrid_apply(shell->multigrid, shell->n, r, z) != KACANOV_OK)
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "kacanov: %s", kacanov_multigrid_message(shell->multigrid));
  PetscCall(VecRestoreArrayWrite(out, &z));
  PetscCall(VecRestoreArrayRead(in, &r));
  PetscFunctionReturn(0);
}

int main(int argc, char** argv) {
  enum { nx = 24, n = 6 };
  const double length = 4.0, young = 2.0, poisson = 0.3, stress = 0.01;
  const size_t nodes = (nx + 1) * (n + 1) * (n + 1), elements = nx * n * n, unknowns = 3 * nodes;
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));

  double *coordinates, *load;
  int32_t *connectivity, *held;
  size_t held_count = 0;
  PetscCall(PetscCalloc2(unknowns, &coordinates, unknowns, &load));
  PetscCall(PetscCalloc2(8 * elements, &connectivity, unknowns, &held));
  for (int k = 0, node = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= nx; ++i, ++node) {
        const double share_y = (j == 0 || j == n) ? 0.5 : 1.0, share_z = (k == 0 || k == n) ? 0.5 : 1.0;
        coordinates[3 * node] = length * i / nx;
        coordinates[3 * node + 1] = (double)j / n;
        coordinates[3 * node + 2] = (double)k / n;
        if (i == 0) held[held_count++] = 3 * node;
        if (j == 0) held[held_count++] = 3 * node + 1;
        if (k == 0) held[held_count++] = 3 * node + 2;
        if (i == nx) load[3 * node] = stress * share_y * share_z / (n * n);
      }
  for (int k = 0, at = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < nx; ++i)
        for (int layer = 0; layer < 2; ++layer) { /* Gmsh's order: around the bottom, then around the top */
          const int32_t corner = ((k + layer) * (n + 1) + j) * (nx + 1) + i;
          connectivity[at++] = corner;
          connectivity[at++] = corner + 1;
          connectivity[at++] = corner + nx + 2;
          connectivity[at++] = corner + nx + 1;
        }

  kacanov_law law = {0};
  law.struct_size = sizeof law;
  PetscCheck(kacanov_elastic_law(young, poisson, &law) == KACANOV_OK, PETSC_COMM_SELF, PETSC_ERR_LIB, "law");
  kacanov_description body = {0};
  body.struct_size = sizeof body;
  body.element = KACANOV_HEX8;
  body.threads = 2;
  body.nodes = nodes;
  body.coordinates = coordinates;
  body.elements = elements;
  body.connectivity = connectivity;
  body.laws = 1;
  body.law = &law;
  body.borrow = 1; /* the arrays outlive the operator */
  Shell shell = {NULL, NULL, unknowns};
  char message[256];
  if (kacanov_create(&body, &shell.op, message, sizeof message) != KACANOV_OK)
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "kacanov: %s", message);
  KACANOV(shell.op, kacanov_constrain(shell.op, held_count, held));
  KACANOV(shell.op, kacanov_multigrid_create(shell.op, NULL, &shell.multigrid));

  Mat matrix;
  Vec f, u;
  KSP ksp;
  PC preconditioner;
  const PetscInt size = (PetscInt)unknowns;
  PetscCall(MatCreateShell(PETSC_COMM_SELF, size, size, size, size, &shell, &matrix));
  PetscCall(MatShellSetOperation(matrix, MATOP_MULT, (void (*)(void))multiply));
  PetscCall(MatShellSetOperation(matrix, MATOP_GET_DIAGONAL, (void (*)(void))get_diagonal));
  PetscCall(MatSetOption(matrix, MAT_SPD, PETSC_TRUE));
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, size, load, &f));
  PetscCall(VecDuplicate(f, &u));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &ksp));
  PetscCall(KSPSetOperators(ksp, matrix, matrix));
  PetscCall(KSPSetType(ksp, KSPCG));
  PetscCall(KSPGetPC(ksp, &preconditioner));
  PetscCall(PCSetType(preconditioner, PCSHELL));
  PetscCall(PCShellSetContext(preconditioner, &shell));
  PetscCall(PCShellSetApply(preconditioner, precondition));
  PetscCall(KSPSetTolerances(ksp, 1e-12, PETSC_DEFAULT, PETSC_DEFAULT, 5000));
  PetscCall(KSPSetFromOptions(ksp));
  PetscCall(KSPSolve(ksp, f, u));

  PetscInt iterations;
  KSPConvergedReason reason;
  PetscCall(KSPGetIterationNumber(ksp, &iterations));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  const PetscScalar* values;
  double error = 0.0;
  PetscCall(VecGetArrayRead(u, &values));
  for (size_t i = 0; i < unknowns; ++i) {
    const double exact = stress / young * coordinates[i] * (i % 3 == 0 ? 1.0 : -poisson);
    error = PetscMax(error, PetscAbsReal(values[i] - exact) / (stress / young * length));
  }
  PetscCall(VecRestoreArrayRead(u, &values));
  PetscCall(PetscPrintf(PETSC_COMM_SELF, "%d unknowns: %s after %d iterations, largest relative error %.2e\n",
                        (int)unknowns, KSPConvergedReasons[reason], (int)iterations, error));

  PetscCall(KSPDestroy(&ksp));
  PetscCall(VecDestroy(&u));
  PetscCall(VecDestroy(&f));
  PetscCall(MatDestroy(&matrix));
  kacanov_multigrid_destroy(shell.multigrid);
  kacanov_destroy(shell.op);
  PetscCall(PetscFree2(connectivity, held));
  PetscCall(PetscFree2(coordinates, load));
  PetscCall(PetscFinalize());
  return reason > 0 && error < 1e-9 ? 0 : 1;
}
