// SPDX-License-Identifier: BSD-3-Clause
// Meshes from Abaqus and CalculiX decks, and the error messages for unusable decks.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <kacanov/error.hpp>
#include "formats/mesh_file.hpp"
#include "formats/mesh_writer.hpp"
#include "temporary_folder.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

const std::string cube_nodes =
    "*Node, nset=Nall\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n";
const std::string cube = cube_nodes + "*ELEMENT, TYPE=C3D8, ELSET=Body\n10, 1,2,3,4,5,6,7,8\n";

Mesh read(const std::string& bytes) {
  Mesh mesh = read_mesh("a.inp", bytes);
  check_mesh(mesh);
  return mesh;
}

std::string refusal(const std::string& bytes) {
  try {
    read(bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "(accepted)";
}

std::vector<std::int32_t> members(const Mesh& mesh, const std::string& name, int dimension) {
  const auto found = std::find_if(mesh.groups.begin(), mesh.groups.end(),
                                  [&](const Group& g) { return g.name == name && g.dimension == dimension; });
  INFO(name);
  REQUIRE(found != mesh.groups.end());
  return found->members;
}

/// Returns the coordinate that all nodes of a group's single facet share.
double plane_of(const Mesh& mesh, const std::string& name, std::size_t coordinate) {
  const auto facets = members(mesh, name, mesh.dim() - 1);
  REQUIRE(facets.size() == 1);
  const auto nodes = mesh.facet(facets[0]);
  const std::size_t dim = mesh.dim();
  const double value = mesh.coordinates[nodes[0] * dim + coordinate];
  for (const std::int32_t node : nodes) CHECK(mesh.coordinates[node * dim + coordinate] == value);
  return value;
}

}  // namespace

TEST_CASE("the sides S1 to S6 of a hexahedron are those of the manual") {
  std::string text = cube;
  for (const char* side : {"1", "2", "3", "4", "5", "6"})
    text += std::string("*SURFACE, NAME=F") + side + ", TYPE=ELEMENT\nBODY, S" + side + "\n";
  const Mesh mesh = read(text);
  CHECK(mesh.type == ElementType::hex8);
  CHECK(mesh.element_tag(0) == 10);
  CHECK(plane_of(mesh, "F1", 2) == 0.0);
  CHECK(plane_of(mesh, "F2", 2) == 1.0);
  CHECK(plane_of(mesh, "F3", 1) == 0.0);
  CHECK(plane_of(mesh, "F4", 0) == 1.0);
  CHECK(plane_of(mesh, "F5", 1) == 1.0);
  CHECK(plane_of(mesh, "F6", 0) == 0.0);
  CHECK(members(mesh, "Body", 3) == std::vector<std::int32_t>{0});
  CHECK(members(mesh, "Nall", 0).size() == 8);
  CHECK(mesh.warnings.empty());
}

TEST_CASE("quadratic tetrahedra have their mid-sides where the manual has them, and their sides") {
  // Nodes 5 to 10 are the midpoints of the edges 12, 23, 31, 14, 24, 34, on two lines.
  const Mesh mesh = read(
      "*NODE\n1,0,0,0\n2,2,0,0\n3,0,2,0\n4,0,0,2\n5,1,0,0\n6,1,1,0\n7,0,1,0\n8,0,0,1\n9,1,0,1\n10,0,1,1\n"
      "*ELEMENT, TYPE=C3D10\n1, 1,2,3,4,5,6,7,\n8,9,10\n"
      "*SURFACE, NAME=A\n1, S1\n*SURFACE, NAME=B\n1, S2\n*SURFACE, NAME=C\n1, S3\n*SURFACE, NAME=D\n1, S4\n");
  CHECK(mesh.type == ElementType::tet10);
  for (const CellEdge& edge : cell(mesh.type).edges)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto x = [&](std::int8_t k) { return mesh.coordinates[3 * mesh.elements[k] + c]; };
      CHECK(x(edge.middle) == doctest::Approx((x(edge.a) + x(edge.b)) / 2));
    }
  CHECK(plane_of(mesh, "A", 2) == 0.0);
  CHECK(plane_of(mesh, "B", 1) == 0.0);
  CHECK(plane_of(mesh, "D", 0) == 0.0);
  CHECK(members(mesh, "C", 2).size() == 1);
}

