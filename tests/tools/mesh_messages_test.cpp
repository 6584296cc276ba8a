// SPDX-License-Identifier: BSD-3-Clause
// Groups of Gmsh files, and the error messages for unusable files.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <kacanov/error.hpp>
#include "formats/gmsh_reader.hpp"
#include "formats/printable.hpp"
#include "temporary_folder.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

const std::string format22 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
const std::string format41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
const std::string tetrahedron_nodes = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n";
const std::string square_nodes = "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n";

std::string elements(const std::vector<std::string>& lines) {
  std::string text = "$Elements\n" + std::to_string(lines.size()) + "\n";
  for (const std::string& line : lines) text += line + "\n";
  return text + "$EndElements\n";
}

Mesh read_text(const std::string& bytes) { return read_gmsh("a.msh", bytes); }

/// Returns the error message without the leading file name.
std::string refusal(const std::string& bytes) {
  try {
    read_text(bytes);
  } catch (const InputError& error) {
    const std::string text = error.what();
    CHECK(text.starts_with("a.msh: "));
    return text.substr(7);
  }
  return "(accepted)";
}

void check_contains(const std::string& text, const std::vector<std::string>& parts) {
  CAPTURE(text);
  for (const std::string& part : parts) {
    CAPTURE(part);
    CHECK(text.find(part) != std::string::npos);
  }
}

const Group& group(const Mesh& mesh, const std::string& name, int dimension) {
  const auto found = std::find_if(mesh.groups.begin(), mesh.groups.end(),
                                  [&](const Group& g) { return g.name == name && g.dimension == dimension; });
  REQUIRE(found != mesh.groups.end());
  return *found;
}

template <typename T>
std::string raw(T value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

}  // namespace

TEST_CASE("groups without a name are named by their number, empty ones stay, equal names share one group") {
  const Mesh mesh =
      read_text(format22 +
                "$PhysicalNames\n5\n2 1 \"side with spaces\"\n2 8 \"\"\n2 9 \"never used\"\n3 2 \"side with "
                "spaces\"\n2 3 \"side with spaces\"\n$EndPhysicalNames\n" +
                tetrahedron_nodes +
                elements({"1 2 2 1 1 1 3 2", "2 2 2 -12 1 1 2 4", "3 2 2 8 1 1 4 3", "4 2 2 3 1 2 3 4",
                          "9 4 2 2 1 1 2 3 4"}));
  CHECK(group(mesh, "side with spaces", 2).members.size() == 2);
  CHECK(group(mesh, "side with spaces", 3).members == std::vector<std::int32_t>{0});
  CHECK(group(mesh, "12", 2).members.size() == 1);
  CHECK(group(mesh, "8", 2).members.size() == 1);
  CHECK(group(mesh, "never used", 2).members.empty());
  CHECK(mesh.groups.size() == 5);
  CHECK(mesh.element_tag(0) == 9);
  CHECK(mesh.node_tags.empty());
}

TEST_CASE("an element repeated for several groups is one element in all of them") {
  const Mesh mesh =
      read_text(format22 + tetrahedron_nodes +
                elements({"1 4 2 7 1 1 2 3 4", "2 4 2 5 1 1 2 3 4", "3 2 2 6 1 1 3 2", "4 2 2 6 1 3 2 1"}));
  CHECK(mesh.element_count() == 1);
  CHECK(group(mesh, "7", 3).members == group(mesh, "5", 3).members);
  CHECK(group(mesh, "6", 2).members.size() == 1);
}

TEST_CASE("curves and points are node groups in 3D, curves are sides in 2D, inner surfaces no boundary") {
  const Mesh body = read_text(
      format22 + "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n$EndNodes\n" +
      elements({"1 15 2 1 1 4", "2 1 2 2 1 3 1", "3 2 2 3 1 1 2 3", "4 4 0 1 2 3 4", "5 4 2 0 1 1 3 2 5"}));
  CHECK(group(body, "1", 0).members == std::vector<std::int32_t>{3});
  CHECK(group(body, "2", 1).members == std::vector<std::int32_t>{0, 2});
  CHECK(group(body, "3", 2).members.empty());
  CHECK(group(body, "3", 2).inner == 1);
  CHECK(body.facet_count() == 6);
  CHECK(body.groups.size() == 3);

  const Mesh sheet =
      read_text(format22 + square_nodes +
                elements({"1 1 2 1 1 2 1", "2 1 2 2 1 1 3", "3 2 2 4 1 1 2 3", "4 2 2 4 1 1 3 4"}));
  CHECK(sheet.type == ElementType::tri3);
  CHECK(sheet.coordinates == std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1});
  CHECK(group(sheet, "1", 1).members.size() == 1);
  CHECK(group(sheet, "2", 1).members.empty());  // the diagonal
  CHECK(group(sheet, "4", 2).members.size() == 2);
}

