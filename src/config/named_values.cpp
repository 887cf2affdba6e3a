#include "config/named_values.h"

namespace sampled_data_observers {
namespace {

Eigen::MatrixXd read_value(ConfigSection& section, const std::string& key,
                           const NamedShape& shape) {
  if (shape.rows == 1 && shape.cols == 1 && !section.is_list(key)) {
    return scalar_matrix(section.number(key));
  }
  Eigen::MatrixXd value = section.matrix(key, shape.rows, shape.cols);
  if (shape.form == NamedShape::Form::kSymmetric && !value.isApprox(value.transpose(), 1e-12)) {
    throw section.error(key, "a symmetric matrix", "another");
  }
  return value;
}

}  // namespace

NamedMatrices read_named_values(ConfigSection& section, const std::vector<NamedShape>& shapes) {
  NamedMatrices values;
  for (const NamedShape& shape : shapes) {
    const std::size_t slash = shape.name.find('/');
    if (slash == std::string::npos) {
      values[shape.name] = read_value(section, shape.name, shape);
      continue;
    }
    ConfigSection below = section.section(shape.name.substr(0, slash));
    values[shape.name] = read_value(below, shape.name.substr(slash + 1), shape);
  }
  return values;
}

NamedMatrices read_gain_values(ConfigSection& gains, const std::vector<NamedShape>& shapes,
                               const CertificateSubject& subject) {
  NamedMatrices values;
  for (const NamedShape& shape : shapes) {
    const bool is_injection = shape.name == "H" && gains.has("variant");
    if (is_injection) {
      const bool predicts =
          gains.choice("variant", {"predictor", "zero_order_hold"}) == "predictor";
      values["H"] = predicts ? Eigen::MatrixXd(-subject.plant.C() * values.at("L"))
                             : Eigen::MatrixXd::Zero(shape.rows, shape.cols);
    } else if (shape.name.find('/') == std::string::npos && gains.is_map(shape.name)) {
      // Below the name of its one sensor.
      ConfigSection sensors = gains.section(shape.name);
      const std::vector<std::string> names = sensors.keys();
      if (names.size() != 1) {
        throw gains.error(shape.name, "the gain of one sensor", std::to_string(names.size()));
      }
      values[shape.name] = read_value(sensors, names.front(), shape);
    } else {
      values.merge(read_named_values(gains, {shape}));
    }
  }
  return values;
}

StatedErrorMaps read_stated_error_maps(ConfigSection& section, Eigen::Index n) {
  StatedErrorMaps stated;
  if (section.has("A")) stated.A = section.matrix("A", n, n);
  if (section.has("A_d")) stated.A_d = section.matrix("A_d", n, n);
  return stated;
}

}  // namespace sampled_data_observers
