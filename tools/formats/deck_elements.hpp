// SPDX-License-Identifier: BSD-3-Clause
// The names of Abaqus' and CalculiX' elements: which cell each is, and what is to be said of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <kacanov/mesh_view.hpp>

namespace kacanov {

struct DeckElementType {
  std::string_view cell;                  ///< name among cells()
  std::string_view remark;                ///< how the element of a body differs here; empty where it does not
  std::string_view refusal;               ///< why a body cannot be made of it; empty where it can
  PlaneState plane = PlaneState::strain;  ///< of a body in 2D
};

/// What an element of this type, in upper case, is taken for. Nothing for one that is not known.
std::optional<DeckElementType> deck_element_type(std::string_view type);

/// Why an element that deck_element_type() does not know cannot be read, and what to do.
std::string_view why_not_known(std::string_view type);

/// The nodes of facet `side` (S1 is 0) of a body's cell, in our order and places of the element's nodes;
/// empty where there is no such side. `cell` is a place among cells().
std::span<const std::int8_t> deck_side(std::size_t cell, std::size_t side);

/// How many sides have numbers.
std::size_t deck_sides(std::size_t cell);

}  // namespace kacanov
