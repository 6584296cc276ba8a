// SPDX-License-Identifier: BSD-3-Clause
// Fields on unstructured grids as VTK files that ParaView opens: .vtu, packed by zlib and written by one
// process or share by share; collections (.pvd).
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
#include "formats/atomic_file.hpp"
#include "formats/packed_blocks.hpp"

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

/// A grid and its fields, or a share of one. No array is owned.
struct Grid {
  int dim = 3;
  const Cell* cell = nullptr;           ///< type of all cells
  std::span<const double> points;       ///< points × dim; of a share, those that no other has
  std::span<const std::int32_t> cells;  ///< cells × nodes, Gmsh's node order
  std::vector<Field> point_fields, cell_fields;
  /// What a node that `cells` names is among the points of all shares; empty: the same.
  std::function<std::int64_t(std::int32_t)> number_of_point = {};
};

/// Points and cells of all shares, and of those before this one.
struct GridPlace {
  std::size_t points = 0, cells = 0;
  std::size_t points_before = 0, cells_before = 0;
};

/// Each writes under a temporary name and renames, so that a file of that name is always whole. Throws
/// InternalError naming the file if it cannot be written or if a field does not fit the grid.
void write_vtu(const std::string& path, const Grid& grid);

/// The arrays of a share of a grid, counted as they follow each other in the XML. The same number of arrays
/// for all shares.
class VtuShare {
 public:
  /// Nothing that `grid` points to is copied. Throws InternalError as write_vtu.
  VtuShare(const std::string& path, const Grid& grid, const GridPlace& place);

  std::size_t arrays() const noexcept { return arrays_.size(); }
  /// Hands an array's share over in blocks.
  void pack(std::size_t array, BlockSink& sink) const;

 private:
  friend class VtuFileWriter;
  using TakeBytes = std::function<void(const void*, std::size_t)>;
  struct Array {
    const char* section;
    std::string attributes;
    std::uint64_t bytes, before;  ///< of all shares; of those before this one
    std::function<void(const TakeBytes&)> visit;
  };
  void add_field(const char* section, const Grid& grid, const Field& field);
  void add_cells(const Grid& grid);

  GridPlace place_;
  std::vector<Array> arrays_;
};

/// A file that shares are written to in their order. Arrays go into it from the last to the first: Debian's
/// meshio looks for each by its offset among all, some of which it has put others in place of by then, and
/// takes the first that it finds.
class VtuFileWriter : public BlockSink {
 public:
  /// `share`: any of them.
  VtuFileWriter(const std::string& path, const VtuShare& share);

  /// To be called for the last array first; then all shares of it; then end().
  void begin(std::size_t array);
  void loose(std::span<const unsigned char> bytes) override;
  void packed(std::span<const unsigned char> bytes, std::span<const std::uint64_t> lengths) override;
  void end();
  void commit();

 private:
  std::string head() const;
  void put(std::span<const unsigned char> bytes);

  const VtuShare& share_;
  AtomicFile file_;
  std::vector<std::uint64_t> offsets_;  ///< of arrays, from the first byte of all on
  std::size_t room_ = 0;                ///< for head(), before the arrays
  std::uint64_t written_ = 0;           ///< bytes of arrays
  std::size_t array_ = 0;
  BlockDeflater deflater_;
  std::vector<unsigned char> block_;    ///< what is there of a block that shares have part in
  std::vector<std::uint64_t> lengths_;  ///< of the array's blocks
};

struct PvdPart {
  std::string name;  ///< shown by ParaView's extract block
  std::string file;  ///< relative to the folder of the .pvd
  double time = 0.0;
  int part = 0;  ///< number of the block among those of its time
};
void write_pvd(const std::string& path, std::span<const PvdPart> parts);

}  // namespace kacanov
