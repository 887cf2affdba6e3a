#include "config/mode_config.h"

#include <utility>

#include "config/expression_config.h"
#include "plant/affine_formula.h"
#include "plant/bounded_slope_map.h"
#include "plant/lipschitz_map.h"
#include "plant/polytopic_map.h"

namespace sampled_data_observers {
namespace {

std::shared_ptr<const VectorMap> read_psi(ConfigSection& mode, const ExpressionNames& names,
                                          Eigen::Index arguments) {
  ExpressionNames of_psi;
  for (Eigen::Index i = 1; i <= arguments; ++i) of_psi.x.push_back("v" + std::to_string(i));
  of_psi.constants = names.constants;
  return ExpressionReader(of_psi).read_list(mode, "psi", 0);
}

std::shared_ptr<const VectorMap> read_lipschitz_map(ConfigSection& mode,
                                                    const ExpressionNames& names, Eigen::MatrixXd A,
                                                    Eigen::MatrixXd B) {
  const Eigen::Index n = A.rows();
  LipschitzDescription map;
  map.S = mode.matrix("S", -1, n);
  map.psi = read_psi(mode, names, map.S.rows());
  map.G = mode.matrix("G", n, map.psi->size());
  map.A = std::move(A);
  map.B = std::move(B);
  if (mode.has("lipschitz_constant")) {
    map.lipschitz_constant = mode.number_in("lipschitz_constant", 1e-300, 1e300, std::nullopt);
  }
  if (mode.has("vertices")) {
    ConfigSection vertices = mode.section("vertices");
    for (const std::string& name : vertices.keys()) {
      map.vertices.push_back(vertices.matrix(name, n, n));
    }
  }
  return std::make_shared<const LipschitzMap>(std::move(map));
}

/// A flow by formulas with the vertices of its Jacobian.
std::shared_ptr<const VectorMap> read_polytopic_map(ConfigSection& mode,
                                                    std::shared_ptr<const VectorMap> flow) {
  const Eigen::Index n = flow->size();
  PolytopicDescription description;
  ConfigSection vertices = mode.section("jacobian_vertices");
  for (const std::string& name : vertices.keys()) {
    description.vertices.push_back(vertices.matrix(name, n, n));
  }
  if (description.vertices.empty()) {
    throw mode.error("jacobian_vertices", "at least one n x n matrix, below a name", "none");
  }
  description.G.resize(n, 0);
  description.S.resize(0, n);
  if (mode.has("G") || mode.has("S") || mode.has("lipschitz_constant")) {
    description.G = mode.matrix("G", n, -1);
    description.S = mode.matrix("S", -1, n);
    description.lipschitz_constant =
        mode.number_in("lipschitz_constant", 1e-300, 1e300, std::nullopt);
  }
  return std::make_shared<const PolytopicMap>(std::move(flow), std::move(description));
}

}  // namespace

std::shared_ptr<const VectorMap> read_flow_map(ConfigSection& mode, const ExpressionNames& names) {
  if (mode.has("flow")) {
    ExpressionReader reader(names);
    reader.read_definitions(mode, "definitions");
    std::shared_ptr<const VectorMap> flow = reader.read_map(mode, "flow", names.x);
    if (!mode.has("jacobian_vertices")) return flow;
    return read_polytopic_map(mode, std::move(flow));
  }
  const auto n = static_cast<Eigen::Index>(names.x.size());
  const auto p = static_cast<Eigen::Index>(names.u.size());
  Eigen::MatrixXd A = mode.matrix("A", n, n);
  Eigen::MatrixXd B = p > 0 ? mode.matrix("B", n, p) : Eigen::MatrixXd::Zero(n, 0);
  if (mode.has("psi")) return read_lipschitz_map(mode, names, std::move(A), std::move(B));
  Eigen::VectorXd b = mode.has("b") ? mode.vector("b", n) : Eigen::VectorXd::Zero(n);
  return std::make_shared<const AffineMap>(std::move(A), std::move(B), std::move(b));
}

std::shared_ptr<const VectorMap> read_jump_map(ConfigSection& mode, const ExpressionNames& names) {
  if (!mode.has("jump_map")) return nullptr;
  const auto n = static_cast<Eigen::Index>(names.x.size());
  ConfigSection section = mode.section("jump_map");
  std::shared_ptr<const VectorMap> map;
  if (section.has("formulas")) {
    map = ExpressionReader(names).read_map(section, "formulas", names.x);
  } else {
    Eigen::MatrixXd A_d = section.matrix("A_d", n, n);
    Eigen::VectorXd b_d = section.has("b_d") ? section.vector("b_d", n) : Eigen::VectorXd::Zero(n);
    map = std::make_shared<const AffineMap>(std::move(A_d), Eigen::MatrixXd::Zero(n, 0),
                                            std::move(b_d));
  }
  if (section.has("lipschitz_constant")) {
    const double constant = section.number_in("lipschitz_constant", 0.0, 1e50, std::nullopt);
    map = std::make_shared<const BoundedSlopeMap>(std::move(map), constant);
  }
  section.finish();
  return map;
}

std::shared_ptr<const VectorMap> read_output_map(ConfigSection& sensor,
                                                 const ExpressionNames& names) {
  const auto n = static_cast<Eigen::Index>(names.x.size());
  if (sensor.has("h")) {
    std::shared_ptr<const VectorMap> map = ExpressionReader(names).read_list(sensor, "h", 0);
    const std::shared_ptr<const AffineMap> affine = affine_map_of(names, sensor.texts("h"));
    return affine ? affine : map;
  }
  Eigen::MatrixXd C = sensor.matrix("C", -1, n);
  if (!sensor.has("d")) return std::make_shared<const AffineMap>(C);
  Eigen::VectorXd d = sensor.vector("d", C.rows());
  const Eigen::Index outputs = C.rows();
  return std::make_shared<const AffineMap>(std::move(C), Eigen::MatrixXd::Zero(outputs, 0),
                                           std::move(d));
}

}  // namespace sampled_data_observers
