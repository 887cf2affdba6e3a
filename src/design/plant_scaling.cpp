#include "design/plant_scaling.h"

#include <cmath>

#include "design/log_balance.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

/// A matrix of another shape, such as none at all, is left to who asks for it.
Eigen::MatrixXd in_units(const Eigen::VectorXd& rows, const Eigen::MatrixXd& a,
                         const Eigen::VectorXd& cols) {
  if (a.rows() != rows.size() || a.cols() != cols.size()) return a;
  return rows.cwiseInverse().asDiagonal() * a * cols.asDiagonal();
}

/// For each state the square of how much it moves the outputs within the time scale, each output in
/// its unit.
Eigen::VectorXd visibility(const CertificateSubject& subject) {
  constexpr int kTimes = 16;
  constexpr int kJumps = 3;
  const double scale = time_scale(subject);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(subject.plant.states());
  for (const ModeMatrices& mode : subject.plant.modes) {
    const Eigen::MatrixXd cycle = jump_of(mode) * exponential_of(mode.A * scale);
    for (const Eigen::MatrixXd* C : {&mode.C, &mode.C_c, &mode.C_d}) {
      if (C->rows() == 0) continue;
      Eigen::MatrixXd before = Eigen::MatrixXd::Identity(mode.A.rows(), mode.A.rows());
      for (int jump = 0; jump < (subject.plant.jumps() ? kJumps : 1); ++jump) {
        for (int i = 0; i <= kTimes; ++i) {
          // Also soon after, before fast modes have decayed.
          const double tau = i == 0 ? 0.0 : scale * std::exp2(1 - i);
          const Eigen::MatrixXd seen = *C * exponential_of(mode.A * tau) * before;
          sum += seen.colwise().squaredNorm().transpose();
        }
        before = cycle * before;
      }
    }
  }
  return sum;
}

/// Makes rows of C of norm 1.
void take_row_norms(const Eigen::MatrixXd& C, Eigen::VectorXd& unit) {
  for (Eigen::Index i = 0; i < C.rows(); ++i) {
    const double norm = C.row(i).norm();
    if (std::isfinite(norm) && norm > 0.0) unit(i) *= norm;
  }
}

void take_outputs(const CertificateSubject& subject, PlantScaling& scaling) {
  const ModeMatrices mode = scaled(subject, scaling).plant.mode();
  take_row_norms(mode.C, scaling.output);
  take_row_norms(mode.C_c, scaling.continuous_output);
  take_row_norms(mode.C_d, scaling.jump_output);
}

void take_states(const CertificateSubject& subject, PlantScaling& scaling) {
  const Eigen::VectorXd seen = visibility(scaled(subject, scaling));
  for (Eigen::Index i = 0; i < seen.size(); ++i) {
    if (std::isfinite(seen(i)) && seen(i) > 0.0) scaling.state(i) /= std::sqrt(seen(i));
  }
}

PlantScaling scaling_of_states(const CertificateSubject& subject) {
  constexpr int kRounds = 2;
  PlantScaling scaling = units_of_file(subject);
  balance_logarithms(subject, scaling);
  take_outputs(subject, scaling);
  for (int round = 0; round < kRounds; ++round) {
    take_states(subject, scaling);
    take_outputs(subject, scaling);
  }
  const bool is_sane = scaling.state.allFinite() && scaling.output.allFinite() &&
                       scaling.continuous_output.allFinite() && scaling.jump_output.allFinite();
  return is_sane ? scaling : units_of_file(subject);
}

double geometric_mean(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 1.0 : std::exp(values.array().log().mean());
}

void make_uniform(Eigen::VectorXd& values) { values.setConstant(geometric_mean(values)); }

}  // namespace

PlantScaling units_of_file(const CertificateSubject& subject) {
  const ModeMatrices& mode = subject.plant.mode();
  PlantScaling scaling;
  scaling.state = Eigen::VectorXd::Ones(mode.A.rows());
  scaling.output = Eigen::VectorXd::Ones(mode.C.rows());
  scaling.continuous_output = Eigen::VectorXd::Ones(mode.C_c.rows());
  scaling.jump_output = Eigen::VectorXd::Ones(mode.C_d.rows());
  scaling.sampled = subject.plant.sampled;
  if (subject.plant.vertices.empty()) scaling.nonlinearities = subject.plant.G.cols();
  return scaling;
}

