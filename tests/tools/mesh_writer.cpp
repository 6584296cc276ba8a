// SPDX-License-Identifier: BSD-3-Clause
// Writers of Gmsh formats 2.2 and 4.1, ASCII and binary.
#include "mesh_writer.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <tuple>
#include <vector>

namespace kacanov::testing {
namespace {

class Out {
 public:
  explicit Out(const GmshForm& form) : form_(form) {}
  void line(const std::string& text) { bytes_ += text + (form_.carriage_returns ? "\r\n" : "\n"); }
  void tag(std::int64_t value) { number(static_cast<std::int32_t>(value), value); }
  void size(std::size_t value) {
    number(static_cast<std::uint64_t>(value), static_cast<std::int64_t>(value));
  }
  void real(double value) {
    if (form_.binary) {
      raw(value);
      return;
    }
    char text[40];
    std::snprintf(text, sizeof text, "%.17g ", value);
    bytes_ += text;
  }
  void end_record() {
    if (!form_.binary) line("");
  }
  void begin(const std::string& section) { line("$" + section); }
  void end(const std::string& section) {
    if (form_.binary && section != "PhysicalNames") bytes_ += "\n";
    line("$End" + section);
  }
  std::string bytes() const { return bytes_; }

 private:
  template <typename T>
  void number(T value, std::int64_t text) {
    if (form_.binary)
      raw(value);
    else
      bytes_ += std::to_string(text) + " ";
  }
  template <typename T>
  void raw(T value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  const GmshForm& form_;
  std::string bytes_;
};

/// A Gmsh entity: consecutive elements of one dimension with the same groups.
struct Entity {
  int dimension = 0;
  int type = 0;
  std::vector<int> physicals;
  std::vector<std::vector<std::int32_t>> elements;
  std::vector<std::int64_t> tags;
};

class Writer {
 public:
  Writer(const Mesh& mesh, const GmshForm& form) : mesh_(mesh), form_(form), out_(form) { collect(); }

  std::string write() {
    header();
    names();
    if (form_.new_format) entities();
    form_.new_format ? node_blocks() : node_list();
    form_.new_format ? element_blocks() : element_list();
    return out_.bytes();
  }

 private:
  void collect() {
    const std::size_t n = nodes_per_element(mesh_.type);
    for (int dimension = 0; dimension <= mesh_.dim(); ++dimension) {
      std::map<std::int32_t, std::vector<int>> physicals;  // groups of each member
      if (dimension == mesh_.dim())
        for (std::size_t e = 0; e < mesh_.element_count(); ++e) physicals[static_cast<std::int32_t>(e)];
      for (std::size_t g = 0; g < mesh_.groups.size(); ++g)
        if (mesh_.groups[g].dimension == dimension)
          for (const std::int32_t m : mesh_.groups[g].members)
            physicals[m].push_back(static_cast<int>(g) + 1);
      for (const auto& [member, groups] : physicals) {
        if (entities_.empty() || entities_.back().dimension != dimension ||
            entities_.back().physicals != groups)
          entities_.push_back({dimension, 0, groups, {}, {}});
        Entity& entity = entities_.back();
        if (dimension == mesh_.dim()) {
          entity.type = cell(mesh_.type).gmsh;
          const auto begin =
              mesh_.elements.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(member) * n);
          entity.elements.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(n));
          entity.tags.push_back(mesh_.element_tag(member));
        } else if (dimension == mesh_.dim() - 1) {
          entity.type = cell(mesh_.type).facet().gmsh;
          const auto facet = mesh_.facet(member);
          entity.elements.emplace_back(facet.begin(), facet.end());
          entity.tags.push_back(next_++);
        } else {
          entity.type = 15;
          entity.elements.push_back({member});
          entity.tags.push_back(next_++);
        }
      }
    }
  }

  void header() {
    out_.begin("MeshFormat");
    out_.line(std::string(form_.new_format ? "4.1 " : "2.2 ") + (form_.binary ? "1 8" : "0 8"));
    if (form_.binary) out_.tag(1);
    out_.end("MeshFormat");
  }

  void names() {
    out_.begin("PhysicalNames");
    out_.line(std::to_string(mesh_.groups.size()));
    for (std::size_t g = 0; g < mesh_.groups.size(); ++g)
      out_.line(std::to_string(mesh_.groups[g].dimension) + " " + std::to_string(g + 1) + " \"" +
                mesh_.groups[g].name + "\"");
    out_.end("PhysicalNames");
  }

