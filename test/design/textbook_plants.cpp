#include "textbook_plants.h"

#include <sstream>
#include <utility>

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

std::string yaml(const Eigen::MatrixXd& matrix) {
  const Eigen::IOFormat format(Eigen::FullPrecision, Eigen::DontAlignCols, ", ", ", ", "[", "]",
                               "[", "]");
  std::ostringstream text;
  text << matrix.format(format);
  return text.str();
}

struct Sampling {
  double T1;
  double T2;
  double noise;
};

TextbookPlant plant(std::string name, const Rows& A, const Rows& C, Sampling sampling,
                    const std::vector<double>& B, const Rows& N, double disturbance) {
  TextbookPlant result;
  result.name = std::move(name);
  result.A = matrix_of(A);
  result.C = matrix_of(C);
  result.T1 = sampling.T1;
  result.T2 = sampling.T2;
  result.noise = sampling.noise;
  result.B = Eigen::Map<const Eigen::VectorXd>(B.data(), static_cast<Eigen::Index>(B.size()));
  result.N = matrix_of(N);
  result.disturbance = disturbance;
  return result;
}

}  // namespace

std::string TextbookPlant::file(bool declares_disturbance) const {
  std::ostringstream text;
  text.precision(17);
  text << "plant:\n  states: [";
  for (Eigen::Index i = 0; i < A.rows(); ++i) text << (i == 0 ? "x" : ", x") << i + 1;
  text << "]\n  inputs: [u]\n  A: " << yaml(A) << "\n  B: " << yaml(B)
       << "\nsensors:\n  s: {C: " << yaml(C) << ", source: {topic: s}}\ninput: {topic: u}\n"
       << "design:\n  sampling: {T1: " << T1 << ", T2: " << T2 << "}\n";
  if (declares_disturbance) text << "  N: " << yaml(N) << '\n';
  text << "error_assumptions:\n  initial_error: " << 10.0 * noise << "\n  noise: " << noise << '\n';
  if (declares_disturbance) text << "  disturbance: " << disturbance << '\n';
  return text.str();
}

