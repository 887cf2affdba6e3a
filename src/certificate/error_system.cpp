#include "certificate/error_system.h"

#include <memory>
#include <utility>

#include "certificate/timer_grid.h"

namespace sampled_data_observers {
namespace {

Eigen::MatrixXd widened(const Eigen::MatrixXd& rows, Eigen::Index size) {
  Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(rows.rows(), size);
  wide.leftCols(rows.cols()) = rows;
  return wide;
}

Eigen::MatrixXd heightened(const Eigen::MatrixXd& columns, Eigen::Index size) {
  return widened(columns.transpose(), size).transpose();
}

/// All but flow and resets, for an error of `size` entries.
ErrorSystem without_observer(const CertificateSubject& subject, Eigen::Index size) {
  const PlantMatrices& plant = subject.plant;
  ErrorSystem system;
  system.states = plant.states();
  system.size = size;
  const bool has_vertices = !plant.vertices.empty();
  system.G = has_vertices ? Eigen::MatrixXd(size, 0) : heightened(plant.G, size);
  system.S = has_vertices ? Eigen::MatrixXd(0, size) : widened(plant.S, size);
  system.lipschitz_constant = plant.lipschitz_constant.value_or(0.0);
  system.N = heightened(plant.N, size);
  // Without the row of w, C_pᵀ C_p says nothing: the other terms may outweigh it.
  const bool has_gain = plant.N.cols() > 0;
  system.C_p = has_gain ? widened(plant.C_p, size) : Eigen::MatrixXd(0, size);
  return system;
}

Eigen::MatrixXd rows_of(const SampledOutputs& outputs, const Eigen::MatrixXd& C) {
  return C.middleRows(outputs.first, outputs.rows);
}

ErrorSystem corrected_at_samples(
    const CertificateSubject& subject,
    const std::function<MatrixExpression(std::size_t sensor, std::size_t node)>& gain,
    bool is_constant) {
  const PlantMatrices& plant = subject.plant;
  const Eigen::Index n = plant.states();
  ErrorSystem system = without_observer(subject, n);
  system.F = plant_flows(plant);
  for (std::size_t i = 0; i < plant.sampled.size(); ++i) {
    ErrorReset reset;
    reset.name = plant.sampled[i].sensor;
    reset.position = plant.sampled[i].position;
    reset.J = Eigen::MatrixXd::Identity(n, n);
    reset.C = rows_of(plant.sampled[i], plant.C());
    reset.K = [gain, i](std::size_t node) { return gain(i, node); };
    reset.is_constant = is_constant;
    system.resets.push_back(std::move(reset));
  }
  return system;
}

/// @param sign  1 or −1, of L in x̂' = f + sign L θ
ErrorSystem corrected_by_injection(const CertificateSubject& subject, double sign, bool has_H) {
  const PlantMatrices& plant = subject.plant;
  const Eigen::Index n = plant.states();
  const Eigen::Index m = plant.C().rows();
  ErrorSystem system = without_observer(subject, n + m);
  std::vector<MatrixExpression> L;
  std::vector<std::vector<MatrixExpression>> H;
  for (std::size_t i = 0; i < plant.sampled.size(); ++i) {
    const Eigen::Index rows = plant.sampled[i].rows;
    L.push_back(MatrixExpression(-sign) * symbol(gain_of_sensor("L", subject, i), n, rows));
    H.emplace_back();
    for (std::size_t j = 0; j < plant.sampled.size(); ++j) {
      H.back().push_back(i == j && has_H ? symbol(gain_of_sensor("H", subject, i), rows, rows)
                                         : zeros(rows, plant.sampled[j].rows));
    }
  }
  const MatrixExpression all_L = blocks({L});
  const MatrixExpression all_H = blocks(H);
  for (const MatrixExpression& flow : plant_flows(plant)) {
    system.F.push_back(blocks({{flow, all_L}, {zeros(m, n), all_H}}));
  }
  for (const SampledOutputs& outputs : plant.sampled) {
    // θ⁺ = C (x − x̂) + η, as e⁺ = (I − K (C, −I)) e − K η with K = (0, −I).
    ErrorReset reset;
    reset.name = outputs.sensor;
    reset.position = outputs.position;
    reset.J = Eigen::MatrixXd::Identity(n + m, n + m);
    reset.C = widened(rows_of(outputs, plant.C()), n + m);
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + m, outputs.rows);
    for (Eigen::Index row = 0; row < outputs.rows; ++row) {
      reset.C(row, n + outputs.first + row) = -1.0;
      K(n + outputs.first + row, row) = -1.0;
    }
    reset.K = [K](std::size_t) { return MatrixExpression(K); };
    system.resets.push_back(std::move(reset));
  }
  return system;
}

}  // namespace

