#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "certificate/condition.h"
#include "certificate/error_bound.h"
#include "certificate/plant_matrices.h"
#include "sampled_data_observers/observer/law_gains.h"

namespace sampled_data_observers {

/// A bound on the number N(t, s) of jumps between two times t >= s (bernard2022, definition 2.1):
/// N <= (t − s)/tau + N0 of an average dwell time, N >= (t − s)/tau − N0 of a reverse one.
struct DwellTime {
  enum class Kind { kAverage, kReverseAverage };
  Kind kind = Kind::kAverage;
  double tau = 0.0;  ///< [s]
  double N0 = 1.0;   ///< a whole number >= 1
};

/// The shortest and the longest time between two samples of a sensor [s].
struct SamplingTimes {
  double T1 = 0.0;
  double T2 = 0.0;
};

/// What a claim is about: the plant, and what is known of the times between samples or jumps.
struct CertificateSubject {
  PlantMatrices plant;
  double T1 = 0.0;  ///< the shortest [s]; 0 for any
  double T2 = 0.0;  ///< the longest [s]; ∞ where there is none
  /// In place of T1 and T2, which then are 0 and ∞.
  std::optional<DwellTime> dwell_time;
  /// Of each sampled sensor, in their order, where there are several: each is sampled whatever the
  /// others do. T1 and T2 are the shortest and the longest of them then.
  std::vector<SamplingTimes> sensor_times = {};
  /// Of a theorem whose Lyapunov function depends on timers: values of each of them, from 0 to its
  /// longest time, its shortest among them, in increasing order [s].
  std::vector<std::vector<double>> timer_nodes = {};
  /// Of such a theorem, of one timer: whether the function falls at events too, by the factor mu,
  /// which is a parameter then.
  bool falls_at_events = false;
  /// In a design, of each state's error in the final error: w of √Σ (w_i e_i)², one over the unit
  /// of the state. Empty: of the norm, and in its programs what the design finds fit.
  Eigen::VectorXd error_weights = {};
};

/// sensor_times; where there are none, those of the only sensor, or of jumps.
std::vector<SamplingTimes> times_of_timers(const CertificateSubject& subject);

/// Takes times of several sensors, and the shortest and the longest of them for T1 and T2.
void set_sensor_times(CertificateSubject& subject, std::vector<SamplingTimes> times);

/// A time that is typical of the events of a subject [s]: T2; where it has none, its dwell time,
/// T1, or the time in which the plant moves by itself.
double time_scale(const CertificateSubject& subject);

/// A matrix, a list or a number that a theorem speaks of. In files, a name "K/gps/1" stands below
/// three keys.
struct NamedShape {
  enum class Form { kScalar, kList, kMatrix, kSymmetric };
  std::string name;
  Eigen::Index rows = 1;
  Eigen::Index cols = 1;
  Form form = Form::kScalar;
};
NamedShape scalar_shape(const std::string& name);
/// A matrix of one row, in files one list.
NamedShape list_shape(const std::string& name, Eigen::Index size);
NamedShape matrix_shape(const std::string& name, Eigen::Index rows, Eigen::Index cols);
NamedShape symmetric_shape(const std::string& name, Eigen::Index n);

/// Values between which a scalar is searched for.
struct SearchRange {
  double low = 0.0;
  double high = 0.0;
  bool is_logarithmic = true;
};
struct NamedRange {
  std::string name;
  SearchRange range;
};

/// A number that follows from a proof, such as the gain from the noise to the error.
struct GuaranteedFigure {
  std::string meaning;  ///< with its unit
  double value = 0.0;
};

/// Of which times between samples or jumps a theorem speaks.
enum class TheoremTimes {
  kUpToT2,  ///< in [T1, T2]
  kFromT1,  ///< of T1 or more
  kAverageDwellTime,
  kReverseAverageDwellTime
};

/// Whether those are times on average.
constexpr bool is_of_average(TheoremTimes times) {
  return times == TheoremTimes::kAverageDwellTime ||
         times == TheoremTimes::kReverseAverageDwellTime;
}

/// A theorem of a paper: what it demands of gains and of the matrices that prove them, and what it
/// then guarantees. Stateless.
class Theorem {
 public:
  Theorem() = default;
  Theorem(const Theorem&) = delete;
  Theorem& operator=(const Theorem&) = delete;
  virtual ~Theorem() = default;

  /// Paper key and number: "ferrante2019_theorem2".
  virtual std::string name() const = 0;

  /// What it guarantees, in one sentence.
  virtual std::string guarantee() const = 0;

  /// The observer types whose gains it is about.
  virtual std::vector<std::string> observer_types() const = 0;

  virtual TheoremTimes times() const { return TheoremTimes::kUpToT2; }

  /// Whether it is about plants of several sensors that are sampled independently of each other.
  virtual bool takes_several_sensors() const { return false; }