const std::vector<TextbookPlant>& textbook_plants() {
  static const std::vector<TextbookPlant> all = {
      // Angle [rad] and speed; voltage, and 10 % of load that nobody knows.
      plant("dc_motor", {{0, 1}, {0, -2}}, {{1, 0}}, {0.02, 0.1, 0.01}, {0, 10}, {{0}, {1}}, 1.0),
      // Swung by 2 rad/s^2; gusts.
      plant("pendulum", {{0, 1}, {-9.81, -0.2}}, {{1, 0}}, {0.02, 0.1, 0.005}, {0, 2}, {{0}, {1}},
            0.2),
      plant("inverted_pendulum", {{0, 1}, {9.81, -0.1}}, {{1, 0}}, {0.01, 0.05, 0.002}, {0, 2},
            {{0}, {1}}, 0.2),
      plant("cart", {{0, 1}, {0, 0}}, {{1, 0}}, {0.05, 0.2, 0.01}, {0, 1}, {{0}, {1}}, 0.1),
      // Levels [m]; inflow.
      plant("two_tanks", {{-0.05, 0}, {0.05, -0.04}}, {{0, 1}}, {0.5, 2, 0.002}, {0.01, 0},
            {{1}, {0}}, 0.001),
      // 300 kg on 20 kN/m and 1.5 kN s/m, wheel of 50 kg on 200 kN/m; body and wheel height. Known
      // road of 20 mm, unevenness of 2 mm.
      plant("quarter_car",
            {{0, 1, 0, 0}, {-66.7, -5, 66.7, 5}, {0, 0, 0, 1}, {400, 30, -4400, -30}},
            {{1, 0, 0, 0}, {0, 0, 1, 0}}, {0.002, 0.006, 0.001}, {0, 0, 0, 80},
            {{0}, {0}, {0}, {4000}}, 0.002),
      // 1 mF, 10 mH, 1 Ohm: voltage [V] and current [A]; source of 10 V.
      plant("rlc", {{0, 1000}, {-100, -100}}, {{1, 0}}, {0.0005, 0.002, 0.05}, {0, 1000},
            {{0}, {100}}, 1.0),
      // Angle of attack, pitch rate, pitch; elevator of 0.1 rad.
      plant("aircraft_pitch", {{-0.313, 56.7, 0}, {-0.0139, -0.426, 0}, {0, 56.7, 0}}, {{0, 0, 1}},
            {0.02, 0.1, 0.002}, {0.0232, 0.00203, 0}, {{0.232}, {0.0203}, {0}}, 0.01),
      // Height, climb, and the acceleration by which thrust is wrong; gusts, and its drift.
      plant("drone_altitude", {{0, 1, 0}, {0, -0.3, 1}, {0, 0, 0}}, {{1, 0, 0}}, {0.03, 0.1, 0.02},
            {0, 3, 0}, {{0, 0}, {1, 0}, {0, 0.5}}, 0.3),
      // Minimal model, minutes: glucose [mg/dl], remote insulin [1/(100 min)], insulin [mU/dl];
      // infusion, and meals.
      plant("glucose", {{-0.028, -0.8, 0}, {0, -0.025, 0.013}, {0, 0, -0.09}}, {{1, 0, 0}},
            {4, 6, 2}, {5, 0, 0}, {{1}, {0}, {0}}, 0.5),
      // Motor angle and speed, load angle and speed; torques on both.
      plant("flexible_shaft",
            {{0, 1, 0, 0}, {-100, -0.5, 100, 0.5}, {0, 0, 0, 1}, {100, 0.5, -100, -0.5}},
            {{1, 0, 0, 0}}, {0.01, 0.03, 0.001}, {0, 20, 0, 0}, {{0, 0}, {1, 0}, {0, 0}, {0, 1}},
            1.0),
      plant("mass_spring", {{0, 1}, {-1, 0}}, {{1, 0}}, {0.1, 0.5, 0.01}, {0, 0.5}, {{0}, {1}},
            0.05),
      plant("ball_and_beam", {{0, 1, 0, 0}, {0, 0, -7, 0}, {0, 0, 0, 1}, {0, 0, 0, -1}},
            {{1, 0, 0, 0}, {0, 0, 1, 0}}, {0.02, 0.06, 0.002}, {0, 0, 0, 1},
            {{0, 0}, {1, 0}, {0, 0}, {0, 1}}, 0.1),
      plant("maglev", {{0, 1}, {400, 0}}, {{1, 0}}, {0.002, 0.008, 0.0001}, {0, 2}, {{0}, {1}},
            0.2),
      // Temperatures [K]; heater.
      plant("heat_rod", {{-0.2, 0.1, 0}, {0.1, -0.2, 0.1}, {0, 0.1, -0.1}}, {{1, 0, 0}},
            {0.5, 2, 0.1}, {2, 0, 0}, {{1}, {0}, {0}}, 0.2),
      // Slewed by thrusters.
      plant("satellite_attitude", {{0, 1}, {0, -0.001}}, {{1, 0}}, {0.2, 1, 0.001}, {0, 0.01},
            {{0}, {1}}, 0.001),
      // Yaw rate [deg/s] and heading [deg]; rudder, and waves.
      plant("ship_heading", {{-0.05, 0}, {1, 0}}, {{0, 1}}, {0.5, 2, 0.5}, {0.2, 0}, {{1}, {0}},
            0.02),
      // Air and wall [K], hours; heater of 10 K in ten minutes.
      plant("thermal_room", {{-6, 5}, {0.5, -0.6}}, {{1, 0}}, {0.01, 0.04, 0.2}, {60, 0},
            {{1}, {0}}, 6),
      // Angle [rad] and bias of the gyro; the rate that it shows, its noise and the bias' drift.
      plant("gyro_bias", {{0, -1}, {0, 0}}, {{1, 0}}, {0.05, 0.2, 0.01}, {0.5, 0},
            {{1, 0}, {0, 0.1}}, 0.02),
      // Open-circuit and RC voltage; current of 50 A.
      plant("battery", {{0, 0}, {0, -0.033}}, {{1, -1}}, {1, 5, 0.005}, {-0.0005, 0.01},
            {{0.0005, 0}, {0, 0.01}}, 0.1),
      // Lateral speed and yaw rate; steering of 0.1 rad, wind.
      plant("vehicle_lateral", {{-5, -19}, {1.5, -6}}, {{0, 1}}, {0.02, 0.06, 0.005}, {8, 4},
            {{8}, {4}}, 0.2),
      // Position, speed, acceleration; valve.
      plant("hydraulic_servo", {{0, 1, 0}, {0, 0, 1}, {0, -400, -8}}, {{1, 0, 0}},
            {0.005, 0.02, 0.0005}, {0, 0, 40}, {{0}, {0}, {400}}, 0.01),
      // Trolley, and angle of the load; its drive, and wind on both.
      plant("crane", {{0, 1, 0, 0}, {0, -0.2, 1, 0}, {0, 0, 0, 1}, {0, 0.1, -4, -0.05}},
            {{1, 0, 0, 0}, {0, 0, 1, 0}}, {0.02, 0.1, 0.005}, {0, 1, 0, -0.5},
            {{0, 0}, {1, 0}, {0, 0}, {0, 1}}, 0.1),
  };
  return all;
}

}  // namespace sampled_data_observers::test
