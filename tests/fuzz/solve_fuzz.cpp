// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as the case of kacanov_solve: rejected with a message, or solved until the host stops it,
// with fields of the documented lengths.
#include <kacanov/kacanov_solve.h>

#include <array>
#include <cstring>
#include <memory>
#include <string>

#include <kacanov/error.hpp>
#include "bytes.hpp"
#include "case/case_file.hpp"

using kacanov::fuzz::expect;

namespace {

/// Returns true for an invalid case and for a box of few cells: larger boxes add no coverage and take longer,
/// and other targets cover mesh files.
bool is_small(const std::string& text) {
  try {
    const kacanov::Case input = kacanov::parse_case(kacanov::CaseText{"case.json", text}, {});
    if (!input.mesh.box || input.mesh.adapt) return false;
    double cells = 1.0;
    for (int c = 0; c < dimension(input.mesh.box->type); ++c) cells *= input.mesh.box->cells[c];
    return cells <= 60.0;
  } catch (const kacanov::InputError&) {
    return true;
  }
}

struct Host {
  int asked = 0;
};

int stop(void* data) { return ++static_cast<Host*>(data)->asked > 200 ? 1 : 0; }

void tell(void*, const kacanov_progress* step) { expect(step->phase != nullptr && step->outer >= 0); }

volatile double read_last;  ///< makes the compiler keep every read

/// Checks that every field has the length that the header documents.
void check_fields(const kacanov_solution* solution) {
  kacanov_solution_information about{};
  about.struct_size = sizeof about;
  expect(kacanov_solution_inspect(solution, &about) == KACANOV_OK);
  expect(about.message != nullptr && kacanov_solution_json(solution) != nullptr);
  const auto dim = static_cast<std::size_t>(about.dimension);
  const std::array<std::size_t, 12> lengths{
      about.nodes * dim,        about.nodes * dim,    about.nodes * 6,      about.nodes,
      about.elements * 6,       about.elements,       about.elements,       about.elements,
      about.contact_points * 3, about.contact_points, about.contact_points, about.contact_points * 3};
  for (std::size_t k = 0; k < lengths.size(); ++k) {
    std::size_t count = 0;
    const double* values = kacanov_solution_field(solution, static_cast<kacanov_field>(k), &count);
    expect(count == lengths[k] && (count == 0 || values != nullptr));
    for (std::size_t i = 0; i < count; ++i) read_last = values[i];
  }
  std::size_t count = 0;
  const std::int32_t* nodes = kacanov_solution_indices(solution, KACANOV_INDEX_CONNECTIVITY, &count);
  expect(count == about.elements * static_cast<std::size_t>(about.nodes_per_element));
  for (std::size_t i = 0; i < count; ++i)
    expect(nodes[i] >= 0 && static_cast<std::size_t>(nodes[i]) < about.nodes);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(kacanov::fuzz::Bytes(data, size).rest());
  if (!is_small(text)) return 0;
  Host host;
  kacanov_solve_options options{};
  options.struct_size = sizeof options;
  options.folder = "/nowhere";
  options.threads = 1;
  options.progress = tell;
  options.stop = stop;
  options.data = &host;
  char message[512] = "?";
  kacanov_solution* made = nullptr;
  const int code = kacanov_solve(text.c_str(), &options, &made, message, sizeof message);
  const std::unique_ptr<kacanov_solution, void (*)(kacanov_solution*)> solution(made,
                                                                                kacanov_solution_destroy);
  expect((code == KACANOV_OK) == (made != nullptr));
  expect((code == KACANOV_OK) == (std::strlen(message) == 0));
  expect(code != KACANOV_ERROR_INTERNAL && code != KACANOV_ERROR_STATE && code != KACANOV_ERROR_NULL);
  if (made != nullptr) check_fields(made);
  return 0;
}
