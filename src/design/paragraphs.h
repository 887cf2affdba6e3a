#pragma once

#include <Eigen/Core>
#include <complex>
#include <sstream>
#include <string>
#include <vector>

namespace sampled_data_observers {

/// Text in sections of wrapped paragraphs, of at most 96 columns.
class Paragraphs {
 public:
  void heading(const std::string& text);
  /// Indented below its heading.
  void paragraph(const std::string& text);
  void bullet(const std::string& text);
  /// Columns from left to right; the last is wrapped.
  void row(const std::vector<std::string>& cells, const std::vector<std::size_t>& widths);

  std::string text() const { return out_.str(); }

 private:
  void wrap(const std::string& text, const std::string& first, const std::string& rest);

  std::ostringstream out_;
};

/// Four significant digits.
std::string brief(double value);
/// "0.118 +- 0.368i"
std::string brief(const std::complex<double>& eigenvalue);
/// The states that orthonormal directions (n x d) have a part in: "x1, x3" or "all states".
std::string states_moved(const Eigen::MatrixXd& directions, const std::vector<std::string>& names);

}  // namespace sampled_data_observers