TEST_CASE("quadrilaterals make a body in 2D, their sides its boundary") {
  const Mesh sheet =
      read_text(format22 + "$Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n" +
                elements({"1 1 2 7 1 1 2", "2 1 2 8 1 2 5", "3 3 2 9 1 1 2 5 4", "4 3 2 9 1 2 3 6 5"}));
  CHECK(sheet.type == ElementType::quad4);
  CHECK(sheet.element_count() == 2);
  CHECK(sheet.facet_count() == 6);
  CHECK(group(sheet, "7", 1).members.size() == 1);
  CHECK(group(sheet, "8", 1).members.empty());  // interior facet
  CHECK(group(sheet, "9", 2).members.size() == 2);
  CHECK_NOTHROW(check_mesh(sheet));
}

TEST_CASE("comments, unknown sections and data are passed over") {
  const Mesh mesh = read_text("$Comments\nmade by hand\n$EndComments\n" + format22 +
                              "\n$Periodic\n0\n$EndPeriodic\n" + tetrahedron_nodes + "$Empty\n$EndEmpty\n" +
                              elements({"1 4 0 1 2 3 4"}) + "$NodeData\n1\n\"$EndNode\"\n$EndNodeData\n\n");
  CHECK(mesh.element_count() == 1);
}

TEST_CASE("the version and the encoding have to be known") {
  check_contains(refusal("$MeshFormat\n4 0 8\n$EndMeshFormat\n"),
                 {"line 2", "4.0 is not supported", "2.2 and 4.1"});
  check_contains(refusal("$MeshFormat\n3.1 0 8\n"), {"line 2", "3.1 is not supported"});
  check_contains(refusal("$MeshFormat\n4.1 2 8\n"), {"line 2", "file type"});
  check_contains(refusal("$MeshFormat\n4.1 0 4\n"), {"line 2", "data size"});
  check_contains(refusal("$NOD\n3\n"), {"line 1", "format 1 is not supported"});
  check_contains(refusal("solid cube\n"), {"line 1", "is this a Gmsh mesh"});
  check_contains(refusal("\n\n"), {"is this a Gmsh mesh"});
  check_contains(refusal("$MeshFormat\n4.1 1 8\n" + raw(std::int32_t{0x01000000})),
                 {"byte 20", "other byte order"});
  check_contains(refusal("$MeshFormat\n4.1 1 8\n" + raw(std::int32_t{2})), {"byte 20", "corrupt"});
}

TEST_CASE("files that are not there are named") {
  const TemporaryFolder folder;
  const auto refused = [](const std::string& path, const std::string& part) {
    try {
      read_gmsh(path);
    } catch (const InputError& error) {
      check_contains(error.what(), {path, part});
      return true;
    }
    return false;
  };
  write_bytes(folder.file("empty.msh"), "");
  CHECK(refused(folder.file("none.msh"), "No such file"));
  CHECK(refused(folder.file("."), "folder"));
  CHECK(refused(folder.file("empty.msh"), "empty"));
  CHECK(refused("/dev/null", "not a regular file"));
}

