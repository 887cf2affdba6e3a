#include "design/methods/ferrante2019.h"

#include "design/assumed_disturbance.h"
#include "design/final_error.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {

std::vector<DesignParameter> ferrante2019_parameters(const CertificateSubject& subject) {
  std::vector<DesignParameter> all = {
      {"lambda_t", "rate of convergence [1/s]; 0.001/T2 where not given", 1e-3 / subject.T2,
       std::nullopt},
      {"delta", "how fast the weight of the held innovation falls [1/s]", std::nullopt,
       SearchRange{0.1 / subject.T2, 30.0 / subject.T2, true}},
      {"gain_bound", "bound on the norm of L", 1000.0, std::nullopt},
  };
  if (subject.plant.N.cols() > 0) {
    all.push_back({"gamma", "L2 gain from the disturbance, where it is not minimized", std::nullopt,
                   std::nullopt});
  }
  return all;
}

std::vector<Objective> ferrante2019_objectives(const CertificateSubject& subject) {
  std::vector<Objective> all = {Objective::kFeasible, Objective::kMaxT2, Objective::kMaxDecay,
                                Objective::kMinFinalError};
  // Without C_p the gain is zero, however bad the design.
  if (subject.plant.N.cols() > 0 && subject.plant.C_p.rows() > 0) {
    all.push_back(Objective::kMinGamma);
  }
  return all;
}

bool keeps_gain_bound(const Eigen::MatrixXd& L, const Parameters& parameters) {
  return L.allFinite() && norm2(L) <= parameters.at("gain_bound") * (1.0 + 1e-9);
}

PlantMatrices ferrante2019_plant(const CertificateSubject& subject, const Parameters& parameters,
                                 Objective objective) {
  PlantMatrices plant = subject.plant;
  if (objective == Objective::kMinGamma || objective == Objective::kMinFinalError ||
      parameters.count("gamma") > 0) {
    return plant;
  }
  plant.N.resize(plant.states(), 0);
  plant.C_p.resize(0, plant.states());
  return plant;
}

void add_gamma(LmiProgram& program, const CertificateSubject& subject, const Parameters& parameters,
               Objective objective) {
  if (subject.plant.N.cols() == 0) return;
  const auto given = parameters.find("gamma");
  if (objective == Objective::kMinGamma) {
    program.minimize(program.squared("gamma"));
  } else if (given != parameters.end()) {
    program.fix("gamma", scalar_matrix(given->second));
  } else if (objective == Objective::kMinFinalError) {
    program.squared("gamma");
  }
}

LmiProgram ferrante2019_program(const CertificateSubject& subject, const Parameters& parameters,
                                Objective objective) {
  LmiProgram program;
  const Eigen::Index n = subject.plant.states();
  const Eigen::Index m = subject.plant.C().rows();
  const MatrixExpression P1 = program.symmetric("P1", n);
  program.require_positive("P1 > 0", P1);
  // Without gain, all multiples of a solution are one.
  const PlantMatrices plant = ferrante2019_plant(subject, parameters, objective);
  if (plant.N.cols() == 0 && plant.C_p.rows() == 0 && objective != Objective::kMinFinalError) {
    program.bound_above("P1 <= I", P1, identity(n));
  }
  program.require_positive("P2 > 0", program.symmetric("P2", m));
  if (!subject.plant.is_linear()) program.require_positive("chi > 0", program.scalar("chi"));
  add_gamma(program, subject, parameters, objective);
  program.fix("delta", scalar_matrix(parameters.at("delta")));
  program.fix("lambda_t", scalar_matrix(parameters.at("lambda_t")));
  if (objective == Objective::kMinFinalError) {
    minimize_ferrante2019_level(program, subject, weights_of_design(subject), parameters);
  }
  return program;
}

}  // namespace sampled_data_observers
