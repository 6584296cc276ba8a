// SPDX-License-Identifier: BSD-3-Clause
// The dual form of ADMM, on multipliers alone, extended to friction (theory: dual-admm).
#pragma once

#include "contact/admm.hpp"

namespace kacanov {

/// λ = λ₊ + λ₋ ← λ₊ − r C B_r⁻¹ CᵀM (λ₊ − λ₋) + r (Ca − ρ) with a = B_r⁻¹ (F + r NᵀMρ), from state.lambda and
/// state.phi (theory: dual-admm); λ₊ is the projection onto admissible multipliers. One solve per iteration;
/// same sequence, entry and exit as admm() with α = 1, also if inexact; u follows at the end.
AdmmResult dual_admm(const LinearProblem& problem, ContactState& state, CgWork& work,
                     const AdmmOptions& options);

}  // namespace kacanov
