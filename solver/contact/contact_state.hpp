// SPDX-License-Identifier: BSD-3-Clause
// State of the iterations on a contact problem.
#pragma once

#include "contact/traces.hpp"

namespace kacanov {

/// u with its auxiliary variables and multipliers; kept from one linearisation to the next.
struct ContactState {
  Vector u;             ///< including prescribed components
  ContactValues trace;  ///< (Nu, Tu), with Tu relative to `origin`: friction acts on slip
  ContactValues phi, lambda;
  Vector gap;    ///< ρ of each contact point, at the state's share of the load
  Vector bound;  ///< ψ of each contact point
  /// Points × 2: the Tu from which slip is measured (theory: slip-history); empty: zero.
  Vector origin;

  /// Fills `trace` from `u`.
  void evaluate(const Traces& traces) { evaluate(traces, u, trace); }
  /// Computes the traces at another displacement.
  void evaluate(const Traces& traces, std::span<const double> displacement, ContactValues& values) const {
    traces.evaluate(displacement, values);
    for (std::size_t k = 0; k < origin.size(); ++k) values.tangential[k] -= origin[k];
  }
  /// Sets the reference of slip to `u`, whose traces `trace` holds, for points that measure slip per load
  /// step.
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
