#include "design/jump_observability.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "design/observability.h"
#include "linear_algebra/matrix_functions.h"

namespace sampled_data_observers {
namespace {

constexpr double kMostSequences = 1e6;

/// Goes through all sequences, with what their common beginnings share.
class SequenceSearch {
 public:
  SequenceSearch(const CertificateSubject& subject, std::size_t points) {
    const ModeMatrices& plant = subject.plant.mode();
    for (std::size_t i = 0; i < points; ++i) {
      const double part =
          points > 1 ? static_cast<double>(i) / static_cast<double>(points - 1) : 0.0;
      const double tau = subject.T1 + part * (subject.T2 - subject.T1);
      intervals_.push_back({tau, pair_at_jumps(plant.A, *plant.A_d, plant.C_d, tau)});
    }
    result_.least_gramian = std::numeric_limits<double>::infinity();
  }

  void run(std::size_t jumps, const Eigen::MatrixXd& transition, const Eigen::MatrixXd& gramian) {
    if (jumps == 0) {
      const double least = min_eigenvalue(gramian);
      if (least < result_.least_gramian) result_ = {least, sequence_};
      return;
    }
    for (const Interval& interval : intervals_) {
      const Eigen::MatrixXd seen = interval.pair.H * transition;
      sequence_.push_back(interval.tau);
      run(jumps - 1, interval.pair.F * transition, gramian + seen.transpose() * seen);
      sequence_.pop_back();
    }
  }

  const JumpObservability& result() const { return result_; }

 private:
  struct Interval {
    double tau = 0.0;
    DiscretePair pair;
  };

  std::vector<Interval> intervals_;
  std::vector<double> sequence_;
  JumpObservability result_;
};

}  // namespace

JumpObservability jump_observability(const CertificateSubject& subject, std::size_t jumps,
                                     std::size_t points) {
  const PlantMatrices& plant = subject.plant;
  if (plant.modes.size() > 1 || !plant.mode().A_d || plant.mode().C_d.rows() == 0) {
    throw std::invalid_argument(
        "observability from jumps is about a plant that does not switch, jumps by a matrix, and "
        "has an output measured at jumps");
  }
  if (std::pow(static_cast<double>(points), static_cast<double>(jumps)) > kMostSequences) {
    throw std::invalid_argument(std::to_string(points) + " lengths of " + std::to_string(jumps) +
                                " intervals are more than a million sequences");
  }
  const Eigen::Index n = plant.states();
  SequenceSearch search(subject, points);
  search.run(jumps, Eigen::MatrixXd::Identity(n, n), Eigen::MatrixXd::Zero(n, n));
  return search.result();
}

}  // namespace sampled_data_observers
