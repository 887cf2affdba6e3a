// What theorems name, in other units.
#include <cmath>
#include <set>
#include <string>

#include "design/final_error.h"
#include "design/plant_scaling.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// "L_d" of "L_d/1".
std::string base_of(const std::string& name) { return name.substr(0, name.find('/')); }

bool is_etienne2019(const Theorem& theorem) { return theorem.name().rfind("etienne2019", 0) == 0; }

/// Values on their way from units that differ by a scaling.
class Unscaling {
 public:
  Unscaling(const Theorem& theorem, const NamedMatrices& values, const PlantScaling& scaling)
      : theorem_(theorem),
        scaling_(scaling),
        from_x_(scaling.state.cwiseInverse()),
        from_y_(scaling.output.cwiseInverse()),
        level_(level(values)) {}

  Eigen::MatrixXd unscaled(const std::string& name, const Eigen::MatrixXd& value) const {
    const std::string base = base_of(name);
    const double time = scaling_.time;
    const bool acts_at_samples = theorem_.observer_types().front() == "ConstantGainObserver";
    if (is_rate(base)) return value / time;
    if (base == "gamma") return gamma_unit() * value;
    if (base == "noise_size" || base == kNoise) return unit_of_noise() * value;
    if (base == "disturbance_size" || base == kDisturbance) return scaling_.disturbance * value;
    if (base == "chi") {
      return value * (level_ / (time * scaling_.nonlinearity * scaling_.nonlinearity));
    }
    if (base == "flow_part") return form_of_flow(value);
    if (base == "jump_part" || base == "jump_parts") return form_of_jump(value, output_of(name));
    if (base == "P_constant" || base == "P_most" || base == "P_after") {
      return form_of_state(level_, value);
    }
    if (base == "P" || base == "P1" || base == "Q" || base == "metric" || base == "projection") {
      return form_of_state(level_, value);
    }
    if (base == "P_largest") return level_ * value;
    if (base == "P_rest") return form_of_state(level_, value);
    if (base == "P_measured") {
      return level_ * (from_y_.asDiagonal() * value * from_y_.asDiagonal());
    }
    if (base == "nu") {
      const double y = scaling_.sampled.empty() ? unit_of_noise() : output_of(name)(0);
      return level_ * value / (y * y);
    }
    if (base == "timers") return time * value;
    if (base == "K" && has_norm_of_noise(theorem_)) return gain(1.0, value, output_of(name));
    if (base == "Z" && has_norm_of_noise(theorem_)) {
      const Eigen::VectorXd from = output_of(name).cwiseInverse();
      return level_ * (from.asDiagonal() * value * from.asDiagonal());
    }
    if (base == "S") return form_of_output_at_switches(value);
    if (base == "P2") return level_ * (from_y_.asDiagonal() * value * from_y_.asDiagonal());
    if (base == "L") return gain(acts_at_samples ? 1.0 : time, value, output_of(name));
    if (base == "L_c") return gain(time, value, scaling_.continuous_output);
    if (base == "L_d") return gain(1.0, value, scaling_.jump_output);
    if (base == "H") {
      const Eigen::VectorXd y = output_of(name);
      return (y.asDiagonal() * value * y.cwiseInverse().asDiagonal()) / time;
    }
    return is_etienne2019(theorem_) ? multiplier_of_etienne2019(base, value) : value;
  }

 private:
  /// Of outputs whose unit is one: those that are sampled, or else measured at jumps.
  double unit_of_noise() const {
    return scaling_.output.size() > 0 ? scaling_.output(0) : scaling_.jump_output(0);
  }
  /// What V is measured in. With P > I, the least eigenvalue of P stays as it is, as it does by
  /// itself where all states have one factor; where multiples of V are all the same, flows of V are
  /// to be compared with |y_p|².
  double level(const NamedMatrices& values) const {
    if (!has_norm_of_state(theorem_)) {
      return scaling_.time * scaling_.performance * scaling_.performance;
    }
    const Eigen::VectorXd& x = scaling_.state;
    const bool is_uniform = (x.array() == x(0)).all();
    const auto P = values.find("P");
    if (is_uniform || P == values.end()) return x(0) * x(0);
    return min_eigenvalue(P->second) / min_eigenvalue(form_of_state(1.0, P->second));
  }

  /// Of the state, or of the state and all outputs.
  Eigen::MatrixXd form_of_state(double factor, const Eigen::MatrixXd& value) const {
    if (value.rows() == from_x_.size()) {
      return factor * (from_x_.asDiagonal() * value * from_x_.asDiagonal());
    }
    Eigen::VectorXd from(from_x_.size() + from_y_.size());
    from << from_x_, from_y_;
    return factor * (from.asDiagonal() * value * from.asDiagonal());
  }

  /// Of the error, and of more that is in these units: one over all.
  Eigen::MatrixXd form_of_error(double factor, const Eigen::MatrixXd& value,
                                const Eigen::VectorXd& beside) const {
    const Eigen::Index n = from_x_.size();
    Eigen::VectorXd from(value.rows());
    from.head(n) = from_x_;
    if (value.rows() > n + beside.size()) from.segment(n, from_y_.size()) = from_y_;
    from.tail(beside.size()) = beside;
    return factor * (from.asDiagonal() * value * from.asDiagonal());
  }

