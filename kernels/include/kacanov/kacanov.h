/* SPDX-License-Identifier: BSD-3-Clause */
/* The C interface: matrix-free operators of small-strain elastoplasticity for other finite element codes.
 *
 * A body is meshed with one element type; each element follows a Hencky law
 *   tau = k0 tr(eps) I + 2 g(x) dev(eps),   x = |dev(eps)| (Frobenius norm),
 * with bulk modulus k0 and secant shear modulus g. A handle keeps g (one value a quadrature point), frozen at
 * a displacement by kacanov_update, and then applies the linear operator B(g) to vectors.
 *
 * Vectors are of double, or of float in the calls that end in _float. They have nodes * dimension entries,
 * interleaved (all components of node 0, then of node 1, ...; or see component_vectors), in the caller's node
 * order. Units are the caller's; in 2D everything is for unit thickness, or goes
 * all round the axis (kacanov_plane).
 *
 * Every function that returns int returns a kacanov_code: KACANOV_OK, or what went wrong; the handle then has
 * a message that says so in words. Output arrays have undefined content after an error. Nothing is printed,
 * there is no global state and no MPI. A handle is used by one thread at a time: a call that finds another at
 * work returns KACANOV_ERROR_STATE and does nothing, not even a message. Different handles are independent.
 * Arrays passed in stay the caller's.
 *
 * Structs grow at their end, and the library keeps up with callers built against older headers: every struct
 * begins with struct_size, which the caller sets to its sizeof. What an old caller's struct does not have is
 * taken as zero; what a newer caller's has beyond this library has to be zero. Names and numbers stay.
 *
 * Threads are the library's own, or with KACANOV_THREADS=openmp in the environment those of OpenMP, one team
 * a calling thread. A small body uses fewer than asked for (see kacanov_information.threads). After fork()
 * the child has none of its parent's threads: operators there use one.
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

/* The version of this header; kacanov_version() has that of the library. */
#define KACANOV_VERSION_MAJOR 0
#define KACANOV_VERSION_MINOR 2
#define KACANOV_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

typedef enum kacanov_code {
  KACANOV_OK = 0,
  KACANOV_ERROR_NULL = 1,     /* a required pointer is null */
  KACANOV_ERROR_SIZE = 2,     /* a vector or array has another size than expected, or two of them overlap */
  KACANOV_ERROR_MESH = 3,     /* index out of range, inverted or degenerate element, coordinate not finite */
  KACANOV_ERROR_LAW = 4,      /* a law's parameter is missing or out of range, or a law does not exist */
  KACANOV_ERROR_VALUE = 5,    /* an option or an entry of a vector is out of range or not finite */
  KACANOV_ERROR_STATE = 6,    /* a call is missing that has to come first, or the handle is in use */
  KACANOV_ERROR_MEMORY = 7,   /* out of memory */
  KACANOV_ERROR_INTERNAL = 8, /* a defect of the library */
  KACANOV_ERROR_CASE = 9 /* of kacanov_solve: the case or a file of it is wrong; the message says where */
} kacanov_code;

/* Node order is that of Gmsh; tet10 has its mid-side nodes on the edges 01 12 20 30 32 31. */
typedef enum kacanov_element {
  KACANOV_TRI3 = 0,  /* 2D, 1 quadrature point */
  KACANOV_TET4 = 1,  /* 1 point */
  KACANOV_TET10 = 2, /* 4 points */
  KACANOV_HEX8 = 3,  /* 8 points */
  KACANOV_QUAD4 = 4  /* 2D, 4 points */
} kacanov_element;

/* What an element in 2D is of. */
typedef enum kacanov_plane {
  KACANOV_PLANE_STRAIN = 0,
  KACANOV_PLANE_STRESS = 1, /* no stress across the plane; without mean_dilatation and KACANOV_USER */
  KACANOV_AXISYMMETRIC = 2 /* a section: x >= 0 is the distance from the axis, y runs along it. Integrals, and
                              so forces and energies, go all round; of strains and stresses zz is the hoop's.
                              Without KACANOV_USER */
} kacanov_plane;

