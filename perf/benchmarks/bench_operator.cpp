// SPDX-License-Identifier: BSD-3-Clause
// Benchmarks the operator against assembled matrices, in unknowns per second and in one run, as JSON or as a
// table.
#include <CLI/CLI.hpp>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#ifdef KACANOV_BENCH_GMSH
#include "formats/gmsh_reader.hpp"
#endif
#include <kacanov/kacanov.h>
#include <kacanov/locality.hpp>
#include <kacanov/operator.hpp>
#include "machine.hpp"
#include "matrices.hpp"
#include "meshes.hpp"

using namespace kacanov;
using nlohmann::json;

namespace {

/// A power law on handles of the C interface, built in or as a callback: a body whose points are all beyond
/// yield at displacements of the size of an element.
class PowerLawBody {
 public:
  /// `mesh` must outlive this object. With `own` the law is a callback, which all threads may call.
  PowerLawBody(const meshes::OwnedMesh& mesh, bool own, int threads);
  void residual(std::span<const double> u, std::span<double> f);
  void update_tangent(std::span<const double> u);

 private:
  struct Destroy {
    void operator()(kacanov_operator* op) const { kacanov_destroy(op); }
  };
  std::unique_ptr<kacanov_operator, Destroy> op_;
};

constexpr double power_shear = 1.0, power_yield = 1e-3, power_exponent = 0.2;

int evaluate_power_law(void*, const kacanov_law_points* points) {
  for (std::size_t i = 0; i < points->count; ++i) {
    const double x = points->x[i];
    const bool elastic = x <= power_yield;
    const double g = elastic ? power_shear : power_shear * std::pow(x / power_yield, power_exponent - 1.0);
    points->g[i] = g;
    if (points->slope != nullptr) points->slope[i] = elastic ? 0.0 : (power_exponent - 1.0) * g / x;
    if (points->energy != nullptr)
      points->energy[i] = elastic
                              ? 0.5 * g * x * x
                              : g * x * x / (power_exponent + 1.0) + power_shear * power_yield * power_yield *
                                                                         (0.5 - 1.0 / (power_exponent + 1.0));
  }
  return 0;
}

void check_call(int code, const char* message) {
  if (code != KACANOV_OK) throw std::runtime_error(message);
}

PowerLawBody::PowerLawBody(const meshes::OwnedMesh& mesh, bool own, int threads) {
  kacanov_law law{};
  law.struct_size = sizeof law;
  law.kind = own ? KACANOV_USER : KACANOV_POWER;
  law.bulk = 2.0;
  law.shear = power_shear;
  law.x0 = power_yield;
  law.n = power_exponent;
  if (own) law.evaluate = evaluate_power_law;
  law.parallel = own ? 1 : 0;
  kacanov_description body{};
  body.struct_size = sizeof body;
  body.element = static_cast<std::int32_t>(mesh.type);
  body.threads = threads;
  body.nodes = mesh.view().node_count();
  body.coordinates = mesh.coordinates.data();
  body.elements = mesh.view().element_count();
  body.connectivity = mesh.connectivity.data();
  body.borrow = 1;
  body.laws = 1;
  body.law = &law;
  kacanov_operator* op = nullptr;
  char message[256];
  check_call(kacanov_create(&body, &op, message, sizeof message), message);
  op_.reset(op);
}

void PowerLawBody::residual(std::span<const double> u, std::span<double> f) {
  check_call(kacanov_residual(op_.get(), u.size(), u.data(), f.data()), kacanov_message(op_.get()));
}

void PowerLawBody::update_tangent(std::span<const double> u) {
  check_call(kacanov_update_tangent(op_.get(), u.size(), u.data()), kacanov_message(op_.get()));
}

struct Settings {
  std::vector<std::string> elements;
  std::vector<std::size_t> unknowns{182'000, 812'000};
  std::vector<std::string> meshes{"box", "irregular"};
  int threads = static_cast<int>(std::thread::hardware_concurrency());
  int rounds = 20;
  std::string instruction_set;
  bool print_json = false;
  bool no_matrix = false;
};

std::vector<std::string> all_elements() {
  std::vector<std::string> names;
  for (const ElementType type : element_types()) names.emplace_back(cell(type).name);
  return names;
}

/// Returns the mesh with nodes and elements in the operator's preferred order, from which matrices profit
/// too.
meshes::OwnedMesh in_order(const meshes::OwnedMesh& mesh) {
  const std::size_t dim = dimension(mesh.type);
  const LocalityOrder order = locality_order(mesh.view());
  meshes::OwnedMesh ordered = mesh;
  std::vector<std::int32_t> rank(order.nodes.size());
  for (std::size_t i = 0; i < rank.size(); ++i) {
    const std::size_t old = order.nodes[i];
    rank[old] = static_cast<std::int32_t>(i);
    std::copy_n(mesh.coordinates.begin() + static_cast<std::ptrdiff_t>(old * dim), dim,
                ordered.coordinates.begin() + static_cast<std::ptrdiff_t>(i * dim));
  }
  const std::size_t per_element = nodes_per_element(mesh.type);
  for (std::size_t e = 0; e < order.elements.size(); ++e)
    for (std::size_t a = 0; a < per_element; ++a)
      ordered.connectivity[e * per_element + a] =
          rank[mesh.connectivity[static_cast<std::size_t>(order.elements[e]) * per_element + a]];
  return ordered;
}

#ifdef KACANOV_BENCH_GMSH
/// Returns the body of a Gmsh file; an unusable file is an error with a message.
meshes::OwnedMesh read_mesh(const std::string& path) {
  Mesh mesh = read_gmsh(path);
  return in_order({mesh.type, std::move(mesh.coordinates), std::move(mesh.elements)});
}
#else
meshes::OwnedMesh read_mesh(const std::string& path) {
  throw std::runtime_error(path + ": this build has no reader of meshes (KACANOV_SOLVER=OFF)");
}
#endif

/// Returns a beam 4 × 1 × 1 (4 × 1 in 2D) with about this many unknowns.
meshes::OwnedMesh make_mesh(ElementType type, std::size_t unknowns, bool irregular) {
  const std::size_t dim = dimension(type);
  const double nodes = static_cast<double>(unknowns / dim);
  const bool flat = dim == 2;
  const double cells = nodes / 4 / std::pow(cell(type).order, dim);
  int n = static_cast<int>(std::lround(flat ? std::sqrt(cells) : std::cbrt(cells)));
  n = std::max(n, 1);
  auto mesh = meshes::box(type, {4 * n, n, n}, {4, 1, 1});
  if (!irregular) return mesh;
  meshes::jitter(mesh, cell(type).order == 2 ? 0.05 : 0.15, 1);
  if (type == ElementType::tet4) meshes::flip(mesh, 2, 2);
  meshes::straighten(mesh);
  meshes::shuffle(mesh, 3);
  return in_order(mesh);
}

struct Timed {
  std::function<void()> run;
  double seconds = std::numeric_limits<double>::max();
};

/// Runs all in turn, so that disturbances affect them alike, and keeps the best time of each.
void time_interleaved(std::vector<Timed>& all, int rounds) {
  for (Timed& timed : all) timed.run();
  for (int round = 0; round < rounds; ++round)
    for (Timed& timed : all) {
      const double start = perf::now();
      timed.run();
      timed.seconds = std::min(timed.seconds, perf::now() - start);
    }
}

/// Returns the bytes that one application must move at least: x and y once, coordinates, g, indices.
double traffic(const Body& body, std::size_t held, double real) {
  return static_cast<double>(held) + 3.0 * real * static_cast<double>(body.unknowns());
}

/// Returns fused multiply-adds and other operations per element, for a tetrahedron in a long fan, otherwise
/// for all its quadrature points; a division counts as one.
double flops_an_element(ElementType type) {
  return points_per_element(type) * (dimension(type) == 2 ? 80.0 : type == ElementType::tet4 ? 155.0 : 190.0);
}

json measure(const meshes::OwnedMesh& mesh, const std::string& kind, const Settings& settings,
             const std::vector<double>& triad, const std::vector<double>& fma) {
  const ElementType type = mesh.type;
  const std::string element = std::string(cell(type).name);
  const std::vector<Law> laws{elastic_law(1.0, 0.3)};
  const Body body{mesh.view(), laws, {}};
  const std::size_t n = body.unknowns();
  std::vector<double> x(n), y(n), expected(n);
  std::mt19937 random(1);
  for (double& value : x) value = std::uniform_real_distribution<double>(-1, 1)(random);
  const std::vector<float> xf(x.begin(), x.end());
  std::vector<float> yf(n);
  std::vector<double> x4, y4(4 * n);
  for (int v = 0; v < 4; ++v) x4.insert(x4.end(), x.begin(), x.end());

  std::vector<int> teams{1};
  if (settings.threads > 1) teams.push_back(settings.threads);
  std::vector<Operator> doubles;
  std::vector<FloatOperator> floats;
  std::vector<std::size_t> held;  // bytes of each double-precision operator without tangent
  double setup = 0.0;
  for (const int threads : teams) {
    const double start = perf::now();
    doubles.emplace_back(body, OperatorOptions{threads, settings.instruction_set});
    setup = perf::now() - start;
    floats.emplace_back(body, OperatorOptions{threads, settings.instruction_set});
    held.push_back(doubles.back().bytes());
    doubles.back().update_tangent(x);
  }
  const int most = teams.back();
  std::vector<Timed> timed;
  for (Operator& op : doubles) timed.push_back({[&] { op.apply(x, y); }});
  for (FloatOperator& op : floats) timed.push_back({[&] { op.apply(xf, yf); }});
  Operator& op = doubles.back();
  timed.push_back({[&] { op.apply_tangent(x, y); }});
  timed.push_back({[&] { op.apply_dot(x, y); }});
  timed.push_back({[&] { op.apply_many(std::span(x4).first(2 * n), std::span(y4).first(2 * n), 2); }});
  timed.push_back({[&] { op.apply_many(x4, y4, 4); }});
  timed.push_back({[&] { op.residual(x, y); }});
  PowerLawBody built_in(mesh, false, most), own(mesh, true, most);
  for (PowerLawBody* law : {&built_in, &own}) {
    timed.push_back({[&x, &y, law] { law->residual(x, y); }});
    timed.push_back({[&x, law] { law->update_tangent(x); }});
  }
  perf::Matrices matrices;
  if (!settings.no_matrix) {
    std::vector<double> g(body.secant_count());
    op.secant(g);
    matrices = perf::assemble(body, g);
    op.apply(x, y);
    matrices.apply_blocks(x, expected, most);
    double worst = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      worst = std::max(worst, std::abs(y[i] - expected[i]));
      largest = std::max(largest, std::abs(expected[i]));
    }
    if (!(worst < 1e-12 * largest)) throw std::runtime_error("operator and matrix differ");
    const auto size = static_cast<Eigen::Index>(n);
    timed.push_back({[&] { matrices.apply_blocks(x, y, most); }});
    timed.push_back({[&, size] {
      Eigen::setNbThreads(most);
      const Eigen::Map<const Eigen::SparseMatrix<double, Eigen::RowMajor, std::int32_t>> csr(
          size, size, static_cast<Eigen::Index>(matrices.value.size()), matrices.first.data(),
          matrices.column.data(), matrices.value.data());
      Eigen::Map<Eigen::VectorXd>(y.data(), size).noalias() =
          csr * Eigen::Map<const Eigen::VectorXd>(x.data(), size);
    }});
  }
  time_interleaved(timed, settings.rounds);

