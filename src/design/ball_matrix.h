#pragma once

#include <Eigen/Core>

#include "design/arb.h"
#include "design/rigorous_check.h"

namespace sampled_data_observers {

/// A real number that is known to lie in a ball: a midpoint and a radius.
class Ball {
 public:
  Ball() { arb_init(value_); }
  Ball(const Ball& other) : Ball() { arb_set(value_, other.value_); }
  Ball(Ball&& other) noexcept : Ball() { arb_swap(value_, other.value_); }
  Ball& operator=(Ball other) noexcept {
    arb_swap(value_, other.value_);
    return *this;
  }
  ~Ball() { arb_clear(value_); }

  arb_ptr get() { return value_; }
  arb_srcptr get() const { return value_; }

 private:
  arb_t value_;
};

/// A matrix of balls. An operation on such matrices gives balls that contain its result for all
/// matrices of numbers in those it was given, whatever the rounding.
class BallMatrix {
 public:
  BallMatrix() : BallMatrix(0, 0) {}
  /// Zeros.
  BallMatrix(Eigen::Index rows, Eigen::Index cols) { arb_mat_init(value_, rows, cols); }
  BallMatrix(const BallMatrix& other) : BallMatrix(other.rows(), other.cols()) {
    arb_mat_set(value_, other.value_);
  }
  BallMatrix(BallMatrix&& other) noexcept : BallMatrix() { arb_mat_swap(value_, other.value_); }
  BallMatrix& operator=(BallMatrix other) noexcept {
    arb_mat_swap(value_, other.value_);
    return *this;
  }
  ~BallMatrix() { arb_mat_clear(value_); }

  Eigen::Index rows() const { return arb_mat_nrows(value_); }
  Eigen::Index cols() const { return arb_mat_ncols(value_); }
  arb_mat_struct* get() { return value_; }
  const arb_mat_struct* get() const { return value_; }
  arb_ptr entry(Eigen::Index i, Eigen::Index j) { return arb_mat_entry(value_, i, j); }
  arb_srcptr entry(Eigen::Index i, Eigen::Index j) const { return arb_mat_entry(value_, i, j); }

 private:
  arb_mat_t value_;
};

/// All numbers of which `value` is the nearest double, `value` among them; zero, and what is not
/// rounded, stands for itself. What is proved for the balls of the numbers read from a file is so
/// proved of the decimals in the file and of the doubles that an observer computes with.
void set_nearest(arb_ptr ball, double value, RoundedNumbers rounded);
BallMatrix nearest_balls(const Eigen::MatrixXd& values, RoundedNumbers rounded);

/// The numbers themselves.
BallMatrix exact_balls(const Eigen::MatrixXd& values);
Eigen::MatrixXd midpoints(const BallMatrix& a);

// In these, `precision` is the number of bits of the midpoints.
BallMatrix sum(const BallMatrix& a, const BallMatrix& b, slong precision);
BallMatrix product(const BallMatrix& a, const BallMatrix& b, slong precision);
BallMatrix scaled(arb_srcptr scalar, const BallMatrix& a, slong precision);
BallMatrix transpose(const BallMatrix& a);
/// Indeterminate where a may be singular.
BallMatrix inverse(const BallMatrix& a, slong precision);
BallMatrix exponential(const BallMatrix& a, slong precision);

/// A number not less than the largest row sum of absolute values.
Ball norm_bound(const BallMatrix& a);

/// Whether the symmetric matrix of which `a` has the lower triangle is certainly positive definite.
bool is_positive_definite(const BallMatrix& a, slong precision);

}  // namespace sampled_data_observers
