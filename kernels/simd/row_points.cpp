// SPDX-License-Identifier: BSD-3-Clause
// Selects the loops over consecutive elements built for an instruction set.
#include "simd/row_points.hpp"

#include "simd/instruction_set.hpp"

namespace kacanov::simd {
namespace {

const AllRowLoops& all_loops([[maybe_unused]] InstructionSet set) {
#ifdef KACANOV_X86_KERNELS
  if (set == InstructionSet::avx512) return rows_avx512();
  if (set == InstructionSet::avx2) return rows_avx2();
#endif
  return rows_plain();
}

}  // namespace

template <std::size_t nodes>
const RowLoops<nodes>& row_loops(std::string_view instruction_set) {
  const AllRowLoops& all = all_loops(choose_instruction_set(instruction_set));
  if constexpr (nodes == 4)
    return all.tet4;
  else if constexpr (nodes == 8)
    return all.hex8;
  else
    return all.tet10;
}

template const RowLoops<4>& row_loops<4>(std::string_view);
template const RowLoops<8>& row_loops<8>(std::string_view);
template const RowLoops<10>& row_loops<10>(std::string_view);

}  // namespace kacanov::simd
