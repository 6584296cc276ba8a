// SPDX-License-Identifier: BSD-3-Clause
// The VTK writer, checked with a small reader: data, order and layout.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include <kacanov/mesh.hpp>
#include "formats/inflate.hpp"
#include "formats/packed_blocks.hpp"
#include "formats/vtu_writer.hpp"
#include "temporary_folder.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// One data array: its attributes and its bytes.
struct Array {
  std::map<std::string, std::string> attributes;
  std::string bytes;
  std::size_t offset = 0, end = 0;  ///< of its compressed form, from the start of the first array

  template <typename T>
  std::vector<T> values() const {
    std::vector<T> result(bytes.size() / sizeof(T));
    std::memcpy(result.data(), bytes.data(), result.size() * sizeof(T));
    return result;
  }
};

std::map<std::string, std::string> attributes(const std::string& element) {
  std::map<std::string, std::string> result;
  for (std::size_t at = 0; (at = element.find("=\"", at)) != std::string::npos;) {
    const std::size_t begin = element.rfind(' ', at) + 1, end = element.find('"', at + 2);
    result[element.substr(begin, at - begin)] = element.substr(at + 2, end - at - 2);
    at = end;
  }
  return result;
}

/// Returns an array's bytes, decompressed block by block; `next` moves to the position behind it.
std::string unpacked(const std::string& file, std::size_t& next) {
  const auto number = [&](std::size_t i) {
    std::uint64_t value = 0;
    REQUIRE(next + 8 * i + 8 <= file.size());
    std::memcpy(&value, file.data() + next + 8 * i, 8);
    return static_cast<std::size_t>(value);
  };
  const std::size_t blocks = number(0), length = number(1), last = number(2);
  std::string all;
  std::size_t from = next + 8 * (3 + blocks);
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t packed = number(3 + b), size = b + 1 == blocks && last > 0 ? last : length;
    REQUIRE(from + packed <= file.size());
    std::string block(size, '\0');
    REQUIRE(inflate_zlib(std::string_view(file).substr(from, packed),
                         {reinterpret_cast<unsigned char*>(block.data()), block.size()}));
    all += block;
    from += packed;
  }
  next = from;
  return all;
}

/// Returns the arrays in the order of the XML.
std::vector<Array> arrays_in_order(const std::string& file) {
  const std::size_t appended = file.find("<AppendedData");
  REQUIRE(appended != std::string::npos);
  const std::size_t data = file.find("_", file.find('>', appended)) + 1;
  std::vector<Array> result;
  for (std::size_t at = 0; (at = file.find("<DataArray", at)) < appended; ++at) {
    Array array;
    array.attributes = attributes(file.substr(at, file.find("/>", at) - at));
    array.offset = std::stoul(array.attributes["offset"]);
    std::size_t next = data + array.offset;
    array.bytes = unpacked(file, next);
    array.end = next - data;
    result.push_back(array);
  }
  // The arrays follow each other from the last to the first without gaps.
  std::size_t expected = 0;
  for (auto array = result.rbegin(); array != result.rend(); ++array) {
    CHECK(array->offset == expected);
    expected = array->end;
  }
  CHECK(file.substr(data + expected) == "\n</AppendedData>\n</VTKFile>\n");
  return result;
}

/// Returns the arrays of a .vtu file by name.
std::map<std::string, Array> arrays(const std::string& file) {
  std::map<std::string, Array> result;
  for (const Array& array : arrays_in_order(file)) result[array.attributes.at("Name")] = array;
  return result;
}

/// Simulates meshio 5 on a file of raw arrays: from front to back it searches the array of each offset and
/// replaces the offset by that of the base64 form. Returns whether it finds the right arrays.
bool meshio_finds(std::vector<Array> in_order) {
  std::vector<std::size_t> by_offset(in_order.size());
  std::iota(by_offset.begin(), by_offset.end(), std::size_t{0});
  std::sort(by_offset.begin(), by_offset.end(),
            [&](std::size_t a, std::size_t b) { return in_order[a].offset < in_order[b].offset; });
  std::size_t rewritten = 0, at = 0;
  for (const std::size_t right : by_offset) {
    const auto found = std::find_if(in_order.begin(), in_order.end(),
                                    [&](const Array& array) { return array.offset == at; });
    if (found == in_order.end() || found - in_order.begin() != static_cast<std::ptrdiff_t>(right))
      return false;
    found->offset = rewritten;
    rewritten += (8 + found->bytes.size() + 2) / 3 * 4;
    at = found->end;
  }
  return true;
}

}  // namespace

