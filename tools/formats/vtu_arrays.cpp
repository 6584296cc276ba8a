// SPDX-License-Identifier: BSD-3-Clause
// Arrays of a VTK unstructured grid file (.vtu): ASCII, base64 or raw, uncompressed or compressed by zlib.
#include "formats/vtu_arrays.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include <kacanov/error.hpp>
#include "formats/inflate.hpp"
#include "formats/text_bytes.hpp"
#include "formats/words.hpp"

namespace kacanov {
namespace {

constexpr std::string_view white_space = " \t\r\n";

/// Above the greatest compression ratio of zlib.
constexpr std::size_t most_packed = 1100;

std::optional<std::size_t> to_size(std::string_view text) {
  std::size_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() && read.ptr == text.data() + text.size() && value < (std::size_t{1} << 62)
             ? std::optional(value)
             : std::nullopt;
}

/// Decodes the first `count` bytes of base64 text, or as many as there are. Several encoded streams may
/// follow each other, each with its own padding.
std::string from_base64(std::string_view text, std::size_t count) {
  std::string bytes;
  std::uint32_t group = 0;
  int have = 0, padding = 0;
  for (const char c : text) {
    if (bytes.size() >= count) break;
    std::uint32_t value = 0;
    if (c >= 'A' && c <= 'Z') {
      value = static_cast<std::uint32_t>(c - 'A');
    } else if (c >= 'a' && c <= 'z') {
      value = static_cast<std::uint32_t>(c - 'a' + 26);
    } else if (c >= '0' && c <= '9') {
      value = static_cast<std::uint32_t>(c - '0' + 52);
    } else if (c == '+' || c == '/') {
      value = c == '+' ? 62 : 63;
    } else if (c == '=') {
      ++padding;
    } else if (white_space.find(c) != std::string_view::npos) {
      continue;
    } else {
      break;
    }
    group = group << 6 | value;
    if (++have < 4) continue;
    for (int k = 0; k < 3 - padding; ++k) bytes += static_cast<char>(group >> (16 - 8 * k) & 255);
    group = 0;
    have = padding = 0;
  }
  bytes.resize(std::min(bytes.size(), count));
  return bytes;
}

/// Parses the attributes after an element's name; stops at anything else.
XmlAttributes attributes_of(std::string_view text) {
  XmlAttributes found;
  for (;;) {
    text.remove_prefix(std::min(text.find_first_not_of(white_space), text.size()));
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals + 1 >= text.size()) return found;
    std::string_view name = text.substr(0, equals);
    name = name.substr(0, name.find_last_not_of(white_space) + 1);
    text.remove_prefix(equals + 1);
    text.remove_prefix(std::min(text.find_first_not_of(white_space), text.size()));
    if (text.empty() || (text[0] != '"' && text[0] != '\'')) return found;
    const std::size_t end = text.find(text[0], 1);
    if (end == std::string_view::npos) return found;
    found.emplace(name, text.substr(1, end - 1));
    text.remove_prefix(end + 1);
  }
}

}  // namespace

void VtuFile::fail(const std::string& message) const { throw InputError(source_.path + ": " + message); }

VtuFile::VtuFile(SourceFile source, std::string_view bytes) : source_(std::move(source)) {
  std::string_view rest = text_start(source_.path, bytes);
  bool have_file = false;
  while (!rest.empty()) {
    rest.remove_prefix(std::min(rest.find('<'), rest.size()));
    if (rest.starts_with("<!--")) {
      rest.remove_prefix(std::min(rest.find("-->"), rest.size()));
      continue;
    }
    const std::size_t end = rest.find('>');
    if (end == std::string_view::npos) break;
    std::string_view inside = rest.substr(1, end - 1);
    rest.remove_prefix(end + 1);
    const std::string name(inside.substr(0, inside.find_first_of(" \t\r\n/", 1)));
    have_file = have_file || name == "VTKFile";
    take_element(name, attributes_of(inside.substr(std::min(name.size(), inside.size()))), rest);
    if (name == "AppendedData") break;
  }
  if (!have_file) fail("expected a VTK file, <VTKFile type=\"UnstructuredGrid\">");
  if (!have_piece_) fail("expected a piece of an unstructured grid, <Piece>");
}

