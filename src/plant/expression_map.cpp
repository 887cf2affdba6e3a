#include "sampled_data_observers/plant/expression_map.h"

#include <muParser.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <optional>

#include "plant/formula_program.h"

namespace sampled_data_observers {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// As many as fit on a few lines of a message.
constexpr std::size_t kNamesShown = 20;
/// Longer ones take muParser seconds, or are refused by it.
constexpr std::size_t kLongestFormula = 10000;

/// A formula, or a part of one, in quotes and on less than a line.
std::string quoted(const std::string& text) {
  constexpr std::size_t kMost = 60;
  if (text.size() <= kMost) return "'" + text + "'";
  return "'" + text.substr(0, kMost) + "...' (" + std::to_string(text.size()) + " characters)";
}

void check_name(const std::string& name) {
  bool fits = !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0;
  for (const char c : name) {
    fits = fits && (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_');
  }
  if (!fits) {
    throw ExpressionError(name,
                          "formulas take names of letters, digits and '_' that start with no "
                          "digit, not " +
                              quoted(name));
  }
}

/// What muParser says, which may quote the formula again.
std::string fault_of(const mu::ParserError& error) {
  constexpr std::size_t kMost = 100;
  const std::string& text = error.GetMsg();
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

/// muParser would let a formula change a variable.
bool assigns(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool starts = i + 1 < text.size() && text[i + 1] == '=';
    const bool ends = i > 0 && std::string("=<>!").find(text[i - 1]) != std::string::npos;
    if (!starts && !ends) return true;
  }
  return false;
}

/// Without the blanks around it, as muParser reads it.
std::string stripped(const std::string& text) {
  const auto is_blank = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
  const auto begin = std::find_if_not(text.begin(), text.end(), is_blank);
  const auto end = std::find_if_not(text.rbegin(), text.rend(), is_blank).base();
  return begin < end ? std::string(begin, end) : std::string();
}

double value_of(const mu::Parser& parser) {
  try {
    return parser.Eval();
  } catch (const mu::ParserError&) {
    return std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace

struct ExpressionMap::Program {
  struct Formula {
    const double* copied = nullptr;  ///< the value that it is
    std::optional<mu::Parser> parser;
    double constant = 0.0;  ///< what it is without these two

    double value() const {
      if (copied != nullptr) return *copied;
      return parser ? value_of(*parser) : constant;
    }
  };

  std::size_t states = 0;
  std::size_t inputs = 0;
  /// x, u, then the values of the definitions. The parsers know the addresses.
  std::vector<double> values;
  std::vector<std::string> names;
  std::vector<std::pair<std::string, double>> constants;
  std::vector<Formula> definitions;
  std::vector<Formula> expressions;

  /// A formula of the first `known` values. One that is no more than a name, or a number, needs no
  /// parser.
  Formula formula(const NamedExpression& expression, std::size_t known) {
    const mu::Parser parser = parse(expression, known);
    Formula formula;
    const auto end = names.begin() + static_cast<std::ptrdiff_t>(known);
    const auto name = std::find(names.begin(), end, stripped(expression.text));
    if (name != end) {
      formula.copied = &values[static_cast<std::size_t>(name - names.begin())];
    } else if (parser.GetUsedVar().empty()) {
      formula.constant = value_of(parser);
    } else {
      formula.parser = parser;
    }
    return formula;
  }

  /// A parser that knows the first `known` values.
  mu::Parser parse(const NamedExpression& expression, std::size_t known) {
    if (expression.text.size() > kLongestFormula) {
      throw ExpressionError(expression.name, quoted(expression.text) + " is longer than " +
                                                 std::to_string(kLongestFormula) + " characters");
    }
    mu::Parser parser;
    try {
      parser.DefineConst("pi", kPi);
      for (const auto& [name, value] : constants) parser.DefineConst(name, value);
      for (std::size_t i = 0; i < known; ++i) parser.DefineVar(names[i], &values[i]);
      if (assigns(expression.text)) {
        throw ExpressionError(expression.name,
                              quoted(expression.text) + " assigns; use == to compare");
      }
      parser.SetExpr(expression.text);
      parser.Eval();  // compiles, so that later evaluations allocate nothing
    } catch (const mu::ParserError& error) {
      throw ExpressionError(expression.name, quoted(expression.text) + ": " + fault_of(error) +
                                                 " (it may use" + known_names(known) + ")");
    }
    if (parser.GetNumResults() != 1) {
      throw ExpressionError(expression.name, quoted(expression.text) + " has several values");
    }
    return parser;
  }

  std::string known_names(std::size_t known) const {
    std::string text;
    const std::size_t all = known + constants.size();
    const std::size_t shown = std::min(all, kNamesShown);
    for (std::size_t i = 0; i < shown; ++i) {
      text += " " + (i < known ? names[i] : constants[i - known].first);
    }
    if (shown < all) text += " ... (" + std::to_string(all - shown) + " more)";
    return text + " pi";
  }
};

ExpressionMap::ExpressionMap(const ExpressionNames& names,
                             const std::vector<NamedExpression>& definitions,
                             const std::vector<NamedExpression>& expressions)
    : program_(std::make_unique<Program>()),
      names_(names),
      definitions_(definitions),
      expressions_(expressions) {
  Program& program = *program_;
  program.states = names.x.size();
  program.inputs = names.u.size();
  program.constants = names.constants;
  program.names = names.x;
  program.names.insert(program.names.end(), names.u.begin(), names.u.end());
  for (const NamedExpression& definition : definitions) program.names.push_back(definition.name);
  for (const std::string& name : program.names) check_name(name);
  for (const auto& constant : program.constants) check_name(constant.first);
  program.values.assign(program.names.size(), 1.0);

  std::size_t known = program.states + program.inputs;
  program.definitions.reserve(definitions.size());
  program.expressions.reserve(expressions.size());
  for (const NamedExpression& definition : definitions) {
    program.definitions.push_back(program.formula(definition, known++));
  }
  for (const NamedExpression& expression : expressions) {
    program.expressions.push_back(program.formula(expression, known));
  }
  // Copying a parser makes it compile again, at its first evaluation.
  for (const Program::Formula& formula : program.definitions) formula.value();
  for (const Program::Formula& formula : program.expressions) formula.value();
}

ExpressionMap::~ExpressionMap() = default;

Eigen::Index ExpressionMap::size() const {
  return static_cast<Eigen::Index>(program_->expressions.size());
}

void ExpressionMap::evaluate(const double* x, const double* u, double* out) const {
  Program& program = *program_;
  double* value = program.values.data();
  for (std::size_t i = 0; i < program.states; ++i) *value++ = x[i];
  for (std::size_t i = 0; i < program.inputs; ++i) *value++ = u[i];
  for (const Program::Formula& formula : program.definitions) *value++ = formula.value();
  for (const Program::Formula& formula : program.expressions) *out++ = formula.value();
}

std::shared_ptr<const VectorMap> ExpressionMap::jacobian() const {
  return differentiated(names_, definitions_, expressions_);
}

}  // namespace sampled_data_observers
