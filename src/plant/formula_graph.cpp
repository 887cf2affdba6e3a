#include "plant/formula_graph.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace sampled_data_observers {
namespace {

using Operation = FormulaOperation;

constexpr std::size_t kMostOperations = 1000000;

std::size_t operands_of(Operation operation) {
  if (operation <= Operation::kVariable) return 0;
  if (operation == Operation::kSelect) return 3;
  const bool is_unary = operation >= Operation::kNegate && operation <= Operation::kAbs;
  return is_unary ? 1 : 2;
}

double truth(bool value) { return value ? 1.0 : 0.0; }

double power(double base, double exponent) {
  // As muParser has them.
  if (exponent == 2.0) return base * base;
  if (exponent == 3.0) return base * base * base;
  if (exponent == 4.0) return base * base * base * base;
  return std::pow(base, exponent);
}

}  // namespace

double operate(FormulaOperation operation, double a, double b, double c) {
  switch (operation) {
    case Operation::kConstant:
    case Operation::kVariable:
      break;
    case Operation::kAdd:
      return a + b;
    case Operation::kSubtract:
      return a - b;
    case Operation::kMultiply:
      return a * b;
    case Operation::kDivide:
      return a / b;
    case Operation::kPower:
      return power(a, b);
    case Operation::kNegate:
      return -a;
    case Operation::kSin:
      return std::sin(a);
    case Operation::kCos:
      return std::cos(a);
    case Operation::kTan:
      return std::tan(a);
    case Operation::kAsin:
      return std::asin(a);
    case Operation::kAcos:
      return std::acos(a);
    case Operation::kAtan:
      return std::atan(a);
    case Operation::kSinh:
      return std::sinh(a);
    case Operation::kCosh:
      return std::cosh(a);
    case Operation::kTanh:
      return std::tanh(a);
    case Operation::kAsinh:
      return std::asinh(a);
    case Operation::kAcosh:
      return std::acosh(a);
    case Operation::kAtanh:
      return std::atanh(a);
    case Operation::kLog2:
      return std::log2(a);
    case Operation::kLog10:
      return std::log10(a);
    case Operation::kLn:
      return std::log(a);
    case Operation::kExp:
      return std::exp(a);
    case Operation::kSqrt:
      return std::sqrt(a);
    case Operation::kSign:
      return truth(a > 0.0) - truth(a < 0.0);
    case Operation::kRint:
      return std::floor(a + 0.5);
    case Operation::kAbs:
      return std::abs(a);
    case Operation::kAtan2:
      return std::atan2(a, b);
    case Operation::kLess:
      return truth(a < b);
    case Operation::kLessOrEqual:
      return truth(a <= b);
    case Operation::kEqual:
      return truth(a == b);
    case Operation::kNotEqual:
      return truth(a != b);
    case Operation::kAnd:
      return truth(a != 0.0 && b != 0.0);
    case Operation::kOr:
      return truth(a != 0.0 || b != 0.0);
    case Operation::kSelect:
      return a != 0.0 ? b : c;
  }
  return a;
}

FormulaGraph::FormulaGraph() { constant(0.0); }

FormulaGraph::Node FormulaGraph::constant(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  const auto [known, is_new] = constants_.emplace(bits, entries_.size());
  return is_new ? add({Operation::kConstant, 0, 0, 0, value, 0}) : known->second;
}

FormulaGraph::Node FormulaGraph::variable(std::size_t index) {
  const auto [known, is_new] = variables_.emplace(index, entries_.size());
  return is_new ? add({Operation::kVariable, 0, 0, 0, 0.0, index}) : known->second;
}

FormulaGraph::Node FormulaGraph::add(const Entry& entry) {
  if (entries_.size() >= kMostOperations) {
    throw std::length_error("formulas whose derivatives take more than " +
                            std::to_string(kMostOperations) + " operations");
  }
  entries_.push_back(entry);
  return entries_.size() - 1;
}