void VtuFile::take_element(const std::string& name, XmlAttributes attributes, std::string_view rest) {
  const auto is = [&](const char* key, std::string_view value) {
    const auto found = attributes.find(key);
    return found != attributes.end() && found->second == value;
  };
  if (name == "VTKFile") {
    if (!is("type", "UnstructuredGrid")) fail("expected a VTK file of the type UnstructuredGrid (.vtu)");
    if (is("byte_order", "BigEndian")) fail("the file has the other byte order, which is not supported");
    long_header_ = is("header_type", "UInt64");
    compressed_ = attributes.contains("compressor");
    if (compressed_ && !is("compressor", "vtkZLibDataCompressor"))
      fail("the arrays are compressed by something else than zlib, which is not supported");
  } else if (name == "Piece") {
    if (std::exchange(have_piece_, true)) fail("a second piece: expected a grid of one");
    const auto count = [&](const char* key) {
      const std::optional<std::size_t> value = to_size(attributes[key]);
      constexpr std::size_t most = std::numeric_limits<std::int32_t>::max() / 3;
      if (!value || *value > most)
        fail(std::string(key) + ": expected a number that 32-bit indices can hold");
      return *value;
    };
    points_ = count("NumberOfPoints");
    cells_ = count("NumberOfCells");
  } else if (name == "Points" || name == "Cells" || name == "PointData" || name == "CellData") {
    section_ = name;
  } else if (name == "DataArray") {
    const std::string array = attributes["Name"];
    arrays_.push_back({section_, array, std::move(attributes), rest.substr(0, rest.find('<'))});
  } else if (name == "AppendedData") {
    appended_base64_ = !is("encoding", "raw");
    const std::size_t begin = rest.find('_');
    if (begin != std::string_view::npos) appended_ = rest.substr(begin + 1);
  }
}

bool VtuFile::has(std::string_view section, std::string_view name) const {
  return std::any_of(arrays_.begin(), arrays_.end(),
                     [&](const Array& a) { return a.section == section && a.name == name; });
}

const VtuFile::Array& VtuFile::find(std::string_view section, std::string_view name) const {
  for (const Array& array : arrays_)
    if (array.section == section && (array.name == name || section == "Points")) return array;
  fail("expected an array " + std::string(name) + " in <" + std::string(section) + ">");
}

std::string VtuFile::decoded(const Array& array, std::size_t bytes) const {
  const auto format = array.attributes.find("format");
  const bool appended = format != array.attributes.end() && format->second == "appended";
  std::string_view data = array.inline_data;
  bool base64 = true;
  if (appended) {
    const auto offset = array.attributes.find("offset");
    const std::optional<std::size_t> begin = to_size(offset == array.attributes.end() ? "" : offset->second);
    if (!begin || *begin > appended_.size())
      fail("the array " + source_.quoted(array.name) + " begins beyond the file's end");
    data = appended_.substr(*begin);
    base64 = appended_base64_;
  }
  data.remove_prefix(base64 ? std::min(data.find_first_not_of(white_space), data.size()) : 0);
  if (compressed_) return unpacked(array, data, bytes, base64);
  const std::size_t header = long_header_ ? 8 : 4;
  const std::string all =
      base64 ? from_base64(data, header + bytes) : std::string(data.substr(0, header + bytes));
  std::uint64_t told = 0;
  if (all.size() >= header) std::memcpy(&told, all.data(), header);
  if (all.size() < header + bytes || told != bytes)
    fail("the array " + source_.quoted(array.name) + ": expected " + std::to_string(bytes) + " bytes, got " +
         std::to_string(all.size() < header + bytes ? all.size() - std::min(all.size(), header) : told));
  return all.substr(header);
}