std::vector<MatrixExpression> plant_flows(const PlantMatrices& plant) {
  std::vector<MatrixExpression> flows;
  for (const Eigen::MatrixXd& vertex : plant.flow_vertices) flows.emplace_back(vertex);
  if (!flows.empty()) return flows;
  const MatrixExpression A = plant.A();
  if (plant.vertices.empty()) return {A};
  for (const Eigen::MatrixXd& vertex : plant.vertices) flows.push_back(A + vertex);
  return flows;
}

std::string gain_of_sensor(const std::string& symbol, const CertificateSubject& subject,
                           std::size_t sensor) {
  const auto& sampled = subject.plant.sampled;
  return sampled.size() == 1 ? symbol : symbol + "/" + sampled[sensor].sensor;
}

ErrorSystem constant_gain_error(const CertificateSubject& subject) {
  const auto gain = [&subject](std::size_t sensor, std::size_t) {
    return symbol(gain_of_sensor("L", subject, sensor), subject.plant.states(),
                  subject.plant.sampled[sensor].rows);
  };
  ErrorSystem system = corrected_at_samples(subject, gain, true);
  // The subject need not outlive the system.
  for (ErrorReset& reset : system.resets) {
    reset.K = [K = reset.K(0)](std::size_t) { return K; };
  }
  return system;
}

bool has_Z(const CertificateSubject& subject, const TensorGrid& grid, std::size_t sensor,
           std::size_t node) {
  return times_of_timers(subject)[sensor].T1 == 0.0 && grid.position(node, sensor) == 0;
}

ErrorSystem scheduled_gain_error(const CertificateSubject& subject) {
  const auto own = std::make_shared<const CertificateSubject>(subject);
  const auto grid = std::make_shared<const TensorGrid>(grid_of(subject));
  const auto Z = [own](std::size_t sensor, std::size_t node) {
    const SampledOutputs& outputs = own->plant.sampled[sensor];
    return symbol("Z/" + outputs.sensor + "/" + std::to_string(node), outputs.rows, outputs.rows);
  };
  const auto gain = [own, grid, Z](std::size_t sensor, std::size_t node) -> MatrixExpression {
    const SampledOutputs& outputs = own->plant.sampled[sensor];
    const Eigen::Index n = own->plant.states();
    const std::string number = std::to_string(node);
    if (!has_Z(*own, *grid, sensor, node)) {
      return symbol("K/" + outputs.sensor + "/" + number, n, outputs.rows);
    }
    const MatrixExpression C = rows_of(outputs, own->plant.C());
    return inverse(symbol("P/" + number, n, n)) * transpose(C) * Z(sensor, node);
  };
  ErrorSystem system = corrected_at_samples(subject, gain, false);
  const std::vector<SamplingTimes> times = times_of_timers(subject);
  for (std::size_t i = 0; i < system.resets.size(); ++i) {
    if (times[i].T1 > 0.0) continue;
    system.resets[i].Z = [Z, i](std::size_t node) { return Z(i, node); };
  }
  return system;
}

ErrorSystem injection_error(const CertificateSubject& subject) {
  return corrected_by_injection(subject, 1.0, true);
}

ErrorSystem held_injection_error(const CertificateSubject& subject) {
  return corrected_by_injection(subject, -1.0, false);
}

ErrorSystem synchronized_error(const CertificateSubject& subject) {
  return switched_error(subject, 0);
}

ErrorSystem switched_error(const CertificateSubject& subject, std::size_t number) {
  const PlantMatrices& plant = subject.plant;
  const bool switches = plant.modes.size() > 1;
  const ModeMatrices& mode = plant.modes[number];
  const Eigen::Index n = plant.states();
  const auto gain = [&](const std::string& name, const Eigen::MatrixXd& C) {
    return symbol(switches ? of_mode(name, mode) : name, n, C.rows());
  };
  ErrorSystem system = without_observer(subject, n);
  if (switches) system.mode = std::to_string(mode.label);
  const MatrixExpression A = mode.A;
  for (const MatrixExpression& flow :
       switches ? std::vector<MatrixExpression>{A} : plant_flows(plant)) {
    MatrixExpression F = flow;
    if (mode.C_c.rows() > 0) F = F - gain("L_c", mode.C_c) * MatrixExpression(mode.C_c);
    system.F.push_back(F);
  }
  ErrorReset reset;
  reset.name = "jumps";
  reset.J = jump_of(mode);
  reset.C = mode.C_d;
  MatrixExpression K = mode.C_d.rows() > 0 ? gain("L_d", mode.C_d) : zeros(n, 0);
  reset.K = [K = std::move(K)](std::size_t) { return K; };
  system.resets.push_back(std::move(reset));
  return system;
}

}  // namespace sampled_data_observers
