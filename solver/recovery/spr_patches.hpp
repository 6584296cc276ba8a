// SPDX-License-Identifier: BSD-3-Clause
// Superconvergent patch recovery (Zienkiewicz and Zhu 1992): polynomials fitted to the strains round a node,
// stress at nodes and the error of the strains from them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include <kacanov/element_fields.hpp>
#include <kacanov/model.hpp>
#include <kacanov/nodal_stress.hpp>
#include <kacanov/part.hpp>

namespace kacanov {

/// Monomials 1, x_i and, of order 2, x_i x_j; of a plane or of space.
class Monomials {
 public:
  static constexpr std::size_t most = 10;
  Monomials(int dim, int order);
  std::size_t count() const noexcept { return count_; }
  std::size_t linear() const noexcept { return 1 + dim_; }  ///< those of order 0 and 1
  std::array<double, most> at(const Vector3& x) const {
    std::array<double, most> value{1.0};
    for (std::size_t i = 0; i < dim_; ++i) value[1 + i] = x[i];
    if (!quadratic_) return value;
    std::size_t k = 1 + dim_;
    for (std::size_t i = 0; i < dim_; ++i)
      for (std::size_t j = i; j < dim_; ++j) value[k++] = x[i] * x[j];
    return value;
  }
  /// Calls work(std::integral_constant of count()), so that loops over monomials are of known length.
  template <class Work>
  decltype(auto) with_count(const Work& work) const {
    switch (count_) {
      case 3: return work(std::integral_constant<std::size_t, 3>());
      case 4: return work(std::integral_constant<std::size_t, 4>());
      case 6: return work(std::integral_constant<std::size_t, 6>());
      default: return work(std::integral_constant<std::size_t, most>());
    }
  }

 private:
  std::size_t dim_, count_;
  bool quadratic_;
};

/// Places in space and what is known there: `sets` of six values each.
struct Samples {
  static constexpr std::size_t values = 6, most_sets = 2;
  std::span<const Vector3> position;
  std::array<const double*, most_sets> set{};  ///< positions × 6
};

/// Sums over samples about the mean of their places: what linear polynomials are fitted with round any
/// centre.
struct LinearSums {
  double count = 0.0;
  Vector3 mean{};
  std::array<std::array<double, 3>, 3> square{};  ///< of places from the mean
  std::array<std::array<std::array<double, Samples::values>, 4>, Samples::most_sets> side{};

  LinearSums(const Samples& samples, std::size_t sets);
};

/// Least squares round many centres at once.
class PatchFits {
 public:
  static constexpr std::size_t values = Samples::values;
  PatchFits(std::size_t centres, const Monomials& monomials, std::size_t sets = 1);

  bool linear() const noexcept { return monomials_.count() == monomials_.linear(); }
  std::size_t sets() const noexcept { return sets_; }
  /// `at`: the place of centre i; `scale`: one over its patch's size.
  void add(std::size_t i, const Vector3& at, double scale, const Samples& samples);
  /// The same of linear().
  void add(std::size_t i, const Vector3& at, double scale, const LinearSums& sums);
  /// The sums of centre i, to be added up over ranks.
  std::span<double> sums(std::size_t centre) noexcept {
    return std::span(sums_).subspan(centre * width_, width_);
  }
  std::size_t width() const noexcept { return width_; }
  /// Whether any sample came.
  bool has(std::size_t centre) const noexcept { return sums_[centre * width_] > 0.0; }
  /// Solves the normal equations of all centres in place. What too few samples leave open is kept small,
  /// the higher orders first.
  void solve();
  /// After solve(): monomials × 6, of the polynomial of a set.
  const double* coefficients(std::size_t centre, std::size_t set) const noexcept {
    return &sums_[centre * width_ + pairs_ + set * values * monomials_.count()];
  }
  /// `x`: from the centre, times the scale.
  std::array<double, values> evaluate(const double* coefficients, const Vector3& x) const {
    const auto p = monomials_.at(x);
    std::array<double, values> out{};
    monomials_.with_count([&](auto count) {
      for (std::size_t i = 0; i < count(); ++i)
        for (std::size_t v = 0; v < values; ++v) out[v] += p[i] * coefficients[i * values + v];
    });
    return out;
  }

 private:
  template <std::size_t n>
  void add_of(double* sum, const Vector3& at, double scale, const Samples& samples) const;
  template <std::size_t n>
  void add_of(double* sum, const Vector3& from, double scale, const LinearSums& of) const;
  template <std::size_t n>
  void solve_of();

