// SPDX-License-Identifier: BSD-3-Clause
// Writes Gmsh format 4.1: members with the same groups form one entity.
#include <algorithm>
#include <array>
#include <map>

#include "formats/mesh_writer.hpp"
#include "formats/text_file.hpp"

namespace kacanov {
namespace {

constexpr int point_type = 15;

/// Elements, facets or nodes that belong to the same groups.
struct Entity {
  int dimension = 0;
  std::vector<int> groups;  ///< group numbers, from 1
  std::vector<std::int32_t> members;
};

/// Number of possible members of a dimension.
std::size_t member_count(const Mesh& mesh, int dimension) {
  if (dimension == mesh.dim()) return mesh.element_count();
  return dimension == mesh.dim() - 1 ? mesh.facet_count() : mesh.node_count();
}

/// Entities of all elements, and of the facets and nodes in groups. Members of node groups of any dimension
/// become points.
std::vector<Entity> entities_of(const Mesh& mesh) {
  std::vector<Entity> entities;
  for (const int dimension : {0, mesh.dim() - 1, mesh.dim()}) {
    std::vector<std::pair<std::int32_t, int>> pairs;  // member, group
    for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
      const int of = mesh.groups[g].dimension;
      if ((of >= mesh.dim() - 1 ? of : 0) != dimension) continue;
      for (const std::int32_t m : mesh.groups[g].members) pairs.emplace_back(m, static_cast<int>(g) + 1);
    }
    std::sort(pairs.begin(), pairs.end());
    std::map<std::vector<int>, std::size_t> known;
    const auto add = [&](std::int32_t member, std::vector<int> groups) {
      const auto [place, added] = known.emplace(std::move(groups), entities.size());
      if (added) entities.push_back({dimension, place->first, {}});
      entities[place->second].members.push_back(member);
    };
    auto next = pairs.begin();
    for (std::size_t m = 0; m < member_count(mesh, dimension); ++m) {
      const auto member = static_cast<std::int32_t>(m);
      std::vector<int> groups;
      for (; next != pairs.end() && next->first == member; ++next) groups.push_back(next->second);
      if (dimension == mesh.dim() || !groups.empty()) add(member, std::move(groups));
    }
  }
  return entities;
}

class Writer {
 public:
  Writer(const std::string& path, const Mesh& mesh) : mesh_(mesh), entities_(entities_of(mesh)), out_(path) {}

  void write() {
    out_.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    names();
    entities();
    nodes();
    elements();
    out_.commit();
  }

 private:
  void row(std::initializer_list<std::int64_t> numbers) {
    for (const std::int64_t number : numbers) {
      out_.number(number);
      out_.text(" ");
    }
  }
  void position(std::size_t node) {
    const std::size_t dim = mesh_.dim();
    for (std::size_t c = 0; c < 3; ++c) {
      out_.number(c < dim ? mesh_.coordinates[node * dim + c] : 0.0);
      out_.text(" ");
    }
  }

  void names() {
    out_.text("$PhysicalNames\n");
    row({static_cast<std::int64_t>(mesh_.groups.size())});
    out_.text("\n");
    for (std::size_t g = 0; g < mesh_.groups.size(); ++g) {
      const int of = mesh_.groups[g].dimension;
      row({of >= mesh_.dim() - 1 ? of : 0, static_cast<std::int64_t>(g) + 1});
      out_.text("\"" + mesh_.groups[g].name + "\"\n");
    }
    out_.text("$EndPhysicalNames\n");
  }

