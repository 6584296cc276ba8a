// SPDX-License-Identifier: BSD-3-Clause
// A small body for the tests of the C interface: its handle, constraints, penalty blocks and multigrid;
// products and distances.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include <kacanov/kacanov.h>
#include "small_meshes.hpp"

using Vector = std::vector<double>;
inline constexpr std::int32_t all_elements[] = {KACANOV_TRI3, KACANOV_TET4, KACANOV_TET10, KACANOV_HEX8,
                                                KACANOV_QUAD4};
constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

struct Destroy {
  void operator()(kacanov_operator* op) const { kacanov_destroy(op); }
};
using Handle = std::unique_ptr<kacanov_operator, Destroy>;

/// Returns a zeroed struct of the C interface with its struct_size set.
template <class Struct>
Struct sized() {
  Struct made{};
  made.struct_size = sizeof made;
  return made;
}

inline kacanov_law logarithmic() {
  auto law = sized<kacanov_law>();
  REQUIRE(kacanov_elastic_law(2.0, 0.3, &law) == KACANOV_OK);
  law.kind = KACANOV_LOGARITHMIC;
  law.x0 = 0.02;
  return law;
}

/// A mesh with two alternating laws (logarithmic and linear), and the description of both.
struct Example {
  SmallMesh mesh;
  std::vector<kacanov_law> laws;
  std::vector<std::uint16_t> law_of_element;
  kacanov_description description = sized<kacanov_description>();

  explicit Example(std::int32_t element = KACANOV_TET4, std::size_t n = 2) : mesh(small_mesh(element, n)) {
    laws = {logarithmic(), logarithmic()};
    laws[1].kind = KACANOV_LINEAR;
    for (std::size_t e = 0; e < mesh.elements(); ++e)
      law_of_element.push_back(static_cast<std::uint16_t>(e % 2));
    description.element = element;
    description.nodes = mesh.nodes();
    description.coordinates = mesh.coordinates.data();
    description.elements = mesh.elements();
    description.connectivity = mesh.connectivity.data();
    description.laws = laws.size();
    description.law = laws.data();
    description.law_of_element = law_of_element.data();
  }
  Example(const Example&) = delete;
  Example& operator=(const Example&) = delete;

  std::size_t n() const { return mesh.unknowns(); }

  Handle create() const {
    kacanov_operator* op = nullptr;
    char message[256];
    const int code = kacanov_create(&description, &op, message, sizeof message);
    INFO(message);
    REQUIRE(code == KACANOV_OK);
    return Handle(op);
  }

  /// Creates an operator that must fail; returns the code and writes the message to `text`.
  int fault(std::string& text) const {
    auto* op = reinterpret_cast<kacanov_operator*>(&text);  // creation must overwrite this with null
    char message[256];
    const int code = kacanov_create(&description, &op, message, sizeof message);
    CHECK(op == nullptr);
    text = message;
    return code;
  }
};

inline Vector random_vector(std::size_t n, unsigned seed, double size = 1.0) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> value(-size, size);
  Vector x(n);
  for (double& v : x) v = value(random);
  return x;
}

inline Vector applied(const Handle& op, const Vector& x) {
  Vector y(x.size());
  REQUIRE(kacanov_apply(op.get(), x.size(), x.data(), y.data()) == KACANOV_OK);
  return y;
}

/// Returns max |a − b| / max |b|, or NaN if any entry is NaN.
inline double distance(const Vector& a, const Vector& b) {
  REQUIRE(a.size() == b.size());
  double difference = 0.0, size = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (const double here = std::abs(a[i] - b[i]); !(here <= difference)) difference = here;
    size = std::max(size, std::abs(b[i]));
  }
  return difference / size;
}

struct DestroyMultigrid {
  void operator()(kacanov_multigrid* multigrid) const { kacanov_multigrid_destroy(multigrid); }
};
using MultigridHandle = std::unique_ptr<kacanov_multigrid, DestroyMultigrid>;

inline MultigridHandle multigrid_of(const Handle& op) {
  kacanov_multigrid* made = nullptr;
  const int code = kacanov_multigrid_create(op.get(), nullptr, &made);
  INFO(kacanov_message(op.get()));
  REQUIRE(code == KACANOV_OK);
  return MultigridHandle(made);
}

/// Returns the unknowns of the nodes at the bottom (lowest z, or y in 2D), which are constrained.
inline std::vector<std::int32_t> bottom(const SmallMesh& mesh) {
  std::vector<std::int32_t> list;
  for (std::size_t i = 0; i < mesh.unknowns(); ++i)
    if (mesh.coordinates[i / mesh.dim * mesh.dim + mesh.dim - 1] < 0.15)
      list.push_back(static_cast<std::int32_t>(i));
  return list;
}

/// Nodes with penalty blocks: a stiff spring in an oblique direction, added twice at one node.
struct Springs {
  std::vector<std::int32_t> node;
  Vector block;
  explicit Springs(const SmallMesh& mesh) {
    const std::size_t last = mesh.nodes() - 1;
    for (const std::size_t n : {last, last - 1, last}) {
      node.push_back(static_cast<std::int32_t>(n));
      for (std::size_t i = 0; i < mesh.dim; ++i)
        for (std::size_t j = 0; j < mesh.dim; ++j)
          block.push_back(3.0 * static_cast<double>(i + 1) * static_cast<double>(j + 1));
    }
  }
};

inline void hold(const Handle& op, const SmallMesh& mesh) {
  const auto list = bottom(mesh);
  const Springs springs(mesh);
  REQUIRE(kacanov_constrain(op.get(), list.size(), list.data()) == KACANOV_OK);
  REQUIRE(kacanov_set_blocks(op.get(), springs.node.size(), springs.node.data(), springs.block.data()) ==
          KACANOV_OK);
}
