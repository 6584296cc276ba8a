/* SPDX-License-Identifier: BSD-3-Clause */
/* The C interface: matrix-free operators of small-strain elastoplasticity for other finite element codes.
 *
 * A body is meshed with one element type; each element follows a Hencky law
 *   tau = k0 tr(eps) I + 2 g(x) dev(eps),   x = |dev(eps)| (Frobenius norm),
 * with bulk modulus k0 and secant shear modulus g. A handle stores g, one value per quadrature point, frozen
 * at a displacement by kacanov_update, and applies the linear operator B(g) to vectors.
 *
 * Vectors are of double, or of float in the calls that end in _float. They have nodes * dimension entries,
 * interleaved (all components of node 0, then of node 1, ...; or see component_vectors), in the caller's node
 * order. Units are the caller's; in 2D all results are for unit thickness, or for the full circle around the
 * axis (kacanov_plane).
 *
 * Every function that returns int returns a kacanov_code: KACANOV_OK or an error, which the handle's
 * kacanov_message then describes. Output arrays have undefined content after an error. The library prints
 * nothing and has no global state and no MPI. Use a handle from one thread at a time: a call during another
 * call on the same handle returns KACANOV_ERROR_STATE and does nothing, not even set a message. Different
 * handles are independent. Arrays passed in remain the caller's.
 *
 * Structs may grow at their end in later versions; the library accepts callers built with older headers.
 * Every struct begins with struct_size, which the caller sets to its sizeof. Fields missing in an older
 * caller's struct count as zero; fields of a newer caller that this library does not have must be zero. Names
 * and numbers do not change.
 *
 * Threads belong to the library or, with KACANOV_THREADS=openmp in the environment, to OpenMP, one team per
 * calling thread. A small body uses fewer than requested (see kacanov_information.threads). After fork() the
 * child has none of its parent's threads, and operators there use one.
 *
 *   kacanov_description body = {0};
 *   body.struct_size = sizeof body;
 *   body.element = KACANOV_TET4;
 *   ...                                            coordinates, connectivity, laws, threads
 *   char message[256];
 *   kacanov_operator *op;
 *   if (kacanov_create(&body, &op, message, sizeof message)) { puts(message); return 1; }
 *   kacanov_apply(op, n, x, y);
 *   kacanov_destroy(op);
 */
#ifndef KACANOV_H
#define KACANOV_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define KACANOV_API __attribute__((visibility("default")))
#else
#define KACANOV_API
#endif

/* The version of this header; kacanov_version() returns that of the library. */
#define KACANOV_VERSION_MAJOR 0
#define KACANOV_VERSION_MINOR 2
#define KACANOV_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

typedef enum kacanov_code {
  KACANOV_OK = 0,
  KACANOV_ERROR_NULL = 1,     /* a required pointer is null */
  KACANOV_ERROR_SIZE = 2,     /* a vector or array has the wrong size, or two of them overlap */
  KACANOV_ERROR_MESH = 3,     /* index out of range, inverted or degenerate element, coordinate not finite */
  KACANOV_ERROR_LAW = 4,      /* a law's parameter is missing or out of range, or the law does not exist */
  KACANOV_ERROR_VALUE = 5,    /* an option or an entry of a vector is out of range or not finite */
  KACANOV_ERROR_STATE = 6,    /* a required earlier call is missing, or the handle is in use */
  KACANOV_ERROR_MEMORY = 7,   /* out of memory */
  KACANOV_ERROR_INTERNAL = 8, /* a bug in the library */
  KACANOV_ERROR_CASE = 9      /* of kacanov_solve: error in the case or one of its files; see the message */
} kacanov_code;

/* Node order is that of Gmsh; tet10 has its mid-side nodes on the edges 01 12 20 30 32 31. */
typedef enum kacanov_element {
  KACANOV_TRI3 = 0,  /* 2D, 1 quadrature point */
  KACANOV_TET4 = 1,  /* 1 point */
  KACANOV_TET10 = 2, /* 4 points */
  KACANOV_HEX8 = 3,  /* 8 points */
  KACANOV_QUAD4 = 4  /* 2D, 4 points */
} kacanov_element;

