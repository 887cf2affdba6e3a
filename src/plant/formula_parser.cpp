#include "plant/formula_parser.h"

#include <muParser.h>

#include <cctype>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace sampled_data_observers {
namespace {

using Part = FormulaOperation;

/// Deeper ones could fill the stack.
constexpr int kDeepest = 500;

const std::map<std::string, FormulaOperation>& functions_of_one() {
  static const std::map<std::string, FormulaOperation> all = {
      {"sin", Part::kSin},     {"cos", Part::kCos},     {"tan", Part::kTan},
      {"asin", Part::kAsin},   {"acos", Part::kAcos},   {"atan", Part::kAtan},
      {"sinh", Part::kSinh},   {"cosh", Part::kCosh},   {"tanh", Part::kTanh},
      {"asinh", Part::kAsinh}, {"acosh", Part::kAcosh}, {"atanh", Part::kAtanh},
      {"log2", Part::kLog2},   {"log10", Part::kLog10}, {"log", Part::kLn},
      {"ln", Part::kLn},       {"exp", Part::kExp},     {"sqrt", Part::kSqrt},
      {"sign", Part::kSign},   {"rint", Part::kRint},   {"abs", Part::kAbs}};
  return all;
}

/// By recursive descent, from the operators that bind least.
class FormulaReader {
 public:
  using Node = FormulaGraph::Node;

  FormulaReader(const std::string& text, const std::map<std::string, Node>& names,
                FormulaGraph& graph)
      : text_(text), names_(names), graph_(graph) {}

  Node read() {
    const Node result = choice();
    if (peek() != '\0') fail();
    return result;
  }

 private:
  [[noreturn]] void fail() const {
    throw std::invalid_argument("'" + text_.substr(0, 60) + "' can't be read: character " +
                                std::to_string(at_ + 1) + " is not understood");
  }

  char peek() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }

  bool take(const char* token) {
    peek();
    const std::string expected = token;
    if (text_.compare(at_, expected.size(), expected) != 0) return false;
    at_ += expected.size();
    return true;
  }

  void expect(const char* token) {
    if (!take(token)) fail();
  }

  Node choice() {
    if (++depth_ > kDeepest) {
      throw std::invalid_argument("'" + text_.substr(0, 60) +
                                  "...' can't be read: it is nested more than " +
                                  std::to_string(kDeepest) + " deep");
    }
    Node result = alternative();
    if (take("?")) {
      const Node yes = choice();
      expect(":");
      result = graph_.apply(Part::kSelect, result, yes, choice());
    }
    --depth_;
    return result;
  }

  Node alternative() {
    Node result = conjunction();
    while (take("||")) result = graph_.apply(Part::kOr, result, conjunction());
    return result;
  }

  Node conjunction() {
    Node result = comparison();
    while (take("&&")) result = graph_.apply(Part::kAnd, result, comparison());
    return result;
  }

  Node comparison() {
    Node result = sum();
    while (true) {
      if (take("<=")) {
        result = graph_.apply(Part::kLessOrEqual, result, sum());
      } else if (take(">=")) {
        result = graph_.apply(Part::kLessOrEqual, sum(), result);
      } else if (take("==")) {
        result = graph_.apply(Part::kEqual, result, sum());
      } else if (take("!=")) {
        result = graph_.apply(Part::kNotEqual, result, sum());
      } else if (take("<")) {
        result = graph_.apply(Part::kLess, result, sum());
      } else if (take(">")) {
        result = graph_.apply(Part::kLess, sum(), result);
      } else {
        return result;
      }
    }
  }

  Node sum() {
    Node result = product();
    while (true) {
      if (take("+")) {
        result = graph_.apply(Part::kAdd, result, product());
      } else if (take("-")) {
        result = graph_.apply(Part::kSubtract, result, product());
      } else {
        return result;
      }
    }
  }

  Node product() {
    Node result = signed_power();
    while (true) {
      if (take("*")) {
        result = graph_.apply(Part::kMultiply, result, signed_power());
      } else if (take("/")) {
        result = graph_.apply(Part::kDivide, result, signed_power());
      } else {
        return result;
      }
    }
  }

