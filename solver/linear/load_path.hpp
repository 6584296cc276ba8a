// SPDX-License-Identifier: BSD-3-Clause
// The way to the full load: what a share of it puts on the body.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <kacanov/part.hpp>

namespace kacanov {

/// Loads, prescribed displacements and gaps of a part at a share of the full load, or, where the part has
/// load curves, at a time of theirs, which then stands for the share everywhere (theory: load-path).
/// Obstacles that press into the body at rest are drawn back along their direction, each contact entry by the
/// share still missing of its largest indentation; open gaps of other entries and the friction bounds stay
/// what they are. The part itself does not change.
class LoadPath {
 public:
  /// At the full load, or the end of the curves. Collective. `part` has to outlive it.
  explicit LoadPath(const Part& part);

  /// Any share > 0; with 1 everything is that of the part, to the bit.
  void go_to(double share);
  double share() const noexcept { return share_; }
  /// What the loads of a boundary entry are multiplied by.
  double factor_of(std::int32_t entry) const;
  /// Whether no load, prescribed displacement, temperature or obstacle that presses in acts. Collective.
  bool idle() const;
  /// What the state is to be multiplied by to start at another share: with load curves 1, unless all that
  /// acts grows in proportion.
  double growth_to(double share) const;

  /// Entries of F that are not zero, ascending.
  std::span<const Part::ComponentValue> load() const noexcept { return whole_ ? part_->load : load_; }
  /// Of every constrained component, ascending.
  std::span<const Part::ComponentValue> prescribed() const noexcept {
    return whole_ ? part_->prescribed : prescribed_;
  }
  /// The pressures that temperature takes off, as ThermalPressure has them; empty where nothing is warmer.
  std::vector<double> thermal_pressure() const;
  /// One a contact point.
  const std::vector<double>& gap() const noexcept { return gap_; }

  /// f += F.
  void add_load(std::span<double> f) const noexcept {
    for (const auto& entry : load()) f[entry.component] += entry.value;
  }
  /// Sets the constrained components of u, and u along held directions.
  void prescribe(std::span<double> u) const;

 private:
  double value_of(const HeldDirection& held) const { return factor_of(held.entry) * held.value; }
  void go_along_curves(double time);
  void find_acting(const std::vector<double>& depth);

  const Part* part_;
  double share_ = 1.0;
  bool whole_ = true;                                    ///< at the full load
  std::vector<Part::ComponentValue> load_, prescribed_;  ///< at the share; empty at the full load
  /// At the share; how deep the entry's obstacle presses in; what the full prescribed displacements close.
  std::vector<double> gap_, depth_, closed_;
  std::vector<double> factors_;     ///< of boundary entries, with load curves
  std::vector<std::uint8_t> acts_;  ///< boundary entries, then contact entries: whether any factor matters
};

}  // namespace kacanov
