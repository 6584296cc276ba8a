// SPDX-License-Identifier: BSD-3-Clause
// Element types of Abaqus and CalculiX: the cell of each, and remarks about differences.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

struct DeckElementType {
  std::string_view cell;                  ///< name of the cell in cells()
  std::string_view remark;                ///< difference to the element here, for a warning; empty: none
  std::string_view refusal;               ///< reason why bodies of it are not supported; empty: supported
  PlaneState plane = PlaneState::strain;  ///< for 2D elements
};

/// Returns the entry of an element type, given in upper case; nothing if it is unknown.
std::optional<DeckElementType> deck_element_type(std::string_view type);

/// Explains why an element type unknown to deck_element_type() cannot be read, and what to use.
std::string_view why_not_known(std::string_view type);

/// Returns the nodes of facet `side` (S1 is 0) as node places within the element, in our order; empty if
/// there is no such side. `cell` is an index into cells().
std::span<const std::int8_t> deck_side(std::size_t cell, std::size_t side);

/// Number of numbered sides.
std::size_t deck_sides(std::size_t cell);

}  // namespace kacanov
