// SPDX-License-Identifier: BSD-3-Clause
// The fields of a .vtu file with raw appended arrays, and of the pieces of a .pvtu.
#include "verify/vtu.hpp"

#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>

#include "verify/file.hpp"

namespace kacanov::verify {
namespace {

/// The value of an attribute of a tag; empty where there is none.
std::string attribute(const std::string& tag, const std::string& name) {
  const std::size_t at = tag.find(" " + name + "=\"");
  if (at == std::string::npos) return {};
  const std::size_t from = at + name.size() + 3;
  return tag.substr(from, tag.find('"', from) - from);
}

/// Calls visit(tag) for every <name ...> of the text.
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

/// A whole number that an attribute has.
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

}  // namespace

std::map<std::string, Array> read_point_data(const std::filesystem::path& file) {
  const std::string text = whole(file);
  const std::string mark = "<AppendedData encoding=\"raw\">";
  const std::size_t appended = text.find(mark);
  if (appended == std::string::npos)
    throw Failure(file.string() + ": expected a VTU file with raw appended arrays");
  const std::string head = text.substr(0, appended);
  const std::size_t data = text.find('_', appended) + 1;
  std::map<std::string, Array> arrays;
  const auto take = [&](const std::string& tag) {
    Array array;
    const std::string count = attribute(tag, "NumberOfComponents"), type = attribute(tag, "type");
    if (!count.empty()) array.components = number(count, file);
    const std::size_t offset = number(attribute(tag, "offset"), file), at = data + offset;
    std::uint64_t bytes = 0;
    if (offset > text.size() || at + sizeof bytes > text.size())
      throw Failure(file.string() + ": is cut short");
    std::memcpy(&bytes, text.data() + at, sizeof bytes);
    if (bytes > text.size() - at - sizeof bytes) throw Failure(file.string() + ": is cut short");
    const char* from = text.data() + at + sizeof bytes;
    if (type == "Float64")
      append<double>(from, bytes, array.values);
    else if (type == "Int64")
      append<std::int64_t>(from, bytes, array.values);
    else
      throw Failure(file.string() + ": expected double precision, got arrays of type " + type);
    arrays[attribute(tag, "Name")] = std::move(array);
  };
  for_tags(between(head, "<PointData>", "</PointData>"), "DataArray", take);
  for_tags(between(head, "<Points>", "</Points>"), "DataArray", take);
  return arrays;
}

std::vector<std::map<std::string, Array>> read_body(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "body.pvtu")) return {read_point_data(folder / "body.vtu")};
  std::vector<std::map<std::string, Array>> pieces;
  for_tags(whole(folder / "body.pvtu"), "Piece", [&](const std::string& tag) {
    pieces.push_back(read_point_data(folder / attribute(tag, "Source")));
  });
  return pieces;
}

}  // namespace kacanov::verify
