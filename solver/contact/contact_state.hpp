// SPDX-License-Identifier: BSD-3-Clause
// What a contact problem's iterations work on.
#pragma once

#include "contact/traces.hpp"

namespace kacanov {

/// u with its auxiliary and multiplier fields; kept from one linearisation to the next.
struct ContactState {
  Vector u;             ///< takes prescribed components along
  ContactValues trace;  ///< (Nu, Tu), the latter less `origin`: what friction acts on is slip
  ContactValues phi, lambda;
  Vector gap;    ///< ρ of each contact point, under the share of the load that the state belongs to
  Vector bound;  ///< ψ of each contact point
  /// Points × 2: the Tu that slip is counted from (theory: slip-history); empty: rest.
  Vector origin;

  /// Fills `trace` from `u`.
  void evaluate(const Traces& traces) { evaluate(traces, u, trace); }
  /// Traces at another displacement.
  void evaluate(const Traces& traces, std::span<const double> displacement, ContactValues& values) const {
    traces.evaluate(displacement, values);
    for (std::size_t k = 0; k < origin.size(); ++k) values.tangential[k] -= origin[k];
  }
  /// From here on slip of the points that follow the load steps is counted from `u`, whose traces `trace`
  /// holds.
  void count_slip_from_here(std::span<const ContactPoint> points) {
    origin.resize(2 * points.size(), 0.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].since_step) continue;
      for (std::size_t k = 2 * i; k < 2 * i + 2; ++k) {
        origin[k] += trace.tangential[k];
        phi.tangential[k] -= trace.tangential[k];
        trace.tangential[k] = 0.0;
      }
    }
  }
};

}  // namespace kacanov
