// SPDX-License-Identifier: BSD-3-Clause
// Guesses what a mistyped word was meant to be.
#pragma once

#include <span>
#include <string>

namespace kacanov {

/// The candidate closest to a mistyped word, or an empty string when none is near.
std::string closest_word(const std::string& word, std::span<const std::string> candidates);

}  // namespace kacanov
