#include <algorithm>
#include <cmath>

#include "certificate/bernard2022.h"

namespace sampled_data_observers {
namespace {

std::vector<Condition> domain_of_dwell_time(const DwellTime& dwell_time) {
  return {{"tau > 0", dwell_time.tau, std::nullopt, Condition::Kind::kPositive},
          {"N0 >= 1", dwell_time.N0 - 1.0, std::nullopt, Condition::Kind::kNonNegative}};
}

}  // namespace

LyapunovRates lyapunov_rates(const CertificateSubject& subject, FlowOfError kind) {
  const bool decays = kind == FlowOfError::kDecays;
  const MatrixExpression rate = symbol(decays ? "flow_decay" : "flow_growth");
  const MatrixExpression a_c = decays ? -rate : rate;
  std::vector<Condition> domains = domain_of_times(subject.T1, subject.T2);
  domains.push_back(
      {decays ? "a_c < 0" : "a_c > 0", rate, std::nullopt, Condition::Kind::kPositive});
  if (!subject.dwell_time) {
    const MatrixExpression jump_decay = symbol("jump_decay");
    domains.push_back(positive("jump_decay"));
    const MatrixExpression a_d =
        -(a_c * MatrixExpression(decays ? subject.T1 : subject.T2)) - 2.0 * jump_decay;
    return {a_c, a_d, domains};
  }
  for (const Condition& condition : domain_of_dwell_time(*subject.dwell_time)) {
    domains.push_back(condition);
  }
  const MatrixExpression decay = symbol("decay");
  domains.push_back(positive("decay"));
  const MatrixExpression remains = -a_c - 2.0 * decay;
  if (decays) {
    // Otherwise few jumps, which an average dwell time allows, would be the worst.
    domains.push_back(
        {"a_d >= 0: flow_decay >= 2 decay", remains, std::nullopt, Condition::Kind::kNonNegative});
  }
  return {a_c, remains * MatrixExpression(subject.dwell_time->tau), domains};
}

std::vector<NamedShape> LyapunovTheorem::parameters(const CertificateSubject&) const {
  return {scalar_shape(kind_ == FlowOfError::kDecays ? "flow_decay" : "flow_growth"),
          scalar_shape(decay_parameter())};
}

std::string LyapunovTheorem::decay_parameter() const {
  return is_of_average(times_) ? "decay" : "jump_decay";
}

GuaranteedFigure LyapunovTheorem::decay_figure(const NamedMatrices& values) const {
  return is_of_average(times_) ? Theorem::decay_figure(values) : jump_decay_figure(values);
}

std::vector<GuaranteedFigure> LyapunovTheorem::guaranteed_figures(
    const CertificateSubject& subject, const NamedMatrices& values) const {
  if (!is_of_average(times_)) return {};
  const double a_d = evaluate(lyapunov_rates(subject, kind_).a_d, values, 0.0)(0, 0);
  return {
      {"factor by which the error may be larger than exp(-decay t) times what it was, in the "
       "norm of P",
       std::exp(std::abs(a_d) * subject.dwell_time->N0 / 2.0)}};
}

GuaranteedFigure jump_decay_figure(const NamedMatrices& values) {
  return {"guaranteed fall of the logarithm of the error per jump",
          scalar_value(values, "jump_decay")};
}

SearchRange flow_decay_range(const CertificateSubject& subject) {
  const double scale = time_scale(subject);
  return {1e-2 / scale, 100.0 / std::max(subject.T1, 1e-3 * scale), true};
}

SearchRange flow_growth_range(const CertificateSubject& subject) {
  const double scale = time_scale(subject);
  return {1e-3 / scale, 10.0 / scale, true};
}

}  // namespace sampled_data_observers