  const auto rate = [&](double seconds) { return static_cast<double>(n) / seconds; };
  json entries = json::array();
  std::size_t next = 0;
  const double bsr = settings.no_matrix ? 0.0 : timed[timed.size() - 2].seconds;
  const double csr = settings.no_matrix ? 0.0 : timed.back().seconds;
  const auto add = [&](const std::string& form, const std::string& precision, int threads, double seconds,
                       double bytes, double flops) {
    const std::size_t team = threads == 1 ? 0 : teams.size() - 1;
    json entry{{"element", element},
               {"mesh", kind},
               {"form", form},
               {"unknowns", n},
               {"elements", body.mesh.element_count()},
               {"precision", precision},
               {"threads", threads},
               {"seconds", seconds},
               {"unknowns_per_second", rate(seconds)},
               {"bytes_per_unknown", bytes / static_cast<double>(n)},
               {"share_of_triad", bytes / seconds / triad[team]},
               {"share_of_fma_peak", flops / seconds / fma[team] / (precision == "float" ? 2.0 : 1.0)}};
    if (bsr > 0.0 && threads == most) {
      entry["ratio_to_csr"] = csr / seconds;
      entry["ratio_to_bsr3"] = bsr / seconds;
    }
    entries.push_back(entry);
  };
  const double flops = flops_an_element(type) * static_cast<double>(body.mesh.element_count());
  for (std::size_t i = 0; i < doubles.size(); ++i)
    add("apply", "double", teams[i], timed[next++].seconds, traffic(body, held[i], 8), flops);
  for (std::size_t i = 0; i < floats.size(); ++i)
    add("apply", "float", teams[i], timed[next++].seconds, traffic(body, floats[i].bytes(), 4), flops);
  // Several right-hand sides count with the time of one of them.
  const std::vector<std::pair<std::string, double>> forms{
      {"tangent", 1},          {"apply_dot", 1},    {"two_right_sides", 2},
      {"four_right_sides", 4}, {"residual", 1},     {"residual_power", 1},
      {"update_power", 1},     {"residual_own", 1}, {"update_own", 1}};
  for (const auto& [form, vectors] : forms)
    add(form, "double", most, timed[next++].seconds / vectors,
        traffic(body, form == "tangent" ? op.bytes() : held.back(), 8), flops);
  if (!settings.no_matrix) {
    const double vectors = 16.0 * static_cast<double>(n);
    add("bsr3", "double", most, bsr, matrices.bytes_of_blocks() + vectors,
        2.0 * static_cast<double>(matrices.block.size()));
    add("csr", "double", most, csr, matrices.bytes_of_csr() + vectors,
        2.0 * static_cast<double>(matrices.value.size()));
  }
  for (json& entry : entries) {
    entry["instruction_set"] = op.instruction_set();
    entry["setup_seconds"] = setup;
  }
  return entries;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  CLI::App app{"Unknowns a second of the operator against assembled matrices"};
  settings.elements = all_elements();
  const auto* element_option = app.add_option("--element", settings.elements, "element types")
                                   ->delimiter(',')
                                   ->check(CLI::IsMember(all_elements()));
  app.add_option("--unknowns", settings.unknowns, "sizes, met approximately")->delimiter(',');
  app.add_option("--mesh", settings.meshes,
                 "box, irregular, or a Gmsh file: its element and size are then those of the file")
      ->delimiter(',');
  app.add_option("--threads", settings.threads, "threads of the larger team")->check(CLI::PositiveNumber);
  app.add_option("--rounds", settings.rounds, "interleaved repetitions; the best counts")
      ->check(CLI::PositiveNumber);
  app.add_option("--instruction-set", settings.instruction_set, "avx512, avx2, plain");
  app.add_flag("--json", settings.print_json, "JSON on standard output instead of a table");
  app.add_flag("--no-matrix", settings.no_matrix, "leave the assembled matrices out");
  CLI11_PARSE(app, argc, argv);
  const bool asked = element_option->count() > 0;

