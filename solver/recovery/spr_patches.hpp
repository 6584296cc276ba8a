// SPDX-License-Identifier: BSD-3-Clause
// Superconvergent patch recovery (Zienkiewicz and Zhu 1992): polynomials fitted to strains around a node, and
// from them nodal stress and the error of the strains.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include <kacanov/element_fields.hpp>
#include <kacanov/model.hpp>
#include <kacanov/discretisation.hpp>
#include <kacanov/part.hpp>

namespace kacanov {

/// Monomials 1, x_i and, for order 2, x_i x_j, in 2D or 3D.
class Monomials {
 public:
  static constexpr std::size_t most = 10;
  Monomials(int dim, int order);
  std::size_t count() const noexcept { return count_; }
  std::size_t linear() const noexcept { return 1 + dim_; }  ///< number of monomials of order 0 and 1
  std::array<double, most> at(const Vector3& x) const {
    std::array<double, most> value{1.0};
    for (std::size_t i = 0; i < dim_; ++i) value[1 + i] = x[i];
    if (!quadratic_) return value;
    std::size_t k = 1 + dim_;
    for (std::size_t i = 0; i < dim_; ++i)
      for (std::size_t j = i; j < dim_; ++j) value[k++] = x[i] * x[j];
    return value;
  }
  /// Calls work(std::integral_constant of count()), so that loops over monomials have constant length.
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

/// Sample positions and values: `sets` of six values each.
struct Samples {
  static constexpr std::size_t values = 6, most_sets = 2;
  std::span<const Vector3> position;
  std::array<const double*, most_sets> set{};  ///< positions × 6
};

/// Moments of samples about the mean of their positions, for fitting linear polynomials around any centre.
struct LinearSums {
  double count = 0.0;
  Vector3 mean{};
  std::array<std::array<double, 3>, 3> square{};  ///< of positions relative to the mean
  std::array<std::array<std::array<double, Samples::values>, 4>, Samples::most_sets> side{};

  LinearSums(const Samples& samples, std::size_t sets);
};

/// Least-squares fits around many centres.
class PatchFits {
 public:
  static constexpr std::size_t values = Samples::values;
  PatchFits(std::size_t centres, const Monomials& monomials, std::size_t sets = 1);

  bool linear() const noexcept { return monomials_.count() == monomials_.linear(); }
  std::size_t sets() const noexcept { return sets_; }
  /// Adds samples to the fit of centre i. `at`: its position; `scale`: 1 / patch size.
  void add(std::size_t i, const Vector3& at, double scale, const Samples& samples);
  /// The same from moments; only if linear().
  void add(std::size_t i, const Vector3& at, double scale, const LinearSums& sums);
  /// Returns the sums of a centre, to be summed over ranks.
  std::span<double> sums(std::size_t centre) noexcept {
    return std::span(sums_).subspan(centre * width_, width_);
  }
  std::size_t width() const noexcept { return width_; }
  /// Whether the centre has any sample.
  bool has(std::size_t centre) const noexcept { return sums_[centre * width_] > 0.0; }
  /// Solves the normal equations of all centres in place. Regularisation keeps undetermined coefficients
  /// small, those of higher order first.
  void solve();
  /// After solve(): returns the coefficients, monomials × 6, of the polynomial of a set.
  const double* coefficients(std::size_t centre, std::size_t set) const noexcept {
    return &sums_[centre * width_ + pairs_ + set * values * monomials_.count()];
  }
  /// Evaluates a polynomial at `x`, relative to the centre and multiplied by the scale.
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
  /// Per centre: upper triangle of the matrix by rows, then the right-hand sides by sets.
  std::vector<double> sums_;
};

/// Superconvergent patch recovery (theory: nodal-stress), one batch of materials at a time: materials of a
/// batch share no node, and each has its own polynomials. Mid-side nodes have no patch.
class Patches {
 public:
  using Values = std::array<double, PatchFits::values>;

  /// Collective.
  explicit Patches(const Part& part);

  std::int32_t batches() const noexcept { return batches_; }
  bool is_in(std::size_t element, std::int32_t batch) const {
    return part_.law_of_element.empty() || batch_of_law_[part_.law_of_element[element]] == batch;
  }
  /// Corner nodes of the elements.
  const std::vector<std::int32_t>& corners() const noexcept { return corners_; }

  /// Returns fits without samples.
  PatchFits fits(std::size_t sets) const;
  /// Adds the samples of an element to the patches of all its corners.
  void add(PatchFits& fits, std::size_t element, const Samples& samples) const;
  /// Sums over the ranks that share a corner, and solves. Collective.
  void solve(PatchFits& fits) const;
  /// Whether the patch of a corner has any sample, on any rank.
  bool has(const PatchFits& fits, std::size_t node) const { return fits.has(place(node)); }
  /// The polynomial of a corner; valid as long as the fits exist.
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
  /// 1 / (volume around each node)^⅓, or in 2D 1 / √area.
  std::vector<double> scale_;
  std::vector<std::int32_t> batch_of_law_;
  std::int32_t batches_ = 0;
};

/// The strains of a solution, and the polynomials fitted to them.
struct Smoothing {
  const Part& part;
  const BodyState& state;
  const Patches& patches;
  const PatchFits& fits;
  std::size_t set;                     ///< index of the set in the fits
  std::span<const double> mean_trace;  ///< per element: tr ε if it is constant in the element
  std::span<const double> free_strain;
};

/// Sets ∫ ½ (τ(ε) − τ(ε*)) : (ε − ε*) of every element of a batch in `energy`, which has one entry per
/// element.
using ErrorLoop = void (*)(const Smoothing& of, std::int32_t batch, std::span<double> energy);

/// Loops over single elements and points, for all element types.
void reference_errors(const Smoothing& of, std::int32_t batch, std::span<double> energy);
/// Loops over batches of tetrahedra and hexahedra: 1.1 µs per tet10 against 3.1, 1.5 µs per hex8 against 4.4.
void batched_errors(const Smoothing& of, std::int32_t batch, std::span<double> energy);
/// Returns the fastest loop for a type.
ErrorLoop error_loop(ElementType type);

/// Nodal stress from patch polynomials, one batch of materials at a time.
class StressRecovery {
 public:
  StressRecovery(const Part& part, const Patches& patches);
  /// Adds the stress from a set of the fits. Collective.
  void take(const PatchFits& fits, std::size_t set, std::int32_t batch);
  /// Returns the result; call it last. Collective.
  NodalStress result();

 private:
  void take(std::size_t node, const Patches::Values& stress);
  /// Exchanges mid-side values with ranks that have the node but no element of this material at it.
  void take_middles(const PatchFits& fits, std::size_t set, std::int32_t batch);

  const Part& part_;
  const Patches& patches_;
  std::vector<double> seen_;
  NodalStress out_;
};

/// Returns the batch of every law of the part, counted from 0: no two laws of a batch share a node on any
/// rank. Greedy colouring in the order of the laws, the same on every rank. Collective.
std::vector<std::int32_t> law_batches(const Part& part);

}  // namespace kacanov
