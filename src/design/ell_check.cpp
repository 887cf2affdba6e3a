#include "design/ell_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "design/high_gain_error.h"
#include "design/mode_coordinates.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

using Vector = Eigen::VectorXd;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Of the states' scales: what counts as the same state.
constexpr double kSame = 1e-6;
/// δ is looked at from its largest value down over so many decades, so many times a decade.
constexpr int kDecades = 5;
constexpr int kPerDecade = 12;
constexpr double kLargestFactor = 1000.0;
constexpr double kScanFactor = 1.25;

class EllSearch {
 public:
  EllSearch(const TransformedHighGainObserver& law, std::size_t mode, std::size_t count)
      : coordinates_(law, mode), scales_(law.saturation().scales()) {
    check_.mode = law.plant().modes()[mode].label;
    check_.ell = law.settings().ell;
    check_.points = count;
    const Eigen::Index d = coordinates_.d();
    Vector low = Vector::Constant(d, kInfinity);
    Vector high = -low;
    for (const Vector& x : points_of_box(law, count)) {
      const double value = coordinates_.phi(x);
      if (std::isfinite(value)) largest_ = std::max(largest_, std::abs(value));
      const Vector image = coordinates_.state_of(coordinates_.T(x));
      const Vector again = coordinates_.state_of(coordinates_.T(image));
      if (law.is_saturated(image.data()) || !is_same(image, again)) continue;
      regular_.push_back(image);
      const Vector z = coordinates_.T(image);
      low = low.cwiseMin(z);
      high = high.cwiseMax(z);
    }
    check_.regular = regular_.size();
    scales_of_z_ = (0.5 * (high - low)).cwiseMax(1e-12);
  }

  /// @param dwell_time  [s]; nothing where jumps are not asked for
  EllCheck run(std::optional<double> dwell_time) {
    find_slopes();
    if (dwell_time && !regular_.empty()) find_ell_for_jumps(*dwell_time);
    const auto found = second_equilibria(check_.ell);
    check_.points_with_second = found.size();
    double farthest = -1.0;
    for (const SecondEquilibrium& candidate : found) {
      const double distance = (candidate.x - candidate.x_hat).cwiseQuotient(scales_).norm();
      if (!(distance > farthest)) continue;
      farthest = distance;
      check_.second = candidate;
    }
    if (!regular_.empty()) check_.least_ell = least_ell();
    return check_;
  }

 private:
  bool is_same(const Vector& a, const Vector& b) const {
    return (a - b).cwiseQuotient(scales_).cwiseAbs().maxCoeff() <= kSame;
  }

  void find_slopes() {
    const Eigen::Index d = coordinates_.d();
    check_.slopes = Vector::Zero(d);
    Vector errors = Vector::Zero(d + 1);
    Vector sizes = Vector::Constant(d + 1, 1e-300);
    for (const Vector& x : regular_) {
      const Vector z = coordinates_.T(x);
      const Vector slopes = coordinates_.gradient(z, scales_of_z_).cwiseAbs();
      for (Eigen::Index i = 0; i < d; ++i) {
        // A slope that is no number is larger than any.
        check_.slopes(i) =
            std::max(check_.slopes(i), std::isfinite(slopes(i)) ? slopes(i) : kInfinity);
      }
      errors = errors.cwiseMax(coordinates_.derivative_errors(x).cwiseAbs());
      sizes.head(d) = sizes.head(d).cwiseMax(z.cwiseAbs());
      sizes(d) = std::max(sizes(d), std::abs(coordinates_.phi(x)));
    }
    check_.derivative_errors = errors.cwiseQuotient(sizes);
    check_.sufficient_ell = HighGainError(coordinates_.K(), check_.slopes).sufficient_ell();
  }

  void find_ell_for_jumps(double dwell_time) {
    std::vector<Eigen::MatrixXd> jumps;
    for (const Vector& x : regular_) {
      jumps.push_back(coordinates_.jump_gradient(coordinates_.T(x), scales_of_z_));
    }
    const HighGainError error(coordinates_.K(), check_.slopes);
    check_.dwell_time = dwell_time;
    check_.ell_for_jumps = error.ell_for_jumps(jumps, dwell_time);
    check_.jump_growth = error.growth(jumps, check_.ell);
  }

  std::vector<SecondEquilibrium> second_equilibria(double ell) const {
    std::vector<SecondEquilibrium> found;
    for (const Vector& x : regular_) {
      if (auto second = second_equilibrium(x, ell)) found.push_back(std::move(*second));
    }
    return found;
  }

