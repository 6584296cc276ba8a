// SPDX-License-Identifier: BSD-3-Clause
// Error messages about law parameters that are out of range.
#pragma once

#include <string>

namespace kacanov::laws {

/// Returns "name: expected ..., got value".
std::string refusal(const std::string& name, const std::string& expected, double value);
/// Returns an error message unless the value is finite and > 0; otherwise empty.
std::string positive(const std::string& name, double value);
/// Returns an error message unless 0 < value ≤ 1; otherwise empty.
std::string fraction(const std::string& name, double value);

}  // namespace kacanov::laws