std::string VtuFile::unpacked(const Array& array, std::string_view data, std::size_t bytes,
                              bool base64) const {
  const auto damaged = [&]() {
    fail("the array " + source_.quoted(array.name) + " is damaged or cut short");
  };
  const std::size_t width = long_header_ ? 8 : 4;
  const auto piece = [&](std::size_t count) {
    std::string found = base64 ? from_base64(data, count) : std::string(data.substr(0, count));
    if (found.size() < count) damaged();
    return found;
  };
  const auto number = [&](const std::string& header, std::size_t i) {
    std::uint64_t value = 0;
    std::memcpy(&value, header.data() + i * width, width);
    return static_cast<std::size_t>(value);
  };
  // Header: number of blocks, block length, length of a shorter last block or 0; then the compressed lengths.
  const std::string front = piece(3 * width);
  const std::size_t blocks = number(front, 0), length = number(front, 1), last = number(front, 2);
  if (blocks > data.size() || (blocks > 0 && length == 0)) damaged();
  const std::size_t full = last > 0 && blocks > 0 ? blocks - 1 : blocks;
  if (length > 0 && full > bytes / length) damaged();  // before the product below can overflow
  if (last >= std::max<std::size_t>(length, 1) || full * length + (blocks > full ? last : 0) != bytes)
    damaged();
  const std::string header = piece((3 + blocks) * width);
  std::size_t total = header.size();
  for (std::size_t b = 0; b < blocks; ++b) {
    if (number(header, 3 + b) > data.size()) damaged();
    total += number(header, 3 + b);
  }
  const std::string all = piece(total);
  std::string result(bytes, '\0');
  std::size_t from = header.size(), to = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t packed = number(header, 3 + b), size = b < full ? length : last;
    const std::span out(reinterpret_cast<unsigned char*>(result.data()) + to, size);
    if (!inflate_zlib(std::string_view(all).substr(from, packed), out)) damaged();
    from += packed;
    to += size;
  }
  return result;
}

template <typename T>
std::vector<T> VtuFile::values(const Array& array, std::size_t count) const {
  const auto type_of = array.attributes.find("type");
  const std::string type = type_of == array.attributes.end() ? std::string() : type_of->second;
  const auto format = array.attributes.find("format");
  std::vector<T> result;
  if (format == array.attributes.end() || format->second == "ascii") {
    result.reserve(std::min(count, array.inline_data.size()));
    std::string_view text = array.inline_data;
    for (std::string_view word = take_word(text, white_space); !word.empty();
         word = take_word(text, white_space)) {
      const std::optional<double> value = to_number(word);
      constexpr double most = 9e15;  // larger integers are not exact in double
      if (!value || (std::is_integral_v<T> && !(std::abs(*value) < most)))
        fail("the array " + source_.quoted(array.name) + ": expected a number, got " + source_.quoted(word));
      if (result.size() == count)
        fail("the array " + source_.quoted(array.name) + " has more than " + std::to_string(count) +
             " numbers");
      result.push_back(static_cast<T>(*value));
    }
    if (result.size() < count)
      fail("the array " + source_.quoted(array.name) + ": expected " + std::to_string(count) +
           " numbers, got " + std::to_string(result.size()));
    return result;
  }
  const auto convert = [&]<typename From>(From) {
    // Do not allocate for values that the file is too short to hold.
    if (count * sizeof(From) / most_packed > array.inline_data.size() + appended_.size())
      fail("the array " + source_.quoted(array.name) + " is damaged or cut short");
    const std::string bytes = decoded(array, count * sizeof(From));
    result.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      From value;
      std::memcpy(&value, bytes.data() + i * sizeof(From), sizeof(From));
      if constexpr (std::is_floating_point_v<From> && std::is_integral_v<T>)
        fail("the array " + source_.quoted(array.name) + ": expected whole numbers, got " +
             source_.quoted(type));
      else
        result[i] = static_cast<T>(value);
    }
  };
  if (type == "Float64")
    convert(double{});
  else if (type == "Float32")
    convert(float{});
  else if (type == "Int64")
    convert(std::int64_t{});
  else if (type == "UInt64")
    convert(std::uint64_t{});
  else if (type == "Int32")
    convert(std::int32_t{});
  else if (type == "UInt32")
    convert(std::uint32_t{});
  else if (type == "Int16")
    convert(std::int16_t{});
  else if (type == "UInt16")
    convert(std::uint16_t{});
  else if (type == "Int8")
    convert(std::int8_t{});
  else if (type == "UInt8")
    convert(std::uint8_t{});
  else
    fail("the array " + source_.quoted(array.name) + " is of the unknown type " + source_.quoted(type));
  return result;
}

std::vector<double> VtuFile::reals(std::string_view section, std::string_view name, std::size_t count) const {
  return values<double>(find(section, name), count);
}

std::vector<std::int64_t> VtuFile::integers(std::string_view section, std::string_view name,
                                            std::size_t count) const {
  return values<std::int64_t>(find(section, name), count);
}

}  // namespace kacanov