/* Secant shear moduli g(a); below a = x0 always g = mu. */
typedef enum kacanov_law_kind {
  KACANOV_LINEAR = 0,           /* g = mu */
  KACANOV_LOGARITHMIC = 1,      /* mu (x0/a) (ln(a/x0) + 1) */
  KACANOV_LINEAR_HARDENING = 2, /* mu (gamma + (1 - gamma) x0/a), 0 < gamma <= 1 */
  KACANOV_POWER = 3,            /* mu (a/x0)^(n-1), 0 < n <= 1 */
  KACANOV_SATURATING = 4,       /* mu (x0/a) (1 + q (1 - exp(-(a-x0)/(q x0)))), q > 0 */
  KACANOV_TABLE = 5,            /* 2 g a piecewise linear through given points */
  KACANOV_RAMBERG_OSGOOD = 6, /* mu t x0/a with a/x0 = t + q t^n, from a = 0 on; q > 0, n > 1, not squared */
  KACANOV_USER = 7            /* what kacanov_law.evaluate says; not squared */
} kacanov_law_kind;

/* Points at which a law of the caller's own is asked. The arrays are the library's and gone afterwards. */
typedef struct kacanov_law_points {
  size_t struct_size; /* the library's: look at no field beyond it */
  size_t count;
  const double* x;        /* |dev eps| */
  const int32_t* element; /* from 0, in the caller's order: for what differs from place to place */
  const int32_t* point;   /* of that element, from 0; see kacanov_points */
  double* g;              /* to be filled: the secant shear modulus, > 0 */
  double* slope;          /* to be filled unless null: dg/dx */
  double* energy;         /* to be filled unless null: G(x), the integral of g(s) s ds from 0 to x */
} kacanov_law_points;

/* A law of the caller's own: fills what is asked for and returns 0, or another number to make the call that
 * asked fail with KACANOV_ERROR_LAW. Given some thousand points at once, those of an element in a row. It may
 * not throw, jump, or call the handle that asks. */
typedef int (*kacanov_law_callback)(void* data, const kacanov_law_points* points);

typedef struct kacanov_law {
  size_t struct_size; /* sizeof(kacanov_law); the same for all laws of an array */
  int32_t kind;       /* kacanov_law_kind */
  int32_t squared;    /* 0: a = x = |dev eps|; 1: a = x^2 */
  double bulk;        /* k0 > 0 */
  double shear;       /* mu > 0 */
  double x0;          /* yield strain, compared with a; > 0 for all kinds but linear and table */
  double gamma;       /* linear hardening */
  double n;           /* power, Ramberg-Osgood */
  double q;           /* saturating, Ramberg-Osgood */
  size_t table_size;  /* table: points, from (0, 0); table_s increases, table_s/table_x must not */
  const double* table_x;
  const double* table_s;   /* |dev tau| = 2 g a at table_x */
  int32_t mean_dilatation; /* 1: k0 acts on the mean of tr(eps) over the element (B-bar), against locking of
                              nearly incompressible and of plastic bodies; hex8 and quad4 */
  int32_t reserved;        /* 0 */

  /* KACANOV_USER only. bulk and shear are as for the others; g is mu until the first update. x0 is the strain
   * beyond which kacanov_stress says plastic, 0 for never. */
  kacanov_law_callback evaluate; /* asked by update, update_tangent, residual, energy, stress and the matrix
                                    of a tangent, never by apply, and as long as the operator has the law */
  void* data;                    /* handed to it */
  int32_t parallel;              /* 1: the operator's threads may ask at once, each for points of its own;
                                    0: only the calling thread asks */
  int32_t reserved_user;         /* 0 */
} kacanov_law;