TEST_CASE("plane bodies have sides by their corners") {
  const Mesh mesh = read(
      "*NODE\n1,0,0\n2,1,0\n3,0,1\n*ELEMENT,TYPE=CPE3\n1,1,2,3\n"
      "*SURFACE,NAME=S\n1,S1\n*SURFACE,NAME=T\n1,S2\n*SURFACE,NAME=U\n1,S3\n");
  CHECK(mesh.type == ElementType::tri3);
  CHECK(plane_of(mesh, "S", 1) == 0.0);
  CHECK(plane_of(mesh, "U", 0) == 0.0);
  CHECK(members(mesh, "T", 1).size() == 1);
}

TEST_CASE("keywords in any case, comments, blanks, empty lines, carriage returns, continued lines") {
  const std::string plain = cube + "*NSET, NSET=Low, GENERATE\n1,4,1\n*NSET,NSET=Both\nLow, 8\n";
  std::string odd =
      "** a comment\r\n\r\n*hEaDiNg\r\n a title\r\n*node,\r\n nset = Nall\r\n1, 0. , 0 ,0\r\n2,1.D0,0,0\r\n"
      "** between\r\n3,1,+1.0e0,0\r\n4,0,1\r\n5,0,0,1,\r\n6,1,0,1\r\n7,1,1,1\r\n8,0,1,1\r\n"
      "*Element, type=c3d8, elset=Body\r\n10,\r\n1,2,3,4,\r\n5,6,7,8\r\n"
      "* N S E T, nset=Low, generate\r\n1, 4\r\n*nset, NSET=Both\r\nLOW, 8";
  const Mesh a = read(plain), b = read(odd);
  CHECK(a.coordinates == b.coordinates);
  CHECK(a.elements == b.elements);
  CHECK(members(a, "Both", 0) == std::vector<std::int32_t>{0, 1, 2, 3, 7});
  for (const char* name : {"Nall", "Low", "Both"}) CHECK(members(a, name, 0) == members(b, name, 0));
}

TEST_CASE("shells and lines beside a body name its facets and nodes, as mesh generators write them") {
  const Mesh mesh = read(cube +
                         "*ELEMENT, TYPE=CPS4, ELSET=Floor\n20, 1,2,3,4\n*ELEMENT, TYPE=T3D2, ELSET=Edge\n"
                         "30, 1,2\n*ELSET, ELSET=All\nBody, Floor\n");
  CHECK(plane_of(mesh, "Floor", 2) == 0.0);
  CHECK(plane_of(mesh, "All", 2) == 0.0);
  CHECK(members(mesh, "All", 3).size() == 1);
  CHECK(members(mesh, "Edge", 1) == std::vector<std::int32_t>{0, 1});
}

TEST_CASE("a deck of Abaqus/CAE: one part, one instance, sets of both") {
  const Mesh mesh =
      read("*Heading\n*Part, name=P\n" + cube +
           "*Elset, elset=Set-1\n10\n*End Part\n*Assembly, name=A\n*Instance, name=P-1, part=P\n"
           "*End Instance\n*Nset, nset=Set-1, instance=P-1\n1, 2\n*Elset, elset=_top_S2, internal, "
           "instance=P-1\n10\n*Surface, type=ELEMENT, name=top\n_top_S2, S2\n*Elset, elset=Set-1\n"
           "P-1.Body\n*End Assembly\n");
  CHECK(plane_of(mesh, "top", 2) == 1.0);
  CHECK(members(mesh, "Set-1", 0).size() == 2);
  CHECK(members(mesh, "Set-1", 3).size() == 1);
  CHECK(members(mesh, "P-1.Set-1", 3).size() == 1);
  CHECK(std::none_of(mesh.groups.begin(), mesh.groups.end(),
                     [](const Group& g) { return g.name == "_top_S2"; }));
  CHECK(refusal("*Part, name=P\n" + cube + "*End Part\n*Instance, name=I, part=P\n1,0,0\n*End Instance\n")
            .find("a.inp: line 15: *Instance moves the part") == 0);
}

