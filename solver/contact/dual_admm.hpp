// SPDX-License-Identifier: BSD-3-Clause
// The dual form of ADMM, on multipliers alone, extended to friction (theory: dual-admm).
#pragma once

#include "contact/admm.hpp"

namespace kacanov {

/// Iterates from state.lambda and state.phi (theory: dual-admm): λ = λ₊ + λ₋ ← λ₊ − r C B_r⁻¹ CᵀM (λ₊ − λ₋) +
/// r (Ca − ρ), with a = B_r⁻¹ (F + r NᵀMρ) once and one solve with B_r an iteration. λ₊ is the projection of
/// λ onto the multipliers (pressure, or the friction disc), λ₋ the rest. Where multipliers are given, a takes
/// them along and the solves count from them. The same sequence as admm() with α = 1, inexact solves
/// included: CG sees the same residuals. Entry and exit as for admm(); u appears at the end only.
AdmmResult dual_admm(const LinearProblem& problem, ContactState& state, CgWork& work,
                     const AdmmOptions& options);

}  // namespace kacanov
