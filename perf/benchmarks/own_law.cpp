// SPDX-License-Identifier: BSD-3-Clause
// A power law on handles of the C interface: built in, and as a user-defined law.
#include "own_law.hpp"

#include <cmath>
#include <stdexcept>

namespace kacanov::perf {
namespace {

constexpr double shear = 1.0, yield = 1e-3, exponent = 0.2;

int evaluate(void*, const kacanov_law_points* points) {
  for (std::size_t i = 0; i < points->count; ++i) {
    const double x = points->x[i];
    const bool elastic = x <= yield;
    const double g = elastic ? shear : shear * std::pow(x / yield, exponent - 1.0);
    points->g[i] = g;
    if (points->slope != nullptr) points->slope[i] = elastic ? 0.0 : (exponent - 1.0) * g / x;
    if (points->energy != nullptr)
      points->energy[i] =
          elastic ? 0.5 * g * x * x
                  : g * x * x / (exponent + 1.0) + shear * yield * yield * (0.5 - 1.0 / (exponent + 1.0));
  }
  return 0;
}

void check(int code, const char* message) {
  if (code != KACANOV_OK) throw std::runtime_error(message);
}

}  // namespace

PowerLawBody::PowerLawBody(const meshes::OwnedMesh& mesh, bool own, int threads) {
  kacanov_law law{};
  law.struct_size = sizeof law;
  law.kind = own ? KACANOV_USER : KACANOV_POWER;
  law.bulk = 2.0;
  law.shear = shear;
  law.x0 = yield;
  law.n = exponent;
  if (own) law.evaluate = evaluate;
  law.parallel = own ? 1 : 0;
  kacanov_description body{};
  body.struct_size = sizeof body;
  body.element = static_cast<std::int32_t>(mesh.type);
  body.threads = threads;
  body.nodes = mesh.view().node_count();
  body.coordinates = mesh.coordinates.data();
  body.elements = mesh.view().element_count();
  body.connectivity = mesh.connectivity.data();
  body.borrow = 1;
  body.laws = 1;
  body.law = &law;
  kacanov_operator* op = nullptr;
  char message[256];
  check(kacanov_create(&body, &op, message, sizeof message), message);
  op_.reset(op);
}

void PowerLawBody::residual(std::span<const double> u, std::span<double> f) {
  check(kacanov_residual(op_.get(), u.size(), u.data(), f.data()), kacanov_message(op_.get()));
}

void PowerLawBody::update_tangent(std::span<const double> u) {
  check(kacanov_update_tangent(op_.get(), u.size(), u.data()), kacanov_message(op_.get()));
}

}  // namespace kacanov::perf
