#include "design/observability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

using Complex = std::complex<double>;

/// What is smaller than this, relative to the matrix, is zero but for rounding.
constexpr double kZero = 1e-11;
/// An eigenvalue of multiplicity 3 is computed to the cube root of the precision.
constexpr double kSameEigenvalue = 1e-5;
/// The mean of eigenvalues that belong together is computed much better than each.
constexpr double kSamePart = 1e-9;

Eigen::MatrixXd with_unit_rows(const Eigen::MatrixXd& C) {
  Eigen::MatrixXd result = C;
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    const double norm = C.row(i).norm();
    if (norm > 0.0) result.row(i) /= norm;
  }
  return result;
}

Eigen::MatrixXd null_space_to_rounding(const Eigen::MatrixXd& a) {
  if (a.rows() == 0) return Eigen::MatrixXd::Identity(a.cols(), a.cols());
  const Eigen::Index rank = (singular_values(a).array() > kZero).count();
  return weakest_directions(a, a.cols() - rank);
}

/// The states that C x, C A x, …, C A^(k−1) x don't show, for k = 1, 2, … until they don't change.
/// C has rows of about unit norm: what is zero is judged absolutely.
std::vector<Eigen::MatrixXd> unseen_subspaces(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C) {
  const double scale = norm2(A);
  std::vector<Eigen::MatrixXd> unseen = {null_space_to_rounding(C)};
  while (unseen.back().cols() > 0 && scale > 0.0) {
    const Eigen::MatrixXd& N = unseen.back();
    const Eigen::MatrixXd moved = A * N / scale;
    const Eigen::MatrixXd kept = null_space_to_rounding(moved - N * (N.transpose() * moved));
    if (kept.cols() == N.cols()) break;
    unseen.push_back(N * kept);
  }
  return unseen;
}

double rounded(double part, double scale) {
  return std::abs(part) <= kSamePart * scale ? 0.0 : part;
}

/// The modes of `A`, which acts on the columns of `basis`.
std::vector<Mode> modes_in(const Eigen::MatrixXd& A, const Eigen::MatrixXd& basis) {
  const Eigen::Index d = A.rows();
  if (d == 0) return {};
  const double scale = norm2(A);
  const Eigen::VectorXcd computed = eigenvalues_of(A);
  std::vector<Complex> upper;
  for (Eigen::Index i = 0; i < d; ++i) {
    // Those near the real axis may be a real one of higher multiplicity.
    if (computed(i).imag() >= -kSameEigenvalue * scale) upper.push_back(computed(i));
  }
  std::vector<bool> taken(upper.size(), false);
  std::vector<Mode> modes;
  for (std::size_t i = 0; i < upper.size(); ++i) {
    if (taken[i]) continue;
    taken[i] = true;
    std::vector<Complex> same = {upper[i]};
    for (std::size_t k = 0; k < same.size(); ++k) {
      for (std::size_t j = 0; j < upper.size(); ++j) {
        if (taken[j] || std::abs(upper[j] - same[k]) > kSameEigenvalue * scale) continue;
        taken[j] = true;
        same.push_back(upper[j]);
      }
    }
    Complex mean = 0.0;
    for (const Complex& eigenvalue : same) mean += eigenvalue / static_cast<double>(same.size());
    const double a = rounded(mean.real(), scale);
    const double b = rounded(mean.imag(), scale);
    const Eigen::MatrixXd shifted = A - a * Eigen::MatrixXd::Identity(d, d);
    const Eigen::MatrixXd factor =
        b == 0.0 ? shifted
                 : Eigen::MatrixXd(shifted * shifted + b * b * Eigen::MatrixXd::Identity(d, d));
    Eigen::MatrixXd power = factor;
    for (std::size_t k = 1; k < same.size(); ++k) power = power * factor;
    const auto dimension = static_cast<Eigen::Index>(same.size()) * (b == 0.0 ? 1 : 2);
    modes.push_back({{a, b}, basis * weakest_directions(power, std::min(dimension, d))});
  }
  std::sort(modes.begin(), modes.end(), [](const Mode& first, const Mode& second) {
    return first.eigenvalue.real() > second.eigenvalue.real();
  });
  return modes;
}

