// SPDX-License-Identifier: BSD-3-Clause
// Text inside XML.
#pragma once

#include <string>
#include <string_view>

#include "formats/printable.hpp"

namespace kacanov {

/// `text` as printable() shows it, on one line, with the characters escaped that XML reserves.
inline std::string xml_escape(std::string_view text) {
  std::string result;
  for (const char c : printable(text)) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      default: result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return result;
}

}  // namespace kacanov
