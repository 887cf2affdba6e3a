#include "config/claimed_gains.h"

namespace sampled_data_observers {

const char kGainsRemedy[] =
    "; make them again with 'design synthesize', or set allow_uncertified: true to run without "
    "guarantee";

namespace {

std::string a_matrix(Eigen::Index rows, Eigen::Index cols) {
  return "a " + std::to_string(rows) + " x " + std::to_string(cols) + " matrix";
}

std::string what_is(const LawGain* gain) {
  if (gain == nullptr) return "nothing";
  return gain->value.size() == 0 ? "a formula" : a_matrix(gain->value.rows(), gain->value.cols());
}

}  // namespace

NamedMatrices gains_of_theorem(const ConfigSection& gains, const Theorem& theorem,
                               const CertificateSubject& subject, const LawGains& law) {
  NamedMatrices values;
  for (const NamedShape& shape : theorem.gains(subject)) {
    const LawGain* gain = law.find(shape.name);
    if (gain == nullptr || gain->value.rows() != shape.rows || gain->value.cols() != shape.cols) {
      const bool is_number = shape.form == NamedShape::Form::kScalar;
      throw gains.error(
          shape.name,
          (is_number ? "a number" : a_matrix(shape.rows, shape.cols) + " of numbers") + ", since " +
              theorem.name() + " is about it",
          what_is(gain));
    }
    values[shape.name] = gain->value;
  }
  return values;
}

std::optional<ConfigError> objection_to_gains(const ConfigSection& gains, const Theorem& theorem,
                                              const CertificateSubject& subject,
                                              const LawGains& law) {
  const std::vector<std::string> beside = gains_beside(theorem, subject, law);
  if (!beside.empty()) {
    const std::string key = beside.front().substr(0, beside.front().find('/'));
    return gains.error(key, "only gains that " + theorem.name() + " is about" + kGainsRemedy,
                       "'" + key + "', which changes the observer that it is about");
  }
  if (!law.output_injections.empty() && !subject.plant.stated.A) {
    return gains.error("output_injection",
                       "certificate/A, the flow of the error under the injection (design again "
                       "with design/A), or no output injection" +
                           std::string(kGainsRemedy),
                       "a certificate about the plant's own flow");
  }
  return std::nullopt;
}

}  // namespace sampled_data_observers