struct ModeGroup {
  double real_part = 0.0;
  std::vector<const Mode*> modes;
};

std::vector<ModeGroup> by_real_part(const std::vector<Mode>& modes, double scale) {
  std::vector<ModeGroup> groups;
  for (const Mode& mode : modes) {
    const double a = mode.eigenvalue.real();
    if (groups.empty() || std::abs(groups.back().real_part - a) > kSamePart * scale) {
      groups.push_back({a, {}});
    }
    groups.back().modes.push_back(&mode);
  }
  return groups;
}

/// Differences > 0 of the imaginary parts of a group's eigenvalues.
std::vector<double> differences(const ModeGroup& group, double scale) {
  std::vector<double> parts;
  for (const Mode* mode : group.modes) {
    parts.push_back(mode->eigenvalue.imag());
    if (mode->eigenvalue.imag() > 0.0) parts.push_back(-mode->eigenvalue.imag());
  }
  std::vector<double> result;
  for (const double first : parts) {
    for (const double second : parts) {
      if (first - second > kSamePart * scale) result.push_back(first - second);
    }
  }
  return result;
}

/// What acts on the states that a group moves, with the decay taken out, and what is seen of them.
struct GroupPlant {
  Eigen::MatrixXd A;
  Eigen::MatrixXd C;
  Eigen::MatrixXd directions;
};

GroupPlant restricted_to(const ModeGroup& group, const Eigen::MatrixXd& A,
                         const Eigen::MatrixXd& C) {
  Eigen::Index d = 0;
  for (const Mode* mode : group.modes) d += mode->directions.cols();
  GroupPlant plant{Eigen::MatrixXd::Zero(d, d), Eigen::MatrixXd(C.rows(), d),
                   Eigen::MatrixXd(A.rows(), d)};
  Eigen::Index at = 0;
  for (const Mode* mode : group.modes) {
    const Eigen::MatrixXd& D = mode->directions;
    plant.A.block(at, at, D.cols(), D.cols()) = D.transpose() * A * D;
    plant.C.middleCols(at, D.cols()) = C * D;
    plant.directions.middleCols(at, D.cols()) = D;
    at += D.cols();
  }
  plant.A -= group.real_part * Eigen::MatrixXd::Identity(d, d);
  return plant;
}

}  // namespace

bool Mode::decays(TimeDomain domain) const {
  if (domain == TimeDomain::kContinuous) return eigenvalue.real() < 0.0;
  return std::abs(eigenvalue) < 1.0 - kSamePart;
}

std::vector<Mode> modes_of(const Eigen::MatrixXd& A) {
  return modes_in(A, Eigen::MatrixXd::Identity(A.rows(), A.rows()));
}

std::vector<Mode> unseen_modes(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C) {
  const Eigen::MatrixXd N = unseen_subspaces(A, with_unit_rows(C)).back();
  return modes_in(N.transpose() * A * N, N);
}

bool is_detectable(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, TimeDomain domain) {
  const std::vector<Mode> unseen = unseen_modes(A, C);
  return std::all_of(unseen.begin(), unseen.end(),
                     [domain](const Mode& mode) { return mode.decays(domain); });
}

