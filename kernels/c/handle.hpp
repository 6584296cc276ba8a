// SPDX-License-Identifier: BSD-3-Clause
// The handle of the C interface, with checks of arguments and error reports.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <kacanov/kacanov.h>
#include <kacanov/operator.hpp>
#include <kacanov/reference.hpp>
#include "c/laws.hpp"
#include "multigrid/multigrid_body.hpp"
#include "reference/matrix.hpp"

/// The contents of a handle. It keeps the mesh for the recovery of stress and for new laws.
struct kacanov_operator {
  kacanov::MeshView mesh;  ///< of the vectors below, or of the caller's arrays
  std::vector<double> coordinates;
  std::vector<std::int32_t> connectivity;
  std::vector<kacanov::Law> laws;
  std::vector<kacanov::c_api::OwnLaw> own_laws;  ///< one per law
  std::vector<std::uint16_t> own_law_of_element;
  std::span<const std::uint16_t> law_of_element;
  std::vector<std::int32_t> early;  ///< nodes whose values are needed first
  kacanov::OperatorOptions options;
  std::string instruction_set;            ///< of options.instruction_set: as requested, later as chosen
  std::optional<kacanov::Operator> fast;  ///< empty until there are laws
  std::optional<kacanov::FloatOperator> single;  ///< created with the laws, if requested
  bool wants_single = false;
  bool split_vectors = false;      ///< the caller's vectors have one array per component
  bool single_is_current = false;  ///< its g equals that of `fast`
  bool has_tangent = false;
  bool single_has_tangent = false;         ///< its tangent equals that of `fast`
  std::vector<std::int32_t> unit_nodes;    ///< nodes that belong to no element and have rows of the identity
  std::vector<std::int32_t> constrained;   ///< unknowns, ascending
  std::vector<kacanov::NodeBlock> blocks;  ///< added to B and B_T
  std::uint64_t laws_set = 0;              ///< number of times that laws were set
  std::atomic<int> owners = 1;             ///< the caller and the multigrids
  kacanov::reference::NodeGraph graph;     ///< of the matrix; empty until needed
  std::vector<double> image;               ///< of kacanov_apply_add; empty until needed
  std::atomic<bool> busy = false;          ///< true during a call
  char message[512] = "";

  std::size_t unknowns() const noexcept { return mesh.coordinates.size(); }
  kacanov::Body body() const noexcept { return {mesh, laws, law_of_element}; }
  /// Whether the callbacks of user-defined laws are needed.
  bool has_own_laws() const noexcept {
    for (const auto& own : own_laws)
      if (own.evaluate != nullptr) return true;
    return false;
  }
};

namespace kacanov::c_api {

inline void copy_message(const char* text, char* to, std::size_t size) noexcept {
  if (to != nullptr && size > 0) std::snprintf(to, size, "%s", text);
}

/// Releases one owner, and frees the handle after the last one: it lives as long as its multigrids.
inline void let_go(kacanov_operator* op) noexcept {
  if (op != nullptr && op->owners.fetch_sub(1, std::memory_order_acq_rel) == 1) delete op;
}

/// Runs `work`; converts exceptions to a code and a message.
template <class Work>
int guarded(char* message, std::size_t size, Work&& work) noexcept {
  try {
    work();
    return KACANOV_OK;
  } catch (const Fault& fault) {
    copy_message(fault.what(), message, size);
    return fault.code();
  } catch (const std::invalid_argument& error) {
    copy_message(error.what(), message, size);
    return KACANOV_ERROR_VALUE;
  } catch (const std::bad_alloc&) {
    copy_message("out of memory", message, size);
    return KACANOV_ERROR_MEMORY;
  } catch (const std::system_error& error) {
    copy_message(error.what(), message, size);
    return KACANOV_ERROR_MEMORY;
  } catch (const std::length_error&) {
    copy_message("out of memory: a size is beyond any memory", message, size);
    return KACANOV_ERROR_MEMORY;
  } catch (const std::exception& error) {
    copy_message(error.what(), message, size);
    return KACANOV_ERROR_INTERNAL;
  } catch (...) {
    copy_message("unknown failure", message, size);
    return KACANOV_ERROR_INTERNAL;
  }
}

inline void require(const void* pointer, const char* name) {
  if (pointer == nullptr) throw Fault(KACANOV_ERROR_NULL, std::string(name) + ": null pointer");
}

inline void require_size(std::size_t got, std::size_t expected, const char* name) {
  if (got != expected)
    throw Fault(KACANOV_ERROR_SIZE, std::string(name) + ": expected " + std::to_string(expected) + ", got " +
                                        std::to_string(got));
}

/// Runs `work` with guarded() unless another call is using the handle, whose message is then left alone.
template <class Handle, class Work>
int alone(Handle* op, Work&& work) noexcept {
  if (op == nullptr) return KACANOV_ERROR_NULL;
  if (op->busy.exchange(true, std::memory_order_acquire)) return KACANOV_ERROR_STATE;
  const int code = guarded(op->message, sizeof op->message, work);
  op->busy.store(false, std::memory_order_release);
  return code;
}

inline void require_laws(const kacanov_operator& op) {
  if (!op.fast) throw Fault(KACANOV_ERROR_STATE, "the operator has no laws yet: kacanov_set_laws first");
}

inline void require_tangent(const kacanov_operator& op) {
  if (!op.has_tangent)
    throw Fault(KACANOV_ERROR_STATE, "no tangent is frozen yet: kacanov_update_tangent first");
}

/// The same for a handle with laws.
template <class Work>
int on(kacanov_operator* op, Work&& work) noexcept {
  return alone(op, [&] {
    require_laws(*op);
    work(*op->fast);
  });
}

template <class Real>
std::span<const Real> input(const Real* data, std::size_t n, const char* name) {
  if (n > 0) require(data, name);
  return {data, n};
}

template <class Real>
std::span<Real> output(Real* data, std::size_t n, const char* name) {
  if (n > 0) require(data, name);
  return {data, n};
}

template <class Real>
void require_disjoint(std::span<const Real> x, std::span<Real> y, const char* names) {
  const std::less<const Real*> before;
  if (before(x.data(), y.data() + y.size()) && before(y.data(), x.data() + x.size()))
    throw Fault(KACANOV_ERROR_SIZE, std::string(names) + " overlap");
}

}  // namespace kacanov::c_api
