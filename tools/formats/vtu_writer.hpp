// SPDX-License-Identifier: BSD-3-Clause
// Writes fields on unstructured grids for ParaView: zlib-compressed .vtu files, by one process or share by
// share, and collections (.pvd).
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

/// Values of an array to be written: a view of an existing array, or a function that computes entries on
/// demand, a chunk at a time.
template <typename T>
class Values {
 public:
  using Fill = std::function<void(std::size_t first, std::span<T> out)>;

  Values() = default;
  template <typename Array>
  requires std::convertible_to<const Array&, std::span<const T>> Values(const Array& array)
      : there_(array), size_(there_.size()) {}
  /// `fill(first, out)` writes entries first, first + 1 ...; both `first` and out.size() are multiples of the
  /// number of components.
  Values(std::size_t size, Fill fill) : size_(size), fill_(std::move(fill)) {}

  std::size_t size() const noexcept { return size_; }
  /// Calls visit(span) for all entries in order, at most `most` of them per call.
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

/// A named array with `components` values per point or cell, component fastest. In a 2D grid two components
/// are padded with a third zero, so that ParaView treats them as a vector. Six are a symmetric tensor: xx yy
/// zz xy yz zx.
struct Field {
  std::string name;
  int components = 1;
  std::variant<Values<double>, Values<std::int64_t>, Values<std::uint8_t>> values;
};

/// A grid and its fields, or one rank's share of them. Owns no arrays.
struct Grid {
  int dim = 3;
  const Cell* cell = nullptr;           ///< type of all cells
  std::span<const double> points;       ///< points × dim; of a share: the points that it owns
  std::span<const std::int32_t> cells;  ///< cells × nodes, Gmsh's node order
  std::vector<Field> point_fields, cell_fields;
  /// Index of a node in `cells` among the points of all shares; empty: the same index.
  std::function<std::int64_t(std::int32_t)> number_of_point = {};
};

/// Number of points and cells in all shares, and in the shares before this one.
struct GridPlace {
  std::size_t points = 0, cells = 0;
  std::size_t points_before = 0, cells_before = 0;
};

/// Each function writes a temporary file and renames it, so that the named file is always complete. Throws
/// InternalError naming the file if it cannot be written or if a field does not fit the grid.
void write_vtu(const std::string& path, const Grid& grid);

/// The arrays of one share of a grid, in the order of the XML. All shares have the same number of arrays.
class VtuShare {
 public:
  /// Copies nothing that `grid` refers to. Throws InternalError as write_vtu() does.
  VtuShare(const std::string& path, const Grid& grid, const GridPlace& place);

  std::size_t arrays() const noexcept { return arrays_.size(); }
  /// Passes the share of an array to `sink` in blocks.
  void pack(std::size_t array, BlockSink& sink) const;

 private:
  friend class VtuFileWriter;
  using TakeBytes = std::function<void(const void*, std::size_t)>;
  struct Array {
    const char* section;
    std::string attributes;
    std::uint64_t bytes, before;  ///< sizes in all shares, and in the shares before this one
    std::function<void(const TakeBytes&)> visit;
  };
  void add_field(const char* section, const Grid& grid, const Field& field);
  void add_cells(const Grid& grid);

  GridPlace place_;
  std::vector<Array> arrays_;
};

/// A file that receives shares in order. Arrays are written from the last to the first: Debian's meshio finds
/// an array in the data by searching for its offset among all offsets, some of which it has already replaced,
/// and takes the first match.
class VtuFileWriter : public BlockSink {
 public:
  /// `share`: any share of the grid.
  VtuFileWriter(const std::string& path, const VtuShare& share);

  /// Call begin() for the last array first, then pack all shares of it, then call end().
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
  std::vector<std::uint64_t> offsets_;  ///< of the arrays, from the first byte of appended data
  std::size_t room_ = 0;                ///< bytes reserved for head(), before the arrays
  std::uint64_t written_ = 0;           ///< bytes of arrays so far
  std::size_t array_ = 0;
  BlockDeflater deflater_;
  std::vector<unsigned char> block_;    ///< partial block that several shares contribute to
  std::vector<std::uint64_t> lengths_;  ///< compressed lengths of the array's blocks
};

struct PvdPart {
  std::string name;  ///< name shown by ParaView's Extract Block filter
  std::string file;  ///< relative to the folder of the .pvd
  double time = 0.0;
  int part = 0;  ///< index of the block within its time
};
void write_pvd(const std::string& path, std::span<const PvdPart> parts);

}  // namespace kacanov
