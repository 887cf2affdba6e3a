#pragma once

#include "certificate/certificate.h"
#include "certificate/error_bound.h"

namespace sampled_data_observers {

/// What the bounds of all theorems share: a few numbers, at which they look over one interval after
/// another, each from the last event that the theorem is about (a sample, or a jump of the plant)
/// to the next, and the first one from where the estimate begins.
///
/// State: time since the interval began [s] | whether it began at an event, 0 or 1 | the numbers,
/// of which the first one is infinite where nothing is known any more.
class IntervalBound : public ErrorBound {
 public:
  Eigen::Index state_size() const final { return kNumbers + numbers_; }
  void initialize(double* state) const final { begin(initial_error_, state); }
  void begin(double error, double* state) const final;
  void narrow(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* state) const override;
  void flow(double duration, double* state) const final;
  double bound(const double* state) const final;
  void state_bounds(const double* state, double* workspace,
                    Eigen::Ref<Eigen::VectorXd> bounds) const override;
  void ellipsoid(const double* state, double* workspace,
                 Eigen::Ref<Eigen::MatrixXd> Q) const override;
  double jump_stamp_error() const final { return jump_stamp_error_; }
  bool lets_jumps_coincide() const final { return jumps_coincide_; }

 protected:
  struct Interval {
    double tau = 0.0;       ///< time since it began [s]
    bool is_first = false;  ///< whether the estimate began with it
  };

  /// @param numbers  how many there are, >= 1
  IntervalBound(const CertificateSubject& subject, const ErrorAssumptions& assumptions,
                Eigen::Index numbers)
      : T1_(subject.T1),
        T2_(subject.T2),
        jumps_coincide_(subject.T1 == 0.0 || subject.dwell_time),
        initial_error_(assumptions.initial_error),
        jump_stamp_error_(assumptions.jump_stamp_error),
        numbers_(numbers) {}

  /// The numbers where the estimate begins with |x − x̂| <= error.
  virtual void begin_numbers(double error, double* numbers) const = 0;

  /// After that, where (x − x̂)(x − x̂)ᵀ <= Q is known, too. By default they stay.
  virtual void narrow_numbers(const Eigen::Ref<const Eigen::MatrixXd>& Q, double* numbers) const;

  /// Carries the numbers over `duration` > 0 [s]; `from` is where that begins. By default they
  /// stay, for bounds that follow from them and τ.
  virtual void flow_numbers(double duration, const Interval& from, double* numbers) const;

  /// The bound on |x − x̂|.
  virtual double error(const Interval& at, const double* numbers) const = 0;

  /// Those on its entries. By default error() for each.
  virtual void errors(const Interval& at, const double* numbers, double* workspace,
                      Eigen::Ref<Eigen::VectorXd> bounds) const;

  /// The ellipsoid around it. By default the ball of error().
  virtual void error_ellipsoid(const Interval& at, const double* numbers, double* workspace,
                               Eigen::Ref<Eigen::MatrixXd> Q) const;

  // Whether an event at τ [s] after the one before is among those that the theorem is about.
  bool is_foreseen(double tau) const { return T1_ <= tau && tau <= T2_; }
  bool is_too_soon(double tau) const { return tau < T1_; }
  bool is_late(double tau) const { return tau > T2_; }
  /// How much of `duration` from τ on lies before T2 [s].
  double foreseen_part(double duration, double tau) const;

  static Interval interval(const double* state);
  static double* numbers(double* state) { return state + kNumbers; }
  static const double* numbers(const double* state) { return state + kNumbers; }
  /// At an event that the theorem is about.
  static void begin_interval(double* state);
  static bool is_lost(const double* state);
  static void lose(double* state);

 private:
  enum Entry { kTau, kHasEvent, kNumbers };

  double T1_;
  double T2_;
  bool jumps_coincide_;
  double initial_error_;
  double jump_stamp_error_;
  Eigen::Index numbers_;
};

/// That of an observer that corrects at samples, or between them: its intervals are those between
/// samples. Samples may come at any time; plant jumps end the guarantee.
class SampledErrorBound : public IntervalBound {
 public:
  void sample(std::size_t sensor, double* state, double* workspace) const final;
  void jump(const JumpMotion& motion, double* state) const final;

 protected:
  using IntervalBound::IntervalBound;

  /// What a sample makes of the numbers; `at` is still the interval that it ends.
  virtual void sample_numbers(const Interval& at, double* numbers, double* workspace) const = 0;
};

}  // namespace sampled_data_observers
