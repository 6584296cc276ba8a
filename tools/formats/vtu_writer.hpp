// SPDX-License-Identifier: BSD-3-Clause
// Fields on unstructured grids as VTK files that ParaView opens: .vtu, its pieces under MPI (.pvtu),
// collections (.pvd).
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <kacanov/cells.hpp>

namespace kacanov {

/// An array for a file: one that lies there, or one that is worked out while it is written, some entries at a
/// time.
template <typename T>
class Values {
 public:
  using Fill = std::function<void(std::size_t first, std::span<T> out)>;

  Values() = default;
  template <typename Array>
  requires std::convertible_to<const Array&, std::span<const T>> Values(const Array& array)
      : there_(array), size_(there_.size()) {}
  /// `fill(first, out)` writes entries first, first + 1 ...; both are multiples of the field's components.
  Values(std::size_t size, Fill fill) : size_(size), fill_(std::move(fill)) {}

  std::size_t size() const noexcept { return size_; }
  /// Calls visit(span) for all entries, front to back, `most` of them at a time at the most.
  template <typename Visit>
  void visit(std::size_t most, const Visit& visit) const {
    if (!fill_) {
      visit(there_);
      return;
    }
    std::vector<T> some(std::min(most, size_));
    for (std::size_t first = 0; first < size_; first += most) {
      const auto out = std::span(some).first(std::min(most, size_ - first));
      fill_(first, out);
      visit(std::span<const T>(out));
    }
  }

 private:
  std::span<const T> there_;
  std::size_t size_ = 0;
  Fill fill_;
};

/// A named array with `components` values for every point or cell, component fastest. In a 2D grid two
/// components are padded by a zero third, so that ParaView takes them for a vector. Six are a symmetric
/// tensor: xx yy zz xy yz zx.
struct Field {
  std::string name;
  int components = 1;
  std::variant<Values<double>, Values<std::int64_t>, Values<std::uint8_t>> values;
};

/// A grid and its fields. No array is owned.
struct Grid {
  int dim = 3;
  const Cell* cell = nullptr;           ///< type of all cells
  std::span<const double> points;       ///< points × dim
  std::span<const std::int32_t> cells;  ///< cells × nodes, Gmsh's node order
  std::vector<Field> point_fields, cell_fields;
};

/// Each writes under a temporary name and renames, so that a file of that name is always whole. Throws
/// InternalError naming the file if it cannot be written or if a field does not fit the grid.
void write_vtu(const std::string& path, const Grid& grid);
/// One file that shows several pieces as one; `like` gives the names and types of the fields, which all
/// pieces share. Piece names are relative to the folder of `path`.
void write_pvtu(const std::string& path, const Grid& like, std::span<const std::string> pieces);

struct PvdPart {
  std::string name;  ///< shown by ParaView's extract block
  std::string file;  ///< relative to the folder of the .pvd
  double time = 0.0;
  int part = 0;  ///< number of the block among those of its time
};
void write_pvd(const std::string& path, std::span<const PvdPart> parts);

}  // namespace kacanov
