#include "certificate/timer_dependent_conditions.h"

#include <utility>

namespace sampled_data_observers {
namespace {

std::string at(const std::string& symbol, std::size_t node) {
  return symbol + "/" + std::to_string(node);
}

MatrixExpression noise_level(const ErrorReset& reset) {
  return symbol("nu/" + reset.name) * identity(reset.C.rows());
}

}  // namespace

TimerDependentFunction::TimerDependentFunction(ErrorSystem system, TensorGrid grid,
                                               std::vector<double> shortest,
                                               std::optional<GainProducts> products,
                                               bool falls_at_events)
    : system_(std::move(system)),
      grid_(std::move(grid)),
      shortest_(std::move(shortest)),
      products_(std::move(products)),
      falls_at_events_(falls_at_events) {}

bool TimerDependentFunction::is_foreseen(std::size_t timer, std::size_t node) const {
  return grid_.nodes(timer)[grid_.position(node, timer)] >= shortest_[timer];
}

std::string TimerDependentFunction::name_of_P(std::size_t node) const {
  return at(system_.mode.empty() ? "P" : "P/" + system_.mode, node);
}

MatrixExpression TimerDependentFunction::P(std::size_t node) const {
  const Eigen::Index N = system_.size;
  if (is_free(node)) return symbol(name_of_P(node), N, N);
  const ErrorReset& reset = system_.resets.front();
  const MatrixExpression C = reset.C;
  const MatrixExpression K = reset.K(0);
  const MatrixExpression projection = identity(N) - K * inverse(C * K) * C;
  return transpose(C) * symbol("P_measured", C.rows(), C.rows()) * C +
         transpose(projection) * symbol("P_rest", N, N) * projection;
}

std::vector<NamedShape> TimerDependentFunction::shapes() const {
  std::vector<NamedShape> all;
  for (std::size_t node = 0; node < grid_.size(); ++node) {
    if (is_free(node)) all.push_back(symmetric_shape(name_of_P(node), system_.size));
  }
  if (!is_free(0)) {
    all.push_back(symmetric_shape("P_measured", system_.resets.front().C.rows()));
    all.push_back(symmetric_shape("P_rest", system_.size));
  }
  for (const ErrorReset& reset : system_.resets) {
    if (reset.C.rows() > 0) all.push_back(scalar_shape("nu/" + reset.name));
  }
  if (system_.is_linear()) return all;
  for (std::size_t node = 0; node < grid_.size(); ++node) {
    all.push_back(scalar_shape(at("chi", node)));
  }
  return all;
}

MatrixExpression TimerDependentFunction::derivative(const CellCorner& corner,
                                                    const MatrixExpression& F) const {
  MatrixExpression sum = He(P(corner.node) * F);
  for (std::size_t timer = 0; timer < corner.edges.size(); ++timer) {
    const CellCorner::Edge& edge = corner.edges[timer];
    const std::vector<double>& nodes = grid_.nodes(timer);
    const MatrixExpression length = MatrixExpression(nodes[grid_.position(edge.high, timer)]) -
                                    MatrixExpression(nodes[grid_.position(edge.low, timer)]);
    sum = sum + inverse(length) * (P(edge.high) - P(edge.low));
  }
  return sum;
}

MatrixExpression TimerDependentFunction::flow(const CellCorner& corner,
                                              const MatrixExpression& F) const {
  const MatrixExpression P_k = P(corner.node);
  MatrixExpression first = derivative(corner, F) + MatrixExpression(2.0) * symbol("lambda_t") * P_k;
  if (system_.C_p.rows() > 0) {
    const MatrixExpression C_p = system_.C_p;
    first = first + transpose(C_p) * C_p;
  }
  std::vector<std::vector<MatrixExpression>> rows;
  const Eigen::Index w = system_.N.cols();
  const Eigen::Index s = system_.G.cols();
  if (!system_.is_linear()) {
    const MatrixExpression chi = symbol(at("chi", corner.node));
    const MatrixExpression ell = system_.lipschitz_constant;
    const MatrixExpression S = system_.S;
    first = first + chi * (ell * ell * (transpose(S) * S));
    rows.push_back({first, P_k * MatrixExpression(system_.G)});
    rows.push_back({-(chi * identity(s))});
  } else {
    rows.push_back({first});
  }
  if (w > 0) {
    rows.front().push_back(P_k * MatrixExpression(system_.N));
    if (rows.size() > 1) rows.back().push_back(zeros(s, w));
    rows.push_back({-(square("gamma") * identity(w))});
  }
  return symmetric_blocks(rows);
}

MatrixExpression TimerDependentFunction::jump(std::size_t timer, std::size_t node,
                                              const MatrixExpression& after) const {
  const ErrorReset& reset = system_.resets[timer];
  const Eigen::Index m = reset.C.rows();
  const MatrixExpression J = reset.J;
  const MatrixExpression before = falls_at_events_ ? symbol("mu") * P(node) : P(node);
  if (m == 0) return symmetric_blocks({{before, transpose(J) * after}, {after}});
  const MatrixExpression P_K = products_ ? products_->P_K(timer, node) : after * reset.K(node);
  const MatrixExpression C = reset.C;
  return symmetric_blocks(
      {{before, zeros(system_.size, m), transpose(J) * after - transpose(C) * transpose(P_K)},
       {noise_level(reset), -transpose(P_K)},
       {after}});
}

MatrixExpression TimerDependentFunction::coinciding_jump(std::size_t timer, std::size_t node,
                                                         const MatrixExpression& Z) const {
  const ErrorReset& reset = system_.resets[timer];
  const MatrixExpression Zt_C = transpose(Z) * MatrixExpression(reset.C);
  return symmetric_blocks({{He(Z), Z, Zt_C}, {noise_level(reset), Zt_C}, {P(node)}});
}

MatrixExpression TimerDependentFunction::coinciding_jump() const {
  const ErrorReset& reset = system_.resets.front();
  const Eigen::Index m = reset.C.rows();
  const MatrixExpression X = symbol("P_measured", m, m);
  const MatrixExpression M = MatrixExpression(reset.C) * reset.K(0);
  return symmetric_blocks({{X, zeros(m, m), transpose(identity(m) - M) * X},
                           {noise_level(reset), -(transpose(M) * X)},
                           {X}});
}

MatrixExpression TimerDependentFunction::jump_condition(std::size_t timer, std::size_t node) const {
  if (shortest_[timer] > 0.0 || grid_.position(node, timer) != 0) {
    return jump(timer, node, P(grid_.with_first(node, timer)));
  }
  if (products_) return coinciding_jump(timer, node, products_->Z(timer, node));
  const ErrorReset& reset = system_.resets[timer];
  return reset.Z ? coinciding_jump(timer, node, reset.Z(node)) : coinciding_jump();
}

std::vector<Condition> TimerDependentFunction::flow_conditions() const {
  const std::string in_mode = system_.mode.empty() ? "" : " in mode " + system_.mode;
  std::vector<Condition> all;
  for (const NamedShape& shape : shapes()) {
    if (shape.form == NamedShape::Form::kScalar) all.push_back(positive(shape.name));
  }
  for (std::size_t node = 0; node < grid_.size(); ++node) {
    all.push_back({name_of_P(node) + " > 0", P(node), std::nullopt});
  }
  if (!is_free(0)) {
    // Beyond Π it says nothing, so that nothing is lost.
    all.push_back({"P_rest > 0", symbol("P_rest", system_.size, system_.size), std::nullopt});
  }
  std::size_t number = 0;
  for (const std::vector<CellCorner>& corners : cells_of(grid_)) {
    for (const CellCorner& corner : corners) {
      for (const MatrixExpression& F : system_.F) {
        all.push_back({"flow of cell " + std::to_string(number) + " at node " +
                           std::to_string(corner.node) + in_mode + ", timer_dependent (3)",
                       -flow(corner, F), std::nullopt, Condition::Kind::kDefinite, number});
      }
    }
    ++number;
  }
  return all;
}

std::vector<Condition> TimerDependentFunction::jumps_into(const TimerDependentFunction& next,
                                                          std::size_t timer) const {
  std::vector<Condition> all;
  for (std::size_t node = 0; node < grid_.size(); ++node) {
    if (!is_foreseen(timer, node)) continue;
    all.push_back({"jump at node " + std::to_string(node) + " from mode " + system_.mode + " to " +
                       next.system_.mode + ", timer_dependent (4)",
                   jump(timer, node, next.P(grid_.with_first(node, timer))), std::nullopt});
  }
  return all;
}

std::vector<Condition> TimerDependentFunction::conditions() const {
  std::vector<Condition> all = flow_conditions();
  for (std::size_t timer = 0; timer < system_.resets.size(); ++timer) {
    for (std::size_t node = 0; node < grid_.size(); ++node) {
      if (!is_foreseen(timer, node)) continue;
      all.push_back({"jump of " + system_.resets[timer].name + " at node " + std::to_string(node) +
                         ", timer_dependent (4)",
                     jump_condition(timer, node), std::nullopt});
    }
  }
  return all;
}

}  // namespace sampled_data_observers
