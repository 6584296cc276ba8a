// SPDX-License-Identifier: BSD-3-Clause
// Arrays of a VTK unstructured grid file (.vtu): ASCII, base64 or raw, uncompressed or compressed by zlib.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/source_file.hpp"

namespace kacanov {

/// Attributes of an XML element: NAME="value".
using XmlAttributes = std::map<std::string, std::string, std::less<>>;

class VtuFile {
 public:
  /// Parses the file without decoding arrays. `bytes` must stay valid. Throws InputError naming the file if
  /// it is not an unstructured grid, or has several pieces or an unsupported byte order or compression.
  VtuFile(SourceFile source, std::string_view bytes);

  std::size_t points() const noexcept { return points_; }
  std::size_t cells() const noexcept { return cells_; }
  /// Returns whether a section ("Points", "Cells", "PointData", "CellData") has an array of that name.
  bool has(std::string_view section, std::string_view name) const;

  /// Returns the values of an array, which must have `count` of them. The array of points may have any name.
  std::vector<double> reals(std::string_view section, std::string_view name, std::size_t count) const;
  /// The same for integers.
  std::vector<std::int64_t> integers(std::string_view section, std::string_view name,
                                     std::size_t count) const;

  [[noreturn]] void fail(const std::string& message) const;

 private:
  struct Array {
    std::string section, name;
    XmlAttributes attributes;
    std::string_view inline_data;
  };

  void take_element(const std::string& name, XmlAttributes attributes, std::string_view rest);
  const Array& find(std::string_view section, std::string_view name) const;
  template <typename T>
  std::vector<T> values(const Array& array, std::size_t count) const;
  std::string decoded(const Array& array, std::size_t bytes) const;
  std::string unpacked(const Array& array, std::string_view data, std::size_t bytes, bool base64) const;

  SourceFile source_;
  std::size_t points_ = 0, cells_ = 0;
  bool have_piece_ = false, compressed_ = false, long_header_ = false, appended_base64_ = false;
  std::string section_;
  std::vector<Array> arrays_;
  std::string_view appended_;
};

}  // namespace kacanov
