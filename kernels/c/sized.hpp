// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes structs of callers built with other versions of the header, by their struct_size.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string>

#include "c/laws.hpp"

namespace kacanov::c_api {

/// Throws Fault unless `size`, the first field of a caller's struct, is at least the size in the first
/// version with struct_size.
inline void require_struct_size(std::size_t size, std::size_t least, const std::string& where,
                                const char* type) {
  if (size < least)
    throw Fault(KACANOV_ERROR_SIZE, where + "struct_size: expected sizeof(" + type + "), " +
                                        std::to_string(least) + " or more, got " + std::to_string(size));
  constexpr std::size_t most = 1 << 16;
  if (size > most)
    throw Fault(KACANOV_ERROR_SIZE,
                where + "struct_size: expected sizeof(" + type + "), got " + std::to_string(size));
}

/// Returns the caller's struct at `from`, with zeros in missing fields. Throws Fault for the sizes above, and
/// if a newer caller sets a field that is unknown here.
template <class Struct>
Struct read_sized(const void* from, std::size_t least, const std::string& where, const char* type) {
  const auto* bytes = static_cast<const unsigned char*>(from);
  std::size_t size = 0;
  std::memcpy(&size, bytes, sizeof size);
  require_struct_size(size, least, where, type);
  if (size > sizeof(Struct) &&
      std::any_of(bytes + sizeof(Struct), bytes + size, [](unsigned char byte) { return byte != 0; }))
    throw Fault(KACANOV_ERROR_VALUE, where + "a field beyond the " + std::to_string(sizeof(Struct)) +
                                         " bytes of " + type + " that this library knows is not zero");
  Struct to{};
  std::memcpy(&to, bytes, std::min(size, sizeof(Struct)));
  to.struct_size = sizeof(Struct);
  return to;
}

/// Writes `from` to the caller's struct, as far as its size allows; keeps that size, and sets fields of a
/// newer caller beyond this version to zero.
template <class Struct>
void write_sized(const Struct& from, Struct* to, std::size_t least, const std::string& where,
                 const char* type) {
  const std::size_t size = to->struct_size;
  require_struct_size(size, least, where, type);
  auto* bytes = reinterpret_cast<unsigned char*>(to);
  std::memcpy(bytes + sizeof size, reinterpret_cast<const unsigned char*>(&from) + sizeof size,
              std::min(size, sizeof(Struct)) - sizeof size);
  if (size > sizeof(Struct)) std::memset(bytes + sizeof(Struct), 0, size - sizeof(Struct));
}

// Sizes of the structs in version 0.2, the first with struct_size; fields added later are not included.
constexpr std::size_t law_bytes = offsetof(kacanov_law, reserved) + sizeof(std::int32_t),
                      description_bytes = offsetof(kacanov_description, orphans) + sizeof(std::int32_t),
                      fields_bytes = offsetof(kacanov_fields, plastic) + sizeof(std::uint8_t*),
                      information_bytes =
                          offsetof(kacanov_information, instruction_set) + sizeof(const char*);

// The same for structs added later.
constexpr std::size_t multigrid_options_bytes =
                          offsetof(kacanov_multigrid_options, aggregate) + sizeof(double),
                      multigrid_information_bytes =
                          offsetof(kacanov_multigrid_information, reserved) + sizeof(std::int32_t),
                      cg_options_bytes = offsetof(kacanov_cg_options, tangent) + sizeof(std::int32_t),
                      cg_result_bytes = offsetof(kacanov_cg_result, residual) + sizeof(double);

}  // namespace kacanov::c_api
