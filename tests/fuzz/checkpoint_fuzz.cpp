// SPDX-License-Identifier: BSD-3-Clause
// A checkpoint with changed entries and a matching hash: rejected with a message, or a safe restart. Also
// arbitrary bytes as a checkpoint file.
#include <fstream>

#include <kacanov/error.hpp>
#include "bytes.hpp"
#include "program/checkpoint_file.hpp"
#include "small_problem.hpp"

using namespace kacanov;

namespace {

const Part& part() {
  static const Part whole = [] {
    fuzz::start_mpi();
    const Problem problem = fuzz::small_problem();
    return distribute(&problem, MPI_COMM_SELF);
  }();
  return whole;
}

Solution solved(const RunOptions& run) { return solve(part(), fuzz::small_case().model.solver, run); }

const Checkpoint& good_checkpoint() {
  static const Checkpoint last = [] {
    Checkpoint kept;
    RunOptions run;
    run.checkpoint = [&](const Checkpoint& checkpoint) { kept = checkpoint; };
    solved(run);
    return kept;
  }();
  return last;
}

void change(Checkpoint& checkpoint, fuzz::Bytes& in) {
  const auto number =
      std::next(checkpoint.numbers.begin(), static_cast<long>(in.below(checkpoint.numbers.size())));
  const auto field =
      std::next(checkpoint.fields.begin(), static_cast<long>(in.below(checkpoint.fields.size())));
  switch (in.below(5)) {
    case 0: number->second = in.number(); break;
    case 1: checkpoint.numbers.erase(number); break;
    case 2:
      if (!field->second.empty()) field->second[in.below(field->second.size())] = in.number();
      break;
    case 3: field->second.resize(in.below(2 * field->second.size() + 3)); break;
    default: checkpoint.fields.erase(field); break;
  }
}

/// Reads the bytes as a checkpoint file; the case and the problem do not matter.
void read_file(std::string_view bytes) {
  static const std::filesystem::path folder = [] {
    char name[] = "/tmp/kacanov_fuzz_XXXXXX";
    return std::filesystem::path(mkdtemp(name));
  }();
  std::ofstream(folder / checkpoint_name, std::ios::binary) << bytes;
  CheckpointFile(folder, fuzz::small_case(), {}).read();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes in(data, size);
  try {
    if (in.below(8) == 0) {
      read_file(in.rest());
      return 0;
    }
    Checkpoint start = good_checkpoint();
    for (int k = 0; k < 4 && !in.empty() && !start.numbers.empty() && !start.fields.empty(); ++k)
      change(start, in);
    RunOptions run;
    run.start = &start;
    const Solution solution = solved(run);
    fuzz::expect(solution.displacement.size() == part().unknowns());
  } catch (const InputError&) {
  }
  return 0;
}
