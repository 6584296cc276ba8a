// SPDX-License-Identifier: BSD-3-Clause
// A part with changed fields and a matching hash: rejected with a message, or solved safely.
#include <stdexcept>
#include <string>

#include <kacanov/error.hpp>
#include "bytes.hpp"
#include "partition/check_part.hpp"
#include "partition/part_fields.hpp"
#include "small_problem.hpp"

using namespace kacanov;

namespace {

struct Sink {
  std::string bytes;
  void write(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
};

struct Source {
  std::string_view left;
  void expect(std::uint64_t entries, std::size_t bytes_each) const {
    if (entries > left.size() / bytes_each) throw InputError("cut short");
  }
  void read(void* data, std::size_t size) {
    expect(size, 1);
    if (size > 0) std::memcpy(data, left.data(), size);
    left.remove_prefix(size);
  }
};

std::string written(const Part& part) {
  Sink sink;
  FieldWriter{sink}(part);
  return sink.bytes;
}

const std::string& good_part() {
  static const std::string bytes = [] {
    fuzz::start_mpi();
    std::string of_one;
    split(fuzz::small_problem(), 1, [&](int, Part&& part) { of_one = written(part); });
    return of_one;
  }();
  return bytes;
}

/// Overwrites, removes or inserts bytes; positions are fractions of the length, so that seeds stay meaningful
/// when fields are added.
void change(std::string& bytes, fuzz::Bytes& in) {
  const std::size_t at = bytes.size() * in.take<std::uint16_t>() / 65536 + in.take<std::uint8_t>() % 16;
  const auto put = [&](const auto& value) {
    if (at + sizeof value <= bytes.size()) std::memcpy(&bytes[at], &value, sizeof value);
  };
  switch (in.below(6)) {
    case 0: put(in.take<std::uint8_t>()); break;
    case 1: put(in.take<std::int32_t>()); break;
    case 2: put(in.take<std::int64_t>()); break;
    case 3: put(in.number()); break;
    case 4: bytes.erase(std::min(at, bytes.size()), 1 + in.below(16)); break;
    default:
      bytes.insert(std::min(at, bytes.size()), 1 + in.below(16), static_cast<char>(in.take<std::uint8_t>()));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes in(data, size);
  std::string bytes = good_part();
  for (int k = 0; k < 8 && !in.empty() && !bytes.empty(); ++k) change(bytes, in);
  try {
    Source source{bytes};
    Part part;
    FieldReader{source}(part);
    if (!source.left.empty()) return 0;
    fuzz::expect(written(part).size() == bytes.size());
    check_part(part, 0, 1);
    join(part, MPI_COMM_SELF);
    const Solution solution = solve(part, fuzz::small_case().model.solver, {});
    fuzz::expect(solution.displacement.size() == part.unknowns());
  } catch (const InputError&) {
  } catch (const InternalError&) {          // from a library, for numbers that no body has
  } catch (const std::invalid_argument&) {  // from an operator, for degenerate elements
  }
  return 0;
}
