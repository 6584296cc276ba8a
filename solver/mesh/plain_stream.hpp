// SPDX-License-Identifier: BSD-3-Clause
// Streams whose numbers are the project's own in a host that has made a locale with commas global.
#pragma once

#include <fstream>
#include <locale>
#include <sstream>
#include <utility>

namespace kacanov {

/// A stream of the standard library that does not ask the global locale of C++.
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
