// SPDX-License-Identifier: BSD-3-Clause
// Estimates the memory of a run from its arrays, and reads the available memory.
#include "program/memory_model.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <kacanov/error.hpp>
#include "mesh/classic_locale_stream.hpp"
#include "program/control_group.hpp"
#include "program/report.hpp"

namespace kacanov {
namespace {

constexpr double bytes_alone = 20e6,
                 bytes_in_company = 32e6;          // per process: program, MPI and its shared memory
constexpr double bytes_per_contact_point = 1.8e3;  // trace rows, their search spaces and blocks
constexpr double lanes_filled = 1.07;              // operator slots per element
constexpr double nodes_of_blocks = 1.25;           // block nodes of the operators per mesh node
constexpr double overhead = 1.03;                  // of the allocator
// Bytes per node, measured on boxes of 1 million unknowns, tet10 up to 50 million. grids: in addition to the
// aggregate modes; pressures: means and their indices, S, grids of four fields.
constexpr double bytes_of_grids = 105, bytes_of_pressures_tet4 = 500, bytes_of_pressures_tet10 = 220,
                 bytes_of_pressures_hex8 = 600;

/// Returns the number after a word at the start of a line; 0 if there is none.
double number_after(const std::string& path, const std::string& word) {
  PlainFile file(path);
  for (std::string line; std::getline(file, line);) {
    PlainWords words(line);
    std::string key;
    double value = 0.0;
    if (words >> key >> value && key == word) return value;
  }
  return 0.0;
}

/// Returns whether a material has a nonlinear law.
bool nonlinear(const Model& model) {
  return std::any_of(model.materials.begin(), model.materials.end(),
                     [](const MaterialEntry& entry) { return !entry.law.linear(); });
}

/// Returns whether a material has an independent pressure field, which has its own multigrid.
bool with_pressures(const Model& model, ElementType type) {
  return cell(type).corner_dilatation &&
         std::any_of(model.materials.begin(), model.materials.end(), [](const MaterialEntry& entry) {
           return entry.formulation == MaterialEntry::Formulation::mixed;
         });
}

/// Returns whether a material can yield and its hexahedra average the dilatation.
bool averages_and_yields(const Model& model, ElementType type) {
  return dimension(type) == 3 && cell(type).mean_dilatation &&
         std::any_of(model.materials.begin(), model.materials.end(), [](const MaterialEntry& entry) {
           return !entry.law.linear() && entry.bbar.value_or(true) &&
                  entry.formulation != MaterialEntry::Formulation::displacement;
         });
}

double bytes_of_pressures(ElementType type) {
  return type == ElementType::tet4    ? bytes_of_pressures_tet4
         : type == ElementType::tet10 ? bytes_of_pressures_tet10
                                      : bytes_of_pressures_hex8;
}

double estimated_memory_here(const ProblemSize& size, int ranks, int ranks_here) {
  return estimated_memory(size, ranks) * ranks_here / ranks;
}

}  // namespace

ProblemSize flowing(const ProblemSize& size) {
  ProblemSize most = size;
  most.pressures = size.pressures || size.may_flow;
  return most;
}

ProblemSize size_of(const BoxSpec& box, const Model& model) {
  ProblemSize size;
  size.type = box.type;
  size.nonlinear = nonlinear(model);
  size.pressures = with_pressures(model, size.type);
  size.may_flow = averages_and_yields(model, size.type);
  const std::size_t dim = dimension(box.type);
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
  size.pressures = with_pressures(model, size.type);
  size.may_flow = averages_and_yields(model, size.type);
  size.nodes = static_cast<double>(mesh.node_count());
  size.elements = static_cast<double>(mesh.element_count());
  return size;
}

MemoryShares memory_shares(const ProblemSize& size) {
  const double dim = dimension(size.type), npe = nodes_per_element(size.type),
               points = points_per_element(size.type);
  const auto bytes = [&](double node, double element) { return node * size.nodes + element * size.elements; };
  const double slots = points * lanes_filled;
  // Local node numbers per work item, two bytes each: a fan of six tetrahedra has eight nodes.
  const double index = size.type == ElementType::tet4 ? 2.7 : 2.0 * npe;
  const double modes = dim == 3 ? 6 : 3,
               neighbours = dim == 3 ? 8 : 4;  // half the neighbours of an aggregate of 48 nodes
  const double rows =
      neighbours * modes * modes * 8 / 48.0 * 1.4;  // coarser levels, inverse diagonals, vectors
  MemoryShares shares;
  shares.mesh = bytes(8 * dim, 4 * npe);
  shares.problem = bytes(17 * dim, 2);              // load, prescribed, held; law
  shares.part = bytes(8 * dim + 4 + dim, 4 * npe);  // coordinates, index, held; corners
  shares.operators = bytes(nodes_of_blocks * (32 + 4 + 16 + 4), slots * (8 + 4 + 4 + 4) + 2 * index);
  shares.loops = bytes(8 * dim * 6 + 4 * dim, 0);  // u, stored u, R(u), three CG vectors; diagonal
  shares.multigrid = bytes(16 * dim + 4 * dim * (dim + 1) / 2 + 4 + rows, 0);
  if (dim == 3) shares.multigrid += bytes(bytes_of_grids, 0);
  if (size.pressures) shares.multigrid += bytes(bytes_of_pressures(size.type), 0);
  shares.setup = bytes(8 + 1.15 * rows, 8 * points);  // aggregates, block sums; g
  shares.step = bytes(8 * dim, 0);
  shares.tangent = size.nonlinear ? bytes(0, 20 * slots) : 0.0;
  return shares;
}

double estimated_memory(const ProblemSize& size, int ranks) {
  const MemoryShares shares = memory_shares(size);
  const double loops = shares.part + shares.operators + shares.loops + shares.multigrid +
                       std::max(shares.setup, shares.step + shares.tangent);
  const double solving = (loops + bytes_per_contact_point * size.contact_points) / ranks;
  const double handed_in = shares.mesh + shares.problem;
  // While finding boundary and neighbours; orders, ranks and new numbers of the partition.
  const double sides = 8 * size.nodes + 4.0 * facets_per_element(size.type) * size.elements,
               splitting = 28 * size.nodes + 4 * size.elements;
  const double first = std::max({handed_in + sides, handed_in + splitting + shares.part / ranks, solving});
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
  const double needed = estimated_memory_here(size, ranks, ranks_here), available = available_memory();
  if (available == 0.0 || needed <= available) return;
  throw InputError(
      "this case needs about " + readable_bytes(needed) + " of memory on " + std::to_string(ranks_here) +
      (ranks_here == 1 ? " rank, " : " ranks, ") + readable_bytes(available) +
      " are available: take a coarser mesh or more machines (--no-memory-check tries all the same)");
}

bool may_outgrow(const ProblemSize& size, int ranks, int ranks_here) {
  const double available = available_memory();
  return size.may_flow && available > 0.0 &&
         estimated_memory_here(flowing(size), ranks, ranks_here) > available;
}

std::string outgrown_memory_message(const ProblemSize& size, int ranks, int ranks_here) {
  return "where the body flows until k0/g is 300 this case needs about " +
         readable_bytes(estimated_memory_here(flowing(size), ranks, ranks_here)) + " of memory, " +
         readable_bytes(available_memory()) + " are available";
}

}  // namespace kacanov
