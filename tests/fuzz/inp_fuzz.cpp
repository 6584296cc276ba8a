// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as an Abaqus or CalculiX deck: rejected with a message, or a mesh whose indices are all
// valid; then converted to a case.
#include "formats/deck.hpp"
#include "program/deck_case.hpp"
#include "read_mesh.hpp"

using namespace kacanov;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = fuzz::Bytes(data, size).rest();
  fuzz::read_mesh([&] { return mesh_of(read_deck("fuzz.inp", text)); });
  try {
    const DeckCase made = case_of(read_deck("fuzz.inp", text), true);
    fuzz::expect(!made.document.dump().empty());  // for any bytes in names and titles
  } catch (const InputError&) {
  }
  return 0;
}