  /// A sign binds less than a power: -2^2 is -4.
  Node signed_power() {
    if (take("-")) return graph_.apply(Part::kNegate, power());
    take("+");
    return power();
  }

  Node power() {
    const Node base = operand();
    if (!take("^")) return base;
    if (++depth_ > kDeepest) fail();
    const Node result = graph_.apply(Part::kPower, base, signed_power());
    --depth_;
    return result;
  }

  Node operand() {
    const char next = peek();
    if (take("(")) {
      const Node result = choice();
      expect(")");
      return result;
    }
    if (std::isdigit(static_cast<unsigned char>(next)) != 0 || next == '.') return number();
    return named();
  }

  Node number() {
    std::size_t end = at_;
    const auto skip_digits = [&] {
      while (end < text_.size() && std::isdigit(static_cast<unsigned char>(text_[end])) != 0) ++end;
    };
    skip_digits();
    if (end < text_.size() && text_[end] == '.') ++end;
    skip_digits();
    if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
      ++end;
      if (end < text_.size() && (text_[end] == '+' || text_[end] == '-')) ++end;
      skip_digits();
    }
    std::istringstream in(text_.substr(at_, end - at_));
    in.imbue(std::locale::classic());
    double value = 0.0;
    if (!(in >> value)) fail();
    at_ = end;
    return graph_.constant(value);
  }

  Node named() {
    std::size_t end = at_;
    while (end < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[end])) != 0 || text_[end] == '_')) {
      ++end;
    }
    const std::string name = text_.substr(at_, end - at_);
    if (end < text_.size() && text_[end] == '(') {
      at_ = end + 1;
      return call(name);
    }
    const auto known = names_.find(name);
    if (known == names_.end()) fail();
    at_ = end;
    return known->second;
  }

  Node call(const std::string& name) {
    std::vector<Node> arguments;
    do {
      arguments.push_back(choice());
    } while (take(","));
    expect(")");
    const auto of_one = functions_of_one().find(name);
    if (of_one != functions_of_one().end() && arguments.size() == 1) {
      return graph_.apply(of_one->second, arguments.front());
    }
    if (name == "atan2" && arguments.size() == 2) {
      return graph_.apply(Part::kAtan2, arguments[0], arguments[1]);
    }
    Node result = arguments.front();
    for (std::size_t i = 1; i < arguments.size(); ++i) result = folded(name, result, arguments[i]);
    if (name == "avg") {
      const Node count = graph_.constant(static_cast<double>(arguments.size()));
      return graph_.apply(Part::kDivide, result, count);
    }
    if (name != "sum" && name != "min" && name != "max") fail();
    return result;
  }

  Node folded(const std::string& name, Node a, Node b) {
    if (name == "sum" || name == "avg") return graph_.apply(Part::kAdd, a, b);
    if (name == "min") return graph_.apply(Part::kSelect, graph_.apply(Part::kLess, b, a), b, a);
    if (name == "max") return graph_.apply(Part::kSelect, graph_.apply(Part::kLess, a, b), b, a);
    fail();
  }

  const std::string& text_;
  const std::map<std::string, Node>& names_;
  FormulaGraph& graph_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::map<std::string, FormulaGraph::Node> nodes_of_names(const ExpressionNames& names,
                                                         FormulaGraph& graph) {
  std::map<std::string, FormulaGraph::Node> known;
  const mu::Parser parser;
  for (const auto& [name, value] : parser.GetConst()) known[name] = graph.constant(value);
  known["pi"] = graph.constant(3.14159265358979323846);
  for (const auto& [name, value] : names.constants) known[name] = graph.constant(value);
  std::size_t variables = 0;
  for (const std::string& name : names.x) known[name] = graph.variable(variables++);
  for (const std::string& name : names.u) known[name] = graph.variable(variables++);
  return known;
}

FormulaGraph::Node parse_formula(const std::string& text,
                                 const std::map<std::string, FormulaGraph::Node>& names,
                                 FormulaGraph& graph) {
  return FormulaReader(text, names, graph).read();
}

}  // namespace sampled_data_observers
