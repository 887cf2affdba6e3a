#pragma once

#include <limits>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "design/lmi_program.h"
#include "design/lmi_solver.h"

namespace sampled_data_observers {

struct PlantScaling;

/// A design that can't be made, with what to change.
class DesignError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Scalars by name, such as delta or lambda_t.
using Parameters = std::map<std::string, double>;

enum class Objective { kFeasible, kMinGamma, kMaxT2, kMinT1, kMaxDecay, kMinFinalError };
const char* to_string(Objective objective);

/// A scalar of a method that is chosen before its inequalities are linear.
struct DesignParameter {
  std::string name;
  std::string meaning;  ///< for the help, with its unit
  /// Used where the user gives none and does not ask for a search.
  std::optional<double> default_value;
  /// Without default, the parameter is always searched for.
  std::optional<SearchRange> search;
};

/// What a design starts from: the plant, the times, and what the user fixed.
struct DesignProblem {
  CertificateSubject subject;
  Parameters given;
  /// Those to search for although they have defaults.
  std::set<std::string> searched;
  Objective objective = Objective::kFeasible;
  /// Whether a largest T2 or rate less than the one given is an answer, which for new gains it is
  /// not.
  bool accepts_less = false;
  /// Whether the proof of a least final error may be about a rate at which the error hardly falls.
  bool accepts_slow = false;
  /// What the final error of min-final-error is due to: noise and disturbance.
  ErrorAssumptions assumptions;
};

/// Gains with the matrices that prove them; or why there are none.
struct DesignCandidate {
  /// All that the theorem names; empty where there is no design.
  NamedMatrices values;
  /// least_margin() of the theorem's own conditions, in the units of the attempt: > 0 where they
  /// hold.
  double margin = 0.0;
  /// How good it is by the objective: the smaller the better.
  double cost = 0.0;
  /// Conditions that ball arithmetic proved, which are all of them, or none was tried.
  std::size_t proved_conditions = 0;
  /// What `gain_bound` is in the units of the plant file; 0 where no gain is bounded.
  double gain_bound = 0.0;
  std::string solver;
  /// What went wrong, where there is no design.
  std::string message;

  bool is_verified() const { return !values.empty() && margin > 0.0; }
};

/// Whether a is the better one: that which holds, or else is nearer to it; of two that hold, that
/// of less cost.
bool is_better(const DesignCandidate& a, const DesignCandidate& b);

/// What the first program of an attempt tells of it.
struct DesignEstimate {
  /// By the objective, in the units of the attempt, to be compared with other estimates of the
  /// method; infinite where there is no solution.
  double cost = std::numeric_limits<double>::infinity();
  /// Why there is none.
  std::string message;
};

/// A way to find gains for which the conditions of a theorem hold.
class DesignMethod {
 public:
  DesignMethod() = default;
  DesignMethod(const DesignMethod&) = delete;
  DesignMethod& operator=(const DesignMethod&) = delete;
  virtual ~DesignMethod() = default;

  /// Paper key and number: "ferrante2019_proposition2".
  virtual std::string name() const = 0;
  /// What it does, in one sentence.
  virtual std::string summary() const = 0;
  /// The theorem whose original conditions its gains must satisfy.
  virtual const Theorem& theorem() const = 0;
  /// Whether it restricts another method to gains of a certain form: it is tried where it is named.
  virtual bool is_special_case() const { return false; }
  /// The observer type of its gains.
  virtual std::string observer_type() const { return theorem().observer_types().front(); }

  /// @throws std::invalid_argument saying why, for a plant or times that it is not about.
  virtual void require_applicable(const CertificateSubject& subject) const {
    require_subject(theorem(), subject);
  }

  /// All scalars that the user may fix.
  virtual std::vector<DesignParameter> parameters(const CertificateSubject& subject) const = 0;

  /// The parameter that is the guaranteed rate of convergence; empty where there is none.
  virtual std::string decay_parameter() const { return theorem().decay_parameter(); }

  /// The gains whose norms its parameter `gain_bound` limits.
  virtual std::vector<std::string> bounded_gains(const CertificateSubject&) const { return {}; }

  /// Which objectives it can serve. With min-final-error, attempt() finds the assumptions among the
  /// parameters, by the names of kNoise and kDisturbance (final_error.h).
  virtual std::vector<Objective> objectives(const CertificateSubject& subject) const = 0;

  /// One attempt with all parameters chosen. Solves in the calling process, which is a worker.
  /// The candidate is verified by the theorem's own conditions.
  virtual DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                                  Objective objective) const = 0;

  /// What one program tells of an attempt; none where that takes a whole attempt.
  virtual std::optional<DesignEstimate> estimate(const CertificateSubject& /*subject*/,
                                                 const Parameters& /*parameters*/,
                                                 Objective /*objective*/) const {
    return std::nullopt;
  }

  /// attempt() for a plant and parameters in the units of a scaling; one who knows the gains
  /// scales them as well.
  virtual DesignCandidate attempt_scaled(const CertificateSubject& subject,
                                         const Parameters& parameters, Objective objective,
                                         const PlantScaling& /*scaling*/) const {
    return attempt(subject, parameters, objective);
  }

  /// Makes exact again what rounding has changed on the way back to the units of the plant file,
  /// and what is exact by the method's definition.
  virtual void restore(const CertificateSubject& /*subject*/, NamedMatrices& /*values*/) const {}
};

/// A method that is one semidefinite program: it states its variables and its inequalities as named
/// blocks in the paper's notation, and how gains come out of a solution.
class LmiDesignMethod : public DesignMethod {
 public:
  /// Solves the program, and takes the matrices that prove the gains from its solution where it has
  /// all that the theorem names. The candidate is checked by the theorem's own conditions.
  DesignCandidate solve(const CertificateSubject& subject, const Parameters& parameters,
                        Objective objective) const;

  /// The same, but lets the theorem find these matrices, with the gains fixed (certify_here()).
  DesignCandidate attempt(const CertificateSubject& subject, const Parameters& parameters,
                          Objective objective) const override;

  /// @throws std::invalid_argument saying why, for parameters that it can't have.
  virtual LmiProgram program(const CertificateSubject& subject, const Parameters& parameters,
                             Objective objective) const = 0;

 protected:
  /// For methods whose attempts are those of this class.
  DesignEstimate estimate_by_program(const CertificateSubject& subject,
                                     const Parameters& parameters, Objective objective) const;

  /// The gains by name; none where the solution is so inaccurate that they are not what was asked.
  virtual NamedMatrices gains(const CertificateSubject& subject, const Parameters& parameters,
                              const NamedMatrices& solution) const = 0;

 private:
  DesignCandidate certified(const CertificateSubject& subject, const Parameters& parameters,
                            Objective objective, const DesignCandidate& solved) const;
};

/// All methods, and the one of a name; null where there is none.
const std::vector<const DesignMethod*>& design_methods();
const DesignMethod* find_design_method(const std::string& name);

}  // namespace sampled_data_observers
