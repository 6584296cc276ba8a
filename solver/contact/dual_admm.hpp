// SPDX-License-Identifier: BSD-3-Clause
// The dual form of ADMM, on multipliers alone, extended to friction (theory: dual-admm).
#pragma once

#include "contact/admm.hpp"

namespace kacanov {

/// Iterates from state.lambda and state.phi (theory: dual-admm): λ = λ₊ + λ₋ ← λ₊ − r C B_r⁻¹ CᵀM (λ₊ − λ₋) +
/// r (Ca − ρ), with a = B_r⁻¹ (F + r NᵀMρ) computed once and one solve with B_r per iteration. λ₊ is the
/// projection of λ onto admissible multipliers (pressure, or the friction disc), λ₋ the rest. Given initial
/// multipliers are included in a, and the solves are relative to them. Same sequence as admm() with α = 1,
/// also with inexact solves, because CG sees the same residuals. Entry and exit as for admm(); u is computed
/// at the end only.
AdmmResult dual_admm(const LinearProblem& problem, ContactState& state, CgWork& work,
                     const AdmmOptions& options);

}  // namespace kacanov
