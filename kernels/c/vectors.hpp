// SPDX-License-Identifier: BSD-3-Clause
// Vectors passed to the C interface: checks of length and, for displacements, of finite values.
#pragma once

#include <cmath>
#include <deque>
#include <string>
#include <type_traits>
#include <vector>

#include "c/handle.hpp"
#include "operator/threads.hpp"

namespace kacanov::c_api {

inline void require_finite(std::span<const double> values, const char* name) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw Fault(KACANOV_ERROR_VALUE, std::string(name) + "[" + std::to_string(i) + "] is not finite");
}

/// The vectors of one call: the caller's arrays in place, or interleaved copies if the caller has one array
/// per component. The destructor copies outputs back.
class CallVectors {
 public:
  explicit CallVectors(const kacanov_operator& op) : op_(op) {}
  ~CallVectors() {
    for (const Room<double>& room : doubles_) hand_out(room);
    for (const Room<float>& room : floats_) hand_out(room);
  }
  CallVectors(const CallVectors&) = delete;
  CallVectors& operator=(const CallVectors&) = delete;

  /// `size`: total length of one or more consecutive vectors.
  template <class Real>
  std::span<const Real> in(const Real* data, std::size_t size, const char* name) {
    const auto given = input(data, size, name);
    return op_.split_vectors ? copied(given) : given;
  }
  template <class Real>
  std::span<Real> out(Real* data, std::size_t size, const char* name) {
    const auto given = output(data, size, name);
    if (!op_.split_vectors) return given;
    auto& room = rooms(data).emplace_back();
    room.to = given;
    room.values.resize(size);
    return room.values;
  }
  /// The same for a vector that is also read.
  template <class Real>
  std::span<Real> in_out(Real* data, std::size_t size, const char* name) {
    const auto given = output(data, size, name);
    if (!op_.split_vectors) return given;
    const auto values = copied(std::span<const Real>(given));
    rooms(data).back().to = given;
    return {rooms(data).back().values.data(), values.size()};
  }
  /// Returns a displacement after checking its length and that its entries are finite.
  std::span<const double> state(std::size_t n, const double* u) {
    require_size(n, op_.unknowns(), "n");
    const auto given = input(u, n, "u");
    require_finite(given, "u");
    return in(u, n, "u");
  }

 private:
  template <class Real>
  struct Room {
    std::vector<Real> values;  ///< interleaved
    std::span<Real> to;        ///< the caller's array; empty for inputs
  };
  template <class Real>
  std::deque<Room<Real>>& rooms(const Real*) {
    if constexpr (std::is_same_v<Real, double>)
      return doubles_;
    else
      return floats_;
  }
  /// Calls each(interleaved, split) with the two indices of each entry of vectors with this total size.
  template <class Each>
  void for_entries(std::size_t size, const Each& each) const {
    const std::size_t dim = dimension(op_.mesh.type), nodes = op_.mesh.node_count(), n = nodes * dim;
    for (std::size_t v = 0; v < size; v += n)
      in_shares(op_.options.threads, nodes, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          for (std::size_t c = 0; c < dim; ++c) each(v + i * dim + c, v + c * nodes + i);
      });
  }
  template <class Real>
  std::span<const Real> copied(std::span<const Real> given) {
    auto& room = rooms(given.data()).emplace_back();
    room.values.resize(given.size());
    for_entries(given.size(), [&](std::size_t at, std::size_t from) { room.values[at] = given[from]; });
    return room.values;
  }
  template <class Real>
  void hand_out(const Room<Real>& room) const {
    for_entries(room.to.size(), [&](std::size_t from, std::size_t at) { room.to[at] = room.values[from]; });
  }

  const kacanov_operator& op_;
  std::deque<Room<double>> doubles_;
  std::deque<Room<float>> floats_;
};

}  // namespace kacanov::c_api
