#include "textbook_plants.h"

#include <utility>

#include "paper_plants.h"

namespace sampled_data_observers::test {
namespace {

using Rows = std::vector<std::vector<double>>;

Eigen::MatrixXd matrix_of(const Rows& rows) {
  Eigen::MatrixXd matrix(rows.size(), rows.front().size());
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) {
      matrix(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return matrix;
}

TextbookPlant plant(std::string name, const Rows& A, const Rows& C, double T1, double T2,
                    double noise, bool is_held_better = false) {
  return {std::move(name), linear_subject(matrix_of(A), matrix_of(C), T1, T2), noise,
          is_held_better};
}

}  // namespace

const std::vector<TextbookPlant>& textbook_plants() {
  static const std::vector<TextbookPlant> all = {
      plant("dc_motor", {{0, 1}, {0, -2}}, {{1, 0}}, 0.02, 0.1, 0.01),
      plant("pendulum", {{0, 1}, {-9.81, -0.2}}, {{1, 0}}, 0.02, 0.1, 0.005, true),
      plant("inverted_pendulum", {{0, 1}, {9.81, -0.1}}, {{1, 0}}, 0.01, 0.05, 0.002),
      plant("cart", {{0, 1}, {0, 0}}, {{1, 0}}, 0.05, 0.2, 0.01),
      // Levels [m].
      plant("two_tanks", {{-0.05, 0}, {0.05, -0.04}}, {{0, 1}}, 0.5, 2, 0.002),
      // 300 kg on 20 kN/m and 1.5 kN s/m, wheel of 50 kg on 200 kN/m; body and wheel height.
      plant("quarter_car",
            {{0, 1, 0, 0}, {-66.7, -5, 66.7, 5}, {0, 0, 0, 1}, {400, 30, -4400, -30}},
            {{1, 0, 0, 0}, {0, 0, 1, 0}}, 0.002, 0.006, 0.001, true),
      // 1 mF, 10 mH, 1 Ohm: voltage [V] and current [A].
      plant("rlc", {{0, 1000}, {-100, -100}}, {{1, 0}}, 0.0005, 0.002, 0.05),
      // Angle of attack, pitch rate, pitch.
      plant("aircraft_pitch", {{-0.313, 56.7, 0}, {-0.0139, -0.426, 0}, {0, 56.7, 0}}, {{0, 0, 1}},
            0.02, 0.1, 0.002, true),
      // Height, climb, and the acceleration by which thrust is wrong.
      plant("drone_altitude", {{0, 1, 0}, {0, -0.3, 1}, {0, 0, 0}}, {{1, 0, 0}}, 0.03, 0.1, 0.02),
      // Minimal model, minutes: glucose [mg/dl], remote insulin [1/(100 min)], insulin [mU/dl].
      plant("glucose", {{-0.028, -0.8, 0}, {0, -0.025, 0.013}, {0, 0, -0.09}}, {{1, 0, 0}}, 4, 6,
            2),
      // Motor angle and speed, load angle and speed.
      plant("flexible_shaft",
            {{0, 1, 0, 0}, {-100, -0.5, 100, 0.5}, {0, 0, 0, 1}, {100, 0.5, -100, -0.5}},
            {{1, 0, 0, 0}}, 0.01, 0.03, 0.001, true),
      plant("mass_spring", {{0, 1}, {-1, 0}}, {{1, 0}}, 0.1, 0.5, 0.01),
      plant("ball_and_beam", {{0, 1, 0, 0}, {0, 0, -7, 0}, {0, 0, 0, 1}, {0, 0, 0, -1}},
            {{1, 0, 0, 0}, {0, 0, 1, 0}}, 0.02, 0.06, 0.002),
      plant("maglev", {{0, 1}, {400, 0}}, {{1, 0}}, 0.002, 0.008, 0.0001),
      plant("heat_rod", {{-0.2, 0.1, 0}, {0.1, -0.2, 0.1}, {0, 0.1, -0.1}}, {{1, 0, 0}}, 0.5, 2,
            0.1),
      plant("satellite_attitude", {{0, 1}, {0, -0.001}}, {{1, 0}}, 0.2, 1, 0.001, true),
      // Yaw rate [deg/s] and heading [deg].
      plant("ship_heading", {{-0.05, 0}, {1, 0}}, {{0, 1}}, 0.5, 2, 0.5, true),
      // Air and wall [K], hours.
      plant("thermal_room", {{-6, 5}, {0.5, -0.6}}, {{1, 0}}, 0.01, 0.04, 0.2),
      plant("gyro_bias", {{0, -1}, {0, 0}}, {{1, 0}}, 0.05, 0.2, 0.01),
      // Open-circuit and RC voltage.
      plant("battery", {{0, 0}, {0, -0.033}}, {{1, -1}}, 1, 5, 0.005),
      plant("vehicle_lateral", {{-5, -19}, {1.5, -6}}, {{0, 1}}, 0.02, 0.06, 0.01),
      plant("hydraulic_servo", {{0, 1, 0}, {0, 0, 1}, {0, -400, -8}}, {{1, 0, 0}}, 0.005, 0.02,
            0.0005, true),
      // Trolley, and angle of the load.
      plant("crane", {{0, 1, 0, 0}, {0, -0.2, 1, 0}, {0, 0, 0, 1}, {0, 0.1, -4, -0.05}},
            {{1, 0, 0, 0}, {0, 0, 1, 0}}, 0.02, 0.1, 0.005),
  };
  return all;
}

}  // namespace sampled_data_observers::test