/* Plane state of a 2D body. */
typedef enum kacanov_plane {
  KACANOV_PLANE_STRAIN = 0,
  KACANOV_PLANE_STRESS = 1, /* no stress normal to the plane; not with mean_dilatation or KACANOV_USER */
  KACANOV_AXISYMMETRIC = 2 /* a section: x >= 0 is the distance from the axis, y runs along it. Integrals, and
                              therefore forces and energies, cover the full circle; zz of strains and stresses
                              is the hoop component. Not with KACANOV_USER */
} kacanov_plane;

/* Secant shear moduli g(a); g = mu below a = x0. */
typedef enum kacanov_law_kind {
  KACANOV_LINEAR = 0,           /* g = mu */
  KACANOV_LOGARITHMIC = 1,      /* mu (x0/a) (ln(a/x0) + 1) */
  KACANOV_LINEAR_HARDENING = 2, /* mu (gamma + (1 - gamma) x0/a), 0 < gamma <= 1 */
  KACANOV_POWER = 3,            /* mu (a/x0)^(n-1), 0 < n <= 1 */
  KACANOV_SATURATING = 4,       /* mu (x0/a) (1 + q (1 - exp(-(a-x0)/(q x0)))), q > 0 */
  KACANOV_TABLE = 5,            /* 2 g a piecewise linear through given points */
  KACANOV_RAMBERG_OSGOOD = 6, /* mu t x0/a with a/x0 = t + q t^n, from a = 0 on; q > 0, n > 1, not squared */
  KACANOV_USER = 7            /* computed by kacanov_law.evaluate; not squared */
} kacanov_law_kind;

/* Points at which a user-defined law is evaluated. The arrays belong to the library and are valid only during
 * the call. */
typedef struct kacanov_law_points {
  size_t struct_size; /* set by the library: do not access fields beyond it */
  size_t count;
  const double* x;        /* |dev eps| */
  const int32_t* element; /* from 0, in the caller's order: for laws that vary in space */
  const int32_t* point;   /* within the element, from 0; see kacanov_points */
  double* g;              /* output: the secant shear modulus, > 0 */
  double* slope;          /* output unless null: dg/dx */
  double* energy;         /* output unless null: G(x), the integral of g(s) s ds from 0 to x */
} kacanov_law_points;

/* A user-defined law: fills the requested outputs and returns 0; with any other value the call that evaluated
 * it fails with KACANOV_ERROR_LAW. It gets some thousand points per call, those of an element contiguous. It
 * must not throw, jump, or call the handle that evaluates it. */
typedef int (*kacanov_law_callback)(void* data, const kacanov_law_points* points);

typedef struct kacanov_law {
  size_t struct_size; /* sizeof(kacanov_law); the same for all laws of an array */
  int32_t kind;       /* kacanov_law_kind */
  int32_t squared;    /* 0: a = x = |dev eps|; 1: a = x^2 */
  double bulk;        /* k0 > 0 */
  double shear;       /* mu > 0 */
  double x0;          /* yield strain, compared with a; > 0 for all kinds except linear and table */
  double gamma;       /* linear hardening */
  double n;           /* power, Ramberg-Osgood */
  double q;           /* saturating, Ramberg-Osgood */
  size_t table_size;  /* table: number of points, from (0, 0); table_s increases, table_s/table_x must not
                         increase */
  const double* table_x;
  const double* table_s;   /* |dev tau| = 2 g a at table_x */
  int32_t mean_dilatation; /* 1: k0 acts on the element average of tr(eps) (B-bar), which prevents locking of
                              nearly incompressible and of plastic bodies; hex8 and quad4 */
  int32_t reserved;        /* 0 */

  /* KACANOV_USER only. bulk and shear are as for the other kinds; g is mu until the first update.
   * kacanov_stress marks strains beyond x0 as plastic; 0: none. */
  kacanov_law_callback evaluate; /* called by update, update_tangent, residual, energy, stress and the matrix
                                    of a tangent, never by apply, as long as the operator has the law */
  void* data;                    /* passed to evaluate */
  int32_t parallel; /* 1: the operator's threads may call it at the same time, each for its own points; 0:
                       only the calling thread calls it */
  int32_t reserved_user; /* 0 */
} kacanov_law;

