// SPDX-License-Identifier: BSD-3-Clause
// Streams with the classic locale, independent of a host program that sets a global locale with decimal
// commas.
#pragma once

#include <fstream>
#include <locale>
#include <sstream>
#include <utility>

namespace kacanov {

/// A standard stream that ignores the global C++ locale.
template <class Stream>
class Plain : public Stream {
 public:
  template <class... Arguments>
  explicit Plain(Arguments&&... arguments) : Stream(std::forward<Arguments>(arguments)...) {
    this->imbue(std::locale::classic());
  }
};
using PlainText = Plain<std::ostringstream>;
using PlainWords = Plain<std::istringstream>;
using PlainFile = Plain<std::ifstream>;

}  // namespace kacanov
