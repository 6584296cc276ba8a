// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary lines as arguments of --set, applied to a case with every kind of entry.
#include <kacanov/error.hpp>
#include <vector>

#include "../tools/case_samples.hpp"
#include "bytes.hpp"

using namespace kacanov;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string sample = testing::complete_case().dump();
  std::vector<std::string> lines(1);
  for (const char c : fuzz::Bytes(data, size).rest()) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  try {
    parse_case(CaseText{"sample.json", sample}, lines);
  } catch (const InputError&) {
  }
  return 0;
}