/* The body. Zeros and struct_size are a valid start: what may be zero may stay so. */
typedef struct kacanov_description {
  size_t struct_size; /* sizeof(kacanov_description) */
  int32_t element;    /* kacanov_element */
  int32_t threads;    /* at most so many threads for this operator; 0: one */

  size_t nodes;
  const double* coordinates; /* component c of node i: coordinates[i * node_stride + c * component_stride] */
  size_t node_stride;        /* 0: interleaved, the dimension */
  size_t component_stride;   /* 0: 1; `nodes` with node_stride 1 for one array a component */

  size_t elements;
  const int32_t* connectivity; /* node a of element e: connectivity[e * element_stride + a] - index_base */
  size_t element_stride;       /* 0: the nodes of an element */
  int32_t index_base;          /* number of the first node: 0, or 1 as in Fortran */

  int32_t borrow; /* 1: coordinates, connectivity and law_of_element are not copied but used where they are;
                     they must then have default strides, base 0, and outlive the handle */

  int32_t single; /* 1: keeps the operator in single precision too, for the calls that end in _float */

  size_t laws; /* may be 0 here: then kacanov_set_laws has to come before everything else */
  const kacanov_law* law;
  const uint16_t* law_of_element; /* one entry an element, from 0; null: all follow law 0 */

  const char* instruction_set; /* "avx512", "avx2", "plain"; null: what the environment variable
                                  KACANOV_INSTRUCTION_SET says, or else the best the machine has */

  const char* node_order; /* in which an element's nodes come: "gmsh" (null: the same), "vtk", "basix", or
                             "dealii" (its cells of degree 1) */
  int32_t turn_inverted; /* 1: elements with their nodes the wrong way round are turned and not refused; where
                            an array has several points an element, they are those of the element as turned */
  int32_t orphans;       /* kacanov_orphans: nodes of no element */

  int32_t may_be_empty; /* 1: there may be no elements, or no nodes, as on some process of many */
  int32_t
      component_vectors; /* 1: vectors have one array a component, all of component 0, then of component 1,
                            ...; they are copied on the way in and out. Blocks stay as they are, and
                            unknowns are named node * dimension + component all the same */
  size_t early_count;    /* nodes that kacanov_apply_early has ready first, as those that other processes */
  const int32_t* early;  /* have too; counted from 0, any order */

  int32_t plane;          /* kacanov_plane; 0 in 3D */
  int32_t reserved_plane; /* 0 */
} kacanov_description;

/* What is to become of nodes of no element. */
typedef enum kacanov_orphans {
  KACANOV_ORPHANS_ZERO = 0,    /* rows and diagonals of zeros */
  KACANOV_ORPHANS_REFUSED = 1, /* kacanov_create says which node it is */
  KACANOV_ORPHANS_UNIT = 2     /* rows of the identity, diagonals of ones: the operator can be inverted */
} kacanov_orphans;

typedef struct kacanov_operator kacanov_operator;

/* Checks the description and makes an operator with g = mu. `*op` is null after an error, and `message` (may
 * be null) holds at most `message_size` - 1 characters that name the field, node or element at fault. */
KACANOV_API int kacanov_create(const kacanov_description* description, kacanov_operator** op, char* message,
                               size_t message_size);

/* Frees the handle; null is allowed. */
KACANOV_API void kacanov_destroy(kacanov_operator* op);

/* What the last call that failed on this handle said; "" if none did. Valid until the next call. */
KACANOV_API const char* kacanov_message(const kacanov_operator* op);

/* Replaces all laws; g starts again as mu. Costs as much as creating the operator. After an error the handle
 * is as before. `law_of_element` null: all elements follow law 0. */
KACANOV_API int kacanov_set_laws(kacanov_operator* op, size_t laws, const kacanov_law* law, size_t elements,
                                 const uint16_t* law_of_element);

/* ---- In the following `n` is the length of the vectors, nodes * dimension; vectors must not overlap. ----
 */

/* Freezes g at the displacement u. */
KACANOV_API int kacanov_update(kacanov_operator* op, size_t n, const double* u);

/* The frozen g: elements * points entries, the points of an element together. */
KACANOV_API int kacanov_secant(kacanov_operator* op, size_t count, double* g);
KACANOV_API int kacanov_set_secant(kacanov_operator* op, size_t count, const double* g);

/* y = B(g) x. Entries of x are not checked: what is not finite there is not finite in y. */
KACANOV_API int kacanov_apply(kacanov_operator* op, size_t n, const double* x, double* y);