TEST_CASE("blocks come back, whatever was packed before them") {
  std::mt19937 random(7);
  std::vector<unsigned char> noise(block_bytes), even(block_bytes, 3), numbers(block_bytes), half(noise);
  for (unsigned char& byte : noise) byte = static_cast<unsigned char>(random());
  for (std::size_t i = 0; i < numbers.size(); i += 8) numbers[i] = static_cast<unsigned char>(i / 8);
  std::copy(noise.begin(), noise.begin() + block_bytes / 4, half.begin());
  const std::vector<unsigned char> none;
  std::vector<unsigned char> small(noise.begin(), noise.begin() + 5);
  BlockDeflater deflater;
  std::vector<unsigned char> packed;
  const auto comes_back = [&](const std::vector<unsigned char>& block, std::size_t length) {
    CHECK(length <= packed.size());
    std::vector<unsigned char> out(block.size());
    const auto* last = reinterpret_cast<const char*>(packed.data()) + packed.size() - length;
    return inflate_zlib({last, length}, {out.data(), out.size()}) && out == block;
  };
  for (const auto* block : {&even, &even, &noise, &even, &small, &numbers, &half, &half, &numbers}) {
    CHECK(comes_back(*block, deflater.pack(*block, packed)));
    CHECK(comes_back(*block, wrap_as_it_is(*block, packed)));
  }
  CHECK(deflater.pack(even, packed) < block_bytes / 100);
  CHECK(deflater.pack(noise, packed) == block_bytes + 16);
  CHECK(wrap_as_it_is(none, packed) == 11);
}