TEST_CASE("what is wrong in ASCII is named with its line") {
  check_contains(refusal(format22 + "$Nodes\n2\n1 0 0 0\n2 1 x 0\n$EndNodes\n"),
                 {"line 7", "y coordinate", "\"x\""});
  check_contains(refusal(format22 + "$Nodes\n2\n1 0 0\n2 1 0 0\n$EndNodes\n"),
                 {"line 6", "z coordinate", "line ends"});
  check_contains(refusal(format22 + "$Nodes\n2\n1 0 0 0 5\n2 1 0 0\n$EndNodes\n"),
                 {"line 6", "end of the line", "\"5\""});
  check_contains(refusal(format22 + "$Nodes\n2\n1 0 nan 0\n2 1 0 0\n$EndNodes\n"), {"line 6", "finite"});
  check_contains(refusal(format22 + "$Nodes\n2\n1 0 1e999 0\n2 1 0 0\n$EndNodes\n"), {"line 6", "finite"});
  check_contains(refusal(format22 + "$Nodes\n2\n1 0 0 0\n1 1 0 0\n$EndNodes\n"), {"node 1 is listed twice"});
  check_contains(refusal(format22 + "$Nodes\n1\n0 0 0 0\n$EndNodes\n"), {"line 6", "positive"});
  check_contains(refusal(format22 + "$Nodes\n3\n1 0 0 0\n2 1 0 0\n$EndNodes\n"), {"line 8", "$EndNodes"});
  check_contains(refusal(format22 + "$Nodes\n1\n1 0 0 0\n2 1 0 0\n$EndNodes\n"),
                 {"line 7", "expected $EndNodes"});
  check_contains(refusal(format22 + "$Nodes\n99999999999\n1 0 0 0\n$EndNodes\n"),
                 {"line 5", "99999999999 nodes", "corrupt"});
  check_contains(refusal(format22 + "$Nodes\n-4\n$EndNodes\n"), {"line 5", "-4"});
  check_contains(refusal(format22 + tetrahedron_nodes + elements({"1 4 2 1 1 1 2 3 7"})),
                 {"line 13", "element 1", "node 7"});
  check_contains(refusal(format22 + tetrahedron_nodes + elements({"1 4 2 1 1 1 2 3"})),
                 {"line 13", "line ends"});
  check_contains(refusal(format22 + tetrahedron_nodes + elements({"1 4 -2 1 1 1 2 3 4"})),
                 {"line 13", "number of tags"});
  check_contains(refusal(format22 + elements({"1 4 0 1 2 3 4"}) + tetrahedron_nodes),
                 {"line 4", "$Elements comes before"});
  check_contains(refusal(format22 + tetrahedron_nodes + tetrahedron_nodes), {"line 11", "second $Nodes"});
  check_contains(refusal(format22 + "junk\n"), {"line 4", "junk"});
  check_contains(refusal(format22 + "$Blurb\n1 2 3\n"), {"line 4", "$Blurb has no $EndBlurb"});
  check_contains(refusal(format22 + "$EndNodes\n"), {"line 4", "without its beginning"});
  check_contains(refusal(format22 + tetrahedron_nodes), {"without an $Elements"});
  check_contains(refusal(format22), {"without a $Nodes"});
  check_contains(refusal(format22 + "$PhysicalNames\n1\n3 1 body\n$EndPhysicalNames\n"),
                 {"line 6", "double quotes"});
  check_contains(refusal(format22 + "$PhysicalNames\n2\n3 1 \"a\"\n3 1 \"b\"\n$EndPhysicalNames\n"),
                 {"line 7", "named twice"});
}

TEST_CASE("names that are no UTF-8 or move a terminal's cursor are refused, and shown by number") {
  const auto named = [](const std::string& name) {
    return format22 + "$PhysicalNames\n1\n3 7 \"" + name + "\"\n$EndPhysicalNames\n" + tetrahedron_nodes +
           elements({"1 4 2 7 7 1 2 3 4"});
  };
  CHECK(refusal(named("wälzlager 轴承")) == "(accepted)");
  for (const char* name : {"\x1b[2J", "a\xff", "a\xc3", "\xed\xa0\x80", "\xc0\xaf",
                           "\xc2\x9b"
                           "2J",
                           "tab\tin it", "\x7f"})
    check_contains(refusal(named(name)),
                   {"line 6", "physical group 7: its name is no UTF-8, or has control characters"});
  CHECK(printable("wälzlager 轴承\n") == "wälzlager 轴承\n");
  CHECK(printable("\x1b[2J\xff\xc2\x9b") == "\\x1b[2J\\xff\\xc2\\x9b");
}

TEST_CASE("what belongs to thousands of groups is refused before it takes the square of them") {
  std::string many;
  for (int g = 1; g <= 300; ++g) many += " " + std::to_string(g);
  check_contains(refusal(format41 + "$Entities\n0 0 0 1\n5 0 0 0 1 1 1 300" + many + " 0\n$EndEntities\n"),
                 {"line 6", "entity 5 belongs to more than 256 physical groups"});
  std::vector<std::string> lines;
  for (int g = 1; g <= 300; ++g) lines.push_back("1 4 2 " + std::to_string(g) + " 1 1 2 3 4");
  check_contains(refusal(format22 + tetrahedron_nodes + elements(lines)),
                 {"element 1 belongs to more than 256 physical groups"});
}

