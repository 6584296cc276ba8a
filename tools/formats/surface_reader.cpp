// SPDX-License-Identifier: BSD-3-Clause
// Reads obstacle surfaces: STL, ASCII and binary, and the facets of Gmsh files.
#include "formats/surface_reader.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>

#include <kacanov/error.hpp>
#include "formats/gmsh_cursor.hpp"
#include "formats/gmsh_parser.hpp"
#include "formats/mapped_file.hpp"
#include "formats/text_bytes.hpp"
#include "formats/words.hpp"

namespace kacanov {
namespace {

constexpr std::size_t stl_header = 84, stl_record = 50;

/// Words of an ASCII file, line by line.
class StlText {
 public:
  StlText(const SourceFile& source, std::string_view bytes) : source_(source), rest_(bytes) {}

  /// Returns the words of the next non-empty line; empty at the end.
  std::vector<std::string_view> line() {
    std::vector<std::string_view> words;
    while (words.empty() && !rest_.empty()) {
      ++number_;
      std::string_view text = take_line(rest_);
      for (auto word = take_word(text, blanks); !word.empty(); word = take_word(text, blanks))
        words.push_back(word);
    }
    return words;
  }
  [[noreturn]] void fail(const std::string& expected, const std::vector<std::string_view>& got) const {
    throw InputError(source_.path + ":" + std::to_string(number_) + ": expected " + expected + ", got " +
                     (got.empty() ? "the end of the file" : source_.quoted(got[0])));
  }
  void expect(std::initializer_list<std::string_view> words) {
    const auto got = line();
    std::string text;
    bool fits = got.size() == words.size();
    std::size_t k = 0;
    for (const std::string_view word : words) {
      fits = fits && same(got[k++], word);
      text += (text.empty() ? "" : " ") + std::string(word);
    }
    if (!fits) fail("\"" + text + "\"", got);
  }
  Vector3 vertex() {
    const auto words = line();
    if (words.size() != 4 || !same(words[0], "vertex")) fail("\"vertex\" and three numbers", words);
    Vector3 x{};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto value = to_number(words[c + 1]);
      if (!value) fail("a number", {words[c + 1]});
      x[c] = *value;
    }
    return x;
  }
  static bool same(std::string_view word, std::string_view lower) {
    return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), [](char a, char b) {
      return std::tolower(static_cast<unsigned char>(a)) == static_cast<unsigned char>(b);
    });
  }

 private:
  static constexpr std::string_view blanks = " \t\r";
  const SourceFile& source_;
  std::string_view rest_;
  int number_ = 0;
};

void add_triangle(TriangleList& list, const std::array<Vector3, 3>& corners) {
  const auto first = static_cast<std::int32_t>(list.points.size());
  list.points.insert(list.points.end(), corners.begin(), corners.end());
  list.triangles.push_back({first, first + 1, first + 2});
}

TriangleList parse_ascii_stl(const SourceFile& source, std::string_view bytes) {
  StlText in(source, bytes);
  TriangleList list;
  for (auto words = in.line(); !words.empty(); words = in.line()) {
    if (!StlText::same(words[0], "solid")) in.fail("\"solid\"", words);
    for (words = in.line(); words.empty() || !StlText::same(words[0], "endsolid"); words = in.line()) {
      if (words.empty() || !StlText::same(words[0], "facet")) in.fail("\"facet\" or \"endsolid\"", words);
      in.expect({"outer", "loop"});
      const Vector3 a = in.vertex(), b = in.vertex(), c = in.vertex();
      in.expect({"endloop"});
      in.expect({"endfacet"});
      add_triangle(list, {a, b, c});
    }
  }
  return list;
}

bool is_ascii_stl(std::string_view text) { return text.starts_with("solid") || text.starts_with("SOLID"); }

/// Accepts a byte order mark too, but does not inspect the rest, as the file may be a binary STL.
bool is_gmsh(std::string_view bytes) { return bytes.starts_with("$") || bytes.starts_with("\xef\xbb\xbf$"); }

TriangleList parse_binary_stl(std::string_view bytes, std::size_t count) {
  static_assert(std::endian::native == std::endian::little);
  TriangleList list;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> values{};
    std::memcpy(values.data(), bytes.data() + stl_header + t * stl_record + 12, sizeof values);
    std::array<Vector3, 3> corners{};
    for (std::size_t k = 0; k < 9; ++k) corners[k / 3][k % 3] = values[k];
    add_triangle(list, corners);
  }
  return list;
}