  void entities() {
    std::array<double, 6> box{};
    const std::size_t dim = mesh_.dim();
    for (std::size_t i = 0; i < mesh_.coordinates.size(); ++i) {
      const std::size_t c = i % dim;
      box[c] = i < dim ? mesh_.coordinates[i] : std::min(box[c], mesh_.coordinates[i]);
      box[3 + c] = i < dim ? mesh_.coordinates[i] : std::max(box[3 + c], mesh_.coordinates[i]);
    }
    out_.text("$Entities\n");
    for (int d = 0; d < 4; ++d)
      row({std::count_if(entities_.begin(), entities_.end(),
                         [d](const Entity& e) { return e.dimension == d; })});
    out_.text("\n");
    for (int d = 0; d < 4; ++d)
      for (std::size_t i = 0; i < entities_.size(); ++i) {
        const Entity& entity = entities_[i];
        if (entity.dimension != d) continue;
        row({static_cast<std::int64_t>(i) + 1});
        if (d == 0)
          position(entity.members[0]);
        else
          for (const double x : box) {
            out_.number(x);
            out_.text(" ");
          }
        row({static_cast<std::int64_t>(entity.groups.size())});
        for (const int group : entity.groups) row({group});
        out_.text(d == 0 ? "\n" : "0\n");
      }
    out_.text("$EndEntities\n");
  }

  void nodes() {
    const auto count = static_cast<std::int64_t>(mesh_.node_count());
    std::int64_t low = mesh_.node_tag(0), high = low;
    for (std::size_t i = 0; i < mesh_.node_count(); ++i) {
      low = std::min(low, mesh_.node_tag(i));
      high = std::max(high, mesh_.node_tag(i));
    }
    out_.text("$Nodes\n");
    row({1, count, low, high});
    out_.text("\n");
    // All nodes are written under the last entity of the body; Gmsh assigns them by their elements.
    row({mesh_.dim(), static_cast<std::int64_t>(entities_.size()), 0, count});
    out_.text("\n");
    for (std::size_t i = 0; i < mesh_.node_count(); ++i) {
      out_.number(mesh_.node_tag(i));
      out_.text("\n");
    }
    for (std::size_t i = 0; i < mesh_.node_count(); ++i) {
      position(i);
      out_.text("\n");
    }
    out_.text("$EndNodes\n");
  }

  std::span<const std::int32_t> nodes_of(const Entity& entity, const std::int32_t& member) const {
    if (entity.dimension == mesh_.dim()) {
      const std::size_t n = nodes_per_element(mesh_.type);
      return std::span(mesh_.elements).subspan(member * n, n);
    }
    return entity.dimension == mesh_.dim() - 1 ? mesh_.facet(member) : std::span(&member, 1);
  }

  void elements() {
    std::size_t total = 0;
    for (const Entity& entity : entities_) total += entity.members.size();
    std::int64_t low = mesh_.element_tag(0), high = low;
    for (std::size_t e = 0; e < mesh_.element_count(); ++e) {
      low = std::min(low, mesh_.element_tag(e));
      high = std::max(high, mesh_.element_tag(e));
    }
    const auto others = static_cast<std::int64_t>(total - mesh_.element_count());
    out_.text("$Elements\n");
    row({static_cast<std::int64_t>(entities_.size()), static_cast<std::int64_t>(total), low, high + others});
    out_.text("\n");
    for (std::size_t i = 0; i < entities_.size(); ++i) {
      const Entity& entity = entities_[i];
      const bool body = entity.dimension == mesh_.dim(), facets = entity.dimension == mesh_.dim() - 1;
      row({entity.dimension, static_cast<std::int64_t>(i) + 1,
           body     ? cell(mesh_.type).gmsh
           : facets ? cell(mesh_.type).facet().gmsh
                    : point_type,
           static_cast<std::int64_t>(entity.members.size())});
      out_.text("\n");
      for (const std::int32_t& member : entity.members) {
        row({body ? mesh_.element_tag(member) : ++high});
        for (const std::int32_t node : nodes_of(entity, member)) row({mesh_.node_tag(node)});
        out_.text("\n");
      }
    }
    out_.text("$EndElements\n");
  }

  const Mesh& mesh_;
  std::vector<Entity> entities_;
  TextFile out_;
};

}  // namespace

void write_gmsh(const std::string& path, const Mesh& mesh) { Writer(path, mesh).write(); }

}  // namespace kacanov
