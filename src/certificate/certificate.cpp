#include "certificate/certificate.h"

#include <algorithm>
#include <cstdio>
#include <regex>

#include "certificate/theorems.h"

namespace sampled_data_observers {

NamedShape scalar_shape(const std::string& name) { return {name, 1, 1, NamedShape::Form::kScalar}; }

NamedShape matrix_shape(const std::string& name, Eigen::Index rows, Eigen::Index cols) {
  return {name, rows, cols, NamedShape::Form::kMatrix};
}

NamedShape symmetric_shape(const std::string& name, Eigen::Index n) {
  return {name, n, n, NamedShape::Form::kSymmetric};
}

GuaranteedFigure Theorem::gain_figure(const NamedMatrices& values) const {
  return {"L2 gain from the disturbance to the performance output", scalar_value(values, "gamma")};
}

GuaranteedFigure Theorem::decay_figure(const NamedMatrices& values) const {
  return {"guaranteed rate of convergence [1/s]", scalar_value(values, decay_parameter())};
}

const std::vector<const Theorem*>& theorems() {
  static const std::vector<const Theorem*> all = {
      &bernard2022_corollary5_2(),    &bernard2022_equation14(),
      &bernard2022_equation22(),      &bernard2022_equation26(),
      &bernard2022_example4_2(),      &bernard2022_example7_1(),
      &bernard2022_section7_3_2(),    &etienne2019_proposition1(),
      &etienne2019_proposition2(),    &etienne2019_proposition2_channels(),
      &etienne2019_theorem1(),        &ferrante2016_theorem1(),
      &ferrante2019_theorem2(),       &ferrante2019_corollary1(),
      &ferrante2019_corollary2(),     &sferlazza2019_theorem2(),
      &sferlazza2019_theorem2_rate(), &sferlazza2019_equation17(),
  };
  return all;
}

const Theorem* find_theorem(const std::string& name) {
  const auto& all = theorems();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Theorem* theorem) { return theorem->name() == name; });
  return found == all.end() ? nullptr : *found;
}

std::vector<std::string> gains_beside(const Theorem& theorem, const CertificateSubject& subject,
                                      const LawGains& law) {
  const std::vector<NamedShape> known = theorem.gains(subject);
  std::vector<std::string> names;
  for (const LawGain& gain : law.all) {
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const NamedShape& shape) {
      return is_named(gain.name, shape.name);
    });
    const bool is_zero = gain.value.size() > 0 && gain.value.isZero(0.0);
    if (!is_known && !is_zero) names.push_back(gain.name);
  }
  return names;
}

std::vector<ConditionCheck> check(const Certificate& certificate) {
  return check(certificate.theorem->conditions(certificate.subject), certificate.values);
}

std::string statement(const Certificate& certificate) {
  const Theorem& theorem = *certificate.theorem;
  const CertificateSubject& subject = certificate.subject;
  const std::string guarantee = theorem.guarantee();
  std::string text = theorem.name() + ": " + guarantee;
  const char* separator = " (";
  const auto add = [&](const std::string& name, double value, const char* unit) {
    if (!std::regex_search(guarantee, std::regex("\\b" + name + "\\b"))) return;
    char number[32];
    std::snprintf(number, sizeof number, "%.4g", value);
    text += separator + name + " = " + number + unit;
    separator = ", ";
  };
  for (const auto& shapes : {theorem.multipliers(subject), theorem.parameters(subject)}) {
    for (const NamedShape& shape : shapes) {
      if (shape.form != NamedShape::Form::kScalar) continue;
      add(shape.name, certificate.values.at(shape.name)(0, 0), "");
    }
  }
  add("T1", subject.T1, " s");
  add("T2", subject.T2, " s");
  if (*separator == ',') text += ")";
  return text;
}

}  // namespace sampled_data_observers