  /// In (e, φ, w).
  Eigen::MatrixXd form_of_flow(const Eigen::MatrixXd& value) const {
    const bool has_outputs = theorem_.observer_types().front() != "ConstantGainObserver";
    const Eigen::Index size = from_x_.size() + (has_outputs ? from_y_.size() : 0);
    Eigen::VectorXd beside =
        Eigen::VectorXd::Constant(value.rows() - size, 1.0 / scaling_.disturbance);
    beside.head(scaling_.nonlinearities).setConstant(1.0 / scaling_.nonlinearity);
    return form_of_error(level_ / scaling_.time, value, beside);
  }

  /// In (e, η).
  Eigen::MatrixXd form_of_jump(const Eigen::MatrixXd& value, const Eigen::VectorXd& output) const {
    return form_of_error(level_, value, output.cwiseInverse());
  }

  /// The units of the outputs of the sensor that a name "L/gps" ends in, or has in its middle; of
  /// all where it has none.
  Eigen::VectorXd output_of(const std::string& name) const {
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos) return scaling_.output;
    const std::string sensor = name.substr(slash + 1, name.find('/', slash + 1) - slash - 1);
    for (const SampledOutputs& outputs : scaling_.sampled) {
      if (outputs.sensor == sensor) return scaling_.output.segment(outputs.first, outputs.rows);
    }
    return scaling_.output;
  }

  Eigen::MatrixXd form_of_output_at_switches(const Eigen::MatrixXd& value) const {
    const bool is_at_jumps = scaling_.jump_output.size() > 0;
    const Eigen::VectorXd from_y =
        (is_at_jumps ? scaling_.jump_output : scaling_.continuous_output).cwiseInverse();
    return level_ * (from_y.asDiagonal() * value * from_y.asDiagonal());
  }

  Eigen::MatrixXd gain(double time, const Eigen::MatrixXd& value,
                       const Eigen::VectorXd& output) const {
    return (scaling_.state.asDiagonal() * value * output.cwiseInverse().asDiagonal()) / time;
  }

  /// Of the signal that gamma is the gain from: w, or L σ + N w, or the two by their sizes.
  double gamma_unit() const {
    if (!is_etienne2019(theorem_)) return scaling_.performance / scaling_.disturbance;
    const double by_sizes = std::sqrt(level_ / scaling_.time);
    if (theorem_.name() == "etienne2019_proposition2_channels") return by_sizes;
    return by_sizes * scaling_.time / scaling_.state.minCoeff();
  }

  /// Of forms in the error, its derivative, what is held of it, and the signals.
  Eigen::MatrixXd multiplier_of_etienne2019(const std::string& base,
                                            const Eigen::MatrixXd& value) const {
    if (base == "X") return form_of_state(level_ / scaling_.time, value);
    if (base == "Y" || base == "G" || base == "G_1" || base == "G_3") {
      return form_of_state(level_, value);
    }
    if (base == "G_2") return form_of_state(level_ * scaling_.time, value);
    if (base != "G_4" && base != "G_5") return value;
    if (theorem_.name() == "etienne2019_proposition2_channels") {
      return level_ * (from_x_.asDiagonal() * value);
    }
    return form_of_state(level_ * scaling_.time, value);
  }

  const Theorem& theorem_;
  const PlantScaling& scaling_;
  Eigen::VectorXd from_x_;
  Eigen::VectorXd from_y_;
  double level_;
};

}  // namespace

bool is_rate(const std::string& name) {
  static const std::set<std::string> all = {"a",   "alpha",      "decay",       "delta",
                                            "ell", "flow_decay", "flow_growth", "lambda_t"};
  return all.count(name) > 0;
}

bool has_norm_of_state(const Theorem& theorem) {
  return theorem.name().rfind("etienne2019_proposition2", 0) == 0;
}

bool has_norm_of_noise(const Theorem& theorem) {
  return theorem.name().rfind("timer_dependent", 0) == 0;
}

bool has_conditions_for_units(const Theorem& theorem) {
  return has_norm_of_state(theorem) || theorem.name().rfind("bernard2022_example4_2", 0) == 0 ||
         theorem.name().rfind("bernard2022_corollary4_1", 0) == 0;
}

Parameters scaled(const Theorem& theorem, const Parameters& parameters,
                  const PlantScaling& scaling) {
  NamedMatrices values;
  for (const auto& [name, value] : parameters) values[name] = scalar_matrix(value);
  Parameters result;
  for (const auto& [name, value] : scaled(theorem, values, scaling)) result[name] = value(0, 0);
  return result;
}

double gain_unit(const std::string& gain, const PlantScaling& scaling) {
  const bool is_continuous = base_of(gain) == "L_c";
  const Eigen::VectorXd& output = is_continuous ? scaling.continuous_output : scaling.output;
  return scaling.state(0) / (output(0) * scaling.time);
}

NamedMatrices scaled(const Theorem& theorem, const NamedMatrices& values,
                     const PlantScaling& scaling) {
  return unscaled(theorem, values, inverse_of(scaling));
}

NamedMatrices unscaled(const Theorem& theorem, const NamedMatrices& values,
                       const PlantScaling& scaling) {
  const Unscaling units(theorem, values, scaling);
  NamedMatrices result;
  for (const auto& [name, value] : values) result[name] = units.unscaled(name, value);
  return result;
}

}  // namespace sampled_data_observers
