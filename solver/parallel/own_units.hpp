// SPDX-License-Identifier: BSD-3-Clause
// Solves in units of the problem's own, so that its user's may be any (theory: units).
#pragma once

#include <vector>

#include <kacanov/part.hpp>
#include "parallel/unit_system.hpp"

namespace kacanov {

/// The body's extent, the middle of its moduli, and the displacement that loads, prescribed displacements and
/// indentations come to, each as the power of two below. The same on every rank. Collective.
UnitSystem units_of(const Part& part);

/// A part in its own units while this lives, and in the user's, to the bit, before and after.
class InOwnUnits {
 public:
  /// Collective.
  explicit InOwnUnits(Part& part);
  ~InOwnUnits();
  InOwnUnits(const InOwnUnits&) = delete;
  InOwnUnits& operator=(const InOwnUnits&) = delete;

  const UnitSystem& units() const noexcept { return units_; }

 private:
  friend class InUsersUnits;
  /// There and back; each swaps the laws.
  void enter();
  void leave();

  Part& part_;
  UnitSystem units_;
  std::vector<Law> laws_;  ///< in the units that the part is not in
};

/// In between, the same part in its user's units.
class InUsersUnits {
 public:
  explicit InUsersUnits(InOwnUnits& own) : own_(own) { own_.leave(); }
  ~InUsersUnits() { own_.enter(); }
  InUsersUnits(const InUsersUnits&) = delete;
  InUsersUnits& operator=(const InUsersUnits&) = delete;

 private:
  InOwnUnits& own_;
};

}  // namespace kacanov
