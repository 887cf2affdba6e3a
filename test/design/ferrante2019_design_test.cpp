// ferrante2019: designs against the numbers computed independently for its examples.
#include <gtest/gtest.h>

#include <limits>

#include "design/parameter_search.h"
#include "design/request_error.h"
#include "design/synthesis.h"
#include "design/workers.h"
#include "ferrante2019_examples.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

using test::flexible_link;
using test::oscillator;
using test::unicycle;

constexpr double kTolerance = 0.01;

const LmiDesignMethod& proposition(int number) {
  return dynamic_cast<const LmiDesignMethod&>(
      *find_design_method("ferrante2019_proposition" + std::to_string(number)));
}

/// The least gamma for which the inequalities of the proposition itself hold; infinity where the
/// solver finds them contradictory.
double gamma_of_proposition(int number, const CertificateSubject& subject, double lambda_t,
                            double delta, double gain_bound) {
  const Parameters parameters = {
      {"lambda_t", lambda_t}, {"delta", delta}, {"gain_bound", gain_bound}, {"a", 1.0}};
  const LmiSolution solution = solve_with_csdp(
      proposition(number).program(subject, parameters, Objective::kMinGamma), SolverOptions());
  const bool is_solved =
      solution.status == SolverStatus::kSolved || solution.status == SolverStatus::kInaccurate;
  return is_solved ? scalar_value(solution.values, "gamma")
                   : std::numeric_limits<double>::infinity();
}

double best_gamma_of_proposition(int number, const CertificateSubject& subject, double lambda_t,
                                 double gain_bound = 1000.0) {
  double best = std::numeric_limits<double>::infinity();
  const SearchRange range = {std::max(2.0 * lambda_t, 0.1 / subject.T2) * 1.001, 30.0 / subject.T2,
                             true};
  WorkerOptions options;
  options.jobs = 2;
  search_parameters({{"delta", range}}, SearchGoal::kLeastCost,
                    [&](const std::vector<Parameters>& choices) {
                      const auto outcomes = run_in_workers(
                          choices.size(),
                          [&](std::size_t i) {
                            return std::to_string(gamma_of_proposition(
                                number, subject, lambda_t, choices[i].at("delta"), gain_bound));
                          },
                          options);
                      std::vector<double> costs;
                      for (const WorkerOutcome& outcome : outcomes) {
                        costs.push_back(outcome.status == WorkerOutcome::Status::kDone
                                            ? std::stod(outcome.result)
                                            : std::numeric_limits<double>::infinity());
                        best = std::min(best, costs.back());
                      }
                      return costs;
                    });
  return best;
}

Design design(const std::string& method, const CertificateSubject& subject, const Parameters& given,
              Objective objective = Objective::kMinGamma,
              const std::set<std::string>& searched = {}) {
  DesignProblem problem;
  problem.subject = subject;
  problem.given = given;
  problem.searched = searched;
  problem.objective = objective;
  SynthesisOptions options;
  options.jobs = 2;
  Design result = synthesize(*find_design_method(method), problem, options);
  EXPECT_TRUE(all_hold(check(result.certificate))) << method;
  return result;
}

double gamma(const Design& design) { return scalar_value(design.certificate.values, "gamma"); }

double best_gamma(const std::string& method, double T2, double gain_bound) {
  const Design best =
      design(method, oscillator(T2), {{"lambda_t", 0.05}, {"gain_bound", gain_bound}});
  EXPECT_LE(norm2(best.certificate.values.at("L")), gain_bound * 1.00001);
  return gamma(best);
}

TEST(Ferrante2019Example1, Proposition2ReachesTheLeastGammaForEachBoundOnTheGain) {
  const char* method = "ferrante2019_proposition2";
  EXPECT_NEAR(best_gamma(method, 0.41, 1000), 32.22, kTolerance * 32.22);
  EXPECT_NEAR(best_gamma(method, 0.41, 10), 37.0, kTolerance * 37.0);
  EXPECT_THROW(best_gamma(method, 0.41, 2), DesignError);
}

TEST(Ferrante2019Example1, PropositionsReachTheirGamma) {
  const CertificateSubject subject = oscillator(0.3);
  EXPECT_NEAR(best_gamma_of_proposition(2, subject, 0.05), 3.85, kTolerance * 3.85);
  EXPECT_NEAR(best_gamma_of_proposition(3, subject, 0.05), 6.28, kTolerance * 6.28);
  EXPECT_NEAR(best_gamma_of_proposition(4, subject, 0.05), 4.48, kTolerance * 4.48);
  EXPECT_NEAR(best_gamma_of_proposition(5, subject, 0.05), 5.11, kTolerance * 5.11);
}

