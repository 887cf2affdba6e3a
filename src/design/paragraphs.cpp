#include "design/paragraphs.h"

#include <cstdio>

namespace sampled_data_observers {
namespace {

constexpr std::size_t kColumns = 96;
constexpr double kNoPart = 1e-6;

}  // namespace

void Paragraphs::heading(const std::string& text) {
  out_ << (out_.tellp() > 0 ? "\n" : "") << text << '\n';
}

void Paragraphs::paragraph(const std::string& text) { wrap(text, "  ", "  "); }

void Paragraphs::bullet(const std::string& text) { wrap(text, "  - ", "    "); }

void Paragraphs::row(const std::vector<std::string>& cells,
                     const std::vector<std::size_t>& widths) {
  std::string first = "  ";
  std::size_t indent = 2;
  for (std::size_t i = 0; i + 1 < cells.size(); ++i) {
    first += cells[i];
    indent += widths[i];
    first += std::string(first.size() + 1 < indent ? indent - first.size() : 2, ' ');
  }
  wrap(cells.back(), first, std::string(indent, ' '));
}

void Paragraphs::wrap(const std::string& text, const std::string& first, const std::string& rest) {
  std::istringstream words(text);
  std::string line = first;
  bool is_empty = true;
  for (std::string word; words >> word; is_empty = false) {
    if (!is_empty && line.size() + 1 + word.size() > kColumns) {
      out_ << line << '\n';
      line = rest;
      is_empty = true;
    }
    line += (is_empty ? "" : " ") + word;
  }
  out_ << line << '\n';
}

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string brief(const std::complex<double>& eigenvalue) {
  const std::string real = brief(eigenvalue.real());
  return eigenvalue.imag() == 0.0 ? real : real + " +- " + brief(eigenvalue.imag()) + "i";
}

std::string states_moved(const Eigen::MatrixXd& directions, const std::vector<std::string>& names) {
  std::string text;
  std::size_t count = 0;
  for (Eigen::Index i = 0; i < directions.rows(); ++i) {
    if (directions.row(i).norm() < kNoPart) continue;
    text += (text.empty() ? "" : ", ") + names[static_cast<std::size_t>(i)];
    ++count;
  }
  return count == names.size() && count > 1 ? "all states" : text;
}

}  // namespace sampled_data_observers
