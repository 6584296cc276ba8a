/* SPDX-License-Identifier: BSD-3-Clause */
/* The solver's front door in C: a whole case, given as the text of its file, from mesh to certificate.
 *
 *   kacanov_solve_options options = {0};
 *   options.struct_size = sizeof options;
 *   options.folder = "cases";                      relative paths of the case start here
 *   char message[1024];
 *   kacanov_solution *solution;
 *   if (kacanov_solve(text, &options, &solution, message, sizeof message)) { puts(message); return 1; }
 *   size_t count;
 *   const double *u = kacanov_solution_field(solution, KACANOV_FIELD_DISPLACEMENT, &count);
 *   puts(kacanov_solution_json(solution));         what `kacanov run` writes into result.json
 *   kacanov_solution_destroy(solution);
 *
 * The numbers are those of `kacanov run` on as many processes and threads, to the last bit. Codes, messages
 * and struct_size are as in kacanov.h: nothing is thrown or printed, no file is written.
 *
 * A solve needs MPI. Where the host has started it, it is used and left alone; else the first solve starts it
 * for this process alone, leaves environment and signal handlers as they were, and ends it when the process
 * exits. A process that has ended MPI cannot solve, nor can the child of a fork() after a solve. Solves are
 * done one at a time: a call from another thread waits; it needs MPI_THREAD_SERIALIZED if the host has
 * started MPI. Numbers are read and written with a point whatever the host's locale is, which callbacks see.
 */
#ifndef KACANOV_SOLVE_H
#define KACANOV_SOLVE_H

#include <kacanov/kacanov.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A step of the run that is over. */
typedef struct kacanov_progress {
  size_t struct_size;         /* the library's: look at no field beyond it */
  const char* phase;          /* how the step was taken: "admm", "dual_admm", "active_set", "newton" */
  int64_t contact_iterations; /* of this step */
  int64_t cg_iterations;      /* of this step */
  double penalty;             /* of contact, at present */
  double energy;              /* stored in the body */
  double worst_residual;      /* the largest of the KKT residuals, relative: done below solver.tolerance */
  double seconds;             /* since the run began */
  int32_t outer;              /* steps so far */
  int32_t reserved;
} kacanov_progress;

/* Called on the first process after every outer step, those on coarser meshes before the case's own included
 * (solver.nested), where `outer` begins again. `step` and what it points to are gone afterwards.
 * Neither callback may throw, jump, or solve. */
typedef void (*kacanov_progress_callback)(void* data, const kacanov_progress* step);

/* Asked every few applications of the operator, on the calling thread of every process, until it says yes
 * (other than 0) on one: then the run ends with the state after its last whole outer step. */
typedef int (*kacanov_stop_callback)(void* data);

typedef struct kacanov_solution kacanov_solution;

typedef struct kacanov_solve_options {
  size_t struct_size; /* sizeof(kacanov_solve_options) */
  const char* folder; /* where relative paths of the case start; null: the process's current folder */
  const char* name;   /* of the case, in messages and results; null: "case" */
  int32_t threads;    /* of each process; 0: one for small cases or beside other processes, else one a core */
  int32_t skip_memory_check;          /* 1: a run is not refused because it looks too large for the memory */
  kacanov_progress_callback progress; /* may be null */
  kacanov_stop_callback stop;         /* may be null, on some processes as well */
  void* data;                         /* handed to both */
  const void* mesh; /* content of the mesh file, where it is in memory: the file that the case names is not
                       opened then, and says by its ending what format this is */
  size_t mesh_size; /* bytes */
  const kacanov_solution* start; /* a solution of the same body to start from, on any mesh; may be null */
  const void* communicator;      /* points to an MPI_Comm: all its processes call, with the same options, and
                                    the first one's text counts; null: this process alone */
} kacanov_solve_options;

/* Solves the case whose file would hold `text`. `options` may be null. Not converging is no error: see
 * kacanov_solution_information.status. After an error `*solution` is null and `message` (may be null) holds
 * at most `message_size` - 1 characters: for KACANOV_ERROR_CASE what is wrong in the words of the case file,
 * with the path of the key or the line. */
KACANOV_API int kacanov_solve(const char* text, const kacanov_solve_options* options,
                              kacanov_solution** solution, char* message, size_t message_size);

