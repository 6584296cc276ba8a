// SPDX-License-Identifier: BSD-3-Clause
// The C interface on damaged bodies and extreme numbers: no call may return the code of an internal error.
#include <kacanov/kacanov.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "../embedding/small_meshes.hpp"
#include "bytes.hpp"

using kacanov::fuzz::Bytes;

namespace {

void damage(SmallMesh& mesh, Bytes& in) {
  for (std::size_t k = in.below(4); k > 0; --k)
    mesh.coordinates[in.below(mesh.coordinates.size())] = in.number();
  for (std::size_t k = in.below(3); k > 0; --k)
    mesh.connectivity[in.below(mesh.connectivity.size())] = in.take<std::int32_t>();
}

/// A user-defined law, g = 1/(1 + x), except at every seventh point, where g is the number that `data` points
/// to.
int own_law(void* data, const kacanov_law_points* points) {
  const double odd = *static_cast<const double*>(data);
  for (std::size_t i = 0; i < points->count; ++i) {
    const double x = points->x[i];
    points->g[i] = i % 7 == 6 ? odd : 1.0 / (1.0 + x);
    if (points->slope != nullptr) points->slope[i] = i % 7 == 6 ? odd : -1.0 / ((1.0 + x) * (1.0 + x));
    if (points->energy != nullptr) points->energy[i] = x - std::log1p(x);
  }
  return odd == 3.0 ? 1 : 0;
}

kacanov_law some_law(Bytes& in, const std::vector<double>& x, const std::vector<double>& s) {
  kacanov_law law{};
  law.struct_size = sizeof law;
  if (kacanov_elastic_law(1.0, 0.3, &law) != KACANOV_OK) std::abort();
  law.kind = static_cast<std::int32_t>(in.below(8));
  law.squared = static_cast<std::int32_t>(in.below(3));
  law.mean_dilatation = static_cast<std::int32_t>(in.below(2));
  law.x0 = 0.01, law.gamma = 0.2, law.n = 0.5, law.q = 0.9;
  for (double* field : {&law.bulk, &law.shear, &law.x0, &law.gamma, &law.n, &law.q})
    if (in.below(4) == 0) *field = in.number();
  if (law.kind == KACANOV_USER) {
    static double odd = 0.0;
    odd = in.below(2) == 0 ? 1.0 : in.number();
    if (in.below(8) != 0) law.evaluate = own_law;
    law.data = &odd;
    law.parallel = static_cast<std::int32_t>(in.below(2));
  }
  law.table_size = in.below(x.size() + 1);
  law.table_x = in.below(8) == 0 ? nullptr : x.data();
  law.table_s = in.below(8) == 0 ? nullptr : s.data();
  return law;
}

/// Returns a vector of length n; up to two entries are replaced by special numbers.
std::vector<double> some_vector(Bytes& in, std::size_t n) {
  std::vector<double> v(n);
  for (std::size_t i = 0; i < n; ++i) v[i] = 1e-3 * static_cast<double>((i * 7) % 11);
  for (std::size_t k = in.below(3); k > 0 && n > 0; --k) v[in.below(n)] = in.number();
  return v;
}

int constrain(kacanov_operator* op, Bytes& in, std::size_t n) {
  std::vector<std::int32_t> list;
  for (std::size_t k = in.below(12); k > 0; --k) list.push_back(static_cast<std::int32_t>(in.below(n + 1)));
  return kacanov_constrain(op, list.size(), list.data());
}

int add_springs(kacanov_operator* op, Bytes& in, const kacanov_information& about) {
  const std::size_t dim = about.dimension;
  const auto node = static_cast<std::int32_t>(in.below(about.nodes + 1));
  std::vector<double> block(dim * dim, in.below(2) == 0 ? 0.0 : in.number());
  for (std::size_t c = 0; c < dim; ++c) block[c * dim + c] = in.number();
  return kacanov_set_blocks(op, 1, &node, block.data());
}

int solve(kacanov_operator* op, Bytes& in, const std::vector<double>& b, std::vector<double>& x) {
  kacanov_multigrid* multigrid = nullptr;
  kacanov_multigrid_options options{};
  options.struct_size = sizeof options;
  if (in.below(4) == 0) options.aggregate = in.number();
  int code = in.below(4) == 0 ? KACANOV_OK : kacanov_multigrid_create(op, &options, &multigrid);
  kacanov_cg_options cg{};
  cg.struct_size = sizeof cg;
  cg.relative = in.below(4) == 0 ? in.number() : 0.0;
  cg.most_iterations = 20;
  cg.tangent = static_cast<std::int32_t>(in.below(2));
  kacanov_cg_result result{};
  result.struct_size = sizeof result;
  if (code == KACANOV_OK) code = kacanov_cg(op, multigrid, &cg, b.size(), b.data(), x.data(), &result);
  if (multigrid != nullptr && in.below(2) == 0) kacanov_multigrid_update(multigrid);
  if (multigrid != nullptr && code < KACANOV_ERROR_INTERNAL)
    code = kacanov_multigrid_apply(multigrid, b.size(), b.data(), x.data());
  kacanov_multigrid_destroy(multigrid);
  return code;
}

void call(kacanov_operator* op, Bytes& in, const kacanov_information& about) {
  const std::size_t n = about.unknowns, dim = about.dimension;
  const std::size_t points = about.elements * static_cast<std::size_t>(about.points_per_element);
  const std::vector<double> x = some_vector(in, n);
  std::vector<double> y(n), many(3 * n, 0.5), images(3 * n), blocks(n * dim), g(points),
      many_points(6 * points);
  std::vector<float> single(x.begin(), x.end()), image(n);
  std::vector<double> stress(6 * about.elements);
  std::vector<std::int32_t> nodes(about.nodes), elements(about.elements);
  kacanov_fields fields{};
  fields.struct_size = sizeof fields;
  fields.elements = about.elements;
  fields.stress = stress.data();
  double number = 0.0;
  int code = KACANOV_OK;
  switch (in.below(26)) {
    case 0: code = kacanov_update(op, n, x.data()); break;
    case 1: code = kacanov_apply(op, n, x.data(), y.data()); break;
    case 2: code = kacanov_apply_dot(op, n, x.data(), y.data(), &number); break;
    case 3: {
      const auto vectors = static_cast<std::int32_t>(in.below(4));
      code = kacanov_apply_many(op, n, vectors, many.data(), images.data());
      break;
    }
    case 4: code = kacanov_update_tangent(op, n, x.data()); break;
    case 5: code = kacanov_apply_tangent(op, n, x.data(), y.data()); break;
    case 6: code = kacanov_diagonal(op, n, y.data()); break;
    case 7: code = kacanov_block_diagonal(op, blocks.size(), blocks.data()); break;
    case 8: code = kacanov_diagonal_tangent(op, n, y.data()); break;
    case 9: code = kacanov_block_diagonal_tangent(op, blocks.size(), blocks.data()); break;
    case 10: code = kacanov_residual(op, n, x.data(), y.data()); break;
    case 11: code = kacanov_energy(op, n, x.data(), &number); break;
    case 12: code = kacanov_residual_energy_update(op, n, x.data(), y.data(), &number); break;
    case 13: code = kacanov_secant(op, points, g.data()); break;
    case 14: code = kacanov_set_secant(op, points, some_vector(in, points).data()); break;
    case 15: code = kacanov_apply_float(op, n, single.data(), image.data()); break;
    case 16: code = kacanov_diagonal_float(op, n, image.data()); break;
    case 17: code = kacanov_stress(op, n, x.data(), &fields); break;
    case 18:
      code = kacanov_locality_order(op, nodes.size(), nodes.data(), elements.size(), elements.data());
      break;
    case 19: code = constrain(op, in, n); break;
    case 20: code = add_springs(op, in, about); break;
    case 21:
    case 22: code = solve(op, in, x, y); break;
    case 23: code = kacanov_points(op, points, many_points.data(), g.data()); break;
    case 24: code = kacanov_strain(op, n, x.data(), points, many_points.data(), g.data()); break;
    default: code = kacanov_apply(op, in.below(n + 2), x.data(), many.data()); break;
  }
  if (code == KACANOV_ERROR_INTERNAL) std::fprintf(stderr, "%s\n", kacanov_message(op));
  kacanov::fuzz::expect(code >= KACANOV_OK && code < KACANOV_ERROR_INTERNAL);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes in(data, size);
  SmallMesh mesh = small_mesh(static_cast<std::int32_t>(in.below(5)), 1 + in.below(2));
  damage(mesh, in);
  std::vector<double> table_x{0.0, 0.01, 0.02, 0.05}, table_s{0.0, 0.02, 0.03, 0.04};
  if (in.below(2) == 0) table_x[in.below(4)] = in.number();
  std::vector<kacanov_law> laws;
  for (std::size_t k = in.below(4); k > 0; --k) laws.push_back(some_law(in, table_x, table_s));
  std::vector<std::uint16_t> law_of_element(mesh.elements());
  for (auto& law : law_of_element) law = static_cast<std::uint16_t>(in.below(laws.size() + 1));

  kacanov_description description{};
  description.struct_size = sizeof description;
  description.element = in.below(16) == 0 ? in.take<std::int32_t>() : mesh.element;
  description.threads = static_cast<std::int32_t>(in.below(3));
  // The counts may be smaller than the arrays, never larger, which would be the caller's fault.
  description.nodes = in.below(4) == 0 ? in.below(mesh.nodes() + 1) : mesh.nodes();
  description.elements = in.below(4) == 0 ? in.below(mesh.elements() + 1) : mesh.elements();
  description.coordinates = in.below(32) == 0 ? nullptr : mesh.coordinates.data();
  description.connectivity = in.below(32) == 0 ? nullptr : mesh.connectivity.data();
  description.index_base = static_cast<std::int32_t>(in.below(8) == 0);
  description.borrow = static_cast<std::int32_t>(in.below(2));
  description.single = static_cast<std::int32_t>(in.below(2));
  description.component_vectors = static_cast<std::int32_t>(in.below(4) == 0);
  description.may_be_empty = static_cast<std::int32_t>(in.below(8) == 0);
  description.laws = laws.size();
  description.law = laws.empty() ? nullptr : laws.data();
  description.law_of_element = in.below(2) == 0 ? law_of_element.data() : nullptr;
  constexpr std::array<const char*, 4> sets{nullptr, "plain", "avx2", "sse9"};
  description.instruction_set = sets[in.below(sets.size())];
  // Another element type in the same arrays could read beyond their end.
  if (description.element != mesh.element && description.element >= 0 && description.element < 5) return 0;

  kacanov_operator* op = nullptr;
  char message[200];
  const int code = kacanov_create(&description, &op, message, 1 + in.below(sizeof message));
  if (code == KACANOV_ERROR_INTERNAL) std::fprintf(stderr, "%s\n", message);
  kacanov::fuzz::expect((code == KACANOV_OK) == (op != nullptr) && code < KACANOV_ERROR_INTERNAL);
  kacanov_information about{};
  about.struct_size = sizeof about;
  if (op != nullptr && kacanov_inspect(op, &about) == KACANOV_OK)
    for (int k = 0; k < 12 && !in.empty(); ++k) call(op, in, about);
  kacanov_destroy(op);
  return 0;
}
