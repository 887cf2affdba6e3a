#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "certificate/timer_dependent_theorem.h"
#include "certificate/timer_grid.h"
#include "design/methods/methods.h"
#include "design/methods/sampled_plant.h"
#include "design/methods/timer_dependent.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// Gains of an observer x̂⁺ = x̂ + K (y − C x̂): with Y = P⁺ K in place of K, the jump conditions are
/// linear in P and Y, so that one program finds both.
class JumpGainDesign : public LmiDesignMethod {
 public:
  std::vector<DesignParameter> parameters(const CertificateSubject& subject) const override {
    return timer_dependent_parameters(subject);
  }
  std::vector<Objective> objectives(const CertificateSubject& subject) const override {
    return timer_dependent_objectives(subject);
  }
  std::optional<DesignEstimate> estimate(const CertificateSubject& subject,
                                         const Parameters& parameters,
                                         Objective objective) const override {
    return estimate_by_program(subject, parameters, objective);
  }

 protected:
  static LmiProgram program_of(const CertificateSubject& subject, const Parameters& parameters,
                               Objective objective, ErrorSystem (*error)(const CertificateSubject&),
                               const GainProducts& products, LmiProgram program) {
    const TimerDependentFunction function(error(subject), grid_of(subject), shortest_times(subject),
                                          products, subject.falls_at_events);
    require_function(program, function, subject, parameters, objective);
    return program;
  }
};

/// One sensor with a constant gain: P after a sample is always P_0, and K = P_0⁻¹ Y.
class ConstantJumpGain : public JumpGainDesign {
 public:
  std::string name() const override { return "timer_dependent_constant_gain"; }
  std::string summary() const override {
    return "constant gain L of one sensor, by a Lyapunov function that depends on the time since "
           "the last sample";
  }
  const Theorem& theorem() const override { return timer_dependent_theorem(); }

  void require_applicable(const CertificateSubject& subject) const override {
    require_subject(theorem(), subject);
    if (subject.plant.sampled.size() == 1) return;
    throw std::invalid_argument(
        "it is about one sensor; timer_dependent_scheduled_gain and "
        "timer_dependent_alternating_gain are about several");
  }

  LmiProgram program(const CertificateSubject& given, const Parameters& parameters,
                     Objective objective) const override {
    const CertificateSubject subject = timer_dependent_subject(given, parameters, objective);
    const Eigen::Index n = subject.plant.states();
    const Eigen::Index m = subject.plant.C().rows();
    LmiProgram program;
    GainProducts products;
    if (subject.T1 == 0.0) {
      const MatrixExpression Z = program.matrix("Z", m, m);
      products.Z = [value = Z](std::size_t, std::size_t) { return value; };
      const MatrixExpression P_K = transpose(MatrixExpression(subject.plant.C())) * Z;
      products.P_K = [product = P_K](std::size_t, std::size_t) { return product; };
    } else {
      const MatrixExpression Y = program.matrix("Y", n, m);
      products.P_K = [product = Y](std::size_t, std::size_t) { return product; };
    }
    return program_of(subject, parameters, objective, constant_gain_error, products,
                      std::move(program));
  }

 protected:
  NamedMatrices gains(const CertificateSubject& subject, const Parameters&,
                      const NamedMatrices& solution) const override {
    const auto Z = solution.find("Z");
    const Eigen::MatrixXd P_K =
        Z != solution.end() ? subject.plant.C().transpose() * Z->second : solution.at("Y");
    return {{"L", solve_definite(solution.at("P/0"), P_K)}};
  }

 private:
  static const Theorem& timer_dependent_theorem() {
    return *find_theorem("timer_dependent_constant_gain");
  }
};

/// An output at jumps of the plant: P after a jump is always P_0, and L_d = P_0⁻¹ Y.
class GainAtJumps : public JumpGainDesign {
 public:
  std::string name() const override { return "timer_dependent_jump_gain"; }
  std::string summary() const override {
    return "gain L_d at jumps of the plant, by a Lyapunov function that depends on the time since "
           "the last one";
  }
  const Theorem& theorem() const override { return *find_theorem("timer_dependent_synchronized"); }

  void require_applicable(const CertificateSubject& subject) const override {
    require_subject(theorem(), subject);
    if (subject.plant.mode().C_c.rows() == 0) return;
    throw std::invalid_argument(
        "it is about an output at jumps alone, and one in flow is measured");
  }

  LmiProgram program(const CertificateSubject& given, const Parameters& parameters,
                     Objective objective) const override {
    const CertificateSubject subject = timer_dependent_subject(given, parameters, objective);
    LmiProgram program;
    const MatrixExpression Y =
        program.matrix("Y", subject.plant.states(), subject.plant.mode().C_d.rows());
    const GainProducts products = {[product = Y](std::size_t, std::size_t) { return product; }};
    return program_of(subject, parameters, objective, synchronized_error, products,
                      std::move(program));
  }

