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

StatedErrorMaps read_stated_error_maps(ConfigSection& section, Eigen::Index n) {
  StatedErrorMaps stated;
  if (section.has("A")) stated.A = section.matrix("A", n, n);
  if (section.has("A_d")) stated.A_d = section.matrix("A_d", n, n);
  return stated;
}

}  // namespace sampled_data_observers