  Monomials monomials_;
  std::size_t sets_, pairs_, width_;
  /// Centre by centre: upper triangle of the matrix, row by row; then the sides, set by set.
  std::vector<double> sums_;
};

/// Superconvergent patch recovery (theory: nodal-stress), one batch of materials after the other: those of a
/// batch meet at no node, and each has polynomials of its own. Middles of edges have no patch.
class Patches {
 public:
  using Values = std::array<double, PatchFits::values>;

  /// Collective.
  explicit Patches(const Part& part);

  std::int32_t batches() const noexcept { return batches_; }
  bool is_in(std::size_t element, std::int32_t batch) const {
    return part_.law_of_element.empty() || batch_of_law_[part_.law_of_element[element]] == batch;
  }
  /// Nodes that are corners of elements.
  const std::vector<std::int32_t>& corners() const noexcept { return corners_; }

  /// Without samples yet.
  PatchFits fits(std::size_t sets) const;
  /// The samples of an element, for the patches of all its corners.
  void add(PatchFits& fits, std::size_t element, const Samples& samples) const;
  /// Adds up over the ranks that share a corner, and fits. Collective.
  void solve(PatchFits& fits) const;
  /// Whether the patch of a corner has had any sample, on any rank.
  bool has(const PatchFits& fits, std::size_t node) const { return fits.has(place(node)); }
  /// The polynomial of a corner, for as long as the fits live.
  struct Polynomial {
    const PatchFits* fits;
    const double* coefficients;
    Vector3 centre;
    double scale;
    Values operator()(const Vector3& position) const {
      return fits->evaluate(coefficients,
                            {scale * (position[0] - centre[0]), scale * (position[1] - centre[1]),
                             scale * (position[2] - centre[2])});
    }
  };
  Polynomial polynomial(const PatchFits& fits, std::size_t set, std::size_t node) const;

 private:
  std::size_t place(std::size_t node) const { return static_cast<std::size_t>(place_of_node_[node]); }

  const Part& part_;
  std::size_t nodes_of_element_, corners_of_element_;
  std::vector<std::int32_t> corners_, place_of_node_;
  /// One over the third root of the volume round each node, or over the square root of an area.
  std::vector<double> scale_;
  std::vector<std::int32_t> batch_of_law_;
  std::int32_t batches_ = 0;
};

/// The strains of a solution, and polynomials fitted to them.
struct Smoothing {
  const Part& part;
  const BodyState& state;
  const Patches& patches;
  const PatchFits& fits;
  std::size_t set;                     ///< of the fits
  std::span<const double> mean_trace;  ///< elements: tr ε where that is even in an element
  std::span<const double> free_strain;
};

/// Puts ∫ ½ (τ(ε) − τ(ε*)) : (ε − ε*) of every element of a batch into `energy`, of which each has an entry.
using ErrorLoop = void (*)(const Smoothing& of, std::int32_t batch, std::span<double> energy);

/// One element and one point after the other: any type.
void reference_errors(const Smoothing& of, std::int32_t batch, std::span<double> energy);
/// Some elements abreast: tetrahedra and hexahedra. 1.1 µs a tet10 against 3.1, 1.5 µs a hex8 against 4.4.
void batched_errors(const Smoothing& of, std::int32_t batch, std::span<double> energy);
/// The fastest there is.
ErrorLoop error_loop(ElementType type);

/// Takes one batch of materials after the other.
class StressRecovery {
 public:
  StressRecovery(const Part& part, const Patches& patches);
  /// What the fits have of stress, in that set. Collective.
  void take(const PatchFits& fits, std::size_t set, std::int32_t batch);
  /// To be called last. Collective.
  NodalStress result();

 private:
  void take(std::size_t node, const Patches::Values& stress);
  /// Ranks that have a middle but no element of this material there hear of it from the others.
  void take_middles(const PatchFits& fits, std::size_t set, std::int32_t batch);

  const Part& part_;
  const Patches& patches_;
  std::vector<double> seen_;
  NodalStress out_;
};

/// The batch of every law of the part, from 0 on: no two laws of a batch share a node, on any rank. Greedy in
/// the order of the laws, the same on every rank. Collective.
std::vector<std::int32_t> law_batches(const Part& part);

}  // namespace kacanov
