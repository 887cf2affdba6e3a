#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"
#include "sampled_data_observers/plant/plant.h"

namespace sampled_data_observers {

/// A number of the plant that is compared with the truth: row · x + constant.
struct Quantity {
  std::string name;
  Eigen::VectorXd row;  ///< n
  bool angular = false;
  double constant = 0.0;

  /// @param x  n entries, as of an estimate
  double value(const double* x) const;
};

/// The state called `name` as a quantity; nothing where there is none.
std::optional<Quantity> state_quantity(const Plant& plant, const std::string& name);

/// An output of a sensor as a quantity, named after the state that it measures, or
/// "sensor[output]"; nothing where its output map is not affine, or depends on inputs.
std::optional<Quantity> output_quantity(const Plant& plant, std::size_t sensor,
                                        Eigen::Index output);

/// Whether an output of a sensor measures the quantity itself.
bool measures(const Plant& plant, std::size_t sensor, Eigen::Index output,
              const Quantity& quantity);

/// The error of the quantity of an estimate x (n entries) against its true value, wrapped where it
/// is an angle.
double error_of(const Quantity& quantity, const double* x, double truth);

/// The bound on the error of a quantity that follows from those on the entries of the state.
double bound_on(const Quantity& quantity, const Eigen::VectorXd& state_bounds);

/// Errors of the estimate and of holding the last sample, against the truth, on the same stamps.
class Comparison {
 public:
  Comparison(std::vector<Quantity> quantities, std::shared_ptr<const Plant> plant);

  const std::vector<Quantity>& quantities() const { return quantities_; }

  /// Takes in the values of a sample, or of a continuous output, that the observer used.
  void add_sample(std::size_t sensor, Stamp stamp, const double* values);

  /// Guaranteed bounds on |truth − x| of the whole state, NaN where there is none, and of each
  /// entry, empty likewise.
  struct Bounds {
    double norm = std::numeric_limits<double>::quiet_NaN();
    Eigen::VectorXd states = {};
  };

  /// What is wrong at one stamp: an entry per quantity, and the norm over all.
  struct Errors {
    std::vector<double> values;   ///< estimate − truth
    std::vector<double> bounds;   ///< on their size (see bound_on()); infinite where there is none
    std::vector<double> of_hold;  ///< last sample − truth; NaN where there is none
    double norm = 0.0;
    double norm_bound = 0.0;  ///< not finite where there is none
  };
  /// @param truth  one value per quantity
  /// @param x      the estimate, n entries
  Errors errors(const std::vector<double>& truth, const double* x, const Bounds& bounds) const;

  /// Compares at one stamp. @param truth one value per quantity @param x the estimate, n entries
  /// Does nothing before each quantity that a sensor measures directly was sampled once, and
  /// returns false then.
  bool add_truth(const std::vector<double>& truth, const double* x, const Bounds& bounds);

  /// Number of stamps compared.
  std::size_t size() const { return size_; }

  /// How many of these had a finite error bound, at how many of them the error of the quantities
  /// was larger than the bound allows, and the largest share of it that the error took.
  struct BoundCheck {
    std::size_t stamps = 0;
    std::size_t exceeded = 0;
    std::optional<double> share;
  };
  const BoundCheck& bound_check() const { return bound_check_; }

  /// The same of each quantity and the bound on itself (see bound_on()).
  const std::vector<BoundCheck>& bound_checks() const { return bound_checks_; }

  /// Root mean squares, one per quantity; nothing where no stamp was compared or, for the held
  /// sample, no sensor measures the quantity directly.
  std::vector<std::optional<double>> rmse() const;
  std::vector<std::optional<double>> hold_rmse() const;

  /// Root of the sum of the squares of all of rmse() or hold_rmse(); nothing where one is missing.
  static std::optional<double> norm(const std::vector<std::optional<double>>& values);

 private:
  /// The newest sample of a quantity, of whichever sensor measures it.
  struct Held {
    bool is_measured = false;
    std::optional<double> value;
    Stamp stamp = 0;
  };

  static void check(double error, double allowed, BoundCheck& check);

  std::vector<Quantity> quantities_;
  std::shared_ptr<const Plant> plant_;
  std::vector<Held> held_;
  std::vector<double> squares_;
  std::vector<double> hold_squares_;
  std::size_t size_ = 0;
  /// The largest norm of the quantities of a state of norm 1.
  double weight_;
  BoundCheck bound_check_;
  std::vector<BoundCheck> bound_checks_;
};

}  // namespace sampled_data_observers