/* The same, and dot = x . y */
KACANOV_API int kacanov_apply_dot(kacanov_operator* op, size_t n, const double* x, double* y, double* dot);

/* y = alpha B(g) x + beta y; with beta = 0 the old y is not read. */
KACANOV_API int kacanov_apply_add(kacanov_operator* op, size_t n, double alpha, const double* x, double beta,
                                  double* y);

/* Called once y has its final values at the early nodes of the description, before the rest of it is worked
 * out: they can be on their way to other processes meanwhile. On the calling thread; y may be changed there.
 * It may not throw, jump, or call the handle. */
typedef void (*kacanov_early_callback)(void* data, double* y);

/* y = B(g) x or, with `tangent` 1, B_T x, as kacanov_apply; `dot` may be null, and is x . y without what the
 * callback changes. For operators without constraints, blocks and unit rows, which are the caller's where a
 * node belongs to several processes. */
KACANOV_API int kacanov_apply_early(kacanov_operator* op, size_t n, int32_t tangent, const double* x,
                                    double* y, double* dot, kacanov_early_callback callback, void* data);

/* Several input vectors, one after another in x and in y (vectors * n entries each); quicker than one at a
 * time. */
KACANOV_API int kacanov_apply_many(kacanov_operator* op, size_t n, int32_t vectors, const double* x,
                                   double* y);

/* Freezes g and the consistent tangent at u; then y = B_T x, whatever becomes of g. The direction of the
 * strain in the tangent's rank-one term is kept in single precision (relative error 1e-7 of that term). */
KACANOV_API int kacanov_update_tangent(kacanov_operator* op, size_t n, const double* u);
KACANOV_API int kacanov_apply_tangent(kacanov_operator* op, size_t n, const double* x, double* y);

/* The same, and dot = x . y */
KACANOV_API int kacanov_apply_tangent_dot(kacanov_operator* op, size_t n, const double* x, double* y,
                                          double* dot);

/* As kacanov_apply_many. */
KACANOV_API int kacanov_apply_tangent_many(kacanov_operator* op, size_t n, int32_t vectors, const double* x,
                                           double* y);

/* Diagonal of B(g), n entries; diagonal blocks, n * dimension entries: a row-major dimension * dimension
 * block a node. */
KACANOV_API int kacanov_diagonal(kacanov_operator* op, size_t n, double* diagonal);
KACANOV_API int kacanov_block_diagonal(kacanov_operator* op, size_t count, double* blocks);

/* The same of the tangent frozen last. */
KACANOV_API int kacanov_diagonal_tangent(kacanov_operator* op, size_t n, double* diagonal);
KACANOV_API int kacanov_block_diagonal_tangent(kacanov_operator* op, size_t count, double* blocks);

/* Internal force f and stored energy of the true nonlinear law at u; the frozen g plays no part. */
KACANOV_API int kacanov_residual(kacanov_operator* op, size_t n, const double* u, double* f);
KACANOV_API int kacanov_energy(kacanov_operator* op, size_t n, const double* u, double* energy);

/* Both in one pass, which also freezes g at u. */
KACANOV_API int kacanov_residual_energy_update(kacanov_operator* op, size_t n, const double* u, double* f,
                                               double* energy);

/* The frozen operator on vectors of floats, for preconditioners and mixed-precision solvers: about 1e-6
 * relative on well-shaped elements. Needs `single` in the description; g is always that of the operator in
 * double precision. */
KACANOV_API int kacanov_apply_float(kacanov_operator* op, size_t n, const float* x, float* y);
KACANOV_API int kacanov_apply_dot_float(kacanov_operator* op, size_t n, const float* x, float* y,
                                        double* dot);
KACANOV_API int kacanov_apply_many_float(kacanov_operator* op, size_t n, int32_t vectors, const float* x,
                                         float* y);
KACANOV_API int kacanov_diagonal_float(kacanov_operator* op, size_t n, float* diagonal);

