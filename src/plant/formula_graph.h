#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace sampled_data_observers {

/// What a formula is made of.
enum class FormulaOperation : std::uint8_t {
  kConstant,
  kVariable,
  kAdd,
  kSubtract,
  kMultiply,
  kDivide,
  kPower,
  kNegate,
  kSin,
  kCos,
  kTan,
  kAsin,
  kAcos,
  kAtan,
  kSinh,
  kCosh,
  kTanh,
  kAsinh,
  kAcosh,
  kAtanh,
  kLog2,
  kLog10,
  kLn,
  kExp,
  kSqrt,
  kSign,
  kRint,
  kAbs,
  kAtan2,
  kLess,
  kLessOrEqual,
  kEqual,
  kNotEqual,
  kAnd,
  kOr,
  kSelect  ///< a ? b : c
};

/// Formulas as one graph of operations, each of which is in it once, and their derivatives.
class FormulaGraph {
 public:
  /// Its place in the graph; behind all that it depends on.
  using Node = std::size_t;

  /// An operation with its operands; those that it does not have are 0.
  struct Entry {
    FormulaOperation operation = FormulaOperation::kConstant;
    Node a = 0;
    Node b = 0;
    Node c = 0;
    double value = 0.0;        ///< of a constant
    std::size_t variable = 0;  ///< which one, of a variable
  };

  FormulaGraph();

  Node constant(double value);
  Node variable(std::size_t index);
  /// What has no effect (· 1, + 0) or constant operands only is left out.
  /// @throws std::length_error for a graph of more than a million operations.
  Node apply(FormulaOperation operation, Node a, Node b = 0, Node c = 0);

  /// The derivatives of some nodes by a variable. Where the formula jumps or has a kink
  /// (comparisons, sign, rint, abs, min, max), it is that of one side.
  std::vector<Node> derivatives(const std::vector<Node>& of, std::size_t variable);

  const Entry& entry(Node node) const { return entries_[node]; }
  bool is_zero(Node node) const;

  /// For each node up to the last of `of`, whether one of these depends on it.
  std::vector<bool> needed_by(const std::vector<Node>& of) const;

 private:
  using Key = std::tuple<FormulaOperation, Node, Node, Node>;

  Node add(const Entry& entry);
  bool is_constant(Node node, double value) const;
  /// Where the result is one of the operands, or a simpler operation; `node` takes it.
  bool simplify(FormulaOperation operation, Node a, Node b, Node c, Node& node);
  Node derivative(Node node, const std::vector<Node>& of_operands);
  /// By its operand.
  Node slope(Node node);

  std::vector<Entry> entries_;
  std::map<Key, Node> known_;
  std::map<std::uint64_t, Node> constants_;  ///< by their bits
  std::map<std::size_t, Node> variables_;
};

/// The result of an operation on numbers, as muParser has it.
double operate(FormulaOperation operation, double a, double b, double c);

}  // namespace sampled_data_observers
