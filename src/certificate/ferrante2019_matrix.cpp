#include "certificate/ferrante2019_matrix.h"

namespace sampled_data_observers {

MatrixExpression ferrante2019_error_weight(const PlantMatrices& plant,
                                           const MatrixExpression& lambda_t) {
  MatrixExpression weight = 2.0 * lambda_t * symbol("P1", plant.states(), plant.states());
  // Products of the file's numbers stand in the formula, where a proof accounts for rounding.
  if (plant.C_p.rows() > 0) {
    const MatrixExpression C_p = plant.C_p;
    weight = weight + transpose(C_p) * C_p;
  }
  if (plant.is_linear()) return weight;
  const MatrixExpression ell = *plant.lipschitz_constant;
  const MatrixExpression S = plant.S;
  return weight + symbol("chi") * (ell * ell) * (transpose(S) * S);
}

MatrixExpression ferrante2019_with_inputs(
    const PlantMatrices& plant, UpperTriangle rows,
    const std::function<std::vector<MatrixExpression>(const MatrixExpression&)>& column) {
  const auto append = [&](const Eigen::MatrixXd& input, const MatrixExpression& level) {
    if (input.cols() == 0) return;
    const std::vector<MatrixExpression> blocks_of_input = column(input);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].push_back(i < blocks_of_input.size() ? blocks_of_input[i]
                                                   : zeros(rows[i].front().rows(), input.cols()));
    }
    rows.push_back({-(level * identity(input.cols()))});
  };
  append(plant.N, square("gamma"));
  append(plant.G, symbol("chi"));
  return symmetric_blocks(rows);
}

MatrixExpression ferrante2019_M(const PlantMatrices& plant, const MatrixExpression& e,
                                const MatrixExpression& lambda_t, const MatrixExpression& P1_L,
                                const MatrixExpression& P2_CL_H) {
  const MatrixExpression A = plant.A();
  const MatrixExpression C = plant.C();
  const MatrixExpression P1 = symbol("P1", A.rows(), A.rows());
  const MatrixExpression P2 = symbol("P2", C.rows(), C.rows());
  // P2 (C A − C L C − H C)
  const MatrixExpression P2_F21 = P2 * C * A - P2_CL_H * C;
  return ferrante2019_with_inputs(
      plant,
      {{He(P1 * A - P1_L * C) + ferrante2019_error_weight(plant, lambda_t),
        P1_L + e * transpose(P2_F21)},
       {e * (He(P2_CL_H) + (2.0 * lambda_t - symbol("delta")) * P2)}},
      [&](const MatrixExpression& input) {
        return std::vector<MatrixExpression>{P1 * input, e * (P2 * C * input)};
      });
}

}  // namespace sampled_data_observers