/* Likewise with the tangent frozen last. */
KACANOV_API int kacanov_apply_tangent_float(kacanov_operator* op, size_t n, const float* x, float* y);
KACANOV_API int kacanov_apply_tangent_dot_float(kacanov_operator* op, size_t n, const float* x, float* y,
                                                double* dot);
KACANOV_API int kacanov_apply_tangent_many_float(kacanov_operator* op, size_t n, int32_t vectors,
                                                 const float* x, float* y);
KACANOV_API int kacanov_diagonal_tangent_float(kacanov_operator* op, size_t n, float* diagonal);

/* ---- Constraints and penalties: part of B and B_T from then on, wherever these are applied, in diagonals,
 * blocks and matrices, in double and in float. Residual, energy and stress do not know of them. Both calls
 * replace what the last one gave (count 0: nothing). Unknowns and nodes are counted from 0. ---- */

/* Makes the rows and the columns of these unknowns (node * dimension + component, any order) those of the
 * identity. For displacements prescribed there, put them in u and solve for the correction. */
KACANOV_API int kacanov_constrain(kacanov_operator* op, size_t count, const int32_t* unknown);

/* Adds to the diagonal block of node[i] the row-major dimension * dimension block that begins at
 * block[i * dimension * dimension]: symmetric, and positive semidefinite where anything is to be solved. */
KACANOV_API int kacanov_set_blocks(kacanov_operator* op, size_t count, const int32_t* node,
                                   const double* block);

/* ---- Multigrid: z = M r with M near the inverse of B(g), constraints and blocks included; symmetric and
 * positive definite, the same from update to update. For tangents too, with the g of the same displacement.
 * It is that of kacanov's solver: grids round the body, or aggregates of nodes and their rigid-body motions,
 * without a matrix of the body, in single precision within. Good for any units. The operator has to be
 * definite once it is constrained. It has the operator's threads, and may be destroyed before or after it.
 * ---- */
typedef struct kacanov_multigrid kacanov_multigrid;

typedef struct kacanov_multigrid_options {
  size_t struct_size; /* sizeof(kacanov_multigrid_options) */
  double aggregate;   /* 0: grids in 3D where g is not far below k0, otherwise aggregates of 48 nodes. 4 to
                         1000: aggregates of so many. Fewer: somewhat fewer iterations, more memory */
} kacanov_multigrid_options;

/* For what the operator is now; `options` may be null. Costs some ten applications of it, and ten times as
 * many bytes an unknown as a vector. `*multigrid` is null after an error, and kacanov_message(op) has the
 * words. */
KACANOV_API int kacanov_multigrid_create(kacanov_operator* op, const kacanov_multigrid_options* options,
                                         kacanov_multigrid** multigrid);

/* After g, constraints or blocks have changed: aggregates are kept, unless there are other laws. M stays as
 * it was until then. After an error there is none until an update succeeds. */
KACANOV_API int kacanov_multigrid_update(kacanov_multigrid* multigrid);

/* z = M r */
KACANOV_API int kacanov_multigrid_apply(kacanov_multigrid* multigrid, size_t n, const double* r, double* z);

/* Frees the handle; null is allowed. */
KACANOV_API void kacanov_multigrid_destroy(kacanov_multigrid* multigrid);

/* As kacanov_message. */
KACANOV_API const char* kacanov_multigrid_message(const kacanov_multigrid* multigrid);

typedef struct kacanov_multigrid_information {
  size_t struct_size; /* set by the caller before the call: sizeof(kacanov_multigrid_information) */
  size_t bytes;       /* held by the handle, the operator's not counted */
  int32_t levels;     /* the body itself included */
  int32_t reserved;
} kacanov_multigrid_information;
KACANOV_API int kacanov_multigrid_inspect(kacanov_multigrid* multigrid,
                                          kacanov_multigrid_information* information);

typedef struct kacanov_cg_options {
  size_t struct_size;      /* sizeof(kacanov_cg_options) */
  double relative;         /* done at |r| <= relative |r0| ...; 0 with `absolute` 0: 1e-8 */
  double absolute;         /* ... or at |r| <= absolute */
  int32_t most_iterations; /* 0: 2000 */
  int32_t tangent;         /* 1: solves with B_T, 0: with B(g) */
} kacanov_cg_options;