TEST_CASE("points, cells and fields of every element type come back") {
  const TemporaryFolder folder;
  for (const ElementType type : element_types()) {
    const auto vtk_type = static_cast<std::uint8_t>(cell(type).vtk);
    const Mesh mesh = make_box({{2, 1, 3}, {2, 3, 2}, type});
    const std::size_t dim = mesh.dim();
    const std::size_t nodes = nodes_per_element(type);
    std::vector<double> displacement(mesh.coordinates.size()), stress(6 * mesh.element_count());
    std::iota(displacement.begin(), displacement.end(), 0.5);
    std::iota(stress.begin(), stress.end(), -3.0);
    std::vector<std::int64_t> number(mesh.node_count());
    std::iota(number.begin(), number.end(), std::int64_t{1} << 40);
    const std::vector<std::uint8_t> plastic(mesh.element_count(), 1);
    const Grid grid{mesh.dim(),
                    &cell(type),
                    mesh.coordinates,
                    mesh.elements,
                    {{"displacement", mesh.dim(), displacement}, {"node_id", 1, number}},
                    {{"stress", 6, stress}, {"plastic", 1, plastic}}};
    write_vtu(folder.file("body.vtu"), grid);
    const std::string file = read_bytes(folder.file("body.vtu"));
    auto found = arrays(file);
    CHECK(file.find("NumberOfPoints=\"" + std::to_string(mesh.node_count()) + "\"") != std::string::npos);
    CHECK(file.find("NumberOfCells=\"" + std::to_string(mesh.element_count()) + "\"") != std::string::npos);

    const auto points = found["Points"].values<double>(), vectors = found["displacement"].values<double>();
    REQUIRE(points.size() == 3 * mesh.node_count());
    REQUIRE(vectors.size() == points.size());
    CHECK(found["displacement"].attributes["NumberOfComponents"] == "3");
    for (std::size_t i = 0; i < mesh.node_count(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        CHECK(points[3 * i + k] == (k < dim ? mesh.coordinates[dim * i + k] : 0.0));
        CHECK(vectors[3 * i + k] == (k < dim ? displacement[dim * i + k] : 0.0));
      }
    CHECK(found["stress"].values<double>() == stress);
    CHECK(found["stress"].attributes["NumberOfComponents"] == "6");
    CHECK(found["node_id"].values<std::int64_t>() == number);
    CHECK(found["plastic"].values<std::uint8_t>() == plastic);
    CHECK(found["types"].values<std::uint8_t>() == std::vector<std::uint8_t>(mesh.element_count(), vtk_type));

    const auto cells = found["connectivity"].values<std::int32_t>();
    const auto offsets = found["offsets"].values<std::int64_t>();
    REQUIRE(cells.size() == mesh.elements.size());
    for (std::size_t e = 0; e < mesh.element_count(); ++e)
      CHECK(offsets[e] == static_cast<std::int64_t>((e + 1) * nodes));
    if (cell(type).order == 1) {
      CHECK(cells == mesh.elements);
      continue;
    }
    // VTK: the mid-side nodes follow the edges 01 12 20 03 13 23.
    constexpr std::array<std::array<std::size_t, 2>, 6> edges{
        {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
    for (std::size_t e = 0; e < mesh.element_count(); ++e)
      for (std::size_t m = 0; m < 6; ++m)
        for (std::size_t k = 0; k < 3; ++k) {
          const auto x = [&](std::size_t local) {
            return points[3 * static_cast<std::size_t>(cells[10 * e + local]) + k];
          };
          CHECK(x(4 + m) == doctest::Approx((x(edges[m][0]) + x(edges[m][1])) / 2));
        }
  }
}

TEST_CASE("an empty piece is a whole file") {
  const TemporaryFolder folder;
  const std::vector<double> none;
  write_vtu(folder.file("empty.vtu"), {3, &cell(ElementType::tet10).facet(), {}, {}, {{"gap", 1, none}}, {}});
  auto found = arrays(read_bytes(folder.file("empty.vtu")));
  CHECK(found.size() == 5);
  CHECK(found["gap"].bytes.empty());
}

TEST_CASE("collections name their files") {
  const TemporaryFolder folder;
  const std::vector<PvdPart> parts{{"body", "b<1>.vtu", 0.1, 0}, {"contact", "c.vtu", 0.1, 1}};
  write_pvd(folder.file("all.pvd"), parts);
  const std::string collection = read_bytes(folder.file("all.pvd"));
  CHECK(collection.find("name=\"body\" file=\"b&lt;1&gt;.vtu\"") <
        collection.find("name=\"contact\" file=\"c.vtu\""));
  CHECK(collection.find("timestep=\"0.10000000000000001\" part=\"1\"") != std::string::npos);
}

TEST_CASE("meshio finds every array, also where its offsets in base64 are those of others") {
  const TemporaryFolder folder;
  std::mt19937_64 random(7);
  int collisions = 0;
  for (std::size_t cells = 150; cells <= 250; ++cells) {
    const std::vector<double> points(6 * cells);
    std::vector<std::int32_t> corners(3 * cells);
    std::iota(corners.begin(), corners.end(), 0);
    std::vector<std::uint8_t> noise(12 * cells);
    for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
    Grid grid{2, &cell(ElementType::tri3), points, corners, {}, {}};
    for (std::size_t k = 0; k < 12; ++k)
      grid.cell_fields.push_back({"f" + std::to_string(k), 1, std::span(noise).subspan(k * cells, cells)});
    write_vtu(folder.file("a.vtu"), grid);
    std::vector<Array> in_order = arrays_in_order(read_bytes(folder.file("a.vtu")));
    CHECK(meshio_finds(in_order));
    // The same arrays in the usual order, from the first to the last.
    std::size_t at = 0;
    for (Array& array : in_order) {
      const std::size_t length = array.end - array.offset;
      array.offset = at;
      array.end = at += length;
    }
    if (!meshio_finds(in_order)) ++collisions;
  }
  CHECK(collisions > 0);  // otherwise the test proves nothing
}

TEST_CASE("shares of any size make the file that one writer makes") {
  const TemporaryFolder folder;
  std::mt19937_64 random(3);
  for (const std::size_t count : {std::size_t{5}, std::size_t{8192}, std::size_t{40001}}) {
    // A chain of lines from point i to i + 1.
    const Cell& line = cell(ElementType::tri3).facet();
    std::vector<double> points(2 * (count + 1)), noise(count);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<double>(i / 7);
    for (double& x : noise) x = static_cast<double>(random());
    std::vector<std::int32_t> cells;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < 2; ++k) cells.push_back(static_cast<std::int32_t>(i + k));
    write_vtu(folder.file("one.vtu"), {2, &line, points, cells, {}, {{"noise", 1, noise}}});

    std::vector<std::size_t> cuts{0, 0, count};
    for (int k = 0; k < 5; ++k) cuts.push_back(random() % (count + 1));
    std::sort(cuts.begin(), cuts.end());
    std::vector<Grid> grids;
    std::vector<VtuShare> shares;
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      const std::size_t first = cuts[k], here = cuts[k + 1] - first,
                        own = here + (cuts[k + 1] == count ? 1 : 0);
      Grid grid{2,
                &line,
                std::span(points).subspan(2 * first, 2 * own),
                std::span(cells).subspan(2 * first, 2 * here),
                {},
                {{"noise", 1, std::span(noise).subspan(first, here)}}};
      grid.number_of_point = [](std::int32_t node) { return std::int64_t{node}; };
      grids.push_back(grid);
    }
    // If two shares end with the last cell, the first of them has the last point.
    bool given = false;
    for (Grid& grid : grids)
      if (grid.points.size() > grid.cells.size()) {
        if (given) grid.points = {};
        given = true;
      }
    GridPlace place{count + 1, count, 0, 0};
    for (const Grid& grid : grids) {
      shares.emplace_back("many.vtu", grid, place);
      place.points_before += grid.points.size() / 2;
      place.cells_before += grid.cells.size() / 2;
    }
    VtuFileWriter file(folder.file("many.vtu"), shares[0]);
    for (std::size_t array = shares[0].arrays(); array-- > 0;) {
      file.begin(array);
      for (const VtuShare& share : shares) share.pack(array, file);
      file.end();
    }
    file.commit();
    CHECK(read_bytes(folder.file("many.vtu")) == read_bytes(folder.file("one.vtu")));
  }
}

TEST_CASE("what cannot be written is reported with its name, and leaves nothing behind") {
  const TemporaryFolder folder;
  const auto refused = [](const std::string& path, const Grid& grid, const std::string& part) {
    try {
      write_vtu(path, grid);
    } catch (const InternalError& error) {
      const std::string text = error.what();
      return text.starts_with(path) && text.find(part) != std::string::npos;
    }
    return false;
  };
  std::vector<double> points(3 * 10000);
  std::mt19937_64 random(1);
  for (double& x : points) x = static_cast<double>(random());
  const std::vector<double> few(5, 0.0);
  CHECK(refused(folder.file("missing/a.vtu"), {3, &cell(ElementType::tri3), points, {}, {}, {}},
                "No such file"));
  CHECK(refused(folder.file("a.vtu"), {3, &cell(ElementType::tri3), points, {}, {{"gap", 1, few}}, {}},
                "gap has 5 values"));
  CHECK(folder.entries() == 0);

  // A limit on file sizes simulates a full disk. The existing file must not change.
  write_bytes(folder.file("a.vtu"), "before");
  rlimit old{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &old) == 0);
  rlimit tight = old;
  tight.rlim_cur = 20000;
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &tight) == 0);
  const bool large =
      refused(folder.file("a.vtu"), {3, &cell(ElementType::tri3), points, {}, {}, {}}, "cannot be written");
  ::setrlimit(RLIMIT_FSIZE, &old);
  ::signal(SIGXFSZ, handler);
  CHECK(large);
  CHECK(folder.entries() == 1);
  CHECK(read_bytes(folder.file("a.vtu")) == "before");
}
