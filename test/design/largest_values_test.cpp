// max-T2 and max-decay against dense scans.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "design/analysis.h"
#include "design/attempts.h"
#include "design/gain_file.h"
#include "design/plant_scaling.h"
#include "ferrante2019_examples.h"
#include "paper_plants.h"
#include "support/long_tests.h"

namespace sampled_data_observers::test {
namespace {

ThreadOptions two_threads() {
  ThreadOptions threads;
  threads.jobs = 2;
  threads.time_limit = 60.0;
  return threads;
}

/// For how many of many deltas the method has a design.
int feasible_deltas(const DesignMethod& method, const CertificateSubject& subject,
                    const Parameters& given) {
  const int deltas = long_tests_are_wanted() ? 400 : 100;
  std::vector<Parameters> choices;
  for (int i = 0; i < deltas; ++i) {
    choices.push_back(given);
    choices.back()["delta"] = 0.1 / subject.T2 * std::pow(300.0, i / (deltas - 1.0));
  }
  int count = 0;
  for (const DesignCandidate& candidate :
       proved_attempts(method, subject, choices, Objective::kFeasible, GainBound::kOfScaledPlant,
                       two_threads())) {
    count += candidate.is_verified() ? 1 : 0;
  }
  return count;
}

CertificateSubject without_disturbance(CertificateSubject subject) {
  subject.plant.N.resize(subject.plant.states(), 0);
  subject.plant.C_p.resize(0, subject.plant.states());
  return subject;
}

/// Gains whose values are known.
class Fixed : public DesignMethod {
 public:
  explicit Fixed(NamedMatrices gains) : gains_(std::move(gains)) {}
  std::string name() const override { return "fixed"; }
  std::string summary() const override { return "fixed"; }
  const Theorem& theorem() const override { return *find_theorem("ferrante2019_theorem2"); }
  std::vector<DesignParameter> parameters(const CertificateSubject&) const override { return {}; }
  std::vector<Objective> objectives(const CertificateSubject&) const override { return {}; }
  DesignCandidate attempt(const CertificateSubject&, const Parameters&, Objective) const override {
    return {};
  }
  DesignCandidate attempt_scaled(const CertificateSubject& subject, const Parameters& parameters,
                                 Objective objective, const PlantScaling& scaling) const override {
    NamedMatrices fixed = scaled(theorem(), gains_, scaling);
    for (const auto& [name, value] : parameters) fixed[name] = scalar_matrix(value);
    return certify_here(theorem(), subject, fixed, objective);
  }

 private:
  NamedMatrices gains_;
};

TEST(LargestT2, OfGivenGainsIsThatOfADenseScan) {
  Eigen::MatrixXd L(2, 1);
  L << 0.3648, -0.4655;
  AnalysisProblem problem;
  problem.theorem = find_theorem("ferrante2019_theorem2");
  problem.gains = {{"L", L}, {"H", scalar_matrix(-0.3648)}};
  problem.given = {{"lambda_t", 0.05}};
  problem.objective = Objective::kMaxT2;
  SynthesisOptions options;
  options.jobs = 2;
  for (const bool has_disturbance : {true, false}) {
    problem.subject = has_disturbance ? oscillator(0.25) : without_disturbance(oscillator(0.25));
    const Design design = analyze(problem, options);
    CertificateSubject longer = design.certificate.subject;
    EXPECT_NEAR(longer.T2, 0.314, 0.001);
    longer.T2 *= 1.001;
    EXPECT_EQ(feasible_deltas(Fixed(problem.gains), longer, problem.given), 0) << has_disturbance;
  }
}

TEST(LargestT2, OfADesignIsThatOfADenseScan) {
  const char* name = "ferrante2019_proposition4";
  const DesignMethod& method = *find_design_method(name);
  const Parameters given = {{"lambda_t", 0.05}, {"a", 5.0}};
  for (const bool has_disturbance : {true, false}) {
    const CertificateSubject subject =
        has_disturbance ? oscillator(0.25) : without_disturbance(oscillator(0.25));
    const Design design = design_by(name, subject, given, Objective::kMaxT2);
    CertificateSubject longer = design.certificate.subject;
    longer.T2 *= 1.001;
    Parameters all = design.parameters;
    all.erase("delta");
    EXPECT_EQ(feasible_deltas(method, longer, all), 0) << has_disturbance;
  }
}

TEST(LargestDecay, OfADesignIsThatOfADenseScan) {
  const char* name = "ferrante2019_proposition4";
  const Parameters given = {{"a", 5.0}};
  const Design design = design_by(name, oscillator(0.3), given, Objective::kMaxDecay);
  Parameters faster = design.parameters;
  faster.erase("delta");
  faster["lambda_t"] *= 1.001;
  EXPECT_EQ(feasible_deltas(*find_design_method(name), oscillator(0.3), faster), 0);
}

/// An answer to a T2 that was asked for is never a shorter one.
TEST(LargestT2, IsNeverLessThanWasAskedFor) {
  const Parameters given = {{"lambda_t", 0.05}, {"a", 1.0}};
  const char* method = "ferrante2019_proposition5";
  const Design design = design_by(method, oscillator(0.2), given, Objective::kMaxT2);
  EXPECT_GE(design.certificate.subject.T2, 0.2);
  const double largest = design.certificate.subject.T2;
  EXPECT_NE(
      refusal(method, oscillator(1.002 * largest), given, Objective::kMaxT2).find("as asked for"),
      std::string::npos);
}

/// Without damping a gain that is small enough serves any T2.
TEST(LargestT2, MayNotExistAndTheGainFileSaysSo) {
  const Design design =
      design_by("ferrante2016_corollary1", mass_spring(0.2, 3.0), {}, Objective::kMaxT2);
  EXPECT_TRUE(design.search_ended);
  EXPECT_DOUBLE_EQ(design.certificate.subject.T2, 1024.0 * 3.0);
  EXPECT_TRUE(all_hold(check(design.certificate)));
  std::ostringstream file;
  write_gain_file(design, {"plant.yaml", "", "", ""}, file);
  EXPECT_NE(file.str().find("max-T2  # the search ended here"), std::string::npos) << file.str();
}

TEST(Ferrante2016Proposition1, IsAtLeastAsFastAsCorollary1) {
  const CertificateSubject subject = mass_spring(0.2, 3.0);
  const Design fastest = design_by("ferrante2016_corollary1", subject, {}, Objective::kMaxDecay);
  const double rate = scalar_value(fastest.certificate.values, "decay");
  EXPECT_NO_THROW(design_by("ferrante2016_proposition1", subject, {{"decay", 0.999 * rate}},
                            Objective::kFeasible));
}

}  // namespace
}  // namespace sampled_data_observers::test