  /// Whether it is about flows whose linear part is anywhere in a hull (flow_vertices).
  virtual bool takes_flow_vertices() const { return false; }

  /// Whether it is about functions that fall at events too (falls_at_events).
  virtual bool takes_fall_at_events() const { return false; }

  /// Whether it is about a function that is a sum of such of one timer each, so that the nodes of
  /// its timers make no grid.
  virtual bool sums_over_timers() const { return false; }

  /// @throws std::invalid_argument saying why, for a plant or times [T1, T2] that it is not about.
  virtual void require_applicable(const CertificateSubject& subject) const = 0;

  // The shapes of all that has a value in a certificate, for an applicable subject.

  /// Gains of the observer, by the names that its law has for them (LawGains).
  virtual std::vector<NamedShape> gains(const CertificateSubject& subject) const = 0;
  /// What else the section `gains` of its observer must say: the form of a HighGainObserver.
  virtual std::map<std::string, std::string> gain_choices() const { return {}; }
  /// Matrices and multipliers in which the conditions are linear where all else is fixed.
  virtual std::vector<NamedShape> multipliers(const CertificateSubject& subject) const = 0;
  /// Scalars that are chosen: rates, levels, and those searched for.
  virtual std::vector<NamedShape> parameters(const CertificateSubject& subject) const = 0;

  /// Multipliers of which only a least size matters, so that a search for them needs an end.
  virtual std::vector<std::string> unlimited_multipliers(const CertificateSubject&) const {
    return {};
  }

  /// The parameter that is the guaranteed rate of convergence; empty where there is none. What
  /// holds for a rate holds for smaller ones.
  virtual std::string decay_parameter() const { return ""; }

  /// The parameters that say nothing of the guarantee and only help to prove it, with the values
  /// among which a proof for given gains is searched.
  virtual std::vector<NamedRange> search_ranges(const CertificateSubject&) const { return {}; }

  /// Whether the conditions hold for all positive multiples of the multipliers as well.
  virtual bool is_homogeneous(const CertificateSubject& subject) const = 0;

  /// The original inequalities of the theorem, in the symbols of gains(), multipliers() and
  /// parameters(). Together they imply what it guarantees.
  virtual std::vector<Condition> conditions(const CertificateSubject& subject) const = 0;

  /// What it guarantees in numbers besides its parameters.
  /// @pre the conditions hold
  virtual std::vector<GuaranteedFigure> guaranteed_figures(const CertificateSubject&,
                                                           const NamedMatrices& /*values*/) const {
    return {};
  }

  /// What the objective min-gamma makes least, for a theorem that has a gamma.
  /// @pre the conditions hold
  virtual GuaranteedFigure gain_figure(const NamedMatrices& values) const;
  /// What the objective max-decay makes largest, for a theorem that has a decay_parameter().
  virtual GuaranteedFigure decay_figure(const NamedMatrices& values) const;

  /// The bound that it gives at run time; null where it gives none.
  /// @pre the conditions hold
  /// @throws std::invalid_argument saying why, for assumptions that the theorem can't deal with.
  virtual std::unique_ptr<const ErrorBound> error_bound(
      const CertificateSubject& subject, const NamedMatrices& values,
      const ErrorAssumptions& assumptions) const = 0;
};

/// @throws std::invalid_argument saying why, for a subject that the theorem is not about: other
/// times than those that it speaks of, or as Theorem::require_applicable().
void require_subject(const Theorem& theorem, const CertificateSubject& subject);

/// All theorems, and the one of a name; null where there is none.
const std::vector<const Theorem*>& theorems();
const Theorem* find_theorem(const std::string& name);

/// The names of those gains of a law that a theorem does not name and that are not zero: with them
/// the law is another one than it is about.
std::vector<std::string> gains_beside(const Theorem& theorem, const CertificateSubject& subject,
                                      const LawGains& law);

/// The sections of a gain file that make a claim of its gains: the one that they were made for, and
/// one that bounds their error at run time better, where there is such a one.
constexpr const char* kCertificate = "certificate";
constexpr const char* kRunTimeCertificate = "run_time_certificate";

/// The keys of a claim, and of the section `design`, that give a dwell time as {tau, N0}.
constexpr const char* kAverageDwellTime = "average_dwell_time";
constexpr const char* kReverseAverageDwellTime = "reverse_average_dwell_time";

/// A claim with its proof.
struct Certificate {
  const Theorem* theorem = nullptr;
  CertificateSubject subject;
  /// Of all that the theorem names.
  NamedMatrices values;
};

/// Checks the original inequalities in floating point.
std::vector<ConditionCheck> check(const Certificate& certificate);

/// The theorem's name and guarantee, and the numbers that the guarantee speaks of.
std::string statement(const Certificate& certificate);

}  // namespace sampled_data_observers