  void entities() {
    out_.begin("Entities");
    for (int d = 0; d < 4; ++d) {
      std::size_t count = 0;
      for (const Entity& e : entities_) count += e.dimension == d;
      out_.size(count);
    }
    out_.end_record();
    for (std::size_t i = 0; i < entities_.size(); ++i) {
      out_.tag(static_cast<int>(i) + 1);
      for (int k = 0; k < (entities_[i].dimension == 0 ? 3 : 6); ++k) out_.real(0.25 * k);
      out_.size(entities_[i].physicals.size());
      for (const int p : entities_[i].physicals) out_.tag(p);
      if (entities_[i].dimension > 0) {
        out_.size(2);
        out_.tag(1);
        out_.tag(-2);
      }
      out_.end_record();
    }
    out_.end("Entities");
  }

  void position(std::size_t node) {
    const std::size_t dim = mesh_.dim();
    for (std::size_t k = 0; k < 3; ++k) out_.real(k < dim ? mesh_.coordinates[node * dim + k] : 0.125);
  }

  /// Writes the nodes in two blocks, the first in an entity of dimension 2.
  void node_blocks() {
    const std::size_t nodes = mesh_.node_count(), half = nodes / 2;
    out_.begin("Nodes");
    for (const std::size_t v : {std::size_t{2}, nodes, std::size_t{1}, nodes}) out_.size(v);
    out_.end_record();
    for (const auto& [first, last, dimension] :
         {std::tuple{std::size_t{0}, half, 2}, std::tuple{half, nodes, 3}}) {
      out_.tag(dimension);
      out_.tag(1);
      out_.tag(form_.parametric);
      out_.size(last - first);
      out_.end_record();
      for (std::size_t i = first; i < last; ++i) {
        out_.size(mesh_.node_tag(i));
        out_.end_record();
      }
      for (std::size_t i = first; i < last; ++i) {
        position(i);
        if (form_.parametric)
          for (int k = 0; k < dimension; ++k) out_.real(0.5);
        out_.end_record();
      }
    }
    out_.end("Nodes");
  }

  void node_list() {
    out_.begin("Nodes");
    out_.line(std::to_string(mesh_.node_count()));
    for (std::size_t i = 0; i < mesh_.node_count(); ++i) {
      out_.tag(mesh_.node_tag(i));
      position(i);
      out_.end_record();
    }
    out_.end("Nodes");
  }

  void element_blocks() {
    std::size_t total = 0;
    for (const Entity& e : entities_) total += e.tags.size();
    out_.begin("Elements");
    for (const std::size_t v : {entities_.size(), total, std::size_t{1}, total}) out_.size(v);
    out_.end_record();
    for (std::size_t i = 0; i < entities_.size(); ++i) {
      const Entity& e = entities_[i];
      out_.tag(e.dimension);
      out_.tag(static_cast<int>(i) + 1);
      out_.tag(e.type);
      out_.size(e.tags.size());
      out_.end_record();
      for (std::size_t k = 0; k < e.tags.size(); ++k) {
        out_.size(e.tags[k]);
        for (const std::int32_t node : e.elements[k]) out_.size(mesh_.node_tag(node));
        out_.end_record();
      }
    }
    out_.end("Elements");
  }

  void element_list() {
    std::size_t total = 0;
    for (const Entity& e : entities_) total += e.tags.size() * std::max<std::size_t>(1, e.physicals.size());
    out_.begin("Elements");
    out_.line(std::to_string(total));
    for (const Entity& e : entities_)
      for (std::size_t k = 0; k < e.tags.size(); ++k)
        for (std::size_t p = 0; p < std::max<std::size_t>(1, e.physicals.size()); ++p) {
          // Gmsh numbers the repetitions; the first one keeps the element's own number.
          const std::int64_t tag = p == 0 ? e.tags[k] : next_++;
          if (form_.binary) {
            for (const int v : {e.type, 1, 2}) out_.tag(v);
            out_.tag(tag);
          } else {
            out_.tag(tag);
            for (const int v : {e.type, 2}) out_.tag(v);
          }
          out_.tag(e.physicals.empty() ? 0 : e.physicals[p]);
          out_.tag(1);
          for (const std::int32_t node : e.elements[k]) out_.tag(mesh_.node_tag(node));
          out_.end_record();
        }
    out_.end("Elements");
  }

  const Mesh& mesh_;
  const GmshForm& form_;
  Out out_;
  std::vector<Entity> entities_;
  std::int64_t next_ = 1000000;
};

}  // namespace

std::string gmsh_file(const Mesh& mesh, const GmshForm& form) { return Writer(mesh, form).write(); }

}  // namespace kacanov::testing
