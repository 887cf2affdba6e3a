#pragma once

#include <Eigen/Core>
#include <memory>

namespace sampled_data_observers {

class AffineMap;

/// A map from a state x and an input u to a vector: a flow map f, a jump map g or an output map h.
///
/// evaluate() allocates nothing and throws nothing; where the map is not defined it gives NaN. A
/// map may keep scratch memory, so that one object serves one thread at a time.
class VectorMap {
 public:
  VectorMap() = default;
  VectorMap(const VectorMap&) = delete;
  VectorMap& operator=(const VectorMap&) = delete;
  virtual ~VectorMap() = default;

  /// Number of entries of the result.
  virtual Eigen::Index size() const = 0;

  /// out ← map(x, u). `out` has size() entries and overlaps neither x nor u.
  virtual void evaluate(const double* x, const double* u, double* out) const = 0;

  /// The map itself where it is affine, else null.
  virtual const AffineMap* affine() const { return nullptr; }

  /// ∂map/∂x as a map of (x, u): size() x n entries, those by the first state first. Null, as it is
  /// by default, where the map does not know it: whoever needs it then takes differences.
  /// @throws std::invalid_argument, or std::length_error, with a message for the user for formulas
  /// that can't be differentiated.
  virtual std::shared_ptr<const VectorMap> jacobian() const;
};

/// M x + N u + c
class AffineMap : public VectorMap {
 public:
  /// @param M  m x n
  /// @param N  m x p; p may be 0
  /// @param c  m
  /// @throws std::invalid_argument for sizes that do not fit or entries that are not finite.
  AffineMap(Eigen::MatrixXd M, Eigen::MatrixXd N, Eigen::VectorXd c);

  /// M x
  explicit AffineMap(const Eigen::MatrixXd& M);

  /// m x n
  const Eigen::MatrixXd& M() const { return M_; }
  /// m x p; without columns where the map has no input
  const Eigen::MatrixXd& N() const { return N_; }
  /// m entries
  const Eigen::VectorXd& c() const { return c_; }

  Eigen::Index size() const override { return M_.rows(); }
  void evaluate(const double* x, const double* u, double* out) const override;
  const AffineMap* affine() const override { return this; }

 private:
  Eigen::MatrixXd M_;
  Eigen::MatrixXd N_;
  Eigen::VectorXd c_;
};

}  // namespace sampled_data_observers