/// Returns the number of a group of facets in the file.
int number_of_group(const SourceFile& source, const MeshContent& content, const std::string& group) {
  std::string known;
  for (const auto& [key, name] : content.names) {
    if (key.first != 2) continue;
    if (name == group || (name.empty() && std::to_string(key.second) == group)) return key.second;
    known += (known.empty() ? "" : ", ") + source.quoted(name);
  }
  throw InputError(source.path + ": expected a physical surface of the name " + in_quotes(group) +
                   ", the file has " + (known.empty() ? "none with a name" : known));
}

TriangleList facets_of_gmsh(const SourceFile& source, MeshContent content, const std::string& group) {
  TriangleList list;
  const int wanted = group.empty() ? 0 : number_of_group(source, content, group);
  for (std::size_t n = 0; n < content.coordinates.size(); n += 3)
    list.points.push_back({content.coordinates[n], content.coordinates[n + 1], content.coordinates[n + 2]});
  for (std::size_t c = 0; c < cells().size(); ++c) {
    if (cells()[c].dim != 2) continue;
    const ElementList& elements = content.elements[c];
    const auto nodes = static_cast<std::size_t>(cells()[c].nodes);
    std::size_t run = 0;
    for (std::size_t e = 0; e < elements.count(); ++e) {
      while (run + 1 < elements.runs.size() && elements.runs[run + 1].first <= e) ++run;
      const bool grouped = run < elements.runs.size() && elements.runs[run].first <= e;
      const std::vector<int>& tags = content.physicals[grouped ? elements.runs[run].set : 0];
      if (!group.empty() && std::find(tags.begin(), tags.end(), wanted) == tags.end()) continue;
      for (const auto& part : cells()[c].triangles) {
        Surface::Triangle triangle{};
        for (std::size_t k = 0; k < 3; ++k) triangle[k] = elements.nodes[e * nodes + part[k]];
        list.triangles.push_back(triangle);
      }
    }
  }
  if (list.triangles.empty())
    throw InputError(source.path + ": expected facets of an obstacle, the file has " +
                     (group.empty() ? "none" : "none in the group " + in_quotes(group)));
  return list;
}

}  // namespace

TriangleList parse_stl(const SourceFile& source, std::string_view bytes) {
  // A binary file may begin with "solid" too; its length decides.
  std::uint32_t count = 0;
  if (bytes.size() >= stl_header) std::memcpy(&count, bytes.data() + stl_header - sizeof count, sizeof count);
  const std::size_t expected = stl_header + std::size_t{count} * stl_record;
  TriangleList list;
  if (bytes.size() >= stl_header && bytes.size() == expected) {
    list = parse_binary_stl(bytes, count);
  } else if (const TextBytes text(source.path, bytes); is_ascii_stl(text.text())) {
    list = parse_ascii_stl(source, text.text());
  } else {
    throw InputError(
        source.path +
        ": expected an STL or Gmsh file: it begins neither with \"solid\" nor with \"$MeshFormat\"" +
        (bytes.size() < stl_header
             ? ""
             : ", and a binary STL of " + std::to_string(count) + " triangles has " +
                   std::to_string(expected) + " bytes where this one has " + std::to_string(bytes.size())));
  }
  if (list.triangles.empty()) throw InputError(source.path + ": expected at least one triangle");
  return list;
}

Surface read_surface(const SourceFile& source, const std::string& group) {
  const MappedFile file(source.path);
  const std::string_view bytes = file.bytes();
  const auto read = [&] {
    if (is_gmsh(bytes)) return facets_of_gmsh(source, parse_gmsh(source, bytes), group);
    if (!group.empty())
      throw InputError(source.path + ": expected a Gmsh file, the only one that has a group " +
                       in_quotes(group));
    return parse_stl(source, bytes);
  };
  const TriangleList list = read();
  file.check_unchanged();
  try {
    return Surface(list.points, list.triangles);
  } catch (const InputError& error) {
    throw InputError(source.path + ": " + error.what());
  }
}

}  // namespace kacanov
