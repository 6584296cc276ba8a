// SPDX-License-Identifier: BSD-3-Clause
// VTK files as meshes: every encoding, and the error messages for unusable files.
#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include "formats/mesh_file.hpp"
#include "formats/vtu_writer.hpp"
#include "temporary_folder.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

std::string grid(const std::string& words, const std::string& points, const std::string& rest) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" " + words +
         ">\n<!-- by hand -->\n<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n<Points>" +
         points + "</Points>\n<Cells>" + rest + "</Cells></Piece></UnstructuredGrid></VTKFile>\n";
}

const std::string ascii_points =
    "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 "
    "1</DataArray>";
const std::string ascii_cells =
    "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>"
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray>";

std::string with(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), by);
}

std::string refusal(const std::string& bytes) {
  try {
    read_mesh("a.vtu", bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}

// The numbers 0 0 0 1 0 0 0 1 0 0 0 1 in single precision, encoded by Python's base64 and zlib.
const std::string plain = "MAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPw==";
const std::vector<std::string> packed{
    "AQAAAACAAAAwAAAAHAAAAA==eAEFwQEBAAAAgiCeea3pAQCwAIAFAKwDJ70CPg==",
    "AQAAAACAAAAwAAAAEAAAAA==eAFjYEAGDfYMBPgAJ70CPg==",
    "AQAAADAAAAAAAAAAOwAAAA==eAEBMADP/wAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"
    "AAAAAAAAAAAAAAAAAACAPye9Aj4=",
    "AgAAACAAAAAQAAAAEAAAAA0AAAA=eNpjYEAGDfYMaHwADo4Bf3jaY2BABg32AAFPAMA="};

}  // namespace

TEST_CASE("what the program writes of every element it reads again: the same mesh and numbers") {
  const TemporaryFolder folder;
  for (const ElementType type : element_types()) {
    BoxSpec spec;
    spec.type = type;
    spec.cells = {2, 1, 1};
    const Mesh mesh = make_box(spec);
    std::vector<std::int64_t> nodes(mesh.node_count()), elements(mesh.element_count());
    for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = static_cast<std::int64_t>(10 * i + 5);
    for (std::size_t e = 0; e < elements.size(); ++e) elements[e] = static_cast<std::int64_t>(7 * e + 3);
    Grid out{mesh.dim(), &cell(type), mesh.coordinates, mesh.elements, {}, {}};
    out.point_fields.push_back({"node_id", 1, Values<std::int64_t>(nodes)});
    out.cell_fields.push_back({"element_id", 1, Values<std::int64_t>(elements)});
    write_vtu(folder.file("a.vtu"), out);
    const Mesh back = read_mesh(folder.file("a.vtu"));
    CHECK(back.type == type);
    CHECK(back.coordinates == mesh.coordinates);
    CHECK(back.elements == mesh.elements);
    CHECK(back.node_tags == nodes);
    CHECK(back.element_tags == elements);
  }
}

TEST_CASE("numbers as text, in base64, packed by zlib with fixed codes, own codes or none") {
  const Mesh ascii = read_mesh("a.vtu", grid("", ascii_points, ascii_cells));
  CHECK(ascii.type == ElementType::tet4);
  CHECK(ascii.elements == std::vector<std::int32_t>{0, 1, 2, 3});
  const auto array = [](const std::string& data) {
    return "<DataArray type='Float32' Name='Points' NumberOfComponents='3' format='binary'>\n " + data +
           "\n</DataArray>";
  };
  CHECK(read_mesh("a.vtu", grid("", array(plain), ascii_cells)).coordinates == ascii.coordinates);
  for (const std::string& data : packed) {
    INFO(data);
    const std::string zlib = "compressor=\"vtkZLibDataCompressor\" ";
    CHECK(read_mesh("a.vtu", grid(zlib, array(data), ascii_cells)).coordinates == ascii.coordinates);
    const std::string damaged = "a.vtu: the array \"Points\" is damaged or cut short";
    CHECK(refusal(grid(zlib, array(data.substr(0, data.size() / 2)), ascii_cells)) == damaged);
    std::string changed = data;
    changed[changed.size() - 6] = changed[changed.size() - 6] == 'A' ? 'B' : 'A';
    CHECK(refusal(grid(zlib, array(changed), ascii_cells)) == damaged);
  }
}

TEST_CASE("groups of cells that meshio has taken from Gmsh") {
  const std::string groups =
      "<DataArray type=\"Int64\" Name=\"gmsh:physical\" format=\"ascii\">12</DataArray>";
  const Mesh mesh = read_mesh("a.vtu", with(grid("", ascii_points, ascii_cells), "</Cells>",
                                            "</Cells><CellData>" + groups + "</CellData>"));
  REQUIRE(mesh.groups.size() == 1);
  CHECK(mesh.groups[0].name == "12");
  CHECK(mesh.groups[0].dimension == 3);
}

TEST_CASE("VTK files that cannot be used are refused with the array or the cell") {
  const std::string good = grid("", ascii_points, ascii_cells);
  const std::vector<std::array<std::string, 3>> rows{
      {"UnstructuredGrid", "PolyData", "a.vtu: expected a VTK file of the type UnstructuredGrid (.vtu)"},
      {"<Piece ", "<Piece NumberOfPoints=\"1\" NumberOfCells=\"1\"/><Piece ",
       "a.vtu: a second piece: expected a grid of one"},
      {"type=\"UnstructuredGrid\" ", "type=\"UnstructuredGrid\" byte_order=\"BigEndian\"",
       "a.vtu: the file has the other byte order, which is not supported"},
      {"type=\"UnstructuredGrid\" ", "type=\"UnstructuredGrid\" compressor=\"vtkLZ4DataCompressor\"",
       "a.vtu: the arrays are compressed by something else than zlib, which is not supported"},
      {"NumberOfPoints=\"4\"", "NumberOfPoints=\"-4\"",
       "a.vtu: NumberOfPoints: expected a number that 32-bit indices can hold"},
      {"NumberOfPoints=\"4\"", "NumberOfPoints=\"5\"", "a.vtu: the array \"\": expected 15 numbers, got 12"},
      {"NumberOfCells=\"1\"", "NumberOfCells=\"0\"", "a.vtu: expected points and cells, the grid has none"},
      {"0 1 2 3<", "0 1 2 4<", "a.vtu: cell 1 refers to point 4, of which there are 4"},
      {"0 1 2 3<", "0 1 2<", "a.vtu: the array \"connectivity\": expected 4 numbers, got 3"},
      {"0 1 2 3<", "0 1 x 3<", "a.vtu: the array \"connectivity\": expected a number, got \"x\""},
      {">4<", ">5<", "a.vtu: the array offsets: cell 1 has not as many points as its type"},
      {">10<", ">25<", "a.vtu: cell 1 is of VTK's type 25, which is not supported: bodies are made of "},
      {"offsets", "offset", "a.vtu: expected an array offsets in <Cells>"},
      {"format=\"ascii\">4", "format=\"appended\" offset=\"3\">",
       "a.vtu: the array \"offsets\" begins beyond the file's end"},
  };
  for (const auto& [old, by, message] : rows) CHECK(refusal(with(good, old, by)).find(message) == 0);
}
