#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>
#include <vector>

#include "certificate/attack/attacked_observer.h"
#include "certificate/certificate.h"
#include "certificate/error_bound.h"
#include "linear_algebra/matrix_functions.h"
#include "sampled_data_observers/observer/law_gains.h"

namespace sampled_data_observers::test {

/// Searches for the largest error that noise and disturbance leave in the end, of an observer of
/// one sampled sensor, or of one that is corrected at jumps of a linear plant alone. The error is
/// linear for given times between samples and slopes of the nonlinearity, so that for them the
/// worst noise and disturbance, which may change kParts times between two samples, are computed.
/// Times and slopes are searched for: extreme ones at random, then changed one by one where that
/// makes the error larger. It takes the gains from the law, and nothing from its certificate but
/// the plant.
class WorstFinalError {
 public:
  WorstFinalError(const ObserverConfig& config, const CertificateSubject& subject,
                  const ErrorAssumptions& assumptions)
      : config_(config), subject_(subject), assumptions_(assumptions), generator_(1) {
    for (const double tau : {subject.T1, subject.T2, any_time(), any_time()}) add_interval(tau);
  }

  /// @return  the largest of so many runs, each of kSamples samples from no error
  double of_runs(std::size_t runs) {
    double largest = 0.0;
    for (std::size_t run = 0; run < runs;) {
      std::vector<Step> steps(kSamples);
      for (Step& step : steps) step = any_step();
      double worst = error_of(steps);
      for (std::size_t change = 1; change < kChanges && ++run < runs; ++change) {
        std::vector<Step> next = steps;
        // Mostly a late one, since the error forgets early ones.
        const double share = uniform() * uniform();
        next[kSamples - 1 - static_cast<std::size_t>(share * kSamples)] = any_step();
        const double error = error_of(next);
        if (error < worst) continue;
        worst = error;
        steps = std::move(next);
      }
      largest = std::max(largest, worst);
    }
    return largest;
  }

 private:
  static constexpr std::size_t kParts = 8;
  static constexpr std::size_t kSamples = 60;
  static constexpr std::size_t kChanges = 400;
  static constexpr int kIterations = 6;

  /// One part of an interval with one slope: e⁺ = flow e + inputs w.
  struct Part {
    Eigen::MatrixXd flow;
    Eigen::MatrixXd inputs;
  };
  /// Time between two samples, and the sample after it: e⁺ = reset e + noise η.
  struct Interval {
    std::vector<Part> parts;  ///< for each slope
    Eigen::MatrixXd reset;
    Eigen::MatrixXd noise;
  };
  struct Step {
    std::size_t interval = 0;
    std::vector<std::size_t> slopes;  ///< kParts
  };

  /// F of ė = F e + N w, for each slope.
  std::vector<Eigen::MatrixXd> slopes() const {
    const PlantMatrices& plant = subject_.plant;
    if (plant.is_linear()) return {plant.A()};
    std::vector<Eigen::MatrixXd> all;
    if (!plant.vertices.empty()) {
      for (const Eigen::MatrixXd& vertex : plant.vertices) all.push_back(plant.A() + vertex);
      return all;
    }
    for (const double slope : {1.0, -1.0}) {
      all.push_back(plant.A() + slope * plant.lipschitz_constant.value() * plant.G * plant.S);
    }
    return all;
  }

  /// What is injected between samples: θ⁺ = C e + η, ė = A e − L θ, θ̇ = H θ.
  struct Injection {
    Eigen::MatrixXd L;
    Eigen::MatrixXd H;
  };

  bool injects() const {
    return config_.type == "IntersampleInjectionObserver" ||
           config_.type == "SampleAndHoldObserver";
  }

  void add_interval(double tau) {
    const PlantMatrices& plant = subject_.plant;
    const Eigen::Index n = plant.states();
    const Eigen::Index m = plant.jumps() ? plant.mode().C_d.rows() : plant.C().rows();
    const Eigen::Index size = injects() ? n + m : n;
    Interval interval;
    for (const Eigen::MatrixXd& A : slopes()) {
      Eigen::MatrixXd field = Eigen::MatrixXd::Zero(size + plant.N.cols(), size + plant.N.cols());
      field.topLeftCorner(n, n) = A;
      field.topRightCorner(n, plant.N.cols()) = plant.N;
      if (injects()) {
        const LawGains gains = config_.law->observer().gains();
        const bool is_held = config_.type == "SampleAndHoldObserver";
        const Eigen::MatrixXd L = gains.find("L")->value;
        field.block(0, n, n, m) = is_held ? L : Eigen::MatrixXd(-L);
        if (!is_held) field.block(n, n, m, m) = gains.find("H")->value;
      }
      const Eigen::MatrixXd flown = exponential_of(field * (tau / kParts));
      interval.parts.push_back(
          {flown.topLeftCorner(size, size), flown.topRightCorner(size, plant.N.cols())});
    }
    interval.reset = Eigen::MatrixXd::Identity(size, size);
    interval.noise = Eigen::MatrixXd::Zero(size, m);
    if (injects()) {
      interval.reset.bottomLeftCorner(m, n) = plant.C();
      interval.reset.bottomRightCorner(m, m).setZero();
      interval.noise.bottomRows(m).setIdentity();
    } else if (plant.jumps()) {
      interval.noise = -config_.law->observer().gains().find("L_d")->value;
      interval.reset = jump_of(plant.mode()) + interval.noise * plant.mode().C_d;
    } else {
      interval.noise = -gain_at(tau);
      interval.reset += interval.noise * plant.C();
    }
    intervals_.push_back(std::move(interval));
  }

