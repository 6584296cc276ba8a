// SPDX-License-Identifier: BSD-3-Clause
// What a contact problem's iterations work on.
#pragma once

#include "contact/traces.hpp"

namespace kacanov {

/// ω with its auxiliary and multiplier fields; kept from one linearisation to the next.
struct ContactState {
  Vector omega;         ///< takes prescribed components along
  ContactValues trace;  ///< (Nω, Tω)
  ContactValues phi, lambda;
  Vector gap;    ///< ρ of each contact point, under the share of the load that the state belongs to
  Vector bound;  ///< ψ of each contact point
};

}  // namespace kacanov
