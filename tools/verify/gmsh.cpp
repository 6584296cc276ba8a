// SPDX-License-Identifier: BSD-3-Clause
// Reads Gmsh's formats 2.2 and 4.1, ASCII and binary, as described in Gmsh's manual.
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "verify/file.hpp"
#include "verify/mesh.hpp"
#include "verify/obstacle.hpp"

namespace kacanov::verify {
namespace {

struct GmshType {
  int nodes, dimension;
};
/// Element types by Gmsh number.
const std::map<int, GmshType>& types() {
  static const std::map<int, GmshType> table{{15, {1, 0}}, {1, {2, 1}},   {8, {3, 1}},
                                             {2, {3, 2}},  {9, {6, 2}},   {3, {4, 2}},
                                             {4, {4, 3}},  {11, {10, 3}}, {5, {8, 3}}};
  return table;
}

/// Reads consecutive numbers, as text or binary.
class Numbers {
 public:
  explicit Numbers(const std::filesystem::path& file) : file_(file.string()), in_(open_file(file)) {
    if (!in_) fail("cannot be read");
  }
  [[noreturn]] void fail(const std::string& what) const { throw Failure(file_ + ": " + what); }

  bool section(std::string& name) {
    while (in_ >> name)
      if (name.starts_with("$") && !name.starts_with("$End")) return true;
    return false;
  }
  void skip(const std::string& section) {
    const std::string end = "$End" + section.substr(1);
    for (std::string word; in_ >> word;)
      if (word == end) return;
    fail(section + " does not end");
  }
  void end_of_line() {
    std::string rest;
    std::getline(in_, rest);
  }
  std::string quoted() {
    std::string text;
    std::getline(in_, text, '"');
    std::getline(in_, text, '"');
    return text;
  }
  void set_binary() {
    end_of_line();
    binary_ = true;
    if (take<std::int32_t>() != 1) fail("is of the other byte order");
  }
  bool binary() const { return binary_; }
  template <class T>
  T text() {
    T value{};
    if (!(in_ >> value)) fail("ends early, or has no number where one belongs");
    return value;
  }
  template <class T>
  T take() {
    if (!binary_) return text<T>();
    T value{};
    if (!in_.read(reinterpret_cast<char*>(&value), sizeof value)) fail("ends early");
    return value;
  }
  /// Reads a size or tag, which has 8 bytes in a binary file.
  std::int64_t size() {
    return binary_ ? static_cast<std::int64_t>(take<std::uint64_t>()) : text<std::int64_t>();
  }

 private:
  std::string file_;
  std::ifstream in_;
  bool binary_ = false;
};

struct GmshElement {
  int type = 0;
  std::set<int> physicals;
  std::vector<std::int64_t> nodes;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : in_(file) {}

  Mesh read() {
    sections();
    return mesh();
  }

  std::vector<Triangle> facets(const std::string& group) {
    sections();
    static const std::map<int, std::vector<std::array<int, 3>>> cut{
        {2, {{0, 1, 2}}}, {3, {{0, 1, 2}, {0, 2, 3}}}, {9, {{0, 3, 5}, {3, 1, 4}, {3, 4, 5}, {5, 4, 2}}}};
    std::vector<Triangle> triangles;
    for (const GmshElement& e : elements_) {
      if (types().at(e.type).dimension != 2) continue;
      bool wanted = group.empty();
      for (const int physical : e.physicals) {
        const auto named = names_.find({2, physical});
        const bool has_name = named != names_.end() && !named->second.empty();
        wanted = wanted || (has_name ? named->second : std::to_string(physical)) == group;
      }
      if (!wanted) continue;
      for (const auto& part : cut.at(e.type)) {
        triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) triangles.back()[k] = mesh_.nodes[index_.at(e.nodes[part[k]])];
      }
    }
    return triangles;
  }