typedef struct kacanov_cg_result {
  size_t struct_size; /* set by the caller before the call: sizeof(kacanov_cg_result) */
  int32_t iterations;
  int32_t converged;     /* 0: too many iterations, or the operator is not positive definite */
  double first_residual; /* 2-norms over the unknowns that are not constrained */
  double residual;
} kacanov_cg_result;

/* Solves A x = b by conjugate gradients from the x given, A = B(g) or B_T with constraints and blocks;
 * constrained unknowns become those of b. Preconditioned by `multigrid`, which has to be of this operator,
 * or, where that is null, by the diagonal. `options` may be null. That it has not converged is no error: see
 * result->converged. */
KACANOV_API int kacanov_cg(kacanov_operator* op, kacanov_multigrid* multigrid,
                           const kacanov_cg_options* options, size_t n, const double* b, double* x,
                           kacanov_cg_result* result);

/* The operator as a matrix in compressed rows, for those who want one: B(g), or, with `u` not null, the
 * consistent tangent at u. First its number of entries (stored symmetrically, zeros included); then the
 * entries of row i from first[i] (n + 1 of these) on, columns ascending. Null arrays are left out: the
 * structure never changes. Assembled plainly; costs some hundred times as much as kacanov_apply. */
KACANOV_API int kacanov_matrix_entries(kacanov_operator* op, size_t n, size_t* entries);
KACANOV_API int kacanov_matrix(kacanov_operator* op, size_t n, const double* u, size_t entries,
                               int64_t* first, int32_t* column, double* value);

/* The quadrature points, `count` = elements * points_per_element, those of an element in a row: positions
 * (count * dimension) and weights (count; of an element they add up to its volume, or area in 2D). For tet10
 * point i lies next to corner i; for hex8 and quad4, too, in Gmsh's order of the corners. Null arrays are
 * left out. */
KACANOV_API int kacanov_points(kacanov_operator* op, size_t count, double* position, double* weight);

/* Strain there at the displacement u: 6 a point, xx yy zz xy yz zx, components and not engineering shears,
 * the trace the element's mean with mean_dilatation; and x = |dev eps|. Null arrays are left out. The tensor
 * is worked out plainly, x as fast as kacanov_energy. */
KACANOV_API int kacanov_strain(kacanov_operator* op, size_t n, const double* u, size_t count, double* strain,
                               double* x);

/* Means over each element at a displacement; arrays that are null are left out. */
typedef struct kacanov_fields {
  size_t struct_size; /* sizeof(kacanov_fields) */
  size_t elements;    /* length of the arrays, to be checked */
  double* stress;     /* 6 an element: xx yy zz xy yz zx (zz also in plane strain) */
  double* von_mises;  /* 1 an element */
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
  int32_t points_per_element;  /* values of g an element */
  int32_t threads;             /* that are used: at most those asked for */
  uint64_t applications;       /* of B and B_T since the operator was made */
  size_t bytes;                /* held by the handle */
  const char* instruction_set; /* valid as long as the handle */
} kacanov_information;
KACANOV_API int kacanov_inspect(kacanov_operator* op, kacanov_information* information);

/* The numbering the operator likes best, for callers who are free to choose theirs: entry i is the present
 * number, from 0, of what should be node (element) i. Arrays that are null are left out. */
KACANOV_API int kacanov_locality_order(kacanov_operator* op, size_t nodes, int32_t* node_order,
                                       size_t elements, int32_t* element_order);

/* The linear law of Young's modulus > 0 and Poisson's ratio in (-1, 1/2). law->struct_size has to be set. */
KACANOV_API int kacanov_elastic_law(double young, double poisson, kacanov_law* law);

/* What a kacanov_code means, in a few words; never null. */
KACANOV_API const char* kacanov_code_text(int code);

/* "major.minor.patch" */
KACANOV_API const char* kacanov_version(void);

#ifdef __cplusplus
}
#endif

#endif