  /// K(τ) of x̂⁺ = x̂ + K(τ) (y − C x̂), as the law applies it.
  Eigen::MatrixXd gain_at(double tau) const {
    AttackedObserver observer(config_, subject_.plant.N);
    const Eigen::Index n = subject_.plant.states();
    Eigen::MatrixXd K(n, subject_.plant.C().rows());
    for (Eigen::Index i = 0; i < K.cols(); ++i) {
      Attacked at = observer.begin(Eigen::VectorXd::Zero(n));
      observer.flow(from_seconds(tau), Eigen::VectorXd::Zero(subject_.plant.N.cols()), at);
      observer.event(Eigen::VectorXd::Unit(K.cols(), i), at);
      K.col(i) = -observer.error(at);
    }
    return K;
  }

  Step any_step() {
    Step step;
    // Mostly an extreme one.
    step.interval = uniform() < 0.8 ? any(2) : any(intervals_.size());
    const std::size_t slopes = intervals_.front().parts.size();
    const std::size_t slope = any(slopes);
    const bool changes = uniform() < 0.5;
    for (std::size_t part = 0; part < kParts; ++part) {
      step.slopes.push_back(changes ? any(slopes) : slope);
    }
    return step;
  }

  /// The largest |x − x̂| just before the last sample and at it, with the worst inputs.
  double error_of(const std::vector<Step>& steps) {
    const Eigen::Index n = subject_.plant.states();
    const Interval& last = intervals_[steps.back().interval];
    const Eigen::Index size = last.reset.rows();
    std::vector<Eigen::MatrixXd> responses;
    const Eigen::MatrixXd onto_states = Eigen::MatrixXd::Identity(n, size);
    add_responses(steps, onto_states, responses);
    const double before = largest(responses);
    responses = {onto_states * last.noise * assumptions_.noise};
    add_responses(steps, onto_states * last.reset, responses);
    return std::max(before, largest(responses));
  }

  /// What each input makes of the error after the last part, times its largest norm.
  /// @param after  n x N, what follows then
  void add_responses(const std::vector<Step>& steps, Eigen::MatrixXd after,
                     std::vector<Eigen::MatrixXd>& responses) const {
    for (std::size_t k = steps.size(); k-- > 0;) {
      const Interval& interval = intervals_[steps[k].interval];
      for (std::size_t part = kParts; part-- > 0;) {
        const Part& passed = interval.parts[steps[k].slopes[part]];
        if (assumptions_.disturbance > 0.0 && passed.inputs.cols() > 0) {
          responses.push_back(after * passed.inputs * assumptions_.disturbance);
        }
        after = (after * passed.flow).eval();
      }
      if (k == 0) break;
      const Interval& earlier = intervals_[steps[k - 1].interval];
      responses.push_back(after * earlier.noise * assumptions_.noise);
      after = (after * earlier.reset).eval();
    }
  }

  /// |Σ M v| is largest over |v| <= 1 where each v is along Mᵀ d, and d along the sum.
  static double largest(const std::vector<Eigen::MatrixXd>& responses) {
    if (responses.empty()) return 0.0;
    const Eigen::Index n = responses.front().rows();
    double norm = 0.0;
    for (Eigen::Index first = 0; first < n; ++first) {
      Eigen::VectorXd direction = Eigen::VectorXd::Unit(n, first);
      for (int iteration = 0; iteration < kIterations; ++iteration) {
        Eigen::VectorXd error = Eigen::VectorXd::Zero(n);
        for (const Eigen::MatrixXd& response : responses) {
          const Eigen::VectorXd along = response.transpose() * direction;
          const double length = along.norm();
          if (length > 0.0) error += response * along / length;
        }
        norm = std::max(norm, error.norm());
        if (!(error.norm() > 0.0)) break;
        direction = error / error.norm();
      }
    }
    return norm;
  }

  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(generator_); }
  double any_time() { return subject_.T1 + (subject_.T2 - subject_.T1) * uniform(); }
  std::size_t any(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(generator_);
  }

  const ObserverConfig& config_;
  const CertificateSubject& subject_;
  ErrorAssumptions assumptions_;
  std::mt19937_64 generator_;
  std::vector<Interval> intervals_;
};

}  // namespace sampled_data_observers::test
