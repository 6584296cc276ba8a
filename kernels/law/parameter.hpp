// SPDX-License-Identifier: BSD-3-Clause
// What laws say of a parameter that is out of its range.
#pragma once

#include <string>

namespace kacanov::laws {

/// "name: expected ..., got value".
std::string refusal(const std::string& name, const std::string& expected, double value);
/// Empty if the value is finite and > 0.
std::string positive(const std::string& name, double value);
/// Empty if 0 < value ≤ 1.
std::string fraction(const std::string& name, double value);

}  // namespace kacanov::laws