double detectability_margin(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, TimeDomain domain) {
  const Eigen::Index n = A.rows();
  double margin = std::numeric_limits<double>::infinity();
  for (const Mode& mode : modes_of(A)) {
    if (mode.decays(domain)) continue;
    const double a = mode.eigenvalue.real();
    const double b = mode.eigenvalue.imag();
    // A complex matrix X + iY has the singular values of [X −Y; Y X], each twice.
    Eigen::MatrixXd pencil = Eigen::MatrixXd::Zero(2 * (n + C.rows()), 2 * n);
    pencil.topLeftCorner(n, n) = A - a * Eigen::MatrixXd::Identity(n, n);
    pencil.block(0, n, n, n) = b * Eigen::MatrixXd::Identity(n, n);
    pencil.block(n, 0, n, n) = -b * Eigen::MatrixXd::Identity(n, n);
    pencil.block(n, n, n, n) = pencil.topLeftCorner(n, n);
    pencil.block(2 * n, 0, C.rows(), n) = C;
    pencil.block(2 * n + C.rows(), n, C.rows(), n) = C;
    margin = std::min(margin, singular_values(pencil)(2 * n - 1));
  }
  return margin;
}

std::optional<int> observability_order(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C) {
  const std::vector<Eigen::MatrixXd> unseen = unseen_subspaces(A, with_unit_rows(C));
  if (unseen.back().cols() > 0) return std::nullopt;
  return static_cast<int>(unseen.size());
}

double sampled_observability(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, double tau) {
  const Eigen::Index n = A.rows();
  const Eigen::Index seen = n - unseen_subspaces(A, with_unit_rows(C)).back().cols();
  if (seen == 0) return 0.0;
  const Eigen::MatrixXd F = exponential_of(A * tau);
  Eigen::MatrixXd matrix(C.rows() * n, n);
  Eigen::MatrixXd block = C;
  for (Eigen::Index k = 0; k < n; ++k) {
    matrix.middleRows(k * C.rows(), C.rows()) = block;
    block = block * F;
  }
  return singular_values(matrix)(seen - 1);
}

std::vector<PathologicalInterval> pathological_intervals(const Eigen::MatrixXd& A,
                                                         const Eigen::MatrixXd& C, double longest) {
  constexpr std::size_t kMost = 1000;
  const double scale = norm2(A);
  const std::vector<Mode> modes = modes_of(A);
  std::vector<PathologicalInterval> found;
  for (const ModeGroup& group : by_real_part(modes, scale)) {
    const GroupPlant plant = restricted_to(group, A, with_unit_rows(C));
    const Eigen::Index unseen_anyway = unseen_subspaces(plant.A, plant.C).back().cols();
    std::vector<double> candidates;
    for (const double difference : differences(group, scale)) {
      const double beat = 2.0 * std::acos(-1.0) / difference;
      for (std::size_t k = 1; k <= kMost && static_cast<double>(k) * beat <= longest; ++k) {
        candidates.push_back(static_cast<double>(k) * beat);
      }
    }
    std::sort(candidates.begin(), candidates.end());
    double last = 0.0;
    for (const double tau : candidates) {
      if (tau - last <= kSamePart * tau) continue;
      last = tau;
      const Eigen::MatrixXd unseen =
          unseen_subspaces(exponential_of(plant.A * tau), plant.C).back();
      if (unseen.cols() <= unseen_anyway) continue;
      found.push_back({tau, plant.directions * unseen, group.real_part < 0.0});
    }
  }
  std::sort(found.begin(), found.end(),
            [](const PathologicalInterval& first, const PathologicalInterval& second) {
              return first.tau < second.tau;
            });
  if (found.size() > kMost) found.resize(kMost);
  return found;
}

double longest_beat(const Eigen::MatrixXd& A) {
  const double scale = norm2(A);
  const std::vector<Mode> modes = modes_of(A);
  double longest = 0.0;
  for (const ModeGroup& group : by_real_part(modes, scale)) {
    for (const double difference : differences(group, scale)) {
      longest = std::max(longest, 2.0 * std::acos(-1.0) / difference);
    }
  }
  return longest;
}

DiscretePair pair_at_jumps(const Eigen::MatrixXd& A, const Eigen::MatrixXd& A_d,
                           const Eigen::MatrixXd& C_d, double tau) {
  const Eigen::MatrixXd flowed = exponential_of(A * tau);
  return {A_d * flowed, C_d * flowed};
}

}  // namespace sampled_data_observers
