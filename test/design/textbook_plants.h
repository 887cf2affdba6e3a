#pragma once

#include <Eigen/Core>
#include <ostream>
#include <string>
#include <vector>

namespace sampled_data_observers::test {

/// A plant of a textbook in SI units, but where its field uses others: dx/dt = A x + B u + N w,
/// with one sensor y = C x + noise. What a user would know of it, and how it is moved in tests.
struct TextbookPlant {
  std::string name;
  Eigen::MatrixXd A;
  Eigen::MatrixXd C;
  double T1 = 0.0;
  double T2 = 0.0;
  double noise = 0.0;  ///< |noise| is at most this
  Eigen::VectorXd B;  ///< of the known input u, which moves the plant by 1 or −1 and what holds it
  Eigen::MatrixXd N;
  double disturbance = 0.0;  ///< |w| is at most this

  /// The file that a user would write, with or without what is known of disturbances.
  std::string file(bool declares_disturbance) const;
};

/// For messages of tests.
inline void PrintTo(const TextbookPlant& plant, std::ostream* out) { *out << plant.name; }

const std::vector<TextbookPlant>& textbook_plants();

}  // namespace sampled_data_observers::test
