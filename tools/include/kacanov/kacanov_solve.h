/* SPDX-License-Identifier: BSD-3-Clause */
/* C interface of the solver: solves a whole case, given as the text of its file, from mesh to certificate.
 *
 *   kacanov_solve_options options = {0};
 *   options.struct_size = sizeof options;
 *   options.folder = "cases";                      relative paths of the case start here
 *   char message[1024];
 *   kacanov_solution *solution;
 *   if (kacanov_solve(text, &options, &solution, message, sizeof message)) { puts(message); return 1; }
 *   size_t count;
 *   const double *u = kacanov_solution_field(solution, KACANOV_FIELD_DISPLACEMENT, &count);
 *   puts(kacanov_solution_json(solution));         the result.json of `kacanov run`
 *   kacanov_solution_destroy(solution);
 *
 * The results are bitwise equal to those of `kacanov run` with the same numbers of processes and threads.
 * Codes, messages and struct_size are as in kacanov.h: nothing is thrown or printed, no file is written.
 *
 * A solve needs MPI. If the host has started it, it is used and left alone; otherwise the first solve starts
 * it for this process alone, restores environment and signal handlers, and finalises it at process exit. A
 * process that has finalised MPI cannot solve, nor can a child forked after a solve. Only one solve runs at a
 * time: a call from another thread waits; it needs MPI_THREAD_SERIALIZED if the host has started MPI. Numbers
 * are read and written with a decimal point in any locale; callbacks run in the host's locale.
 */
#ifndef KACANOV_SOLVE_H
#define KACANOV_SOLVE_H

#include <kacanov/kacanov.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A completed outer step of the run. */
typedef struct kacanov_progress {
  size_t struct_size;         /* set by the library: fields beyond it do not exist */
  const char* phase;          /* method of the step: "admm", "dual_admm", "active_set", "newton" */
  int64_t contact_iterations; /* of this step */
  int64_t cg_iterations;      /* of this step */
  double penalty;             /* current contact penalty */
  double energy;              /* stored in the body */
  double worst_residual;      /* largest relative KKT residual; the run ends below solver.tolerance */
  double seconds;             /* since the start of the run */
  int32_t outer;              /* steps so far */
  int32_t reserved;
} kacanov_progress;

/* Called on the first process after every outer step, including steps on coarser meshes (solver.nested), for
 * each of which `outer` restarts. `step` and its pointers are valid during the call only. Neither callback
 * may throw, jump, or solve. */
typedef void (*kacanov_progress_callback)(void* data, const kacanov_progress* step);

/* Called every few operator applications, on the calling thread of every process. If it returns non-zero on
 * any process, the run ends with the state after its last complete outer step. */
typedef int (*kacanov_stop_callback)(void* data);

typedef struct kacanov_solution kacanov_solution;

typedef struct kacanov_solve_options {
  size_t struct_size; /* sizeof(kacanov_solve_options) */
  const char* folder; /* where relative paths of the case start; null: current working directory */
  const char* name;   /* name of the case in messages and results; null: "case" */
  int32_t threads;    /* per process; 0: one for small cases or with several processes, else one per core */
  int32_t skip_memory_check;          /* 1: do not refuse a run that seems too large for the memory */
  kacanov_progress_callback progress; /* may be null */
  kacanov_stop_callback stop;         /* may be null, also on only some processes */
  void* data;                         /* passed to both callbacks */
  const void* mesh; /* content of the mesh file, if it is in memory: the file named in the case is then not
                       opened; its content determines the format */
  size_t mesh_size; /* bytes */
  const kacanov_solution* start; /* initial guess: a solution of the same body on any mesh; may be null */
  const void* communicator;      /* points to an MPI_Comm: all its processes call with the same options; the
                                    text of the first counts; null: this process alone */
} kacanov_solve_options;

/* Solves the case given by `text`, the content of a case file. `options` may be null. A run that does not
 * converge is no error: see kacanov_solution_information.status. After an error `*solution` is null, and
 * `message` (may be null) contains at most `message_size` - 1 characters: for KACANOV_ERROR_CASE the path of
 * the key or the line, and what was expected there. */
KACANOV_API int kacanov_solve(const char* text, const kacanov_solve_options* options,
                              kacanov_solution** solution, char* message, size_t message_size);

