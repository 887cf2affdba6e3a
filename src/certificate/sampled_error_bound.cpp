#include "certificate/sampled_error_bound.h"

#include <limits>

namespace sampled_data_observers {
namespace {

// The state.
constexpr int kLevel = 0;
constexpr int kTau = 1;         // s
constexpr int kHasSampled = 2;  // 0 or 1

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

void SampledErrorBound::initialize(double* state) const { begin(initial_error_, state); }

void SampledErrorBound::begin(double error, double* state) const {
  state[kLevel] = level_per_error_ * error;
  state[kTau] = 0.0;
  state[kHasSampled] = 0.0;
}

void SampledErrorBound::flow(double duration, double* state) const { state[kTau] += duration; }

void SampledErrorBound::sample(double* state, double* workspace) const {
  const double tau = state[kTau];
  double& level = state[kLevel];
  if (level != kInfinity) {
    level = state[kHasSampled] == 0.0 ? first_level(level, tau, workspace)
                                      : next_level(level, tau, workspace);
  }
  state[kTau] = 0.0;
  state[kHasSampled] = 1.0;
}

void SampledErrorBound::jump(double, double* state) const { state[kLevel] = kInfinity; }

double SampledErrorBound::bound(const double* state) const {
  if (state[kLevel] == kInfinity) return kInfinity;
  return state[kHasSampled] == 0.0 ? first_error(state[kLevel], state[kTau])
                                   : error(state[kLevel], state[kTau]);
}

}  // namespace sampled_data_observers