/* The body. struct_size and zeros are a valid start: zero is the default of every optional field. */
typedef struct kacanov_description {
  size_t struct_size; /* sizeof(kacanov_description) */
  int32_t element;    /* kacanov_element */
  int32_t threads;    /* maximum number of threads of this operator; 0: one */

  size_t nodes;
  const double* coordinates; /* component c of node i: coordinates[i * node_stride + c * component_stride] */
  size_t node_stride;        /* 0: interleaved, the dimension */
  size_t component_stride;   /* 0: 1; `nodes` with node_stride 1 for one array per component */

  size_t elements;
  const int32_t* connectivity; /* node a of element e: connectivity[e * element_stride + a] - index_base */
  size_t element_stride;       /* 0: the number of nodes of an element */
  int32_t index_base;          /* number of the first node: 0, or 1 as in Fortran */

  int32_t borrow; /* 1: coordinates, connectivity and law_of_element are not copied but used in place; they
                     must then have default strides, base 0, and outlive the handle */

  int32_t single; /* 1: also keeps the operator in single precision, for the calls that end in _float */

  size_t laws; /* may be 0 here: then kacanov_set_laws must be the first call */
  const kacanov_law* law;
  const uint16_t* law_of_element; /* one entry per element, from 0; null: all follow law 0 */

  const char* instruction_set; /* "avx512", "avx2", "plain"; null: the environment variable
                                  KACANOV_INSTRUCTION_SET, or else the best that the machine supports */

  const char* node_order; /* order of the nodes of an element: "gmsh" (also if null), "vtk", "basix", or
                             "dealii" (its cells of degree 1) */
  int32_t turn_inverted;  /* 1: inverted elements are reoriented instead of rejected; arrays with several
                             points per element then follow the reoriented element */
  int32_t orphans;        /* kacanov_orphans: nodes that belong to no element */

  int32_t may_be_empty; /* 1: there may be no elements, or no nodes, as on some process of a parallel run */
  int32_t component_vectors; /* 1: vectors have one array per component, all of component 0, then of component
                                1, ...; they are copied on input and output. Blocks do not change, and
                                unknowns are still numbered node * dimension + component */
  size_t early_count;        /* nodes that kacanov_apply_early completes first, such as the interface nodes */
  const int32_t* early;      /* shared with other processes; counted from 0, any order */

  int32_t plane;          /* kacanov_plane; 0 in 3D */
  int32_t reserved_plane; /* 0 */
} kacanov_description;

/* Treatment of nodes that belong to no element. */
typedef enum kacanov_orphans {
  KACANOV_ORPHANS_ZERO = 0,    /* rows and diagonals of zeros */
  KACANOV_ORPHANS_REFUSED = 1, /* kacanov_create names the node and fails */
  KACANOV_ORPHANS_UNIT = 2     /* rows of the identity, diagonals of ones: the operator is invertible */
} kacanov_orphans;

typedef struct kacanov_operator kacanov_operator;

/* Checks the description and creates an operator with g = mu. `*op` is null after an error, and `message`
 * (may be null) receives at most `message_size` - 1 characters that name the incorrect field, node or
 * element. */
KACANOV_API int kacanov_create(const kacanov_description* description, kacanov_operator** op, char* message,
                               size_t message_size);

/* Frees the handle; null is allowed. */
KACANOV_API void kacanov_destroy(kacanov_operator* op);

/* Message of the last failed call on this handle; "" if none failed. Valid until the next call. */
KACANOV_API const char* kacanov_message(const kacanov_operator* op);

/* Replaces all laws and resets g to mu. Costs as much as creating the operator. After an error the handle is
 * unchanged. `law_of_element` null: all elements follow law 0. */
KACANOV_API int kacanov_set_laws(kacanov_operator* op, size_t laws, const kacanov_law* law, size_t elements,
                                 const uint16_t* law_of_element);

/* ---- In the following `n` is the length of the vectors, nodes * dimension; vectors must not overlap. ----
 */

/* Freezes g at the displacement u. */
KACANOV_API int kacanov_update(kacanov_operator* op, size_t n, const double* u);

/* The frozen g: elements * points entries, the points of an element contiguous. */
KACANOV_API int kacanov_secant(kacanov_operator* op, size_t count, double* g);
KACANOV_API int kacanov_set_secant(kacanov_operator* op, size_t count, const double* g);

/* y = B(g) x. Entries of x are not checked: entries that are not finite make y not finite. */
KACANOV_API int kacanov_apply(kacanov_operator* op, size_t n, const double* x, double* y);

