// SPDX-License-Identifier: BSD-3-Clause
// How much memory a run takes, from what its arrays hold; and how much there is.
#include "program/memory_model.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include <kacanov/error.hpp>
#include "program/control_group.hpp"
#include "program/report.hpp"

namespace kacanov {
namespace {

/// Bytes for every node and every element.
struct Bytes {
  double node = 0.0, element = 0.0;
  Bytes operator+(const Bytes& b) const { return {node + b.node, element + b.element}; }
  double of(const ProblemSize& size) const { return node * size.nodes + element * size.elements; }
};

constexpr double bytes_alone = 20e6,
                 bytes_in_company = 32e6;          // of a process: the program, MPI and its shared memory
constexpr double bytes_per_contact_point = 1.8e3;  // rows of traces, their spaces and blocks
constexpr double lanes_filled = 1.07;              // slots of the operators an element
constexpr double nodes_of_blocks = 1.25;           // nodes of the operators' blocks a node
constexpr double overhead = 1.03;                  // of the allocator

/// What a part, its operators and the loops hold; see Part, Layout, StepContext, RigidMultigrid.
struct Demand {
  Bytes mesh, problem, part, steady, setup, solve;

  explicit Demand(const ProblemSize& size) {
    const double dim = dimension(size.type), npe = nodes_per_element(size.type),
                 points = points_per_element(size.type);
    const double slots = points * lanes_filled;
    // Local numbers of a unit's nodes, two bytes each: fans of six tetrahedra have eight.
    const double index = size.type == ElementType::tet4 ? 2.7 : 2.0 * npe;
    mesh = {8 * dim, 4 * npe};
    problem = {17 * dim, 2};              // load, prescribed, held; law
    part = {8 * dim + 4 + dim, 4 * npe};  // coordinates, index, held; corners
    const Bytes operators{nodes_of_blocks * (32 + 4 + 16 + 4), slots * (8 + 4 + 4 + 4) + 2 * index};
    const Bytes loops{8 * dim * 6 + 4 * dim, 0};  // ω, kept ω, R(ω), three vectors of CG; diagonal
    const double modes = dim == 3 ? 6 : 3,
                 neighbours = dim == 3 ? 8 : 4;  // half the couplings of an aggregate of 48 nodes
    const double rows =
        neighbours * modes * modes * 8 / 48.0 * 1.4;  // levels below, inverse diagonals, vectors
    const Bytes multigrid{16 * dim + 4 * dim * (dim + 1) / 2 + 4 + rows, 0};
    steady = part + operators + loops + multigrid;
    setup = {8 + 1.15 * rows, 8 * points};               // aggregates, sums of blocks; g
    solve = {8 * dim, size.nonlinear ? 20 * slots : 0};  // step; tangent
  }
};

/// The number behind a word at the beginning of a line, 0 where there is none.
double number_after(const std::string& path, const std::string& word) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key;
    double value = 0.0;
    if (words >> key >> value && key == word) return value;
  }
  return 0.0;
}

/// Whether some material has another law than the linear one.
bool nonlinear(const Model& model) {
  return std::any_of(model.materials.begin(), model.materials.end(),
                     [](const MaterialEntry& entry) { return !entry.law.linear(); });
}

}  // namespace

ProblemSize size_of(const BoxSpec& box, const Model& model) {
  ProblemSize size;
  size.type = box.type;
  size.nonlinear = nonlinear(model);
  const auto dim = static_cast<std::size_t>(dimension(box.type));
  const double order = cell(box.type).order;
  size.nodes = 1.0;
  size.elements = cell(box.type).box_elements();
  for (std::size_t c = 0; c < dim; ++c) {
    size.nodes *= 1.0 + order * box.cells[c];
    size.elements *= box.cells[c];
  }
  return size;
}

ProblemSize size_of(const Mesh& mesh, const Model& model) {
  ProblemSize size;
  size.type = mesh.type;
  size.nonlinear = nonlinear(model);
  size.nodes = static_cast<double>(mesh.node_count());
  size.elements = static_cast<double>(mesh.element_count());
  return size;
}

double estimated_memory(const ProblemSize& size, int ranks) {
  const Demand demand(size);
  const double loops = demand.steady.of(size) + std::max(demand.setup.of(size), demand.solve.of(size));
  const double solving = (loops + bytes_per_contact_point * size.contact_points) / ranks;
  const Bytes sides{8, 4.0 * facets_per_element(size.type)};  // while boundary and neighbours are sought
  const Bytes splitting{28, 4};                               // orders, ranks and new numbers
  const double reading = (demand.mesh + demand.problem + sides).of(size);
  const double handing_out =
      (demand.mesh + demand.problem + splitting).of(size) + demand.part.of(size) / ranks;
  const double first = std::max({reading, handing_out, solving});
  return ranks * (ranks == 1 ? bytes_alone : bytes_in_company) + overhead * (first + (ranks - 1) * solving);
}

std::uint64_t peak_memory() {
  return static_cast<std::uint64_t>(1024.0 * number_after("/proc/self/status", "VmHWM:"));
}

double available_memory() {
  double available = 1024.0 * number_after("/proc/meminfo", "MemAvailable:");
  const double left = control_group_limits().memory;
  if (!std::isfinite(left)) return available;
  return available > 0.0 ? std::min(available, left) : left;
}

void refuse_what_cannot_fit(const ProblemSize& size, int ranks, int ranks_here) {
  const double needed = estimated_memory(size, ranks) * ranks_here / ranks, available = available_memory();
  if (available == 0.0 || needed <= available) return;
  throw InputError(
      "this case needs about " + readable_bytes(needed) + " of memory on " + std::to_string(ranks_here) +
      (ranks_here == 1 ? " rank, " : " ranks, ") + readable_bytes(available) +
      " are available: take a coarser mesh or more machines (--no-memory-check tries all the same)");
}

}  // namespace kacanov
