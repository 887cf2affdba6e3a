#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "support/example_run.h"

namespace sampled_data_observers::test {

/// Whether two runs have the same estimates, bit for bit.
inline bool are_same(const ExampleRun& a, const ExampleRun& b) {
  if (a.estimate.size() != b.estimate.size()) return false;
  for (std::size_t i = 0; i < a.estimate.size(); ++i) {
    if (a.estimate.value(i) != b.estimate.value(i)) return false;
  }
  return true;
}

/// An example that hears of some jumps wrongly, beside the same one that hears of them as they are.
class Recovery {
 public:
  /// @param near  how far from a jump errors do not count [s]: there one of plant and estimate has
  ///              jumped, and the other has not
  Recovery(Example example, double near, std::string observer_file)
      : example_(std::move(example)),
        observer_file_(std::move(observer_file)),
        near_(near),
        truthful_(example_.run("scenario.yaml", observer_file_)) {}

  const ExampleRun& truthful() const { return truthful_; }
  /// Time of a jump, counted from 0 [s].
  double jump(std::size_t k) const { return truthful_.jumps.at(k).time; }

  ExampleRun run(const std::function<void(ToldJumps&)>& mistake) const {
    return Example(example_).tell(mistake).run("scenario.yaml", observer_file_);
  }

  /// From when on the error is at most `tolerance` above that of the run without mistakes, for
  /// good.
  double recovered_at(const ExampleRun& run, double tolerance) const {
    return excess(run).last_above(tolerance);
  }
  double recovered_at(const std::function<void(ToldJumps&)>& mistake, double tolerance) const {
    return recovered_at(run(mistake), tolerance);
  }
  /// How far the error is above that of the run without mistakes at most.
  double most(const ExampleRun& run) const { return excess(run).max(); }

 private:
  Trajectory excess(const ExampleRun& run) const {
    if (run.error.size() != truthful_.error.size()) {
      throw std::logic_error("Recovery: estimates begin at different times");
    }
    Trajectory all(1.0);
    for (std::size_t i = 0; i < run.error.size(); ++i) {
      const double more = run.error.value(i).norm() - truthful_.error.value(i).norm();
      // Where an error is not finite it is never small.
      const double positive = std::isfinite(more) ? std::max(0.0, more) : kNotFinite;
      all.add(run.error.time(i), Eigen::VectorXd::Constant(1, positive));
    }
    return all.where([&](double time) {
      return std::none_of(truthful_.jumps.begin(), truthful_.jumps.end(),
                          [&](const auto& jump) { return std::abs(jump.time - time) < near_; });
    });
  }

  static constexpr double kNotFinite = std::numeric_limits<double>::infinity();

  Example example_;
  std::string observer_file_;
  double near_;
  ExampleRun truthful_;
};

}  // namespace sampled_data_observers::test
