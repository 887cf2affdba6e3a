#pragma once

#include "certificate/certificate.h"
#include "certificate/error_bound.h"

namespace sampled_data_observers {

/// A bound that is carried from sample to sample as one number, a level, and follows between them
/// from the level and the time τ since the last sample.
///
/// Samples may come at any time: from T1 to T2 apart the level falls as the theorem says, and else
/// it is what the flow and the sample make of it at most. Plant jumps end the guarantee.
class SampledErrorBound : public ErrorBound {
 public:
  Eigen::Index state_size() const final { return 3; }
  void initialize(double* state) const final;
  void begin(double error, double* state) const final;
  void flow(double duration, double* state) const final;
  void sample(double* state, double* workspace) const final;
  void jump(double moved, double* state) const final;
  double bound(const double* state) const final;

 protected:
  /// @param level_per_error  the level where the estimate begins with an error of norm 1
  SampledErrorBound(const CertificateSubject& subject, double level_per_error, double initial_error)
      : T1_(subject.T1),
        T2_(subject.T2),
        level_per_error_(level_per_error),
        initial_error_(initial_error) {}

  /// Whether a sample at τ [s] after the one before is among those that the theorem is about.
  bool is_foreseen(double tau) const { return T1_ <= tau && tau <= T2_; }

  /// The level after a sample at τ [s] >= 0, and after the first one.
  virtual double next_level(double level, double tau, double* workspace) const = 0;
  virtual double first_level(double level, double tau, double* workspace) const = 0;

  /// The bound on |x − x̂| at τ [s], and before the first sample.
  virtual double error(double level, double tau) const = 0;
  virtual double first_error(double level, double tau) const = 0;

 private:
  double T1_;
  double T2_;
  double level_per_error_;
  double initial_error_;
};

}  // namespace sampled_data_observers
