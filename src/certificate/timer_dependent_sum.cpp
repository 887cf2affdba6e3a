#include "certificate/timer_dependent_sum.h"

#include <utility>

namespace sampled_data_observers {
namespace {

std::string numbered(const std::string& symbol, std::size_t number) {
  return symbol + "/" + std::to_string(number);
}

}  // namespace

TimerDependentSum::TimerDependentSum(ErrorSystem system, std::vector<std::vector<double>> nodes,
                                     std::vector<double> shortest)
    : system_(std::move(system)), nodes_(std::move(nodes)), shortest_(std::move(shortest)) {}

std::string TimerDependentSum::name_of(const std::string& symbol, std::size_t timer) const {
  return symbol + "/" + system_.resets[timer].name;
}

MatrixExpression TimerDependentSum::P_constant() const {
  return symbol("P_constant", system_.size, system_.size);
}

MatrixExpression TimerDependentSum::P(std::size_t timer, std::size_t node) const {
  return symbol(numbered(name_of("P", timer), node), system_.size, system_.size);
}

MatrixExpression TimerDependentSum::P_most(std::size_t timer) const {
  return symbol(name_of("P_most", timer), system_.size, system_.size);
}

MatrixExpression TimerDependentSum::P_after(std::size_t timer) const {
  return symbol(name_of("P_after", timer), system_.size, system_.size);
}

MatrixExpression TimerDependentSum::jump_part(std::size_t timer, std::size_t other) const {
  const Eigen::Index rows = system_.size + system_.resets[timer].C.rows();
  return symbol(name_of("jump_part", timer) + "/" + system_.resets[other].name, rows, rows);
}

MatrixExpression TimerDependentSum::jump_parts(std::size_t timer) const {
  const Eigen::Index rows = system_.size + system_.resets[timer].C.rows();
  return symbol(name_of("jump_parts", timer), rows, rows);
}

Eigen::Index TimerDependentSum::flow_size() const {
  return system_.size + system_.G.cols() + system_.N.cols();
}

MatrixExpression TimerDependentSum::flow_part(std::size_t timer, std::size_t vertex) const {
  const std::string name = name_of("flow_part", timer);
  return symbol(system_.F.size() == 1 ? name : numbered(name, vertex), flow_size(), flow_size());
}

std::vector<NamedShape> TimerDependentSum::shapes() const {
  std::vector<NamedShape> all = {symmetric_shape("P_constant", system_.size)};
  const auto add = [&](const MatrixExpression& matrix) {
    all.push_back(symmetric_shape(matrix.node().name, matrix.rows()));
  };
  for (std::size_t timer = 0; timer < timers(); ++timer) {
    for (std::size_t node = 0; node < nodes_[timer].size(); ++node) add(P(timer, node));
    add(P_most(timer));
    add(P_after(timer));
    for (std::size_t v = 0; v < system_.F.size(); ++v) add(flow_part(timer, v));
    for (std::size_t other = 0; other < timers(); ++other) {
      if (other != timer) add(jump_part(timer, other));
    }
    add(jump_parts(timer));
    all.push_back(scalar_shape(name_of("nu", timer)));
    for (std::size_t node = 0; node < nodes_[timer].size() && !system_.is_linear(); ++node) {
      all.push_back(scalar_shape(numbered(name_of("chi", timer), node)));
    }
  }
  return all;
}

/// What a summand of P has of the flow condition, in (e, φ, w).
MatrixExpression TimerDependentSum::form_of_flow(const MatrixExpression& P,
                                                 const MatrixExpression& F,
                                                 const std::optional<MatrixExpression>& slope,
                                                 const std::optional<MatrixExpression>& chi) const {
  MatrixExpression first = He(P * F) + MatrixExpression(2.0) * symbol("lambda_t") * P;
  if (slope) first = first + *slope;
  std::vector<std::vector<MatrixExpression>> rows;
  const Eigen::Index s = system_.G.cols();
  const Eigen::Index w = system_.N.cols();
  if (s > 0) {
    if (chi) {
      const MatrixExpression ell = system_.lipschitz_constant;
      const MatrixExpression S = system_.S;
      first = first + *chi * (ell * ell * (transpose(S) * S));
    }
    rows.push_back({first, P * MatrixExpression(system_.G)});
    rows.push_back({chi ? -(*chi * identity(s)) : zeros(s, s)});
  } else {
    rows.push_back({first});
  }
  if (w > 0) {
    rows.front().push_back(P * MatrixExpression(system_.N));
    if (s > 0) rows.back().push_back(zeros(s, w));
    rows.push_back({zeros(w, w)});
  }
  return symmetric_blocks(rows);
}

/// P_c, the performance output and the disturbance, and all parts of the timers.
MatrixExpression TimerDependentSum::rest_of_flow(std::size_t vertex) const {
  MatrixExpression sum = form_of_flow(P_constant(), system_.F[vertex], std::nullopt, std::nullopt);
  for (std::size_t timer = 0; timer < timers(); ++timer) sum = sum + flow_part(timer, vertex);
  const Eigen::Index N = system_.size;
  const Eigen::Index s = system_.G.cols();
  const Eigen::Index w = system_.N.cols();
  if (w == 0) return sum;
  MatrixExpression output = zeros(N, N);
  if (system_.C_p.rows() > 0) {
    const MatrixExpression C_p = system_.C_p;
    output = transpose(C_p) * C_p;
  }
  const MatrixExpression supply = -(square("gamma") * identity(w));
  if (s == 0) return sum + symmetric_blocks({{output, zeros(N, w)}, {supply}});
  return sum + symmetric_blocks(
                   {{output, zeros(N, s), zeros(N, w)}, {zeros(s, s), zeros(s, w)}, {supply}});
}

/// 2 (C e + η)ᵀ Kᵀ P e, in (e, η).
MatrixExpression TimerDependentSum::form_of_jump(std::size_t timer,
                                                 const MatrixExpression& P) const {
  const ErrorReset& reset = system_.resets[timer];
  const Eigen::Index m = reset.C.rows();
  const MatrixExpression P_K = P * reset.K(0);
  return symmetric_blocks({{He(P_K * MatrixExpression(reset.C)), P_K}, {zeros(m, m)}});
}

MatrixExpression TimerDependentSum::jump_condition(std::size_t timer, std::size_t node) const {
  const ErrorReset& reset = system_.resets[timer];
  const Eigen::Index N = system_.size;
  const Eigen::Index m = reset.C.rows();
  const MatrixExpression level = symbol(name_of("nu", timer)) * identity(m);
  const MatrixExpression first =
      form_of_jump(timer, P_constant() + P(timer, 0)) + jump_parts(timer) +
      symmetric_blocks({{P(timer, node) - P(timer, 0), zeros(N, m)}, {level}});
  const MatrixExpression most = P_after(timer);
  const MatrixExpression innovation =
      blocks({{transpose(MatrixExpression(reset.C))}, {identity(m)}});
  return symmetric_blocks({{first, innovation * (transpose(reset.K(0)) * most)}, {most}});
}

std::vector<Condition> TimerDependentSum::flow_conditions() const {
  std::vector<Condition> all = {{"P_constant > 0", P_constant(), std::nullopt}};
  for (std::size_t timer = 0; timer < timers(); ++timer) {
    for (std::size_t node = 0; node < nodes_[timer].size(); ++node) {
      const MatrixExpression P_k = P(timer, node);
      all.push_back({P_k.node().name + " > 0", P_k, std::nullopt});
    }
  }
  std::size_t cell = 0;
  for (std::size_t timer = 0; timer < timers(); ++timer) {
    const std::string& name = system_.resets[timer].name;
    const std::vector<double>& nodes = nodes_[timer];
    for (std::size_t low = 0; low + 1 < nodes.size(); ++low, ++cell) {
      const MatrixExpression length =
          MatrixExpression(nodes[low + 1]) - MatrixExpression(nodes[low]);
      const MatrixExpression slope = inverse(length) * (P(timer, low + 1) - P(timer, low));
      for (const std::size_t node : {low, low + 1}) {
        std::optional<MatrixExpression> chi;
        if (!system_.is_linear()) chi = symbol(numbered(name_of("chi", timer), node));
        for (std::size_t v = 0; v < system_.F.size(); ++v) {
          all.push_back(
              {"flow of " + name + " in cell " + std::to_string(low) + " at node " +
                   std::to_string(node) + ", timer_dependent (8)",
               flow_part(timer, v) - form_of_flow(P(timer, node), system_.F[v], slope, chi),
               std::nullopt, Condition::Kind::kDefinite, cell});
        }
      }
    }
  }
  for (std::size_t v = 0; v < system_.F.size(); ++v) {
    all.push_back({"flow, timer_dependent (9)", -rest_of_flow(v), std::nullopt});
  }
  return all;
}

void TimerDependentSum::add_jump_conditions(std::vector<Condition>& all) const {
  for (std::size_t timer = 0; timer < timers(); ++timer) {
    const std::string& name = system_.resets[timer].name;
    for (std::size_t node = 0; node < nodes_[timer].size(); ++node) {
      const MatrixExpression P_k = P(timer, node);
      all.push_back(
          {P_k.node().name + " < " + name_of("P_most", timer), P_most(timer) - P_k, std::nullopt});
    }
    MatrixExpression rest = P_after(timer) - P_constant() - P(timer, 0);
    MatrixExpression parts = -jump_parts(timer);
    for (std::size_t other = 0; other < timers(); ++other) {
      if (other == timer) continue;
      rest = rest - P_most(other);
      parts = parts + jump_part(timer, other);
      for (std::size_t node = 0; node < nodes_[other].size(); ++node) {
        all.push_back(
            {"part of " + system_.resets[other].name + " at node " + std::to_string(node) +
                 " in the jump of " + name + ", timer_dependent (10)",
             form_of_jump(timer, P(other, node)) - jump_part(timer, other), std::nullopt});
      }
    }
    all.push_back({"P after a sample < " + name_of("P_after", timer), rest, std::nullopt});
    all.push_back({"parts of the jump of " + name + ", timer_dependent (10)", parts, std::nullopt});
    for (std::size_t node = 0; node < nodes_[timer].size(); ++node) {
      if (nodes_[timer][node] < shortest_[timer]) continue;
      all.push_back(
          {"jump of " + name + " at node " + std::to_string(node) + ", timer_dependent (11)",
           jump_condition(timer, node), std::nullopt});
    }
  }
}

std::vector<Condition> TimerDependentSum::conditions() const {
  std::vector<Condition> all;
  for (const NamedShape& shape : shapes()) {
    if (shape.form == NamedShape::Form::kScalar) all.push_back(positive(shape.name));
  }
  for (Condition& condition : flow_conditions()) all.push_back(std::move(condition));
  add_jump_conditions(all);
  return all;
}

}  // namespace sampled_data_observers
