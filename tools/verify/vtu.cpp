// SPDX-License-Identifier: BSD-3-Clause
// Reads fields of .vtu files with raw appended arrays, compressed by zlib or not, and of the pieces of a
// .pvtu.
#include "verify/vtu.hpp"

#include <zlib.h>

#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include "verify/file.hpp"

namespace kacanov::verify {
namespace {

/// Returns the value of an attribute of a tag; empty if it is missing.
std::string attribute(const std::string& tag, const std::string& name) {
  const std::size_t at = tag.find(" " + name + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t from = at + name.size() + 3;
  return tag.substr(from, tag.find('"', from) - from);
}

/// Calls visit(tag) for every <name ...> in the text.
template <class Visit>
void for_tags(const std::string& text, const std::string& name, const Visit& visit) {
  for (std::size_t at = text.find("<" + name + " "); at != std::string::npos;
       at = text.find("<" + name + " ", at + 1))
    visit(text.substr(at, text.find('>', at) - at));
}

std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find(to, begin) - begin);
}

/// Parses an integer attribute.
std::size_t number(const std::string& text, const std::filesystem::path& file) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw Failure(file.string() + ": expected a number in an attribute of an array, got \"" + text + "\"");
  return value;
}

template <class T>
void append(const char* data, std::size_t bytes, std::vector<double>& out) {
  for (std::size_t i = 0; i + sizeof(T) <= bytes; i += sizeof(T)) {
    T value;
    std::memcpy(&value, data + i, sizeof value);
    out.push_back(static_cast<double>(value));
  }
}

/// Reads a number of an array header.
std::uint64_t front_number(const std::string& text, std::size_t at, const std::filesystem::path& file) {
  std::uint64_t value = 0;
  if (at > text.size() || text.size() - at < sizeof value) throw Failure(file.string() + ": is cut short");
  std::memcpy(&value, text.data() + at, sizeof value);
  return value;
}

/// Returns the bytes of an uncompressed array that starts with its length at `at`.
std::string plain_array(const std::string& text, std::size_t at, const std::filesystem::path& file) {
  const std::uint64_t bytes = front_number(text, at, file);
  if (bytes > text.size() - at - sizeof bytes) throw Failure(file.string() + ": is cut short");
  return text.substr(at + sizeof bytes, bytes);
}

/// Decompresses the array at `at`. Its header holds the number of blocks, their length, the length of a
/// shorter last block, and the compressed lengths.
std::string packed_array(const std::string& text, std::size_t at, const std::filesystem::path& file) {
  const std::uint64_t blocks = front_number(text, at, file), length = front_number(text, at + 8, file),
                      last = front_number(text, at + 16, file);
  if (blocks > text.size() / 8 || (blocks > 0 && (length > (1U << 24) || last >= length)))
    throw Failure(file.string() + ": is damaged");
  std::string all;
  std::size_t from = at + (3 + blocks) * 8;
  for (std::uint64_t b = 0; b < blocks; ++b) {
    const std::uint64_t packed = front_number(text, at + (3 + b) * 8, file);
    if (from > text.size() || packed > text.size() - from) throw Failure(file.string() + ": is cut short");
    const std::uint64_t size = b + 1 == blocks && last > 0 ? last : length;
    const std::size_t before = all.size();
    all.resize(before + size);
    uLongf got = size;
    if (uncompress(reinterpret_cast<Bytef*>(all.data() + before), &got,
                   reinterpret_cast<const Bytef*>(text.data() + from), packed) != Z_OK ||
        got != size)
      throw Failure(file.string() + ": is damaged");
    from += packed;
  }
  return all;
}

}  // namespace

std::map<std::string, Array> read_point_data(const std::filesystem::path& file) {
  const std::string text = whole(file);
  const std::string mark = "<AppendedData encoding=\"raw\">";
  const std::size_t appended = text.find(mark);
  if (appended == std::string::npos)
    throw Failure(file.string() + ": expected a VTU file with raw appended arrays");
  const std::string head = text.substr(0, appended);
  const std::size_t data = text.find('_', appended) + 1;
  bool packed = false;
  for_tags(head, "VTKFile", [&](const std::string& tag) {
    const std::string by = attribute(tag, "compressor");
    if (!by.empty() && by != "vtkZLibDataCompressor")
      throw Failure(file.string() + ": expected arrays packed by vtkZLibDataCompressor or not at all, got " +
                    by);
    packed = !by.empty();
  });
  std::map<std::string, Array> arrays;
  const auto take = [&](const std::string& tag) {
    Array array;
    const std::string count = attribute(tag, "NumberOfComponents"), type = attribute(tag, "type");
    if (!count.empty()) array.components = number(count, file);
    const std::size_t offset = number(attribute(tag, "offset"), file), at = data + offset;
    if (offset > text.size()) throw Failure(file.string() + ": is cut short");
    const std::string bytes = packed ? packed_array(text, at, file) : plain_array(text, at, file);
    if (type == "Float64")
      append<double>(bytes.data(), bytes.size(), array.values);
    else if (type == "Int64")
      append<std::int64_t>(bytes.data(), bytes.size(), array.values);
    else
      throw Failure(file.string() + ": expected double precision, got arrays of type " + type);
    arrays[attribute(tag, "Name")] = std::move(array);
  };
  for_tags(between(head, "<PointData>", "</PointData>"), "DataArray", take);
  for_tags(between(head, "<Points>", "</Points>"), "DataArray", take);
  return arrays;
}

std::vector<std::map<std::string, Array>> read_body(const std::filesystem::path& folder,
                                                    const std::string& mark) {
  const std::filesystem::path pieced = folder / ("body" + mark + ".pvtu");
  if (!std::filesystem::exists(pieced)) return {read_point_data(folder / ("body" + mark + ".vtu"))};
  std::vector<std::map<std::string, Array>> pieces;
  for_tags(whole(pieced), "Piece", [&](const std::string& tag) {
    pieces.push_back(read_point_data(folder / attribute(tag, "Source")));
  });
  return pieces;
}

}  // namespace kacanov::verify