/* y = B(g) x and dot = x . y */
KACANOV_API int kacanov_apply_dot(kacanov_operator* op, size_t n, const double* x, double* y, double* dot);

/* y = alpha B(g) x + beta y; with beta = 0 the old y is not read. */
KACANOV_API int kacanov_apply_add(kacanov_operator* op, size_t n, double alpha, const double* x, double beta,
                                  double* y);

/* Called when y has its final values at the early nodes of the description, before the rest of y is computed,
 * so that these values can be sent to other processes meanwhile. Runs on the calling thread and may change y.
 * It must not throw, jump, or call the handle. */
typedef void (*kacanov_early_callback)(void* data, double* y);

/* y = B(g) x or, if `tangent` is 1, B_T x, as kacanov_apply; `dot` may be null, and is x . y without the
 * callback's changes. Only for operators without constraints, blocks and unit rows: where a node belongs to
 * several processes, the caller must apply these. */
KACANOV_API int kacanov_apply_early(kacanov_operator* op, size_t n, int32_t tangent, const double* x,
                                    double* y, double* dot, kacanov_early_callback callback, void* data);

/* The product for several input vectors, one after another in x and in y (vectors * n entries each); faster
 * than one at a time. */
KACANOV_API int kacanov_apply_many(kacanov_operator* op, size_t n, int32_t vectors, const double* x,
                                   double* y);

/* Freezes g and the consistent tangent B_T at u; later changes of g do not affect y = B_T x. The direction of
 * the strain in the tangent's rank-one term is stored in single precision (relative error 1e-7 of that
 * term). */
KACANOV_API int kacanov_update_tangent(kacanov_operator* op, size_t n, const double* u);
KACANOV_API int kacanov_apply_tangent(kacanov_operator* op, size_t n, const double* x, double* y);

/* y = B_T x and dot = x . y */
KACANOV_API int kacanov_apply_tangent_dot(kacanov_operator* op, size_t n, const double* x, double* y,
                                          double* dot);

/* The tangent version of kacanov_apply_many. */
KACANOV_API int kacanov_apply_tangent_many(kacanov_operator* op, size_t n, int32_t vectors, const double* x,
                                           double* y);

/* Diagonal of B(g), n entries; diagonal blocks, n * dimension entries: one row-major dimension * dimension
 * block per node. */
KACANOV_API int kacanov_diagonal(kacanov_operator* op, size_t n, double* diagonal);
KACANOV_API int kacanov_block_diagonal(kacanov_operator* op, size_t count, double* blocks);

/* Diagonal and diagonal blocks of the tangent frozen last. */
KACANOV_API int kacanov_diagonal_tangent(kacanov_operator* op, size_t n, double* diagonal);
KACANOV_API int kacanov_block_diagonal_tangent(kacanov_operator* op, size_t count, double* blocks);

/* Internal force f and stored energy of the true nonlinear law at u; they do not use the frozen g. */
KACANOV_API int kacanov_residual(kacanov_operator* op, size_t n, const double* u, double* f);
KACANOV_API int kacanov_energy(kacanov_operator* op, size_t n, const double* u, double* energy);

/* Computes force and energy in one pass and also freezes g at u. */
KACANOV_API int kacanov_residual_energy_update(kacanov_operator* op, size_t n, const double* u, double* f,
                                               double* energy);

/* The frozen operator on vectors of floats, for preconditioners and mixed-precision solvers: relative error
 * about 1e-6 on well-shaped elements. Needs `single` in the description; g is always that of the operator in
 * double precision. */
KACANOV_API int kacanov_apply_float(kacanov_operator* op, size_t n, const float* x, float* y);
KACANOV_API int kacanov_apply_dot_float(kacanov_operator* op, size_t n, const float* x, float* y,
                                        double* dot);
KACANOV_API int kacanov_apply_many_float(kacanov_operator* op, size_t n, int32_t vectors, const float* x,
                                         float* y);
KACANOV_API int kacanov_diagonal_float(kacanov_operator* op, size_t n, float* diagonal);

/* The same for the tangent frozen last. */
KACANOV_API int kacanov_apply_tangent_float(kacanov_operator* op, size_t n, const float* x, float* y);
KACANOV_API int kacanov_apply_tangent_dot_float(kacanov_operator* op, size_t n, const float* x, float* y,
                                                double* dot);
