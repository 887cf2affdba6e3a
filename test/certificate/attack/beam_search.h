#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "certificate/attack/played_run.h"
#include "certificate/certificate.h"

namespace sampled_data_observers::test {

/// Looks for the run in which the error comes to most of its bound: a beam search over times
/// between events, extreme ones, random ones and those that served before, and over noise and
/// disturbance, out and in along the error and at random. What it finds, and its times with the
/// worst of all inputs, are compared.
class BeamSearch {
 public:
  BeamSearch(AttackedObserver& observer, const CertificateSubject& subject,
             const ErrorAssumptions& assumptions)
      : observer_(observer), subject_(subject), assumptions_(assumptions) {}

  /// @param strays  whether some events come later than T2 and sooner than T1 allows
  void run(std::uint64_t seed, bool strays) {
    generator_.seed(seed);
    strays_ = strays;
    std::vector<Branch> beam;
    const Eigen::Index n = observer_.plant().states();
    for (int i = 0; i < kWidth; ++i) {
      const Eigen::VectorXd direction = i < n ? Eigen::VectorXd::Unit(n, i) : any_direction(n);
      Branch branch;
      branch.run.initial_error = assumptions_.initial_error * direction;
      branch.at = observer_.begin(branch.run.initial_error);
      branch.share = observer_.compare(branch.at);
      beam.push_back(std::move(branch));
    }
    const int depth = std::uniform_int_distribution<int>(1, kDepth)(generator_);
    for (int step = 0; step < depth; ++step) {
      std::vector<Branch> next;
      for (const Branch& branch : beam) {
        for (const Duration interval : intervals(step == 0)) extend(branch, interval, next);
      }
      beam = best_of(std::move(next));
    }
    if (!observer_.plant().is_affine()) return;
    for (int i = 0; i < kPolished; ++i) {
      WorstInputs inputs(observer_, beam[static_cast<std::size_t>(i)].run, assumptions_);
      for (const Play& worst : {inputs.worst(), inputs.worst_for_a_state()}) {
        play(observer_, worst, [this](const Attacked& at) { observer_.compare(at); });
      }
    }
  }

 private:
  static constexpr int kWidth = 12;
  static constexpr int kDepth = 24;
  static constexpr int kPolished = 2;
  static constexpr std::size_t kServed = 12;
  static constexpr double kStraying = 0.2;

  struct Branch {
    Play run;
    Attacked at;
    double share = 0.0;  ///< of the bound, after the last event
  };

  struct Served {
    Duration interval = 0;
    double growth = 0.0;
  };

  /// The ends, one at random, one that has served before, and one beside such a one; the first
  /// event may come at any time.
  std::vector<Duration> intervals(bool is_first) {
    const Duration longest = from_seconds(subject_.T2);
    const Duration shortest = is_first ? 0 : std::max<Duration>(1, from_seconds(subject_.T1));
    const auto width = static_cast<double>(longest - shortest);
    std::vector<Duration> result = {longest, shortest,
                                    shortest + static_cast<Duration>(width * uniform())};
    if (strays_ && uniform() < kStraying) {
      result.push_back(uniform() < 0.5 ? from_seconds((1.0 + 2.0 * uniform()) * subject_.T2)
                                       : 1 + from_seconds(uniform() * subject_.T1));
    }
    if (is_first || served_.empty()) return result;
    const auto chosen = static_cast<std::size_t>(uniform() * static_cast<double>(served_.size()));
    const Duration served = served_[chosen].interval;
    const double beside = width * std::pow(10.0, -5.0 * uniform()) * (uniform() - 0.5);
    result.push_back(served);
    result.push_back(std::clamp(served + static_cast<Duration>(beside), shortest, longest));
    return result;
  }

  /// Remembers the intervals in which the error grew the most beside its bound.
  void remember(Duration interval, double growth) {
    if (strays_) return;
    const auto same = [interval](const Served& served) { return served.interval == interval; };
    if (std::any_of(served_.begin(), served_.end(), same)) return;
    served_.push_back({interval, growth});
    const auto more = [](const Served& a, const Served& b) { return a.growth > b.growth; };
    std::sort(served_.begin(), served_.end(), more);
    if (served_.size() > kServed) served_.pop_back();
  }

  double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(generator_); }

  void extend(const Branch& from, Duration interval, std::vector<Branch>& next) {
    // Out and in along the error, and one of any directions.
    const bool has_inputs = assumptions_.noise > 0.0 || assumptions_.disturbance > 0.0;
    for (const double sign : {1.0, -1.0, 0.0}) {
      Branch branch = from;
      Move move;
      move.interval = interval;
      for (int part = 0; part < kParts; ++part) {
        move.w.push_back(input(assumptions_.disturbance, sign,
                               subject_.plant.N.transpose() * observer_.error(branch.at)));
        observer_.flow(part_of(interval, part), move.w.back(), branch.at);
        observer_.compare(branch.at);
      }
      move.noise = input(assumptions_.noise, -sign, observer_.C() * observer_.error(branch.at));
      observer_.event(move.noise, branch.at);
      branch.share = observer_.compare(branch.at);
      if (!from.run.moves.empty() && from.share > 0.0)
        remember(interval, branch.share / from.share);
      branch.run.moves.push_back(std::move(move));
      next.push_back(std::move(branch));
      if (!has_inputs) return;
    }
  }

  Eigen::VectorXd input(double norm, double sign, const Eigen::VectorXd& along) {
    if (!(norm > 0.0) || along.size() == 0) return Eigen::VectorXd::Zero(along.size());
    if (sign == 0.0 || !(along.norm() > 0.0)) return norm * any_direction(along.size());
    return sign * norm / along.norm() * along;
  }

  static std::vector<Branch> best_of(std::vector<Branch> all) {
    const auto more = [](const Branch& a, const Branch& b) { return a.share > b.share; };
    const std::size_t kept = std::min<std::size_t>(kWidth, all.size());
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(kept), all.end(),
                      more);
    all.resize(kept);
    return all;
  }

  Eigen::VectorXd any_direction(Eigen::Index size) {
    std::normal_distribution<double> normal;
    Eigen::VectorXd result(size);
    for (Eigen::Index i = 0; i < size; ++i) result(i) = normal(generator_);
    return result.normalized();
  }

  AttackedObserver& observer_;
  const CertificateSubject& subject_;
  ErrorAssumptions assumptions_;
  std::mt19937_64 generator_;
  std::vector<Served> served_;
  bool strays_ = false;
};

}  // namespace sampled_data_observers::test