 private:
  void sections() {
    for (std::string name; in_.section(name);) {
      if (name == "$MeshFormat") {
        new_ = in_.text<double>() > 3;
        const bool binary = in_.text<int>() == 1;
        in_.text<int>();
        if (binary) in_.set_binary();
      } else if (name == "$PhysicalNames") {
        for (auto left = in_.text<std::int64_t>(); left > 0; --left) {
          const int dimension = in_.text<int>(), tag = std::abs(in_.text<int>());
          names_[{dimension, tag}] = in_.quoted();
        }
      } else if (name == "$Entities") {
        entities();
      } else if (name == "$Nodes") {
        new_ ? node_blocks() : node_list();
      } else if (name == "$Elements") {
        new_ ? element_blocks() : element_list();
      } else {
        in_.skip(name);
      }
    }
  }

  /// Numbers at the start of a section are on a line of their own in both encodings.
  void start_bytes() {
    if (in_.binary()) in_.end_of_line();
  }

  void entities() {
    start_bytes();
    std::array<std::int64_t, 4> counts{};
    for (auto& count : counts) count = in_.size();
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::int64_t i = 0; i < counts[dimension]; ++i) {
        const int tag = in_.take<std::int32_t>();
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) in_.take<double>();
        std::set<int>& physicals = physicals_[{dimension, tag}];
        for (auto left = in_.size(); left > 0; --left) physicals.insert(std::abs(in_.take<std::int32_t>()));
        if (dimension > 0)
          for (auto left = in_.size(); left > 0; --left) in_.take<std::int32_t>();
      }
  }

  void node(std::int64_t tag) {
    index_[tag] = static_cast<Index>(mesh_.tags.size());
    mesh_.tags.push_back(tag);
  }
  Vec position() {
    Vec x{};
    for (Real& c : x) c = in_.take<double>();
    return x;
  }

  void node_blocks() {
    start_bytes();
    auto blocks = in_.size();
    for (int k = 0; k < 3; ++k) in_.size();
    for (; blocks > 0; --blocks) {
      const int dimension = in_.take<std::int32_t>();
      in_.take<std::int32_t>();
      const int parametric = in_.take<std::int32_t>();
      const auto count = in_.size();
      for (std::int64_t i = 0; i < count; ++i) node(in_.size());
      for (std::int64_t i = 0; i < count; ++i) {
        mesh_.nodes.push_back(position());
        for (int k = 0; k < parametric * dimension; ++k) in_.take<double>();
      }
    }
  }

  void node_list() {
    auto left = in_.text<std::int64_t>();
    start_bytes();
    for (; left > 0; --left) {
      node(in_.take<std::int32_t>());
      mesh_.nodes.push_back(position());
    }
  }

  GmshElement& element(int type) {
    if (!types().contains(type))
      in_.fail("elements of Gmsh's type " + std::to_string(type) + " are not known");
    elements_.push_back({type, {}, {}});
    return elements_.back();
  }

  void element_blocks() {
    start_bytes();
    auto blocks = in_.size();
    for (int k = 0; k < 3; ++k) in_.size();
    for (; blocks > 0; --blocks) {
      const int dimension = in_.take<std::int32_t>(), tag = in_.take<std::int32_t>(),
                type = in_.take<std::int32_t>();
      for (auto left = in_.size(); left > 0; --left) {
        GmshElement& next = element(type);
        in_.size();
        for (int k = 0; k < types().at(type).nodes; ++k) next.nodes.push_back(in_.size());
        next.physicals = physicals_[{dimension, tag}];
      }
    }
  }

  void element_list() {
    auto left = in_.text<std::int64_t>();
    start_bytes();
    while (left > 0) {
      int type = 0, count = 1, tags = 0;
      if (in_.binary()) {
        type = in_.take<std::int32_t>();
        count = in_.take<std::int32_t>();
        tags = in_.take<std::int32_t>();
      }
      for (int i = 0; i < count; ++i, --left) {
        in_.take<std::int32_t>();
        if (!in_.binary()) {
          type = in_.text<int>();
          tags = in_.text<int>();
        }
        GmshElement& next = element(type);
        for (int k = 0; k < tags; ++k) {
          const int value = in_.take<std::int32_t>();
          if (k == 0 && value != 0) next.physicals.insert(std::abs(value));
        }
        for (int k = 0; k < types().at(type).nodes; ++k) next.nodes.push_back(in_.take<std::int32_t>());
        // Format 2.2 repeats an element once per group, consecutively.
        const auto same = elements_.size() >= 2 ? elements_.end() - 2 : elements_.end();
        if (same == elements_.end() || same->type != type || same->nodes != next.nodes) continue;
        same->physicals.insert(next.physicals.begin(), next.physicals.end());
        elements_.pop_back();
      }
    }
  }

  Mesh mesh() {
    static const std::map<int, Shape> bodies{
        {2, Shape::tri3}, {3, Shape::quad4}, {4, Shape::tet4}, {11, Shape::tet10}, {5, Shape::hex8}};
    int dim = 0, body = 0;
    for (const GmshElement& e : elements_)
      if (types().at(e.type).dimension > dim) {
        dim = types().at(e.type).dimension;
        body = e.type;
      }
    if (!bodies.contains(body)) in_.fail("there are no elements that a body is made of");
    mesh_.shape = bodies.at(body);
    std::map<std::pair<int, std::string>, std::vector<Indices>> groups;
    for (const GmshElement& e : elements_) {
      const int dimension = types().at(e.type).dimension;
      if (dimension == dim && e.type != body) in_.fail("the body is made of several types of elements");
      Indices nodes;
      for (const std::int64_t tag : e.nodes) nodes.push_back(index_.at(tag));
      const Indices cell = e.type == body ? Indices{static_cast<Index>(mesh_.elements.size())} : nodes;
      for (const int physical : e.physicals) {
        const auto named = names_.find({dimension, physical});
        const bool has_name = named != names_.end() && !named->second.empty();
        groups[{dimension, has_name ? named->second : std::to_string(physical)}].push_back(cell);
      }
      if (e.type == body) mesh_.elements.push_back(std::move(nodes));
    }
    for (auto& [key, cells] : groups) mesh_.groups.push_back({key.second, key.first, std::move(cells)});
    if (dim == 2)
      for (Vec& x : mesh_.nodes) x[2] = 0;
    drop_unreferenced_nodes();
    return std::move(mesh_);
  }

  /// Drops nodes that no element of the body uses, and the facets that contain them.
  void drop_unreferenced_nodes() {
    std::vector<Index> place(mesh_.nodes.size(), -1);
    for (const Indices& element : mesh_.elements)
      for (const Index node : element) place[node] = 0;
    Index kept = 0;
    for (std::size_t n = 0; n < place.size(); ++n) {
      if (place[n] < 0) continue;
      mesh_.nodes[kept] = mesh_.nodes[n];
      mesh_.tags[kept] = mesh_.tags[n];
      place[n] = kept++;
    }
    mesh_.nodes.resize(kept);
    mesh_.tags.resize(kept);
    const auto renumber = [&](Indices& cell) {
      for (Index& node : cell) node = place[node];
    };
    for (Indices& element : mesh_.elements) renumber(element);
    for (NamedGroup& group : mesh_.groups) {
      if (group.dimension == mesh_.dim()) continue;
      for (Indices& cell : group.cells) {
        renumber(cell);
        const bool facet = group.dimension == mesh_.dim() - 1;
        if (std::erase(cell, -1) > 0 && facet) cell.clear();
      }
      std::erase_if(group.cells, [](const Indices& cell) { return cell.empty(); });
    }
  }

  Numbers in_;
  Mesh mesh_;
  bool new_ = false;
  std::map<std::pair<int, int>, std::string> names_;
  std::map<std::pair<int, int>, std::set<int>> physicals_;
  std::map<std::int64_t, Index> index_;
  std::vector<GmshElement> elements_;
};

}  // namespace

Mesh read_gmsh(const std::filesystem::path& file) { return Reader(file).read(); }

std::vector<Triangle> read_gmsh_facets(const std::filesystem::path& file, const std::string& group) {
  return Reader(file).facets(group);
}

}  // namespace kacanov::verify