KACANOV_API int kacanov_apply_tangent_many_float(kacanov_operator* op, size_t n, int32_t vectors,
                                                 const float* x, float* y);
KACANOV_API int kacanov_diagonal_tangent_float(kacanov_operator* op, size_t n, float* diagonal);

/* ---- Constraints and penalties become part of B and B_T in all products, diagonals, blocks and matrices, in
 * double and in float. Residual, energy and stress ignore them. Each of the two calls replaces the input of
 * its last call (count 0: removes it). Unknowns and nodes are counted from 0. ---- */

/* Replaces the rows and columns of these unknowns (node * dimension + component, any order) by those of the
 * identity. For prescribed displacements, put them in u and solve for the correction. */
KACANOV_API int kacanov_constrain(kacanov_operator* op, size_t count, const int32_t* unknown);

/* Adds to the diagonal block of node[i] the row-major dimension * dimension block that begins at
 * block[i * dimension * dimension]: symmetric, and positive semidefinite if the system is to be solved. */
KACANOV_API int kacanov_set_blocks(kacanov_operator* op, size_t count, const int32_t* node,
                                   const double* block);

/* ---- Multigrid: z = M r, where M approximates the inverse of B(g), constraints and blocks included. M is
 * symmetric and positive definite, and constant between updates. It also serves tangents, with g of the same
 * displacement. It is the multigrid of kacanov's solver: grids around the body, or aggregates of nodes with
 * their rigid-body motions, without a matrix of the body, in single precision inside. Any units work. The
 * constrained operator must be definite. The multigrid uses the operator's threads; the two may be destroyed
 * in either order. ---- */
typedef struct kacanov_multigrid kacanov_multigrid;

typedef struct kacanov_multigrid_options {
  size_t struct_size; /* sizeof(kacanov_multigrid_options) */
  double aggregate;   /* 0: grids in 3D where g is not far below k0, otherwise aggregates of 48 nodes. 4 to
                         1000: aggregates of this many nodes. Smaller aggregates: somewhat fewer iterations,
                         more memory */
} kacanov_multigrid_options;

/* Sets up the multigrid for the present operator; `options` may be null. Costs about ten applications of the
 * operator, and ten times the memory of a vector. `*multigrid` is null after an error, which
 * kacanov_message(op) describes. */
KACANOV_API int kacanov_multigrid_create(kacanov_operator* op, const kacanov_multigrid_options* options,
                                         kacanov_multigrid** multigrid);

/* Updates M after changes of g, constraints or blocks; until then M stays the same. Aggregates are kept
 * unless the laws have changed. After an error there is no M until an update succeeds. */
KACANOV_API int kacanov_multigrid_update(kacanov_multigrid* multigrid);

/* z = M r */
KACANOV_API int kacanov_multigrid_apply(kacanov_multigrid* multigrid, size_t n, const double* r, double* z);

/* Frees the handle; null is allowed. */
KACANOV_API void kacanov_multigrid_destroy(kacanov_multigrid* multigrid);

/* Like kacanov_message, for the multigrid. */
KACANOV_API const char* kacanov_multigrid_message(const kacanov_multigrid* multigrid);

typedef struct kacanov_multigrid_information {
  size_t struct_size; /* set by the caller before the call: sizeof(kacanov_multigrid_information) */
  size_t bytes;       /* memory of the handle, without the operator */
  int32_t levels;     /* number of levels, that of the body included */
  int32_t reserved;
} kacanov_multigrid_information;
KACANOV_API int kacanov_multigrid_inspect(kacanov_multigrid* multigrid,
                                          kacanov_multigrid_information* information);

typedef struct kacanov_cg_options {
  size_t struct_size;      /* sizeof(kacanov_cg_options) */
  double relative;         /* stops at |r| <= relative |r0| ...; if both are 0: 1e-8 */
  double absolute;         /* ... or at |r| <= absolute */
  int32_t most_iterations; /* 0: 2000 */
  int32_t tangent;         /* 1: solves with B_T, 0: with B(g) */
} kacanov_cg_options;

typedef struct kacanov_cg_result {
  size_t struct_size; /* set by the caller before the call: sizeof(kacanov_cg_result) */
  int32_t iterations;
  int32_t converged;     /* 0: too many iterations, or the operator is not positive definite */
  double first_residual; /* 2-norms over the unconstrained unknowns */
  double residual;
} kacanov_cg_result;