bool FormulaGraph::is_constant(Node node, double value) const {
  return entries_[node].operation == Operation::kConstant && entries_[node].value == value;
}

bool FormulaGraph::is_zero(Node node) const { return is_constant(node, 0.0); }

bool FormulaGraph::simplify(FormulaOperation operation, Node a, Node b, Node c, Node& node) {
  const auto becomes = [&node](Node simpler) {
    node = simpler;
    return true;
  };
  switch (operation) {
    case Operation::kAdd:
      if (is_zero(a)) return becomes(b);
      return is_zero(b) && becomes(a);
    case Operation::kSubtract:
      if (is_zero(b)) return becomes(a);
      return is_zero(a) && becomes(apply(Operation::kNegate, b));
    case Operation::kMultiply:
      if (is_zero(a) || is_constant(b, 1.0)) return becomes(a);
      if (is_zero(b) || is_constant(a, 1.0)) return becomes(b);
      if (is_constant(a, -1.0)) return becomes(apply(Operation::kNegate, b));
      return is_constant(b, -1.0) && becomes(apply(Operation::kNegate, a));
    case Operation::kDivide:
      return (is_zero(a) || is_constant(b, 1.0)) && becomes(a);
    case Operation::kPower:
      return is_constant(b, 1.0) && becomes(a);
    case Operation::kNegate:
      return entries_[a].operation == Operation::kNegate && becomes(entries_[a].a);
    case Operation::kSelect:
      if (b == c) return becomes(b);
      return entries_[a].operation == Operation::kConstant &&
             becomes(entries_[a].value != 0.0 ? b : c);
    default:
      return false;
  }
}

FormulaGraph::Node FormulaGraph::apply(FormulaOperation operation, Node a, Node b, Node c) {
  const std::size_t operands = operands_of(operation);
  const auto is_number = [&](Node node, std::size_t position) {
    return position >= operands || entries_[node].operation == Operation::kConstant;
  };
  if (is_number(a, 0) && is_number(b, 1) && is_number(c, 2)) {
    return constant(operate(operation, entries_[a].value, entries_[b].value, entries_[c].value));
  }
  Node simpler = 0;
  if (simplify(operation, a, b, c, simpler)) return simpler;
  const auto [known, is_new] = known_.emplace(Key{operation, a, b, c}, entries_.size());
  return is_new ? add({operation, a, b, c, 0.0, 0}) : known->second;
}

std::vector<bool> FormulaGraph::needed_by(const std::vector<Node>& of) const {
  const Node last = of.empty() ? 0 : *std::max_element(of.begin(), of.end());
  std::vector<bool> needed(last + 1, false);
  for (const Node node : of) needed[node] = true;
  for (Node node = last + 1; node-- > 0;) {
    if (!needed[node]) continue;
    const Entry& at = entries_[node];
    const std::size_t operands = operands_of(at.operation);
    if (operands > 0) needed[at.a] = true;
    if (operands > 1) needed[at.b] = true;
    if (operands > 2) needed[at.c] = true;
  }
  return needed;
}

std::vector<FormulaGraph::Node> FormulaGraph::derivatives(const std::vector<Node>& of,
                                                          std::size_t variable) {
  const std::vector<bool> needed = needed_by(of);
  const Node zero = constant(0.0);
  std::vector<Node> all(needed.size(), zero);
  for (Node node = 0; node < needed.size(); ++node) {
    if (!needed[node]) continue;
    const Entry& at = entries_[node];
    if (at.operation == Operation::kVariable) {
      if (at.variable == variable) all[node] = constant(1.0);
    } else {
      all[node] = derivative(node, all);
    }
  }
  std::vector<Node> result;
  for (const Node node : of) result.push_back(all[node]);
  return result;
}

