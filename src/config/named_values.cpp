#include "config/named_values.h"

#include <map>

namespace sampled_data_observers {
namespace {

Eigen::MatrixXd read_value(ConfigSection& section, const std::string& key,
                           const NamedShape& shape) {
  if (shape.form == NamedShape::Form::kList) return section.vector(key, shape.cols).transpose();
  if (shape.rows == 1 && shape.cols == 1 && !section.is_list(key)) {
    return scalar_matrix(section.number(key));
  }
  Eigen::MatrixXd value = section.matrix(key, shape.rows, shape.cols);
  if (shape.form == NamedShape::Form::kSymmetric && !value.isApprox(value.transpose(), 1e-12)) {
    throw section.error(key, "a symmetric matrix", "another");
  }
  return value;
}

/// What is read, and where in its name the keys of the section begin.
struct ShapeBelow {
  const NamedShape* shape;
  std::size_t begin;

  /// The keys that are left.
  std::string name() const { return shape->name.substr(begin); }
};

void read_below(ConfigSection& section, const std::vector<ShapeBelow>& all, NamedMatrices* values) {
  std::map<std::string, std::vector<ShapeBelow>> below;
  for (const ShapeBelow& at : all) {
    const std::string name = at.name();
    const std::size_t slash = name.find('/');
    if (slash == std::string::npos) {
      (*values)[at.shape->name] = read_value(section, name, *at.shape);
    } else {
      below[name.substr(0, slash)].push_back({at.shape, at.begin + slash + 1});
    }
  }
  for (const auto& [key, shapes] : below) {
    ConfigSection of_key = section.section(key);
    read_below(of_key, shapes, values);
    of_key.finish();
  }
}

}  // namespace

NamedMatrices read_named_values(ConfigSection& section, const std::vector<NamedShape>& shapes) {
  std::vector<ShapeBelow> all;
  for (const NamedShape& shape : shapes) all.push_back({&shape, 0});
  NamedMatrices values;
  read_below(section, all, &values);
  return values;
}

StatedErrorMaps read_stated_error_maps(ConfigSection& section, Eigen::Index n) {
  StatedErrorMaps stated;
  if (section.has("A")) stated.A = section.matrix("A", n, n);
  if (section.has("A_d")) stated.A_d = section.matrix("A_d", n, n);
  return stated;
}

}  // namespace sampled_data_observers