TEST_CASE("files are included, and named in messages") {
  const TemporaryFolder folder;
  write_bytes(folder.file("nodes.inp"), cube_nodes);
  write_bytes(folder.file("deck.inp"), "*INCLUDE, INPUT=nodes.inp\n*ELEMENT,TYPE=C3D8\n1,1,2,3,4,5,6,7,8\n");
  CHECK(read_mesh(folder.file("deck.inp")).node_count() == 8);
  write_bytes(folder.file("nodes.inp"), cube_nodes + "1,0,0,0\n");
  const auto message = [&] {
    try {
      read_mesh(folder.file("deck.inp"));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(message() == folder.file("nodes.inp") + ": line 10: node 1 is there twice");
  write_bytes(folder.file("nodes.inp"), "*INCLUDE, INPUT=deck.inp\n");
  CHECK(message().find("files that include each other more than 16 deep") != std::string::npos);
  write_bytes(folder.file("deck.inp"), "*INCLUDE, INPUT=gone.inp\n");
  CHECK(message().find("deck.inp: line 1: ") != std::string::npos);
}

TEST_CASE("what is no mesh is told with its lines, output is not") {
  const Mesh mesh =
      read(cube + "*MATERIAL, NAME=Steel\n*ELASTIC\n210000,0.3\n*STEP\n*STATIC\n*NODE FILE\nU\n*END STEP\n");
  REQUIRE(mesh.warnings.size() == 1);
  CHECK(mesh.warnings[0] ==
        "a.inp: the mesh is read, and left out what is none: *MATERIAL (line 12), *ELASTIC (line 13), *STEP "
        "(line 15), *STATIC (line 16); kacanov convert makes a case of a whole deck");
}

TEST_CASE("bad decks are refused with file, line and what was expected") {
  const std::vector<std::pair<std::string, std::string>> rows{
      {"*ELEMENT,TYPE=C3D8\n", "a.inp: expected nodes, *NODE"},
      {cube_nodes, "a.inp: expected elements, *ELEMENT"},
      {cube + "*NODE\n3,0,0,0\n", "a.inp: line 13: node 3 is there twice"},
      {cube + "*ELEMENT,TYPE=C3D8\n10,1,2,3,4,5,6,7,8\n", "a.inp: line 13: element 10 is there twice"},
      {cube + "*ELEMENT,TYPE=C3D8\n11,1,2,3,4,5,6,7,99\n",
       "a.inp: line 13: element 11 refers to node 99, which no *NODE gives"},
      {cube + "*ELEMENT,TYPE=C3D8\n11,1,2,3,4\n*NSET,NSET=A\n1\n",
       "a.inp: line 13: expected 8 nodes of a C3D8, got 4"},
      {cube + "*ELEMENT,TYPE=C3D8\n11,1,2,3,4,5,6,7,8,9\n",
       "a.inp: line 13: expected 8 nodes of a C3D8, got more"},
      {cube + "*ELEMENT,TYPE=C3D20R\n",
       "a.inp: line 12: elements of the type \"C3D20R\" are not supported: there "
       "are no quadratic hexahedra here: mesh the body with C3D10 or C3D8"},
      {cube + "*ELEMENT\n", "a.inp: line 12: *ELEMENT: expected TYPE=<type of element>"},
      {"*NODE\n1,0,0\n2,1,0\n3,0,1\n4,.5,0\n5,.5,.5\n6,0,.5\n*ELEMENT,TYPE=CAX6\n1,1,2,3,4,5,6\n",
       "a.inp: line 8: a body of CAX6: quadratic triangles are no bodies here: write linear ones"},
      {"*ELEMENT,TYPE=CPS8R\n",
       "a.inp: line 1: elements of the type \"CPS8R\" are not supported: mesh the body with CPS3 or CPS4"},
      {"*ELEMENT,TYPE=CAX8\n",
       "a.inp: line 1: elements of the type \"CAX8\" are not supported: mesh the body with CAX3 or CAX4"},
      {"*NODE\n1,0,0\n2,1,0\n3,0,1\n4,1,1\n*ELEMENT,TYPE=CPS3\n1,1,2,3\n*ELEMENT,TYPE=CAX3\n2,2,4,3\n",
       "a.inp: line 8: a body of CAX3 beside CPS3: expected one of plane strain (CPE), plane stress (CPS), "
       "axial "
       "symmetry (CAX)"},
      {"*NODE\n1,0,x,0\n", "a.inp: line 2: expected a coordinate, got \"x\""},
      {"*NODE\n1,0,1e999,0\n", "a.inp: line 2: expected a coordinate, got \"1e999\""},
      {"*NODE\none,0,0,0\n", "a.inp: line 2: expected the number of a node, got \"one\""},
      {"*NODE\n-1,0,0,0\n", "a.inp: line 2: expected a positive number of a node, got -1"},
      {"*NODE,SYSTEM=C\n", "a.inp: line 1: *NODE: SYSTEM=C is not known here, but SYSTEM=R"},
      {cube + "*NSET,NSET=A\n1,77\n", "a.inp: line 13: there is no node \"77\""},
      {cube + "*NSET,NSET=A\nB\n", "a.inp: line 13: there is no set of nodes \"B\" above"},
      {cube + "*NSET\n1\n", "a.inp: line 12: *NSET: expected NSET=<name>"},
      {cube + "*ELSET,ELSET=A,GENERATE\n20,30\n", "a.inp: line 13: there is no element from 20 to 30"},
      {cube + "*ELSET,ELSET=A,GENERATE\n1,30,0\n",
       "a.inp: line 13: expected a range: first, last not below it, and a step of 1 or more"},
      {cube + "*SURFACE,NAME=A\n10,S7\n",
       "a.inp: line 13: expected a set or element and a side S1 to S6, got "
       "\"S7\": whole sets and sides of shells are not read"},
      {"*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n*SURFACE,NAME=A\n1,S5\n",
       "a.inp: line 9: element 1 is a tet4, which has no side 5"},
      {cube + "*NGEN\n1,2\n",
       "a.inp: line 12: *NGEN makes or moves nodes or elements, which is not read: write "
       "them out, as with a mesh generator or Abaqus/CAE"},
      {"*INCLUDE, INPUT=b.inp\n", "a.inp: line 1: files cannot be included here"},
      {"(0 \"Fluent\")\n",
       "a.inp: this is an ANSYS Fluent mesh, not one of Gmsh: export the mesh as Abaqus .inp, "
       "or translate it with meshio"},
  };
  for (const auto& [text, message] : rows) CHECK(refusal(text) == message);
}

TEST_CASE("elements that are taken for others are named with what differs") {
  const Mesh mesh = read(cube_nodes + "*ELEMENT, TYPE=C3D8R\n1, 1,2,3,4,5,6,7,8\n");
  REQUIRE(mesh.warnings.size() == 1);
  CHECK(mesh.warnings[0].find("a.inp: line 10: C3D8R: all points are integrated here") == 0);
}

TEST_CASE(
    "every element is written and read again with its sides, numbers and groups, as a deck and for Gmsh") {
  const TemporaryFolder folder;
  for (const ElementType type : element_types()) {
    BoxSpec spec;
    spec.type = type;
    spec.cells = {3, 2, 2};
    Mesh mesh = make_box(spec);
    mesh.groups.push_back({"some elements", mesh.dim(), {0, 1, 2}});
    mesh.groups.push_back({"some nodes", 0, {1, 4}});
    for (std::size_t i = 0; i < mesh.node_count(); ++i)
      mesh.node_tags.push_back(static_cast<std::int64_t>(1000 - 3 * i));
    for (std::size_t e = 0; e < mesh.element_count(); ++e)
      mesh.element_tags.push_back(static_cast<std::int64_t>(5 * e + 2));
    write_deck(folder.file("a.inp"), mesh);
    write_gmsh(folder.file("a.msh"), mesh);
    for (const std::string name : {"a.inp", "a.msh"}) {
      INFO(name, " ", cell(type).name);
      const Mesh back = read_mesh(folder.file(name));
      CHECK(back.type == type);
      CHECK(back.coordinates == mesh.coordinates);
      CHECK(back.elements == mesh.elements);
      CHECK(back.facets == mesh.facets);
      CHECK(back.node_tags == mesh.node_tags);
      CHECK(back.element_tags == mesh.element_tags);
      CHECK(back.groups.size() == mesh.groups.size());
      for (const Group& group : mesh.groups)
        CHECK(members(back, group.name, group.dimension) == group.members);
    }
  }
}
