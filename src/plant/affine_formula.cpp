#include "plant/affine_formula.h"

#include <cctype>
#include <locale>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

namespace sampled_data_observers {
namespace {

constexpr double kPiOfFormulas = 3.14159265358979323846;
/// Brackets within each other; more than that nobody writes.
constexpr int kDeepestBrackets = 100;

/// Coefficients of x and u, and behind them the constant.
using AffineForm = Eigen::RowVectorXd;

/// Reads one formula, by recursive descent.
class AffineFormula {
 public:
  AffineFormula(const std::map<std::string, AffineForm>& names, Eigen::Index size,
                const std::string& text)
      : names_(names), size_(size), text_(text) {}

  /// Nothing where it is not affine.
  std::optional<AffineForm> read() {
    std::optional<AffineForm> form = sum();
    if (!form || next() != '\0' || !form->allFinite()) return std::nullopt;
    return form;
  }

 private:
  static bool is_letter(char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
  }
  static bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

  /// The next character that is no space; '\0' at the end.
  char next() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool is_constant(const AffineForm& form) const { return form.head(size_).isZero(0.0); }

  std::optional<AffineForm> sum() {
    std::optional<AffineForm> result = product();
    while (result && (next() == '+' || next() == '-')) {
      const bool is_minus = text_[at_++] == '-';
      const std::optional<AffineForm> term = product();
      if (!term) return std::nullopt;
      *result += is_minus ? AffineForm(-*term) : *term;
    }
    return result;
  }

  std::optional<AffineForm> product() {
    std::optional<AffineForm> result = factor();
    while (result && (next() == '*' || next() == '/')) {
      const bool is_quotient = text_[at_++] == '/';
      const std::optional<AffineForm> other = factor();
      if (!other) return std::nullopt;
      if (is_quotient) {
        if (!is_constant(*other)) return std::nullopt;
        *result /= (*other)(size_);
      } else if (is_constant(*other)) {
        *result *= (*other)(size_);
      } else if (is_constant(*result)) {
        *result = (*result)(size_) * *other;
      } else {
        return std::nullopt;
      }
    }
    return result;
  }

  std::optional<AffineForm> factor() {
    bool is_negative = false;
    for (; next() == '-' || next() == '+'; ++at_) is_negative ^= text_[at_] == '-';
    std::optional<AffineForm> form = without_sign();
    if (form && is_negative) *form = -*form;
    return form;
  }

  std::optional<AffineForm> without_sign() {
    const char c = next();
    if (c == '(') return in_brackets();
    if (is_letter(c)) return name();
    return is_digit(c) || c == '.' ? number() : std::nullopt;
  }

  std::optional<AffineForm> in_brackets() {
    if (++depth_ > kDeepestBrackets) return std::nullopt;
    ++at_;
    std::optional<AffineForm> form = sum();
    if (!form || next() != ')') return std::nullopt;
    ++at_;
    --depth_;
    return form;
  }

  std::optional<AffineForm> name() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const auto found = names_.find(text_.substr(begin, at_ - begin));
    if (found == names_.end()) return std::nullopt;
    return found->second;
  }

  std::optional<AffineForm> number() {
    const std::size_t begin = at_;
    const auto is_sign_of_exponent = [this, begin] {
      const bool is_sign = text_[at_] == '+' || text_[at_] == '-';
      return is_sign && at_ > begin && (text_[at_ - 1] == 'e' || text_[at_ - 1] == 'E');
    };
    while (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.' || text_[at_] == 'e' ||
                                  text_[at_] == 'E' || is_sign_of_exponent())) {
      ++at_;
    }
    std::istringstream digits(text_.substr(begin, at_ - begin));
    digits.imbue(std::locale::classic());
    AffineForm form = AffineForm::Zero(size_ + 1);
    if (!(digits >> form(size_)) || !digits.eof()) return std::nullopt;
    return form;
  }

  const std::map<std::string, AffineForm>& names_;
  Eigen::Index size_;
  const std::string& text_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::shared_ptr<const AffineMap> affine_map_of(const ExpressionNames& names,
                                               const std::vector<std::string>& texts) {
  const auto n = static_cast<Eigen::Index>(names.x.size());
  const auto p = static_cast<Eigen::Index>(names.u.size());
  std::map<std::string, AffineForm> known;
  const auto constant = [&](double value) {
    AffineForm form = AffineForm::Zero(n + p + 1);
    form(n + p) = value;
    return form;
  };
  known["pi"] = constant(kPiOfFormulas);
  for (const auto& [name, value] : names.constants) known[name] = constant(value);
  for (Eigen::Index i = 0; i < n + p; ++i) {
    const auto at = static_cast<std::size_t>(i < n ? i : i - n);
    known[i < n ? names.x[at] : names.u[at]] = AffineForm::Unit(n + p + 1, i);
  }
  const auto size = static_cast<Eigen::Index>(texts.size());
  Eigen::MatrixXd M(size, n);
  Eigen::MatrixXd N(size, p);
  Eigen::VectorXd c(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const std::string& text = texts[static_cast<std::size_t>(i)];
    const std::optional<AffineForm> form = AffineFormula(known, n + p, text).read();
    if (!form) return nullptr;
    M.row(i) = form->head(n);
    N.row(i) = form->segment(n, p);
    c(i) = (*form)(n + p);
  }
  if (N.isZero(0.0)) N.resize(size, 0);
  return std::make_shared<const AffineMap>(std::move(M), std::move(N), std::move(c));
}

}  // namespace sampled_data_observers
