#include "design/written_values.h"

#include <set>
#include <utility>

#include "design/yaml_text.h"
#include "files/csv.h"

namespace sampled_data_observers {
namespace {

/// A key, or several joined by '/', and the text of its value.
using Entries = std::vector<std::pair<std::string, std::string>>;

std::string row_as_list(const Eigen::MatrixXd& matrix, Eigen::Index row) {
  std::string text = "[";
  for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
    text += (j == 0 ? "" : ", ") + shortest_decimal(matrix(row, j));
  }
  return text + "]";
}

std::string value_text(const NamedShape& shape, const Eigen::MatrixXd& value) {
  switch (shape.form) {
    case NamedShape::Form::kScalar:
      return shortest_decimal(value(0, 0));
    case NamedShape::Form::kList:
      return row_as_list(value, 0);
    case NamedShape::Form::kMatrix:
    case NamedShape::Form::kSymmetric:
      break;
  }
  return nested_lists(value);
}

/// In quotes where it is a number: ROS' loader of parameters takes texts only for keys.
std::string key_text(const std::string& key) {
  const bool is_number = key.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? yaml_scalar(key) : key;
}

/// Those of a first key together, where the first of them stands.
void write_entries(const Entries& entries, const std::string& indent, std::ostream& out) {
  std::set<std::string> begun;
  for (const auto& [name, text] : entries) {
    const std::size_t slash = name.find('/');
    const std::string key = name.substr(0, slash);
    if (slash == std::string::npos) {
      out << indent << key_text(key) << ": " << text << '\n';
      continue;
    }
    if (!begun.insert(key).second) continue;
    Entries below;
    for (const auto& [other, other_text] : entries) {
      if (other.compare(0, slash + 1, key + "/") == 0) {
        below.emplace_back(other.substr(slash + 1), other_text);
      }
    }
    out << indent << key_text(key) << ":\n";
    write_entries(below, indent + "  ", out);
  }
}

}  // namespace

std::string nested_lists(const Eigen::MatrixXd& matrix) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    text += (i == 0 ? "" : ", ") + row_as_list(matrix, i);
  }
  return text + "]";
}

void write_named_values(const std::vector<NamedShape>& shapes, const NamedMatrices& values,
                        std::ostream& out) {
  Entries entries;
  for (const NamedShape& shape : shapes) {
    entries.emplace_back(shape.name, value_text(shape, values.at(shape.name)));
  }
  write_entries(entries, "  ", out);
}

}  // namespace sampled_data_observers