  std::vector<double> triad{perf::triad_bytes_per_second(1)}, fma{perf::fma_flops_per_second(1)};
  if (settings.threads > 1) {
    triad.push_back(perf::triad_bytes_per_second(settings.threads));
    fma.push_back(perf::fma_flops_per_second(settings.threads));
  }
  json result{{"triad_bytes_per_second", triad}, {"fma_flops_per_second", fma}, {"entries", json::array()}};
  const auto add = [&](const meshes::OwnedMesh& mesh, const std::string& kind) {
    const json entries = measure(mesh, kind, settings, triad, fma);
    result["entries"].insert(result["entries"].end(), entries.begin(), entries.end());
  };
  const auto generated = [](const std::string& kind) { return kind == "box" || kind == "irregular"; };
  for (const std::string& element : settings.elements)
    for (const std::size_t unknowns : settings.unknowns)
      for (const std::string& kind : settings.meshes)
        if (generated(kind)) add(make_mesh(*element_type(element), unknowns, kind == "irregular"), kind);
  for (const std::string& file : settings.meshes)
    if (!generated(file)) {
      try {
        const meshes::OwnedMesh mesh = read_mesh(file);
        if (asked && std::find(settings.elements.begin(), settings.elements.end(),
                               std::string(cell(mesh.type).name)) == settings.elements.end())
          throw std::runtime_error(file + ": has elements " + std::string(cell(mesh.type).name) +
                                   ", none that --element asks for");
        add(mesh, file);
      } catch (const std::exception& error) {
        std::cerr << "bench_operator: --mesh " << error.what() << "\n";
        return 2;
      }
    }
  if (settings.print_json) {
    std::cout << result.dump(2) << "\n";
    return 0;
  }
  std::printf("triad %.1f GB/s, fused multiply-adds %.1f Gflop/s (%d threads)\n", triad.back() / 1e9,
              fma.back() / 1e9, settings.threads);
  std::printf("%-6s %-10s %-17s %-7s %3s %9s %9s %8s %7s %7s %7s %7s\n", "", "mesh", "form", "", "thr",
              "unknowns", "ms", "M/s", "B/unk", "/csr", "/bsr3", "fma %");
  for (const json& e : result["entries"])
    std::printf("%-6s %-10s %-17s %-7s %3d %9zu %9.3f %8.1f %7.1f %7.2f %7.2f %7.1f\n",
                e["element"].get<std::string>().c_str(), e["mesh"].get<std::string>().c_str(),
                e["form"].get<std::string>().c_str(), e["precision"].get<std::string>().c_str(),
                e["threads"].get<int>(), e["unknowns"].get<std::size_t>(), e["seconds"].get<double>() * 1e3,
                e["unknowns_per_second"].get<double>() / 1e6, e["bytes_per_unknown"].get<double>(),
                e.value("ratio_to_csr", 0.0), e.value("ratio_to_bsr3", 0.0),
                100 * e["share_of_fma_peak"].get<double>());
  return 0;
}
