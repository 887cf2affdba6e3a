#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "certificate/attack/attacked_observer.h"
#include "certificate/error_bound.h"

namespace sampled_data_observers::test {

/// How finely the flow between two events is looked at; the disturbance may change as often.
constexpr int kParts = 3;

/// What nature does up to one event and at it.
struct Move {
  Duration interval = 0;
  std::vector<Eigen::VectorXd> w;  ///< kParts
  Eigen::VectorXd noise;
};

/// All that nature does in a run.
struct Play {
  Eigen::VectorXd initial_error;
  std::vector<Move> moves;
};

inline Duration part_of(Duration interval, int part) {
  return interval * (part + 1) / kParts - interval * part / kParts;
}

/// Plays it, and calls look(at) where the error is compared with its bound: at the start, kParts
/// times before each event, and after it.
template <typename Look>
void play(AttackedObserver& observer, const Play& run, const Look& look) {
  Attacked at = observer.begin(run.initial_error);
  look(at);
  for (const Move& move : run.moves) {
    for (int part = 0; part < kParts; ++part) {
      observer.flow(part_of(move.interval, part), move.w[static_cast<std::size_t>(part)], at);
      look(at);
    }
    observer.event(move.noise, at);
    look(at);
  }
}

/// For the times of a run, the worst initial error, noise and disturbance for an instant of it: the
/// error depends linearly on them where the plant is affine, e = M_0 e_0 + M_1 v_1 + …, and
/// |e| is largest, with each part within its norm, where each is the multiple of M_iᵀ d that its
/// norm allows and d = e/|e|. That is iterated, from several d. |e_j| is largest with d = ±the unit
/// vector of j.
class WorstInputs {
 public:
  WorstInputs(AttackedObserver& observer, const Play& run, const ErrorAssumptions& assumptions)
      : observer_(observer), run_(run) {
    const Eigen::Index n = observer.plant().states();
    add_part(assumptions.initial_error, n, [](Play& play) { return &play.initial_error; });
    for (std::size_t k = 0; k < run.moves.size(); ++k) {
      for (std::size_t part = 0; part < kParts; ++part) {
        const Eigen::Index inputs = run.moves[k].w[part].size();
        add_part(assumptions.disturbance, inputs,
                 [k, part](Play& play) { return &play.moves[k].w[part]; });
      }
      add_part(assumptions.noise, run.moves[k].noise.size(),
               [k](Play& play) { return &play.moves[k].noise; });
    }
  }

  /// The run with the inputs that are the worst for the state and the instant at which that comes
  /// to most of its bound.
  Play worst_for_a_state() {
    std::vector<Eigen::VectorXd> bounds;
    play(observer_, run_,
         [&](const Attacked& at) { bounds.push_back(observer_.state_bounds(at)); });
    Play worst = run_;
    double largest = 0.0;
    for (std::size_t instant = 0; instant < bounds.size(); ++instant) {
      if (!bounds[instant].allFinite()) continue;
      for (Eigen::Index j = 0; j < bounds[instant].size(); ++j) {
        const Eigen::VectorXd along = Eigen::VectorXd::Unit(bounds[instant].size(), j);
        const double share = largest_along(instant, along)(j) / bounds[instant](j);
        if (!(share > largest)) continue;
        largest = share;
        worst = chosen();
      }
    }
    return worst;
  }

  /// The same for the norm.
  Play worst() {
    const Eigen::Index n = observer_.plant().states();
    std::vector<double> bounds;
    play(observer_, run_, [&](const Attacked& at) { bounds.push_back(observer_.bound(at)); });
    Play worst = run_;
    double largest = 0.0;
    for (std::size_t instant = 0; instant < bounds.size(); ++instant) {
      if (!std::isfinite(bounds[instant])) continue;
      for (Eigen::Index first = 0; first < n; ++first) {
        Eigen::VectorXd direction = Eigen::VectorXd::Unit(n, first);
        double norm = 0.0;
        for (int iteration = 0; iteration < kIterations; ++iteration) {
          const Eigen::VectorXd error = largest_along(instant, direction);
          norm = error.norm();
          if (!(norm > 0.0)) break;
          direction = error / norm;
        }
        if (!(norm > largest * bounds[instant])) continue;
        largest = norm / bounds[instant];
        largest_along(instant, direction);
        worst = chosen();
      }
    }
    return worst;
  }

 private:
  static constexpr int kIterations = 6;

  /// One of the inputs, with what the error is at each instant for each of its unit vectors.
  struct Part {
    double norm = 0.0;
    std::function<Eigen::VectorXd*(Play&)> in;
    std::vector<Eigen::MatrixXd> response;  ///< n x size, for each instant
    Eigen::VectorXd value;
  };

  void add_part(double norm, Eigen::Index size, std::function<Eigen::VectorXd*(Play&)> in) {
    if (!(norm > 0.0) || size == 0) return;
    Part part{norm, std::move(in), {}, Eigen::VectorXd::Zero(size)};
    for (Eigen::Index i = 0; i < size; ++i) {
      Play alone = without_inputs();
      *part.in(alone) = norm * Eigen::VectorXd::Unit(size, i);
      std::size_t instant = 0;
      play(observer_, alone, [&](const Attacked& at) {
        observer_.compare(at);
        if (i == 0) part.response.emplace_back(at.x.size(), size);
        part.response[instant++].col(i) = observer_.error(at) / norm;
      });
    }
    parts_.push_back(std::move(part));
  }

  Play without_inputs() const {
    Play result = run_;
    result.initial_error.setZero();
    for (Move& move : result.moves) {
      for (Eigen::VectorXd& w : move.w) w.setZero();
      move.noise.setZero();
    }
    return result;
  }

  /// Chooses the inputs whose error at this instant is the largest in this direction.
  Eigen::VectorXd largest_along(std::size_t instant, const Eigen::VectorXd& direction) {
    Eigen::VectorXd error = Eigen::VectorXd::Zero(direction.size());
    for (Part& part : parts_) {
      const Eigen::MatrixXd& response = part.response[instant];
      const Eigen::VectorXd along = response.transpose() * direction;
      const double size = along.norm();
      part.value = size > 0.0 ? Eigen::VectorXd(part.norm / size * along)
                              : Eigen::VectorXd(Eigen::VectorXd::Zero(along.size()));
      error += response * part.value;
    }
    return error;
  }

  Play chosen() const {
    Play result = without_inputs();
    for (const Part& part : parts_) *part.in(result) = part.value;
    return result;
  }

  AttackedObserver& observer_;
  Play run_;
  std::vector<Part> parts_;
};

}  // namespace sampled_data_observers::test
