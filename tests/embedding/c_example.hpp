// SPDX-License-Identifier: BSD-3-Clause
// A small body for the tests of the C interface, its handle, and helpers for products and distances.
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
