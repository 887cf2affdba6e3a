#include "sampled_data_observers/design/attempts.h"

#include <locale>
#include <sstream>
#include <string>
#include <utility>

#include "sampled_data_observers/certificate/matrix_functions.h"
#include "sampled_data_observers/design/certify.h"
#include "sampled_data_observers/design/packing.h"
#include "sampled_data_observers/design/rigorous_check.h"

namespace sampled_data_observers {
namespace {

/// By which a least gamma is enlarged where its own proof fails.
constexpr double kFurtherInflations[] = {1.003, 1.01, 1.03};
/// For the proof of one attempt [s].
constexpr double kProofTime = 10.0;
/// Of the norm of a gain, for rounding.
constexpr double kBoundTolerance = 1e-9;

std::ostringstream number_text() {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  return text;
}

void refuse(DesignCandidate& candidate, const std::string& message) {
  candidate.values.clear();
  candidate.proved_conditions = 0;
  candidate.message = message;
}

void require_gain_bound(const DesignMethod& method, const CertificateSubject& subject,
                        const Parameters& parameters, DesignCandidate& candidate) {
  for (const std::string& name : method.bounded_gains(subject)) {
    const double norm = norm2(candidate.values.at(name));
    const double bound = parameters.at("gain_bound");
    if (norm <= bound * (1.0 + kBoundTolerance)) continue;
    std::ostringstream text = number_text();
    text.precision(4);
    text << "the solver left the bound on a gain: the norm of " << name << " is larger than "
         << "gain_bound = " << bound;
    refuse(candidate, text.str());
    return;
  }
}

void require_proof(const Theorem& theorem, const CertificateSubject& subject,
                   DesignCandidate& candidate) {
  ProofOptions options;
  options.time_limit = kProofTime;
  const auto proofs = prove(theorem.conditions(subject), candidate.values, options);
  for (const ConditionProof& proof : proofs) {
    if (proof.status == ProofStatus::kProved) continue;
    std::ostringstream text = number_text();
    text << "not proved in ball arithmetic: " << proof.name;
    if (proof.status == ProofStatus::kDisproved) {
      text << " does not hold";
      if (proof.tau) text << " at tau = " << *proof.tau << " s";
    } else {
      text << ": " << proof.reason;
    }
    refuse(candidate, text.str());
    return;
  }
  candidate.proved_conditions = proofs.size();
}

/// With the same gains and parameters, a gamma that is not quite the least.
DesignCandidate with_larger_gamma(const Theorem& theorem, const CertificateSubject& subject,
                                  const DesignCandidate& candidate, double factor) {
  NamedMatrices fixed = candidate.values;
  for (const NamedShape& shape : theorem.multipliers(subject)) fixed.erase(shape.name);
  const double gamma = factor * scalar_value(candidate.values, "gamma");
  fixed["gamma"] = scalar_matrix(gamma);
  DesignCandidate next = certify_here(theorem, subject, fixed, Objective::kFeasible);
  next.solver = candidate.solver;
  next.cost = gamma;
  return next;
}

std::string packed(const DesignCandidate& candidate) {
  Packer packer;
  packer.add(candidate.values);
  packer.add(candidate.margin);
  packer.add(candidate.cost);
  packer.add(candidate.solver);
  packer.add(candidate.message);
  packer.add(static_cast<std::int64_t>(candidate.proved_conditions));
  return packer.bytes();
}

DesignCandidate unpacked(const WorkerOutcome& outcome) {
  DesignCandidate candidate;
  switch (outcome.status) {
    case WorkerOutcome::Status::kDone: {
      Unpacker unpacker(outcome.result);
      candidate.values = unpacker.matrices();
      candidate.margin = unpacker.number();
      candidate.cost = unpacker.number();
      candidate.solver = unpacker.text();
      candidate.message = unpacker.text();
      candidate.proved_conditions = static_cast<std::size_t>(unpacker.integer());
      break;
    }
    case WorkerOutcome::Status::kThrew:
      candidate.message = outcome.result;
      break;
    case WorkerOutcome::Status::kTimedOut:
      candidate.message = "the solver took longer than the time limit";
      break;
    case WorkerOutcome::Status::kCrashed:
      candidate.message = "the solver's process died";
      break;
  }
  return candidate;
}

}  // namespace

DesignCandidate proved_attempt(const DesignMethod& method, const CertificateSubject& subject,
                               const Parameters& parameters, Objective objective) {
  DesignCandidate first = method.attempt(subject, parameters, objective);
  if (!first.is_verified()) return first;
  require_gain_bound(method, subject, parameters, first);
  if (!first.is_verified()) return first;
  const Theorem& theorem = method.theorem();
  DesignCandidate candidate = first;
  require_proof(theorem, subject, candidate);
  if (candidate.is_verified() || objective != Objective::kMinGamma) return candidate;
  for (const double factor : kFurtherInflations) {
    DesignCandidate next = with_larger_gamma(theorem, subject, first, factor);
    if (!next.is_verified()) continue;
    require_proof(theorem, subject, next);
    if (next.is_verified()) return next;
  }
  return candidate;
}

std::vector<DesignCandidate> proved_attempts(const DesignMethod& method,
                                             const CertificateSubject& subject,
                                             const std::vector<Parameters>& choices,
                                             Objective objective, const WorkerOptions& workers) {
  const auto outcomes = run_in_workers(
      choices.size(),
      [&](std::size_t i) { return packed(proved_attempt(method, subject, choices[i], objective)); },
      workers);
  std::vector<DesignCandidate> candidates;
  candidates.reserve(outcomes.size());
  for (const WorkerOutcome& outcome : outcomes) candidates.push_back(unpacked(outcome));
  return candidates;
}

}  // namespace sampled_data_observers
