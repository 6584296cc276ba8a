// SPDX-License-Identifier: BSD-3-Clause
// Escapes text for XML.
#pragma once

#include <string>
#include <string_view>

#include "formats/printable.hpp"

namespace kacanov {

/// Returns printable(text) on one line, with XML's reserved characters escaped.
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
