// SPDX-License-Identifier: BSD-3-Clause
// Round trips of a mesh through every variant of Gmsh's format; corrupt files are rejected or harmless.
#include <doctest/doctest.h>

#include <algorithm>
#include <optional>
#include <random>

#include <kacanov/error.hpp>
#include "../sanitized.hpp"
#include "formats/gmsh_reader.hpp"
#include "mesh_writer.hpp"
#include "temporary_folder.hpp"

using namespace kacanov;
using namespace kacanov::testing;

namespace {

const std::vector<GmshForm> all_forms{{true, false, false, false},  {true, true, false, false},
                                      {false, false, false, false}, {false, true, false, false},
                                      {true, false, true, true},    {true, true, true, false},
                                      {false, false, false, true}};

void check_equal(const Mesh& a, const Mesh& b) {
  CHECK(a.type == b.type);
  CHECK(a.coordinates == b.coordinates);
  CHECK(a.elements == b.elements);
  CHECK(a.facets == b.facets);
  CHECK(a.facet_element == b.facet_element);
  for (std::size_t i = 0; i < a.node_count(); ++i) REQUIRE(a.node_tag(i) == b.node_tag(i));
  for (std::size_t e = 0; e < a.element_count(); ++e) REQUIRE(a.element_tag(e) == b.element_tag(e));
  REQUIRE(a.groups.size() == b.groups.size());
  for (const Group& group : a.groups) {
    CAPTURE(group.name);
    const auto same = std::find_if(b.groups.begin(), b.groups.end(), [&](const Group& g) {
      return g.name == group.name && g.dimension == group.dimension;
    });
    REQUIRE(same != b.groups.end());
    CHECK(same->members == group.members);
  }
}

/// A box with overlapping groups in every dimension, and with elements and facets without a group.
Mesh grouped_box(ElementType type) {
  Mesh mesh = make_box({{2, 1, 1}, {2, 2, 1}, type});
  const auto elements = static_cast<std::int32_t>(mesh.element_count());
  Group first{"first half", mesh.dim(), {}}, middle{"middle", mesh.dim(), {}};
  for (std::int32_t e = 0; e < elements / 2; ++e) first.members.push_back(e);
  for (std::int32_t e = elements / 4; e < 3 * elements / 4; ++e) middle.members.push_back(e);
  mesh.groups.push_back(first);
  mesh.groups.push_back(middle);
  mesh.groups.push_back({"left", mesh.dim(), {0}});  // the name of a side, used again in another dimension
  mesh.groups.push_back({"some nodes", 0, {1, 3, 4}});
  mesh.groups.push_back({"corner", 0, {0, 3}});
  mesh.groups.push_back({"nothing", mesh.dim() - 1, {}});
  Group most{"most sides", mesh.dim() - 1, {}};
  for (std::size_t f = 0; f + 1 < mesh.facet_count(); ++f)
    most.members.push_back(static_cast<std::int32_t>(f));
  mesh.groups.push_back(most);
  mesh.groups.erase(mesh.groups.begin() + 1);  // the right side keeps at most one name
  return mesh;
}

/// Gives the mesh sparse, unordered numbers.
void renumber(Mesh& mesh, std::int64_t spread, unsigned seed) {
  mesh.node_tags.resize(mesh.node_count());
  for (std::size_t i = 0; i < mesh.node_tags.size(); ++i)
    mesh.node_tags[i] = 5 + spread * static_cast<std::int64_t>(i);
  std::shuffle(mesh.node_tags.begin(), mesh.node_tags.end(), std::mt19937(seed));
  mesh.element_tags.resize(mesh.element_count());
  for (std::size_t e = 0; e < mesh.element_tags.size(); ++e)
    mesh.element_tags[e] = 900 - static_cast<std::int64_t>(e);
}

/// Returns the mesh in a file with these bytes, or nothing if the reader rejects it.
std::optional<Mesh> read_if_valid(const std::string& bytes) {
  try {
    return read_gmsh("a.msh", bytes);
  } catch (const InputError& error) {
    CHECK(std::string(error.what()).starts_with("a.msh: "));
    return std::nullopt;
  }
}

/// Returns whether every index is in range, so that later code can rely on it.
bool consistent(const Mesh& mesh) {
  const auto below = [](const std::vector<std::int32_t>& indices, std::size_t limit) {
    return std::all_of(indices.begin(), indices.end(),
                       [&](std::int32_t i) { return i >= 0 && static_cast<std::size_t>(i) < limit; });
  };
  bool good = below(mesh.elements, mesh.node_count()) && below(mesh.facets, mesh.node_count()) &&
              below(mesh.facet_element, mesh.element_count());
  for (const Group& g : mesh.groups)
    good = good && below(g.members, g.dimension == mesh.dim()       ? mesh.element_count()
                                    : g.dimension == mesh.dim() - 1 ? mesh.facet_count()
                                                                    : mesh.node_count());
  return good;
}

}  // namespace

