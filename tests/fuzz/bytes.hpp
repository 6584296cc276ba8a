// SPDX-License-Identifier: BSD-3-Clause
// A reader of a fuzzer's input bytes as a sequence of values; returns zeros after the end.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>
#include <string_view>

namespace kacanov::fuzz {

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : left_(data, size) {}

  bool empty() const noexcept { return left_.empty(); }
  template <class T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof(T), left_.size());
    if (size > 0) std::memcpy(&value, left_.data(), size);
    left_ = left_.subspan(size);
    return value;
  }
  /// Returns a number below `end`, or 0 if `end` is 0.
  std::size_t below(std::size_t end) { return end == 0 ? 0 : take<std::uint16_t>() % end; }
  /// Returns a number: mostly small and ordinary, sometimes a special or extreme value, sometimes arbitrary
  /// bits.
  double number() {
    constexpr double inf = std::numeric_limits<double>::infinity();
    constexpr std::array<double, 14> odd{std::numeric_limits<double>::quiet_NaN(),
                                         inf,
                                         -inf,
                                         1e308,
                                         -1e308,
                                         1e-308,
                                         5e-324,
                                         0.0,
                                         -0.0,
                                         1e16,
                                         -1.0,
                                         1e18,
                                         4294967296.0,
                                         -2147483649.0};
    const auto kind = take<std::uint8_t>();
    if (kind < odd.size()) return odd[kind];
    if (kind == odd.size()) return take<double>();
    return 0.01 * (take<std::uint8_t>() - 100);
  }
  std::string_view rest() const {
    return left_.empty() ? std::string_view()
                         : std::string_view(reinterpret_cast<const char*>(left_.data()), left_.size());
  }

 private:
  std::span<const std::uint8_t> left_;
};

/// Aborts, so that the fuzzer reports its input, if a required condition does not hold.
inline void expect(bool holds) {
  if (!holds) std::abort();
}

}  // namespace kacanov::fuzz
