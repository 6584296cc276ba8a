/* SPDX-License-Identifier: BSD-3-Clause */
/* A plain C program: Kacanov's method for a clamped bar of tetrahedra, each step solved by conjugate
 * gradients with multigrid. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <kacanov/kacanov.h>

/* A bar of nx by n by n cells with edge 1/n, each split into six tetrahedra. */
typedef struct Bar {
  size_t nodes, elements;
  double* coordinates;
  int32_t* connectivity;
} Bar;

static void* allocate(size_t count, size_t size) {
  void* memory = calloc(count, size);
  if (memory == NULL) {
    fputs("out of memory\n", stderr);
    exit(EXIT_FAILURE);
  }
  return memory;
}

static Bar make_bar(int nx, int n) {
  static const int path[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}}; /* around diagonal 0-7 */
  const size_t cells = (size_t)nx * (size_t)n * (size_t)n;
  Bar bar = {(size_t)(nx + 1) * (size_t)(n + 1) * (size_t)(n + 1), 6 * cells, NULL, NULL};
  bar.coordinates = allocate(3 * bar.nodes, sizeof(double));
  bar.connectivity = allocate(4 * bar.elements, sizeof(int32_t));
  double* x = bar.coordinates;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= nx; ++i, x += 3) {
        x[0] = (double)i / n;
        x[1] = (double)j / n;
        x[2] = (double)k / n;
      }
  int32_t* element = bar.connectivity;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < nx; ++i) {
        int32_t corner[8]; /* bit 0: x, bit 1: y, bit 2: z */
        for (int c = 0; c < 8; ++c)
          corner[c] = ((k + (c >> 2)) * (n + 1) + j + ((c >> 1) & 1)) * (nx + 1) + i + (c & 1);
        for (int t = 0; t < 6; ++t, element += 4) {
          element[0] = corner[0];
          element[1] = corner[path[t][0]];
          element[2] = corner[path[t][1]];
          element[3] = corner[7];
        }
      }
  return bar;
}

static void check(int code, const kacanov_operator* op) {
  if (code == KACANOV_OK) return;
  fprintf(stderr, "kacanov error %d: %s\n", code, kacanov_message(op));
  exit(EXIT_FAILURE);
}

static double dot(size_t n, const double* x, const double* y) {
  double sum = 0.0;
  for (size_t i = 0; i < n; ++i) sum += x[i] * y[i];
  return sum;
}

int main(void) {
  const int n = 5;
  const Bar bar = make_bar(4 * n, n);
  const size_t unknowns = 3 * bar.nodes;

  kacanov_law law = {0};
  law.struct_size = sizeof law;
  if (kacanov_elastic_law(1.0, 0.3, &law) != KACANOV_OK) return EXIT_FAILURE;
  law.kind = KACANOV_LOGARITHMIC;
  law.x0 = 0.002;

  kacanov_description body = {0};
  body.struct_size = sizeof body;
  body.element = KACANOV_TET4;
  body.threads = 2;
  body.nodes = bar.nodes;
  body.coordinates = bar.coordinates;
  body.elements = bar.elements;
  body.connectivity = bar.connectivity;
  body.laws = 1;
  body.law = &law;

  kacanov_operator* op;
  char message[256];
  if (kacanov_create(&body, &op, message, sizeof message) != KACANOV_OK) {
    fprintf(stderr, "kacanov: %s\n", message);
    return EXIT_FAILURE;
  }

  /* Held at x = 0, pulled at x = 4 with a total force of 0.0018 along x. */
  int32_t* held = allocate(unknowns, sizeof(int32_t));
  size_t held_count = 0;
  double *f = allocate(unknowns, sizeof(double)), *u = allocate(unknowns, sizeof(double)),
         *inner = allocate(unknowns, sizeof(double));
  for (size_t i = 0; i < bar.nodes; ++i) {
    for (int c = 0; c < 3; ++c)
      if (bar.coordinates[3 * i] == 0.0) held[held_count++] = (int32_t)(3 * i) + c;
    if (bar.coordinates[3 * i] == 4.0) f[3 * i] = 0.0018 / ((n + 1) * (n + 1));
  }

  check(kacanov_constrain(op, held_count, held), op);
  kacanov_multigrid* multigrid;
  check(kacanov_multigrid_create(op, NULL, &multigrid), op);

  /* Kacanov: freeze g at u, solve, repeat until the true internal force balances f. */
  double residual = 1.0, energy = 0.0, functional_before = HUGE_VAL;
  for (int step = 1; step <= 100 && residual > 1e-7; ++step) {
    /* The first multigrid has the g of an elastic step, later ones that of the previous step. */
    if (step > 1 && kacanov_multigrid_update(multigrid) != KACANOV_OK) {
      fprintf(stderr, "kacanov: %s\n", kacanov_multigrid_message(multigrid));
      return EXIT_FAILURE;
    }
    kacanov_cg_options options = {0};
    options.struct_size = sizeof options;
    options.relative = 1e-3; /* of a residual that decreases from step to step */
    kacanov_cg_result solve = {0};
    solve.struct_size = sizeof solve;
    check(kacanov_cg(op, multigrid, &options, unknowns, f, u, &solve), op);
    check(kacanov_residual_energy_update(op, unknowns, u, inner, &energy), op);
    double square = 0.0;
    for (size_t i = 0; i < held_count; ++i) inner[held[i]] = 0.0; /* support forces */
    for (size_t i = 0; i < unknowns; ++i) square += (f[i] - inner[i]) * (f[i] - inner[i]);
    residual = sqrt(square / dot(unknowns, f, f));
    const double functional = energy - dot(unknowns, f, u);
    printf("step %2d: %4d CG iterations, residual %.2e, functional %.10e\n", step, solve.iterations, residual,
           functional);
    if (functional > functional_before + 1e-12 * fabs(functional)) {
      fputs("the functional has to fall from step to step\n", stderr);
      return EXIT_FAILURE;
    }
    functional_before = functional;
  }

  double* mises = allocate(bar.elements, sizeof(double));
  uint8_t* plastic = allocate(bar.elements, 1);
  kacanov_fields fields = {0};
  fields.struct_size = sizeof fields;
  fields.elements = bar.elements;
  fields.von_mises = mises;
  fields.plastic = plastic;
  check(kacanov_stress(op, unknowns, u, &fields), op);
  double largest = 0.0;
  size_t yielding = 0;
  for (size_t e = 0; e < bar.elements; ++e) {
    largest = fmax(largest, mises[e]);
    yielding += plastic[e];
  }
  kacanov_information information = {0};
  information.struct_size = sizeof information;
  check(kacanov_inspect(op, &information), op);
  printf("%zu unknowns, %s, %zu bytes; largest von Mises stress %.4e, %zu of %zu elements beyond yield\n",
         information.unknowns, information.instruction_set, information.bytes, largest, yielding,
         bar.elements);

  kacanov_multigrid_destroy(multigrid);
  kacanov_destroy(op);
  free(held), free(f), free(u), free(inner), free(mises), free(plastic), free(bar.coordinates),
      free(bar.connectivity);
  return residual <= 1e-7 && yielding > 0 && yielding < bar.elements ? EXIT_SUCCESS : EXIT_FAILURE;
}