TEST(Ferrante2019Example1, AlternatingIsFarBetterThanProposition2WithinABoundOnTheGain) {
  const auto at_one_delta = [](const char* method) {
    const Design best = design(method, oscillator(0.41),
                               {{"lambda_t", 0.05}, {"gain_bound", 3.65}, {"delta", 3.05}});
    EXPECT_LE(norm2(best.certificate.values.at("L")), 3.65 * 1.00001);
    return gamma(best);
  };
  const double alternating = at_one_delta("ferrante2019_alternating");
  // Analysis gives 32.92 for the gain of (51), whose norm is 3.643.
  EXPECT_LT(alternating, 1.01 * 32.92);
  EXPECT_GT(at_one_delta("ferrante2019_proposition2"), 3.0 * alternating);
}

TEST(Ferrante2019Example2, Proposition5ReachesItsGammaAndAHeldInnovation) {
  const CertificateSubject subject = unicycle(0.3);
  EXPECT_NEAR(best_gamma_of_proposition(5, subject, 0.2), 1.512, kTolerance * 1.512);
  // X3 = X1, as printed.
  const Design best = design("ferrante2019_proposition5", subject, {{"lambda_t", 0.2}, {"a", 1.0}});
  EXPECT_TRUE(best.certificate.values.at("H").isZero(0.0));
  // Theorem 2 proves more than the proposition.
  EXPECT_LT(gamma(best), 1.512);
}

// Numbers that an independent computation gave for the performance output z3. They are reproduced,
// to 0.1 %, with both z3 and z4, and a bound of 1e4 on the gain; with z3 alone the gammas are less
// than half.
TEST(Ferrante2019Example3, PropositionsReachTheirGammaAtOneDelta) {
  const auto at_10 = [](int number, int performance_outputs) {
    const CertificateSubject subject = flexible_link(0.1, performance_outputs);
    const auto outcome = run_in_workers(
        1,
        [&](std::size_t) {
          return std::to_string(gamma_of_proposition(number, subject, 0.01, 10.0, 1e4));
        },
        WorkerOptions());
    return std::stod(outcome.front().result);
  };
  const std::vector<std::pair<int, double>> expected = {
      {2, 0.17386}, {3, 0.65083}, {4, 0.58094}, {5, 0.54920}};
  for (const auto& [number, gamma] : expected) {
    EXPECT_NEAR(at_10(number, 2), gamma, 1e-3 * gamma) << number;
    EXPECT_LT(at_10(number, 1), 0.5 * gamma) << number;
  }
}

// Reproduced with a bound of 1e5 on the gain.
TEST(Ferrante2019Example3, PropositionsReachTheirBestGamma) {
  const CertificateSubject subject = flexible_link(0.1016, 2);
  const std::vector<std::pair<int, double>> expected = {
      {2, 0.113}, {3, 0.252}, {4, 0.247}, {5, 0.258}};
  for (const auto& [number, gamma] : expected) {
    EXPECT_NEAR(best_gamma_of_proposition(number, subject, 0.01, 1e5), gamma, kTolerance * gamma)
        << number;
  }
}

TEST(Ferrante2019Example3, OnlyProposition2ReachesTheLongestTime) {
  const CertificateSubject subject = flexible_link(0.3);
  const Parameters given = {{"lambda_t", 0.01}};
  EXPECT_LT(gamma(design("ferrante2019_proposition2", subject, given)), 1.0);
  for (const int number : {3, 4, 5}) {
    EXPECT_THROW(design("ferrante2019_proposition" + std::to_string(number), subject, given),
                 DesignError)
        << number;
  }
}

TEST(Ferrante2019Example3, ASearchForTheSlackScaleFindsASmallerGamma) {
  const CertificateSubject subject = flexible_link(0.1);
  const Parameters given = {{"lambda_t", 0.01}, {"delta", 10}};
  Parameters as_printed = given;
  as_printed["a"] = 1.0;
  const Objective objective = Objective::kMinGamma;
  const char* method = "ferrante2019_proposition4";
  EXPECT_LT(gamma(design(method, subject, given, objective, {"a"})),
            0.9 * gamma(design(method, subject, as_printed, objective)));
}

/// How far gains are from a predictor, H = −C L, and from a held innovation, H = 0.
double distance_to_predictor(const Design& design) {
  const NamedMatrices& values = design.certificate.values;
  return norm2(values.at("H") + design.certificate.subject.plant.C() * values.at("L"));
}
double distance_to_hold(const Design& design) { return norm2(design.certificate.values.at("H")); }

TEST(Ferrante2019Designs, ArePredictorsOrHoldTheInnovationWhereThatIsAskedFor) {
  const CertificateSubject subject = oscillator(0.2);
  const Parameters given = {{"lambda_t", 0.05}, {"gain_bound", 10.0}};
  const auto gamma = [&](const Design& found) {
    return scalar_value(found.certificate.values, "gamma");
  };
  const Design free = design("ferrante2019_alternating", subject, given);
  const Design predictor = design("ferrante2019_alternating_predictor", subject, given);
  const Design hold = design("ferrante2019_alternating_hold", subject, given);
  EXPECT_EQ(distance_to_predictor(predictor), 0.0);
  EXPECT_EQ(distance_to_hold(hold), 0.0);
  EXPECT_EQ(distance_to_predictor(design("ferrante2019_proposition2_predictor", subject, given)),
            0.0);
  EXPECT_EQ(distance_to_hold(design("ferrante2019_proposition3_hold", subject, given)), 0.0);
  EXPECT_EQ(distance_to_hold(design("ferrante2019_proposition4_hold", subject, given)), 0.0);
  EXPECT_LE(gamma(free), 1.01 * gamma(predictor));
  EXPECT_LE(gamma(free), 1.01 * gamma(hold));
}

