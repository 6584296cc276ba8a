// SPDX-License-Identifier: BSD-3-Clause
// Boundary conditions of a deck: displacements, forces, pressures, gravity and temperatures.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "formats/deck.hpp"
#include "formats/deck_temperatures.hpp"

namespace kacanov {

/// Reads *BOUNDARY, *CLOAD, *DLOAD, *DSLOAD, *TEMPERATURE and *INITIAL CONDITIONS.
class DeckConditions {
 public:
  using Triple = std::array<double, 3>;
  /// Called for an unsupported condition that would change the solution, with the reason.
  using Change = std::function<void(const DeckBlock& block, const std::string& why)>;

  static constexpr double is_free = std::numeric_limits<double>::quiet_NaN();

  struct Pressure {
    double value = 0.0;
    DeckPlace place;
  };
  struct Gravity {
    DeckPlace place;
    std::vector<std::int32_t> elements;
    Triple acceleration;
  };

  DeckConditions(const Deck& deck, Change change);

  /// Reads the keyword and returns true if it is one of these.
  bool take(const DeckBlock& block);

  int dimension() const noexcept { return dim_; }
  /// Displacements and forces per node; empty if there are none.
  const std::vector<Triple>& held() const noexcept { return held_; }
  const std::vector<Triple>& forces() const noexcept { return forces_; }
  /// Pressures by element and side.
  const std::map<std::pair<std::int32_t, std::int32_t>, Pressure>& pressures() const noexcept {
    return pressures_;
  }
  const std::vector<Gravity>& gravity() const noexcept { return gravity_; }
  /// Temperature rise of the body's nodes over the initial temperature, by node number.
  std::map<std::int64_t, double> temperature_rise() const { return temperatures_.rise(in_body_); }

 private:
  void take_boundary(const DeckBlock& block);
  void hold(const std::vector<std::int32_t>& nodes, std::pair<int, int> directions, double value);
  void take_point_load(const DeckRow& row, bool in_part);
  void take_element_load(const DeckBlock& block, const DeckRow& row);
  void take_surface_load(const DeckBlock& block, const DeckRow& row);
  void press(DeckSide side, DeckPlace place, double value);

  const Deck& deck_;
  Change change_;
  int dim_ = 2;
  std::vector<bool> in_body_;  ///< one per node
  std::vector<Triple> held_, forces_;
  std::map<std::pair<std::int32_t, std::int32_t>, Pressure> pressures_;
  std::vector<Gravity> gravity_;
  DeckTemperatures temperatures_;
};

}  // namespace kacanov