  /// The error that stays for δ = 1.
  Vector direction(double ell) const {
    const Vector& K = coordinates_.K();
    const Eigen::Index d = K.size();
    Vector v(d);
    v(0) = 1.0 / (K(d - 1) * std::pow(ell, static_cast<double>(d)));
    for (Eigen::Index i = 1; i < d; ++i)
      v(i) = K(i - 1) * std::pow(ell, static_cast<double>(i)) * v(0);
    return v;
  }

  std::optional<SecondEquilibrium> second_equilibrium(const Vector& x, double ell) const {
    const Vector z = coordinates_.T(x);
    const Vector v = direction(ell);
    const double here = coordinates_.phi(x);
    const auto excess = [&](double delta) {
      return coordinates_.phi_of(z + delta * v) - here - delta;
    };
    const double largest = 2.0 * largest_;
    for (const double sign : {-1.0, 1.0}) {
      double outer = sign * largest * 1.01;
      double at_outer = excess(outer);
      for (int k = 1; k <= kDecades * kPerDecade; ++k) {
        const double inner = sign * largest * std::pow(10.0, -static_cast<double>(k) / kPerDecade);
        const double at_inner = excess(inner);
        if (at_outer * at_inner <= 0.0) {
          if (auto second = refined(x, z, v, ell, excess, inner, at_inner, outer)) return second;
        }
        outer = inner;
        at_outer = at_inner;
      }
    }
    return std::nullopt;
  }

  /// Of a change of sign: where it is an equilibrium, not a step of Φ, and holds ẑ.
  template <class Excess>
  std::optional<SecondEquilibrium> refined(const Vector& x, const Vector& z, const Vector& v,
                                           double ell, const Excess& excess, double inner,
                                           double at_inner, double outer) const {
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (inner + outer);
      const double value = excess(middle);
      if ((value > 0.0) == (at_inner > 0.0)) {
        inner = middle;
      } else {
        outer = middle;
      }
    }
    if (!(std::abs(excess(outer)) <= 1e-6 * largest_)) return std::nullopt;
    const Vector z_hat = z + outer * v;
    const Vector x_hat = coordinates_.state_of(z_hat);
    if (is_same(x, x_hat) || !is_stable(z_hat, ell)) return std::nullopt;
    return SecondEquilibrium{x, x_hat, z_hat};
  }

  bool is_stable(const Vector& z_hat, double ell) const {
    const Eigen::Index d = z_hat.size();
    Vector scaled = coordinates_.K();
    for (Eigen::Index i = 0; i < d; ++i) scaled(i) *= std::pow(ell, static_cast<double>(i + 1));
    Eigen::MatrixXd M = closed_loop_of(scaled);
    M.row(d - 1) += coordinates_.gradient(z_hat, scales_of_z_).transpose();
    return M.allFinite() && eigenvalues_of(M).real().maxCoeff() < 0.0;
  }

  bool is_free_of_second(double ell) const {
    return std::none_of(regular_.begin(), regular_.end(),
                        [&](const Vector& x) { return second_equilibrium(x, ell).has_value(); });
  }

  std::optional<double> least_ell() const {
    double free = check_.ell;
    if (is_free_of_second(free)) {
      double next = free / kScanFactor;
      while (next > check_.ell / kLargestFactor && is_free_of_second(next)) {
        free = next;
        next /= kScanFactor;
      }
      if (next <= check_.ell / kLargestFactor) return free;
    } else {
      do {
        free *= kScanFactor;
        if (free > kLargestFactor * check_.ell) return std::nullopt;
      } while (!is_free_of_second(free));
    }
    double bad = free / kScanFactor;
    while (free > 1.05 * bad) {
      const double middle = std::sqrt(free * bad);
      (is_free_of_second(middle) ? free : bad) = middle;
    }
    return free;
  }

  ModeCoordinates coordinates_;
  Vector scales_;
  Vector scales_of_z_;
  std::vector<Vector> regular_;
  /// Largest |Φ| on the box
  double largest_ = 0.0;
  EllCheck check_;
};

}  // namespace

EllCheck check_ell(const TransformedHighGainObserver& law, std::size_t mode, std::size_t points,
                   std::optional<double> dwell_time) {
  const bool is_alone = law.plant().jumps() && !law.plant().switches();
  if (dwell_time && !is_alone) {
    throw std::invalid_argument("a dwell time is for plants that jump and do not switch");
  }
  return EllSearch(law, mode, points).run(dwell_time);
}

}  // namespace sampled_data_observers
