// SPDX-License-Identifier: BSD-3-Clause
// The VTK files, read back by a small reader: what goes in comes out, in VTK's order and layout.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/resource.h>

#include <array>
#include <cstring>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include <kacanov/mesh.hpp>
#include "formats/vtu_writer.hpp"
#include "temporary_folder.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

/// One data array: its attributes and its bytes.
struct Array {
  std::map<std::string, std::string> attributes;
  std::string bytes;

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

/// Every array of a .vtu by name.
std::map<std::string, Array> arrays(const std::string& file) {
  const std::size_t appended = file.find("<AppendedData");
  REQUIRE(appended != std::string::npos);
  const std::size_t data = file.find("_", file.find('>', appended)) + 1;
  std::map<std::string, Array> result;
  std::size_t expected = 0;
  for (std::size_t at = 0; (at = file.find("<DataArray", at)) < appended; ++at) {
    Array array;
    array.attributes = attributes(file.substr(at, file.find("/>", at) - at));
    const std::size_t offset = std::stoul(array.attributes["offset"]);
    CHECK(offset == expected);
    std::uint64_t size = 0;
    REQUIRE(data + offset + 8 <= file.size());
    std::memcpy(&size, file.data() + data + offset, 8);
    REQUIRE(data + offset + 8 + size <= file.size());
    array.bytes = file.substr(data + offset + 8, size);
    expected = offset + 8 + size;
    result[array.attributes["Name"]] = array;
  }
  CHECK(file.substr(data + expected) == "\n</AppendedData>\n</VTKFile>\n");
  return result;
}

}  // namespace

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
    // VTK: the midside nodes follow the edges 01 12 20 03 13 23.
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

TEST_CASE("pieces and collections name their files and fields") {
  const TemporaryFolder folder;
  const std::vector<double> none;
  const Grid grid{2, &cell(ElementType::tri3).facet(), {}, {}, {{"traction", 2, none}}, {{"a<b", 1, none}}};
  const std::vector<std::string> pieces{"p_0.vtu", "p_1.vtu"};
  write_pvtu(folder.file("p.pvtu"), grid, pieces);
  const std::string text = read_bytes(folder.file("p.pvtu"));
  CHECK(text.find("<Piece Source=\"p_0.vtu\"/>") < text.find("<Piece Source=\"p_1.vtu\"/>"));
  CHECK(text.find("Name=\"traction\" NumberOfComponents=\"3\"") != std::string::npos);
  CHECK(text.find("Name=\"a&lt;b\"") != std::string::npos);
  const std::vector<PvdPart> parts{{"body", "p.pvtu", 0.1, 0}, {"contact", "c.vtu", 0.1, 1}};
  write_pvd(folder.file("all.pvd"), parts);
  const std::string collection = read_bytes(folder.file("all.pvd"));
  CHECK(collection.find("name=\"body\" file=\"p.pvtu\"") <
        collection.find("name=\"contact\" file=\"c.vtu\""));
  CHECK(collection.find("timestep=\"0.10000000000000001\" part=\"1\"") != std::string::npos);
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
  const std::vector<double> points(3 * 10000, 1.0), few(5, 0.0);
  CHECK(refused(folder.file("missing/a.vtu"), {3, &cell(ElementType::tri3), points, {}, {}, {}},
                "No such file"));
  CHECK(refused(folder.file("a.vtu"), {3, &cell(ElementType::tri3), points, {}, {{"gap", 1, few}}, {}},
                "gap has 5 values"));
  CHECK(folder.entries() == 0);

  // A limit on the size of files stands for a full disk. The file that was there stays as it was.
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
