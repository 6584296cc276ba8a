// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as a case file: rejected with a message, or a valid case; with a small box also a valid
// problem.
#include <kacanov/error.hpp>
#include <kacanov/problem.hpp>
#include "bytes.hpp"
#include "case/case_file.hpp"

using namespace kacanov;

namespace {

/// Larger boxes add no coverage and take longer.
bool is_small(const BoxSpec& box) {
  double cells = 1.0;
  for (int c = 0; c < dimension(box.type); ++c) cells *= box.cells[c];
  return cells <= 60.0;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const Case input = parse_case(CaseText{"fuzz.json", std::string(fuzz::Bytes(data, size).rest())}, {});
    if (!input.mesh.box || !is_small(*input.mesh.box)) return 0;
    Mesh mesh = make_box(*input.mesh.box);
    check_dimension(input, mesh.dim());
    build_problem(std::move(mesh), input.model);
  } catch (const InputError&) {
  }
  return 0;
}
