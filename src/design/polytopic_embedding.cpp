#include "design/polytopic_embedding.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

using Complex = std::complex<double>;

constexpr double kNegligible = 1e-9;
constexpr double kLargestLoss = 1e-6;
/// How close eigenvalues are taken as one, relative to the norm: rounding splits one of
/// multiplicity k by about 1e-16^(1/k).
constexpr double kTolerances[] = {1e-12, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3};

struct Eigenvalue {
  Complex value;
  int multiplicity = 0;
};

/// The distinct eigenvalues with Im >= 0; none where those found are not the eigenvalues of a real
/// matrix.
std::vector<Eigenvalue> distinct_eigenvalues(const Eigen::VectorXcd& all, double tolerance) {
  std::vector<Eigenvalue> distinct;
  for (Eigen::Index i = 0; i < all.size(); ++i) {
    const auto near = std::find_if(distinct.begin(), distinct.end(), [&](const Eigenvalue& known) {
      return std::abs(all(i) - known.value) <= tolerance;
    });
    if (near == distinct.end()) {
      distinct.push_back({all(i), 1});
      continue;
    }
    const double count = near->multiplicity++;
    near->value = (count * near->value + all(i)) / (count + 1.0);
  }
  std::vector<Eigenvalue> upper;
  int covered = 0;
  for (Eigenvalue& eigenvalue : distinct) {
    const bool is_real = std::abs(eigenvalue.value.imag()) <= tolerance;
    if (!is_real && eigenvalue.value.imag() < 0.0) continue;
    if (is_real) eigenvalue.value.imag(0.0);
    covered += (is_real ? 1 : 2) * eigenvalue.multiplicity;
    upper.push_back(eigenvalue);
  }
  if (covered != all.size()) upper.clear();
  return upper;
}

std::vector<ModeFunction> functions_of(const std::vector<Eigenvalue>& eigenvalues) {
  std::vector<ModeFunction> functions;
  for (const Eigenvalue& eigenvalue : eigenvalues) {
    for (int power = 0; power < eigenvalue.multiplicity; ++power) {
      const double frequency = eigenvalue.value.imag();
      functions.push_back({power, eigenvalue.value.real(), frequency, false});
      if (frequency > 0.0) functions.push_back({power, eigenvalue.value.real(), frequency, true});
    }
  }
  return functions;
}

/// The k-th derivative of f at 0: C(k, p) λ^{k−p}, of which f is the real or the imaginary part.
double derivative_at_zero(const ModeFunction& f, int k) {
  if (k < f.power) return 0.0;
  Complex value(1.0, 0.0);
  for (int i = 1; i <= f.power; ++i) value *= static_cast<double>(k - f.power + i) / i;
  for (int i = f.power; i < k; ++i) value *= Complex(f.rate, f.frequency);
  return f.is_sine ? value.imag() : value.real();
}

/// The R_j follow from the derivatives at 0, A^k = Σ f_j^(k)(0) R_j for k < n.
std::vector<Eigen::MatrixXd> residues_of(const std::vector<ModeFunction>& functions,
                                         const Eigen::MatrixXd& A) {
  const Eigen::Index n = A.rows();
  Eigen::MatrixXd derivatives(n, n);
  Eigen::MatrixXd powers(n, n * n);
  Eigen::MatrixXd power = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    for (Eigen::Index j = 0; j < n; ++j) {
      derivatives(k, j) =
          derivative_at_zero(functions[static_cast<std::size_t>(j)], static_cast<int>(k));
    }
    powers.row(k) = Eigen::Map<const Eigen::RowVectorXd>(power.data(), n * n);
    power = power * A;
  }
  const Eigen::MatrixXd solved = solve_linear(derivatives, powers);
  std::vector<Eigen::MatrixXd> residues;
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::VectorXd entries = solved.row(j).transpose();
    residues.emplace_back(Eigen::Map<const Eigen::MatrixXd>(entries.data(), n, n));
  }
  return residues;
}

/// How much of e^{At} the expansion loses, relative to its norm.
double loss(const ResidueExpansion& expansion, const Eigen::MatrixXd& A, double low, double high) {
  double largest = 0.0;
  for (int i = 0; i <= 8; ++i) {
    const double t = low + (high - low) * i / 8.0;
    const Eigen::MatrixXd exact = exponential_of(A * t);
    const Eigen::MatrixXd difference = expansion.at(t) - exact;
    if (!exact.allFinite()) {
      throw std::runtime_error("e^(A tau) overflows at tau = " + std::to_string(t) + " s");
    }
    if (!difference.allFinite()) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, difference.norm() / exact.norm());
  }
  return largest;
}

}  // namespace

Eigen::MatrixXd ResidueExpansion::at(double t) const {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(residues.front().rows(), residues.front().cols());
  for (std::size_t j = 0; j < functions.size(); ++j)
    sum += functions[j].at(t / scale) * residues[j];
  return sum;
}

ResidueExpansion residue_expansion(const Eigen::MatrixXd& A, double low, double high) {
  const double norm = norm2(A);
  const double scale = norm > 0.0 ? 1.0 / norm : 1.0;
  const Eigen::MatrixXd scaled = A * scale;
  const Eigen::VectorXcd eigenvalues = eigenvalues_of(scaled);
  ResidueExpansion best;
  double least_loss = kLargestLoss;
  for (const double tolerance : kTolerances) {
    ResidueExpansion expansion;
    expansion.functions = functions_of(distinct_eigenvalues(eigenvalues, tolerance));
    if (expansion.functions.empty()) continue;
    expansion.scale = scale;
    expansion.residues = residues_of(expansion.functions, scaled);
    const double own_loss = loss(expansion, A, low, high);
    if (!(own_loss < least_loss)) continue;
    least_loss = own_loss;
    best = std::move(expansion);
  }
  if (best.functions.empty()) {
    throw std::runtime_error(
        "e^(A tau) can't be split by eigenvalues: some of A are too close to each other, or too "
        "far "
        "apart, for double precision");
  }
  return best;
}

std::vector<Eigen::MatrixXd> polytopic_embedding(const Eigen::MatrixXd& A, double low, double high,
                                                 std::size_t max_vertices) {
  const ResidueExpansion expansion = residue_expansion(A, low, high);
  std::vector<Eigen::MatrixXd> vertices = {Eigen::MatrixXd::Zero(A.rows(), A.cols())};
  const double whole = std::max(exponential_of(A * low).norm(), exponential_of(A * high).norm());
  for (std::size_t j = 0; j < expansion.functions.size(); ++j) {
    const Eigen::MatrixXd& R = expansion.residues[j];
    const ModeFunction::Extrema range =
        expansion.functions[j].extrema(low / expansion.scale, high / expansion.scale);
    std::vector<double> values = {range.min};
    if ((range.max - range.min) * R.norm() > kNegligible * whole) {
      values.push_back(range.max);
    } else {
      values = {(range.min + range.max) / 2.0};
    }
    if (vertices.size() * values.size() > max_vertices) {
      throw std::runtime_error(
          "the polytopic embedding of e^(A tau) has more than " + std::to_string(max_vertices) +
          " vertices: their number doubles with every state, and so does the time to solve");
    }
    std::vector<Eigen::MatrixXd> more;
    for (const double value : values) {
      for (const Eigen::MatrixXd& vertex : vertices) more.emplace_back(vertex + value * R);
    }
    vertices = std::move(more);
  }
  return vertices;
}

}  // namespace sampled_data_observers