TEST_CASE("a mesh of every type comes back from every form") {
  for (const ElementType type : element_types())
    for (const std::int64_t spread : {0, 1, 3, 1000}) {
      Mesh mesh = grouped_box(type);
      if (spread > 0) renumber(mesh, spread, static_cast<unsigned>(spread));
      for (const GmshForm& form : all_forms) {
        CAPTURE(static_cast<int>(type));
        CAPTURE(form.new_format);
        CAPTURE(form.binary);
        const auto back = read_if_valid(gmsh_file(mesh, form));
        REQUIRE(back);
        check_equal(mesh, *back);
      }
    }
}

TEST_CASE("the rocker mesh comes back from every form") {
  const Mesh rocker = read_gmsh(KACANOV_EXAMPLES "/rocker.msh");
  CHECK(rocker.node_count() == 515);
  CHECK(rocker.element_count() == 1764);
  CHECK_NOTHROW(check_mesh(rocker));
  std::vector<std::string> names;
  for (const Group& g : rocker.groups) names.push_back(g.name);
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"base", "body", "clamp", "top"});
  for (const GmshForm& form : all_forms) {
    const auto back = read_if_valid(gmsh_file(rocker, form));
    REQUIRE(back);
    check_equal(rocker, *back);
  }
}

TEST_CASE("a file and its bytes give the same mesh") {
  const TemporaryFolder folder;
  const Mesh mesh = grouped_box(ElementType::hex8);
  for (const GmshForm& form : all_forms) {
    write_bytes(folder.file("mesh.msh"), gmsh_file(mesh, form));
    check_equal(mesh, read_gmsh(folder.file("mesh.msh")));
  }
}

TEST_CASE("a truncated file is refused, wherever it ends") {
  const Mesh mesh = grouped_box(ElementType::tet4);
  const Mesh rocker = read_gmsh(KACANOV_EXAMPLES "/rocker.msh");
  for (const GmshForm& form : all_forms) {
    const std::string small = gmsh_file(mesh, form);
    std::size_t accepted = 0;
    // The last line may lack its line end.
    const std::size_t ends = form.carriage_returns ? 2 : 1;
    for (std::size_t length = 0; length < small.size() - ends; length += 7)
      accepted += read_if_valid(small.substr(0, length)).has_value();
    const std::string large = gmsh_file(rocker, form);
    for (std::size_t length = 100; length < large.size() - ends; length += 3989)
      accepted += read_if_valid(large.substr(0, length)).has_value();
    CHECK(accepted == 0);
  }
}

TEST_CASE("a file with a wrong byte is refused or gives a mesh that holds together") {
  const Mesh mesh = grouped_box(ElementType::tet4);
  for (const GmshForm& form : all_forms) {
    const std::string good = gmsh_file(mesh, form);
    const std::size_t stride = sanitized ? 5 : 1;
    std::size_t refused = 0, inconsistent = 0;
    for (std::size_t at = 0; at < good.size(); at += stride) {
      std::string bad = good;
      bad[at] = static_cast<char>(bad[at] ^ (at % 2 == 0 ? 0x01 : 0x80));
      const auto read_mesh = read_if_valid(bad);
      refused += !read_mesh;
      if (!read_mesh) continue;
      inconsistent += !consistent(*read_mesh);
      try {
        check_mesh(*read_mesh);
      } catch (const InputError&) {
      }
    }
    CHECK(inconsistent == 0);
    CHECK(refused > good.size() / stride / 4);
  }
}

TEST_CASE("exchanged, repeated and lost pieces of a file do no harm either") {
  const Mesh mesh = grouped_box(ElementType::tri3);
  std::mt19937 random(3);
  for (const GmshForm& form : all_forms) {
    const std::string good = gmsh_file(mesh, form);
    for (int trial = 0; trial < 400; ++trial) {
      std::string bad = good;
      const std::size_t from = random() % good.size(), length = 1 + random() % 40,
                        to = random() % good.size();
      const std::string piece = good.substr(from, length);
      if (trial % 3 == 0)
        bad.erase(from, length);
      else if (trial % 3 == 1)
        bad.insert(to, piece);
      else
        bad.replace(to, piece.size(), piece);
      const auto read_mesh = read_if_valid(bad);
      CHECK((!read_mesh || consistent(*read_mesh)));
    }
  }
}