/* Frees the solution and all its arrays; null is allowed. */
KACANOV_API void kacanov_solution_destroy(kacanov_solution* solution);

typedef enum kacanov_status {
  KACANOV_CONVERGED = 0,
  KACANOV_LIMITED_BY_ROUNDING = 1, /* round-off prevents reaching the tolerance */
  KACANOV_NOT_CONVERGED = 2,
  KACANOV_INTERRUPTED = 3 /* stopped by the callback: the best state so far */
} kacanov_status;

typedef struct kacanov_solution_information {
  size_t struct_size; /* set by the caller before the call: sizeof(kacanov_solution_information) */
  size_t nodes;       /* of the mesh of the solve; all counts are 0 except on the first process */
  size_t elements;
  size_t contact_points;
  int32_t status;  /* kacanov_status */
  int32_t element; /* kacanov_element */
  int32_t dimension;
  int32_t nodes_per_element;
  double worst_residual; /* largest KKT residual */
  const char* message;   /* why the run ended; valid as long as the solution */
} kacanov_solution_information;
KACANOV_API int kacanov_solution_inspect(const kacanov_solution* solution,
                                         kacanov_solution_information* information);

/* Returns the content of result.json; valid as long as the solution. */
KACANOV_API const char* kacanov_solution_json(const kacanov_solution* solution);

/* Arrays of double. Nodes, elements and contact points are in the order of the mesh. Components are
 * contiguous: `dimension` of a vector, 6 of a stress (xx yy zz xy yz zx). */
typedef enum kacanov_field {
  KACANOV_FIELD_COORDINATES = 0,        /* nodes * dimension */
  KACANOV_FIELD_DISPLACEMENT = 1,       /* nodes * dimension */
  KACANOV_FIELD_STRESS = 2,             /* nodes * 6, recovered */
  KACANOV_FIELD_VON_MISES = 3,          /* nodes, of the recovered stress */
  KACANOV_FIELD_ELEMENT_STRESS = 4,     /* elements * 6, element means */
  KACANOV_FIELD_ELEMENT_VON_MISES = 5,  /* elements */
  KACANOV_FIELD_ELEMENT_DEV_STRAIN = 6, /* elements: |dev eps| */
  KACANOV_FIELD_ELEMENT_SECANT = 7,     /* elements: g */
  KACANOV_FIELD_CONTACT_NORMAL = 8,     /* contact points * 3, unit, from the body to the obstacle */
  KACANOV_FIELD_CONTACT_GAP = 9,        /* contact points: open distance */
  KACANOV_FIELD_CONTACT_PRESSURE = 10,  /* contact points */
  KACANOV_FIELD_CONTACT_TRACTION = 11   /* contact points * 3: friction traction on the body */
} kacanov_field;

/* Arrays of int32_t; indices of nodes and of contact entries of the case start at 0. */
typedef enum kacanov_index {
  KACANOV_INDEX_CONNECTIVITY = 0,  /* elements * nodes_per_element, in Gmsh's order */
  KACANOV_INDEX_CONTACT_NODE = 1,  /* contact points */
  KACANOV_INDEX_CONTACT_ENTRY = 2, /* contact points */
  KACANOV_INDEX_CONTACT_STATUS =
      3,                    /* contact points: 0 open, 1 stick, 2 slip (Tresca also without pressure) */
  KACANOV_INDEX_PLASTIC = 4 /* elements: 1 if any quadrature point is beyond yield */
} kacanov_index;

/* Returns the array, which is owned by the solution and valid as long; `*count` (may be null) is its length.
 * Returns null with `*count` 0 if there is no such array, it is empty, or memory is exhausted. Element arrays
 * are computed at the first call; several threads may call at the same time. */
KACANOV_API const double* kacanov_solution_field(const kacanov_solution* solution, int32_t field,
                                                 size_t* count);
KACANOV_API const int32_t* kacanov_solution_indices(const kacanov_solution* solution, int32_t index,
                                                    size_t* count);

/* Returns the numbers in the mesh file of nodes (elements = 0) or of elements (elements = 1). */
KACANOV_API const int64_t* kacanov_solution_numbers(const kacanov_solution* solution, int32_t elements,
                                                    size_t* count);

#ifdef __cplusplus
}
#endif

#endif
