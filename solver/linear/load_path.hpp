// SPDX-License-Identifier: BSD-3-Clause
// The load path: loads, prescribed displacements and gaps at a share of the full load.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// Loads, prescribed displacements and gaps of a part at a share of the full load or, with load curves, at a
/// time, which replaces the share (theory: load-path). Indenting obstacles are withdrawn per contact entry by
/// the missing share of its largest indentation; other gaps, friction bounds and the part do not change.
class LoadPath {
 public:
  /// Starts at the full load, or at the end of the curves. Collective. `part` must outlive it.
  explicit LoadPath(const Part& part);

  /// Moves to any share > 0; share 1 reproduces the part's data bit for bit.
  void go_to(double share);
  double share() const noexcept { return share_; }
  /// Returns the current factor on the loads of a boundary entry.
  double factor_of(std::int32_t entry) const;
  /// Whether no load, prescribed displacement, temperature or indenting obstacle acts. Collective.
  bool idle() const;
  /// Returns the factor by which to scale the state as initial guess at another share: 1 with load curves,
  /// unless everything that acts grows proportionally.
  double growth_to(double share) const;

  /// Nonzero entries of F, ascending.
  std::span<const Part::ComponentValue> load() const noexcept { return whole_ ? part_->load : load_; }
  /// One value per constrained component, ascending.
  std::span<const Part::ComponentValue> prescribed() const noexcept {
    return whole_ ? part_->prescribed : prescribed_;
  }
  /// Returns the thermal pressures, in the layout of ThermalPressure; empty if there is no temperature entry.
  std::vector<double> thermal_pressure() const;
  /// One gap per contact point.
  const std::vector<double>& gap() const noexcept { return gap_; }

  /// f += F.
  void add_load(std::span<double> f) const noexcept {
    for (const auto& entry : load()) f[entry.component] += entry.value;
  }
  /// Sets the constrained components of u, and its components along prescribed directions.
  void prescribe(std::span<double> u) const;

 private:
  double value_of(const HeldDirection& held) const { return factor_of(held.entry) * held.value; }
  void go_along_curves(double time);
  void find_acting(const std::vector<double>& depth);

  const Part* part_;
  double share_ = 1.0;
  bool whole_ = true;                                    ///< whether at the full load
  std::vector<Part::ComponentValue> load_, prescribed_;  ///< at the share; empty at the full load
  /// Gap at the share; the entry's largest indentation; closure by the full prescribed displacements.
  std::vector<double> gap_, depth_, closed_;
  std::vector<double> factors_;  ///< of boundary entries; only with load curves
  /// Boundary entries, then contact entries: whether a factor has any effect.
  std::vector<std::uint8_t> acts_;
};

}  // namespace kacanov