/// Postoyan's gain is certified up to 0.1145 s.
TEST(Ferrante2019Example3, APredictorReachesALongerTimeThanPostoyans) {
  CertificateSubject subject = flexible_link(0.115);
  const Design longer = design("ferrante2019_proposition2_predictor", subject,
                               {{"lambda_t", 0.01}, {"gain_bound", 1e4}}, Objective::kFeasible);
  EXPECT_EQ(distance_to_predictor(longer), 0.0);
}

TEST(Ferrante2019Designs, HaveNoGammaWithoutAPerformanceOutput) {
  CertificateSubject subject = oscillator(0.2);
  subject.plant.C_p.resize(0, 2);
  for (const char* method :
       {"ferrante2019_proposition2", "ferrante2019_proposition3", "ferrante2019_proposition4",
        "ferrante2019_proposition5", "ferrante2019_alternating"}) {
    DesignProblem problem;
    problem.subject = subject;
    problem.objective = Objective::kMinGamma;
    try {
      synthesize(*find_design_method(method), problem, {});
      ADD_FAILURE() << method;
    } catch (const RequestError& error) {
      EXPECT_NE(std::string(error.what()).find("a gain needs design/N"), std::string::npos)
          << error.what();
    }
  }
}

TEST(Ferrante2019Designs, HaveAsManyScalarVariablesAsTableII) {
  const CertificateSubject subject = flexible_link(0.1);
  const Parameters parameters = {
      {"lambda_t", 0.01}, {"delta", 10}, {"gain_bound", 1000}, {"a", 1}, {"gamma", 1}};
  // Of Proposition 5, the slack matrices are eliminated: twice two of m x n and two of m x m.
  constexpr int kSlacks = 2 * (2 * 2 * 4 + 2 * 2 * 2);
  for (const auto& [number, count] : {std::pair{2, 26}, {3, 46}, {4, 46}, {5, 86 - kSlacks}}) {
    // But for q, of the bound on the gain, which the paper does not have.
    EXPECT_EQ(
        proposition(number).program(subject, parameters, Objective::kFeasible).scalar_variables() -
            1,
        count)
        << number;
  }
}

TEST(Ferrante2019Designs, Propositions3And5TellThatDeltaMustExceedTwiceTheRate) {
  for (const int number : {3, 5}) {
    try {
      design("ferrante2019_proposition" + std::to_string(number), oscillator(0.3),
             {{"lambda_t", 0.5}, {"delta", 1.0}});
      ADD_FAILURE() << number;
    } catch (const DesignError& error) {
      EXPECT_NE(std::string(error.what()).find("delta > 2 lambda_t"), std::string::npos)
          << error.what();
    }
  }
}

TEST(Ferrante2019Designs, ReachLongerTimesAndFasterRatesThanTheStart) {
  const std::string method = "ferrante2019_proposition4";
  const Design longest =
      design(method, oscillator(0.3), {{"lambda_t", 0.05}, {"delta", 5}}, Objective::kMaxT2);
  EXPECT_GT(longest.certificate.subject.T2, 0.33);
  const Design fastest = design(method, oscillator(0.3), {{"delta", 6}}, Objective::kMaxDecay);
  EXPECT_GT(scalar_value(fastest.certificate.values, "lambda_t"), 0.05);
}

// By which the bench of Table II, and every search for the longest T2, leaves out what is above.
TEST(Ferrante2019Designs, WhatIsInfeasibleAtT2IsSoAboveForTheSameDelta) {
  for (const int number : {2, 3, 4, 5}) {
    int feasible = 0;
    int infeasible_above = 0;
    for (const double delta : {1.0, 5.0, 10.0, 25.0, 60.0, 100.0}) {
      bool is_above = false;
      for (const double T2 : {0.02, 0.06, 0.12, 0.2, 0.3}) {
        const Parameters parameters = {
            {"lambda_t", 0.01}, {"delta", delta}, {"gain_bound", 1000.0}, {"a", 1.0}};
        const SolverStatus status =
            solve_with_interior_point(
                proposition(number).program(flexible_link(T2), parameters, Objective::kMinGamma))
                .status;
        if (is_above) {
          EXPECT_EQ(status, SolverStatus::kInfeasible)
              << number << ", delta = " << delta << ", T2 = " << T2;
          ++infeasible_above;
        }
        is_above = status == SolverStatus::kInfeasible;
        feasible += status == SolverStatus::kSolved ? 1 : 0;
      }
    }
    EXPECT_GE(feasible, 5) << number;
    EXPECT_GE(infeasible_above, 5) << number;
  }
}

}  // namespace
}  // namespace sampled_data_observers