PlantScaling scaling_of(const Theorem& theorem, const CertificateSubject& subject,
                        const KeptNorms& kept) {
  PlantScaling scaling = scaling_of_states(subject);
  // G of Proposition 1 stands for two slack matrices of different units of time.
  scaling.time = theorem.name() == "etienne2019_proposition1" ? 1.0 : time_scale(subject);
  if (kept.of_state) make_uniform(scaling.state);
  if (kept.of_each_sensor) {
    for (const SampledOutputs& outputs : scaling.sampled) {
      auto unit = scaling.output.segment(outputs.first, outputs.rows);
      unit.setConstant(geometric_mean(unit));
    }
    make_uniform(scaling.jump_output);
  }
  if (kept.of_outputs) {
    make_uniform(scaling.output);
    make_uniform(scaling.continuous_output);
    make_uniform(scaling.jump_output);
  }
  const PlantMatrices plant = scaled(subject, scaling).plant;
  const double input = norm2(plant.N);
  if (input > 0.0) scaling.disturbance = 1.0 / input;
  const double output = norm2(plant.C_p);
  if (output > 0.0) scaling.performance = output;
  if (!plant.is_linear() && plant.lipschitz_constant) {
    const double ratio = *plant.lipschitz_constant * norm2(plant.S) / norm2(plant.G);
    if (std::isfinite(ratio) && ratio > 0.0) scaling.nonlinearity = std::sqrt(ratio);
  }
  return scaling;
}

PlantScaling inverse_of(const PlantScaling& scaling) {
  PlantScaling back;
  back.state = scaling.state.cwiseInverse();
  back.output = scaling.output.cwiseInverse();
  back.continuous_output = scaling.continuous_output.cwiseInverse();
  back.jump_output = scaling.jump_output.cwiseInverse();
  back.time = 1.0 / scaling.time;
  back.disturbance = 1.0 / scaling.disturbance;
  back.nonlinearity = 1.0 / scaling.nonlinearity;
  back.performance = 1.0 / scaling.performance;
  back.sampled = scaling.sampled;
  back.nonlinearities = scaling.nonlinearities;
  return back;
}

CertificateSubject scaled(const CertificateSubject& subject, const PlantScaling& scaling) {
  CertificateSubject result = subject;
  result.T1 /= scaling.time;
  result.T2 /= scaling.time;
  for (SamplingTimes& times : result.sensor_times) {
    times.T1 /= scaling.time;
    times.T2 /= scaling.time;
  }
  for (std::vector<double>& nodes : result.timer_nodes) {
    for (double& node : nodes) node /= scaling.time;
  }
  if (result.dwell_time) result.dwell_time->tau /= scaling.time;
  const Eigen::VectorXd& x = scaling.state;
  if (result.error_weights.size() > 0) result.error_weights.array() *= x.array();
  PlantMatrices& plant = result.plant;
  for (ModeMatrices& mode : plant.modes) {
    mode.A = scaling.time * in_units(x, mode.A, x);
    mode.C = in_units(scaling.output, mode.C, x);
    mode.C_c = in_units(scaling.continuous_output, mode.C_c, x);
    mode.C_d = in_units(scaling.jump_output, mode.C_d, x);
    if (mode.A_d) mode.A_d = in_units(x, *mode.A_d, x);
  }
  for (auto* vertices : {&plant.vertices, &plant.flow_vertices}) {
    for (Eigen::MatrixXd& vertex : *vertices) vertex = scaling.time * in_units(x, vertex, x);
  }
  const auto ones = [](Eigen::Index size) { return Eigen::VectorXd(Eigen::VectorXd::Ones(size)); };
  plant.N = scaling.time * scaling.disturbance * in_units(x, plant.N, ones(plant.N.cols()));
  plant.G = scaling.time * scaling.nonlinearity * in_units(x, plant.G, ones(plant.G.cols()));
  plant.S = in_units(ones(plant.S.rows()), plant.S, x);
  if (plant.lipschitz_constant) *plant.lipschitz_constant /= scaling.nonlinearity;
  if (auto& jump = plant.lipschitz_jump) jump->J = in_units(ones(jump->J.rows()), jump->J, x);
  plant.C_p = in_units(ones(plant.C_p.rows()), plant.C_p, x) / scaling.performance;
  return result;
}

PlantScaling rounded_to_powers_of_two(PlantScaling scaling) {
  const auto round = [](double& factor) { factor = std::exp2(std::round(std::log2(factor))); };
  for (Eigen::VectorXd* units :
       {&scaling.state, &scaling.output, &scaling.continuous_output, &scaling.jump_output}) {
    for (Eigen::Index i = 0; i < units->size(); ++i) round((*units)(i));
  }
  for (double* unit :
       {&scaling.time, &scaling.disturbance, &scaling.nonlinearity, &scaling.performance}) {
    round(*unit);
  }
  return scaling;
}

CertificateSubject balanced(const CertificateSubject& subject) {
  return scaled(subject, scaling_of_states(subject));
}

}  // namespace sampled_data_observers