FormulaGraph::Node FormulaGraph::derivative(Node node, const std::vector<Node>& of_operands) {
  const Entry at = entries_[node];  // a copy: others are added
  const std::size_t operands = operands_of(at.operation);
  const Node da = operands > 0 ? of_operands[at.a] : constant(0.0);
  const Node db = operands > 1 ? of_operands[at.b] : constant(0.0);
  const auto times = [this](Node a, Node b) { return apply(Operation::kMultiply, a, b); };
  const auto minus = [this](Node a, Node b) { return apply(Operation::kSubtract, a, b); };
  if (at.operation == Operation::kSelect) {
    return apply(Operation::kSelect, at.a, db, of_operands[at.c]);
  }
  if (is_zero(da) && is_zero(db)) return constant(0.0);
  switch (at.operation) {
    case Operation::kAdd:
    case Operation::kSubtract:
      return apply(at.operation, da, db);
    case Operation::kMultiply:
      return apply(Operation::kAdd, times(da, at.b), times(at.a, db));
    case Operation::kDivide:
      return apply(Operation::kDivide, minus(da, times(node, db)), at.b);
    case Operation::kPower: {
      const Node less = apply(Operation::kPower, at.a, minus(at.b, constant(1.0)));
      const Node by_base = times(times(at.b, less), da);
      if (is_zero(db)) return by_base;
      return apply(Operation::kAdd, by_base, times(times(node, apply(Operation::kLn, at.a)), db));
    }
    case Operation::kAtan2: {
      const Node squares = apply(Operation::kAdd, times(at.a, at.a), times(at.b, at.b));
      return apply(Operation::kDivide, minus(times(at.b, da), times(at.a, db)), squares);
    }
    default:
      return operands == 1 ? times(slope(node), da) : constant(0.0);
  }
}

FormulaGraph::Node FormulaGraph::slope(Node node) {
  const Entry at = entries_[node];
  const Node one = constant(1.0);
  const auto square = [this](Node a) { return apply(Operation::kMultiply, a, a); };
  const auto over = [&](Node a) { return apply(Operation::kDivide, one, a); };
  const auto root = [this](Node a) { return apply(Operation::kSqrt, a); };
  const auto sum = [this](Node a, Node b) { return apply(Operation::kAdd, a, b); };
  const auto minus = [this](Node a, Node b) { return apply(Operation::kSubtract, a, b); };
  const auto scaled = [&](double factor, Node a) {
    return apply(Operation::kMultiply, constant(factor), a);
  };
  switch (at.operation) {
    case Operation::kNegate:
      return constant(-1.0);
    case Operation::kSin:
      return apply(Operation::kCos, at.a);
    case Operation::kCos:
      return apply(Operation::kNegate, apply(Operation::kSin, at.a));
    case Operation::kTan:
      return sum(one, square(node));
    case Operation::kAsin:
      return over(root(minus(one, square(at.a))));
    case Operation::kAcos:
      return apply(Operation::kNegate, over(root(minus(one, square(at.a)))));
    case Operation::kAtan:
      return over(sum(one, square(at.a)));
    case Operation::kSinh:
      return apply(Operation::kCosh, at.a);
    case Operation::kCosh:
      return apply(Operation::kSinh, at.a);
    case Operation::kTanh:
      return minus(one, square(node));
    case Operation::kAsinh:
      return over(root(sum(square(at.a), one)));
    case Operation::kAcosh:
      return over(root(minus(square(at.a), one)));
    case Operation::kAtanh:
      return over(minus(one, square(at.a)));
    case Operation::kLog2:
      return over(scaled(std::log(2.0), at.a));
    case Operation::kLog10:
      return over(scaled(std::log(10.0), at.a));
    case Operation::kLn:
      return over(at.a);
    case Operation::kExp:
      return node;
    case Operation::kSqrt:
      return over(scaled(2.0, node));
    case Operation::kAbs:
      return apply(Operation::kSign, at.a);
    default:  // sign and rint are constant but where they jump
      return constant(0.0);
  }
}

}  // namespace sampled_data_observers