 protected:
  NamedMatrices gains(const CertificateSubject&, const Parameters&,
                      const NamedMatrices& solution) const override {
    return {{"L_d", solve_definite(solution.at("P/0"), solution.at("Y"))}};
  }
};

/// Gains that are interpolated between nodes of the timers (ScheduledGains).
class ScheduledJumpGain : public JumpGainDesign {
 public:
  std::string name() const override { return "timer_dependent_scheduled_gain"; }
  std::string summary() const override {
    return "gains K that depend on the times since the last sample of each sensor, of one or "
           "several sensors";
  }
  const Theorem& theorem() const override {
    return *find_theorem("timer_dependent_scheduled_gain");
  }

  LmiProgram program(const CertificateSubject& given, const Parameters& parameters,
                     Objective objective) const override {
    const CertificateSubject subject = timer_dependent_subject(given, parameters, objective);
    LmiProgram program;
    GainProducts products;
    const TensorGrid grid = grid_of(subject);
    const std::vector<SampledOutputs> sampled = subject.plant.sampled;
    const Eigen::Index n = subject.plant.states();
    for (std::size_t i = 0; i < sampled.size(); ++i) {
      for (std::size_t node = 0; node < grid.size(); ++node) {
        if (has_Z(subject, grid, i, node)) {
          program.matrix(name_of_Z(sampled[i].sensor, node), sampled[i].rows, sampled[i].rows);
        } else if (is_foreseen(subject, grid, i, node)) {
          program.matrix(product_name(sampled[i].sensor, node), n, sampled[i].rows);
        }
      }
    }
    products.Z = [sampled](std::size_t i, std::size_t node) {
      return symbol(name_of_Z(sampled[i].sensor, node), sampled[i].rows, sampled[i].rows);
    };
    products.P_K = [sampled, n](std::size_t i, std::size_t node) {
      return symbol(product_name(sampled[i].sensor, node), n, sampled[i].rows);
    };
    return program_of(subject, parameters, objective, scheduled_gain_error, products,
                      std::move(program));
  }

  /// The law has nodes and a symmetric P to the bit, as changes of units do not leave them.
  void restore(const CertificateSubject& subject, NamedMatrices& values) const override {
    const TensorGrid grid = grid_of(subject);
    for (std::size_t i = 0; i < subject.plant.sampled.size(); ++i) {
      values["timers/" + subject.plant.sampled[i].sensor] = row_of(grid.nodes(i));
    }
    for (std::size_t node = 0; node < grid.size(); ++node) {
      Eigen::MatrixXd& P = values.at("P/" + std::to_string(node));
      P = Eigen::MatrixXd((P + P.transpose()) / 2.0);
    }
  }

 protected:
  NamedMatrices gains(const CertificateSubject& subject, const Parameters&,
                      const NamedMatrices& solution) const override {
    NamedMatrices values;
    const TensorGrid grid = grid_of(subject);
    const auto P = [](std::size_t node) { return "P/" + std::to_string(node); };
    for (std::size_t node = 0; node < grid.size(); ++node) {
      values[P(node)] = solution.at(P(node));
    }
    for (std::size_t i = 0; i < subject.plant.sampled.size(); ++i) {
      const std::string& sensor = subject.plant.sampled[i].sensor;
      values["timers/" + sensor] = row_of(grid.nodes(i));
      for (std::size_t node = 0; node < grid.size(); ++node) {
        if (has_Z(subject, grid, i, node)) {
          const std::string Z = name_of_Z(sensor, node);
          values[Z] = solution.at(Z);
          continue;
        }
        // Sooner than T1 the gain is the one at T1.
        std::size_t from = node;
        while (!is_foreseen(subject, grid, i, from)) from += grid.stride(i);
        values["K/" + sensor + "/" + std::to_string(node)] = solve_definite(
            solution.at(P(grid.with_first(node, i))), solution.at(product_name(sensor, from)));
      }
    }
    return values;
  }

 private:
  static Eigen::MatrixXd row_of(const std::vector<double>& nodes) {
    return Eigen::Map<const Eigen::RowVectorXd>(nodes.data(),
                                                static_cast<Eigen::Index>(nodes.size()));
  }
  static std::string name_of_Z(const std::string& sensor, std::size_t node) {
    return "Z/" + sensor + "/" + std::to_string(node);
  }
  static std::string product_name(const std::string& sensor, std::size_t node) {
    return "Y/" + sensor + "/" + std::to_string(node);
  }
  static bool is_foreseen(const CertificateSubject& subject, const TensorGrid& grid, std::size_t i,
                          std::size_t node) {
    return grid.nodes(i)[grid.position(node, i)] >= times_of_timers(subject)[i].T1;
  }
};

}  // namespace

const DesignMethod& timer_dependent_scheduled_gain_design() {
  static const ScheduledJumpGain method;
  return method;
}

const DesignMethod& timer_dependent_jump_gain_design() {
  static const GainAtJumps method;
  return method;
}

const DesignMethod& timer_dependent_constant_gain_design() {
  static const ConstantJumpGain method;
  return method;
}

}  // namespace sampled_data_observers