/* Frees the solution and all its arrays; null is allowed. */
KACANOV_API void kacanov_solution_destroy(kacanov_solution* solution);

typedef enum kacanov_status {
  KACANOV_CONVERGED = 0,
  KACANOV_LIMITED_BY_ROUNDING = 1, /* as far as arithmetic goes, yet not below the tolerance */
  KACANOV_NOT_CONVERGED = 2,
  KACANOV_INTERRUPTED = 3 /* the stop callback said so: the best state so far */
} kacanov_status;

typedef struct kacanov_solution_information {
  size_t struct_size; /* set by the caller before the call: sizeof(kacanov_solution_information) */
  size_t nodes; /* of the mesh as it was solved on; 0 on all processes but the first, as are all counts */
  size_t elements;
  size_t contact_points;
  int32_t status;  /* kacanov_status */
  int32_t element; /* kacanov_element */
  int32_t dimension;
  int32_t nodes_per_element;
  double worst_residual; /* the largest of the KKT residuals */
  const char* message;   /* why the run ended, in words; valid as long as the solution */
} kacanov_solution_information;
KACANOV_API int kacanov_solution_inspect(const kacanov_solution* solution,
                                         kacanov_solution_information* information);

/* What result.json holds; valid as long as the solution. */
KACANOV_API const char* kacanov_solution_json(const kacanov_solution* solution);

/* Arrays of double. Nodes, elements and contact points are in the order of the mesh; `dimension` components
 * lie together, or 6 of a stress: xx yy zz xy yz zx. */
typedef enum kacanov_field {
  KACANOV_FIELD_COORDINATES = 0,        /* nodes * dimension */
  KACANOV_FIELD_DISPLACEMENT = 1,       /* nodes * dimension */
  KACANOV_FIELD_STRESS = 2,             /* nodes * 6, recovered */
  KACANOV_FIELD_VON_MISES = 3,          /* nodes, of that stress */
  KACANOV_FIELD_ELEMENT_STRESS = 4,     /* elements * 6, means */
  KACANOV_FIELD_ELEMENT_VON_MISES = 5,  /* elements */
  KACANOV_FIELD_ELEMENT_DEV_STRAIN = 6, /* elements: |dev eps| */
  KACANOV_FIELD_ELEMENT_SECANT = 7,     /* elements: g */
  KACANOV_FIELD_CONTACT_NORMAL = 8,     /* contact points * 3, unit, from the body to the obstacle */
  KACANOV_FIELD_CONTACT_GAP = 9,        /* contact points: open distance */
  KACANOV_FIELD_CONTACT_PRESSURE = 10,  /* contact points */
  KACANOV_FIELD_CONTACT_TRACTION = 11   /* contact points * 3: friction, what the obstacle does to the body */
} kacanov_field;

/* Arrays of int32_t; numbers of nodes and of the case's contact entries are from 0. */
typedef enum kacanov_index {
  KACANOV_INDEX_CONNECTIVITY = 0,  /* elements * nodes_per_element, in Gmsh's order */
  KACANOV_INDEX_CONTACT_NODE = 1,  /* contact points */
  KACANOV_INDEX_CONTACT_ENTRY = 2, /* contact points */
  KACANOV_INDEX_CONTACT_STATUS =
      3,                    /* contact points: 0 open, 1 stick, 2 slip (Tresca also without pressure) */
  KACANOV_INDEX_PLASTIC = 4 /* elements: 1 where any point is beyond yield */
} kacanov_index;

/* The array of that kind, which belongs to the solution and lives as long; `*count` (may be null) is its
 * length. Null with `*count` 0 where there is no such array, it is empty, or memory is out. Arrays of
 * elements are made when they are first asked for; several threads may ask at once. */
KACANOV_API const double* kacanov_solution_field(const kacanov_solution* solution, int32_t field,
                                                 size_t* count);
KACANOV_API const int32_t* kacanov_solution_indices(const kacanov_solution* solution, int32_t index,
                                                    size_t* count);

/* The mesh file's own numbers of nodes (elements 0) or of elements (elements 1). */
KACANOV_API const int64_t* kacanov_solution_numbers(const kacanov_solution* solution, int32_t elements,
                                                    size_t* count);

#ifdef __cplusplus
}
#endif

#endif