TEST_CASE("the parts of format 4.1 have to agree with one another") {
  const std::string nodes = "$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n";
  const std::string entities = "$Entities\n0 0 0 1\n1 0 0 0 1 1 1 1 5 0\n$EndEntities\n";
  const Mesh mesh =
      read_text(format41 + entities + nodes + "$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n");
  CHECK(group(mesh, "5", 3).members == std::vector<std::int32_t>{0});
  CHECK(
      read_text(format41 + nodes + "$Elements\n1 1 1 1\n3 1 4 1\n1 1 2 3 4\n$EndElements\n").groups.empty());

  check_contains(
      refusal(format41 + entities + nodes + "$Elements\n1 1 1 1\n3 2 4 1\n1 1 2 3 4\n$EndElements\n"),
      {"entity 2 of dimension 3", "$Entities does not list"});
  check_contains(refusal(format41 + nodes + "$Elements\n1 1 1 1\n2 1 4 1\n1 1 2 3 4\n$EndElements\n"),
                 {"entity of dimension 2"});
  check_contains(refusal(format41 + nodes + "$Elements\n1 2 1 2\n3 1 4 1\n1 1 2 3 4\n$EndElements\n"),
                 {"missing"});
  check_contains(refusal(format41 + nodes + "$Elements\n1 1 1 1\n3 1 4 2\n1 1 2 3 4\n$EndElements\n"),
                 {"more than the 1 elements"});
  check_contains(refusal(format41 + "$Nodes\n1 4 1 4\n3 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n"),
                 {"more than the 4 nodes"});
  check_contains(refusal(format41 + "$PartitionedEntities\n2\n"), {"partitioned"});
  check_contains(
      refusal(format41 + "$Entities\n0 0 0 2\n1 0 0 0 1 1 1 0 0\n1 0 0 0 1 1 1 0 0\n$EndEntities\n"),
      {"line 7", "listed twice"});
}

TEST_CASE("elements and nodes that cannot be used are named by their number") {
  check_contains(refusal(format22 + tetrahedron_nodes + elements({"31 6 0 1 2 3 4 4 4"})),
                 {"line 13", "element 31", "prism6"});
  check_contains(refusal(format22 + tetrahedron_nodes + elements({"31 17 0"})), {"element 31", "hex20"});
  check_contains(refusal(format22 + tetrahedron_nodes + elements({"31 777 0"})), {"element 31", "type 777"});
  check_contains(refusal(format22 + square_nodes + elements({"1 2 0 1 2 3", "17 3 0 1 2 3 4"})),
                 {"element 17 is a quad4", "tri3 too"});
  check_contains(
      refusal(format22 + "$Nodes\n6\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 1 0 0\n5 1 1 0\n6 0 1 0\n$EndNodes\n" +
              elements({"8 9 0 1 2 3 4 5 6"})),
      {"element 8", "tri6", "made of tri3 or quad4"});
  check_contains(refusal(format22 + tetrahedron_nodes + elements({"1 4 0 1 2 3 4", "6 5 0 1 2 3 4 1 2 3 4"})),
                 {"element 6 is a hex8", "tet4 too"});
  check_contains(refusal(format22 + square_nodes + elements({"1 1 0 1 2", "2 1 0 2 3"})),
                 {"nothing that a body can be made of"});
  check_contains(refusal(format22 + tetrahedron_nodes + elements({"1 2 0 1 2 3", "2 2 0 1 2 4"})),
                 {"node 4 has another z", "plane"});
}

TEST_CASE("nodes that no element of the body has are left out, with a warning") {
  // The first node and the fourth belong to no element; a point and a side refer to them.
  const Mesh mesh = read_text(
      format22 + "$Nodes\n5\n7 9 9 0\n8 0 0 0\n9 1 0 0\n10 5 5 0\n11 0 1 0\n$EndNodes\n" +
      elements({"1 15 2 1 1 7", "2 15 2 1 1 11", "3 1 2 2 1 8 9", "4 1 2 2 1 9 10", "5 2 2 3 1 8 9 11"}));
  REQUIRE(mesh.warnings.size() == 1);
  check_contains(mesh.warnings[0],
                 {"a.msh: 2 nodes belong to no element of the body and are left out", "node 7"});
  CHECK(mesh.coordinates == std::vector<double>{0, 0, 1, 0, 0, 1});
  CHECK(mesh.elements == std::vector<std::int32_t>{0, 1, 2});
  CHECK(mesh.node_tags == std::vector<std::int64_t>{8, 9, 11});
  CHECK(group(mesh, "1", 0).members == std::vector<std::int32_t>{2});
  CHECK(group(mesh, "2", 1).members.size() == 1);
  CHECK(group(mesh, "2", 1).inner == 1);
  CHECK_NOTHROW(check_mesh(mesh));
}
