#pragma once

#include <Eigen/Core>
#include <vector>

namespace sampled_data_observers {

/// f(t) = t^p/p! e^{σt} cos(ωt), or with sin: the scalar functions of which e^{At} is made, one for
/// each eigenvalue σ ± iω and each power below its multiplicity.
struct ModeFunction {
  int power = 0;
  double rate = 0.0;       ///< σ
  double frequency = 0.0;  ///< ω >= 0
  bool is_sine = false;    ///< only with ω > 0

  double at(double t) const;

  struct Extrema {
    double min = 0.0;
    double max = 0.0;
  };
  /// Over [low, high], 0 <= low: among the ends and the zeros of the derivative, of which only
  /// those next to the maximum of the envelope can count.
  Extrema extrema(double low, double high) const;
};

/// Σ R_j f_j(t/scale) = e^{At}, ferrante2016 (42) in real form: the residue matrices R_j of
/// (sI − A)⁻¹, for eigenvalues of any multiplicity.
struct ResidueExpansion {
  std::vector<ModeFunction> functions;
  std::vector<Eigen::MatrixXd> residues;
  double scale = 1.0;  ///< [s]

  Eigen::MatrixXd at(double t) const;
};

/// @param low, high  where the expansion is compared with e^{At} [s]
/// @throws std::runtime_error for eigenvalues so close or so far apart that it loses more than 1e-6
/// of e^{At}.
ResidueExpansion residue_expansion(const Eigen::MatrixXd& A, double low, double high);

/// Matrices of whose convex hull e^{Aτ} is part for all τ in [low, high] [s], ferrante2016 (43):
/// one for each choice of least and largest values of the scalar functions. Functions that are
/// constant on the interval or have no residue add none.
/// @throws std::runtime_error as residue_expansion(), where there are more than `max_vertices`, and
/// where e^{Aτ} overflows.
std::vector<Eigen::MatrixXd> polytopic_embedding(const Eigen::MatrixXd& A, double low, double high,
                                                 std::size_t max_vertices = 256);

}  // namespace sampled_data_observers