/* Solves A x = b by conjugate gradients from the given x, with A = B(g) or B_T, constraints and blocks
 * included; constrained entries of x become those of b. Preconditioned by `multigrid`, which must belong to
 * this operator, or by the diagonal if that is null. `options` may be null. Returns KACANOV_OK even without
 * convergence: check result->converged. */
KACANOV_API int kacanov_cg(kacanov_operator* op, kacanov_multigrid* multigrid,
                           const kacanov_cg_options* options, size_t n, const double* b, double* x,
                           kacanov_cg_result* result);

/* The operator as a matrix in compressed row storage: B(g), or, if `u` is not null, the consistent tangent at
 * u. kacanov_matrix_entries returns the number of entries (both triangles, zeros included); row i begins at
 * first[i] (n + 1 entries), columns ascending. Null arrays are skipped: the structure never changes.
 * Assembled by plain loops; costs some hundred times as much as kacanov_apply. */
KACANOV_API int kacanov_matrix_entries(kacanov_operator* op, size_t n, size_t* entries);
KACANOV_API int kacanov_matrix(kacanov_operator* op, size_t n, const double* u, size_t entries,
                               int64_t* first, int32_t* column, double* value);

/* The quadrature points, `count` = elements * points_per_element, those of an element contiguous: positions
 * (count * dimension) and weights (count), which sum to the element's volume, or area in 2D. In tet10, hex8
 * and quad4 point i lies next to corner i, in Gmsh's order of the corners. Null arrays are skipped. */
KACANOV_API int kacanov_points(kacanov_operator* op, size_t count, double* position, double* weight);

/* Strain at the quadrature points for the displacement u: 6 entries per point, xx yy zz xy yz zx, tensor
 * components (not engineering shears), with the element average of the trace for mean_dilatation; and x =
 * |dev eps|. Null arrays are skipped. The tensor is computed by plain loops, x as fast as kacanov_energy. */
KACANOV_API int kacanov_strain(kacanov_operator* op, size_t n, const double* u, size_t count, double* strain,
                               double* x);

/* Averages over each element at a displacement; null arrays are skipped. */
typedef struct kacanov_fields {
  size_t struct_size; /* sizeof(kacanov_fields) */
  size_t elements;    /* length of the arrays, checked */
  double* stress;     /* 6 per element: xx yy zz xy yz zx (zz also in plane strain) */
  double* von_mises;  /* 1 per element */
  double* dev_strain; /* |dev eps| */
  double* secant;     /* g */
  uint8_t* plastic;   /* 1 if any point is beyond yield */
} kacanov_fields;
KACANOV_API int kacanov_stress(kacanov_operator* op, size_t n, const double* u, const kacanov_fields* fields);

typedef struct kacanov_information {
  size_t struct_size; /* set by the caller before the call: sizeof(kacanov_information) */
  size_t unknowns;    /* nodes * dimension: the `n` above */
  size_t nodes;
  size_t elements;
  int32_t dimension;
  int32_t nodes_per_element;
  int32_t points_per_element;  /* values of g per element */
  int32_t threads;             /* threads in use: at most the requested number */
  uint64_t applications;       /* of B and B_T since the operator was created */
  size_t bytes;                /* memory of the handle */
  const char* instruction_set; /* valid until the handle is destroyed */
} kacanov_information;
KACANOV_API int kacanov_inspect(kacanov_operator* op, kacanov_information* information);

/* Node and element numbering for which the operator is fastest, for callers who can choose theirs: entry i is
 * the present number, from 0, of the node (element) that should become number i. Null arrays are skipped. */
KACANOV_API int kacanov_locality_order(kacanov_operator* op, size_t nodes, int32_t* node_order,
                                       size_t elements, int32_t* element_order);

/* The linear law of Young's modulus > 0 and Poisson's ratio in (-1, 1/2). law->struct_size must be set. */
KACANOV_API int kacanov_elastic_law(double young, double poisson, kacanov_law* law);

/* A short description of a kacanov_code; never null. */
KACANOV_API const char* kacanov_code_text(int code);

/* Returns "major.minor.patch". */
KACANOV_API const char* kacanov_version(void);

#ifdef __cplusplus
}
#endif

#endif
