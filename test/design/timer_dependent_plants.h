#pragma once

#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "certificate/certified_gains.h"
#include "certificate/timer_grid.h"
#include "design/analysis.h"
#include "design/gain_file.h"
#include "paper_plants.h"

namespace sampled_data_observers::test {

/// ferrante2019, example 1, with a named sensor and samples as dense as one likes.
inline CertificateSubject densely_sampled_oscillator(double T2) {
  Eigen::MatrixXd A(2, 2);
  A << 0, 1, -4, 0;
  CertificateSubject subject = linear_subject(A, Eigen::MatrixXd::Identity(1, 2), 0.0, T2);
  subject.plant.N = Eigen::MatrixXd::Identity(2, 1);
  subject.plant.C_p = Eigen::MatrixXd::Identity(2, 2);
  return subject;
}

/// x1' = x2, x2' = x3, x3' = w, with sensors of x1 and x2 that are sampled independently.
inline CertificateSubject triple_integrator() {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3, 3);
  A(0, 1) = A(1, 2) = 1.0;
  CertificateSubject subject = linear_subject(A, Eigen::MatrixXd::Identity(2, 3), 0.0, 0.0);
  subject.plant.sampled = {{"position", 0, 0, 1}, {"speed", 1, 1, 1}};
  subject.plant.N = Eigen::MatrixXd::Identity(3, 3).rightCols(1);
  subject.plant.C_p = Eigen::MatrixXd::Identity(1, 3);
  set_sensor_times(subject, {{0.2, 1.0}, {0.05, 0.2}});
  return subject;
}

/// A plant in YAML with the design of a method, as a file and read again.
class DesignedObserver {
 public:
  /// @param times  of each sensor
  DesignedObserver(const std::string& plant, const std::vector<SamplingTimes>& times,
                   const Eigen::MatrixXd& N, const Eigen::MatrixXd& C_p)
      : plant_(read_yaml_text(plant, "plant.yaml")) {
    ConfigSection root(plant_, "");
    subject_.plant = matrices_of(*read_plant(root, no_plant_plugins).plant);
    subject_.plant.N = N;
    subject_.plant.C_p = C_p;
    subject_.T1 = times.front().T1;
    subject_.T2 = times.front().T2;
    if (times.size() > 1) set_sensor_times(subject_, times);
  }

  void design(const char* method, double lambda_t, int cells) {
    take(design_by(method, with_cells(subject_, cells), {{"lambda_t", lambda_t}},
                   Objective::kMinGamma));
  }

  /// A proof of given gains instead.
  void prove_gains(const char* theorem, const NamedMatrices& gains, double lambda_t, int cells) {
    AnalysisProblem problem;
    problem.theorem = find_theorem(theorem);
    problem.subject = with_cells(subject_, cells);
    problem.gains = gains;
    problem.given = {{"lambda_t", lambda_t}};
    problem.objective = Objective::kMinGamma;
    take(analyze(problem, {}));
  }

  const Design& design() const { return design_; }
  const std::string& gain_file() const { return gains_; }
  /// With a gain file, or one made of it.
  ObserverConfig config(const std::string& gains, const std::string& assumptions) const {
    const ConfigNode tree = merge({read_yaml_text(gains, "gains.yaml"), plant_});
    return read_observer_config(
        override_with(tree, read_yaml_text("error_assumptions: " + assumptions, "test.yaml")),
        no_plant_plugins);
  }
  Certificate certificate() const {
    const ConfigNode tree = merge({read_yaml_text(gains_, "gains.yaml"), plant_});
    ConfigSection root(tree, "");
    const PlantConfig plant = read_plant(root, no_plant_plugins);
    return read_certificate(root, *plant.plant, read_law(root, plant)->observer().gains())
        ->certificate;
  }

 private:
  void take(const Design& design) {
    design_ = design;
    std::ostringstream text;
    write_gain_file(design_, {"plant.yaml", plant_fingerprint(plant_), "test", "2000-01-01"}, text);
    gains_ = text.str();
  }

  ConfigNode plant_;
  CertificateSubject subject_;
  Design design_;
  std::string gains_;
};

}  // namespace sampled_data_observers::test
