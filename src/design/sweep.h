#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "design/design_search.h"
#include "ranks/ranks.h"

namespace sampled_data_observers {

/// What is asked of a sweep: the best design by each method for each T2.
struct SweepRequest {
  /// The plant, and the T1 of all designs; T2 is not used.
  CertificateSubject subject;
  std::vector<const DesignMethod*> methods;
  Objective objective = Objective::kMinGamma;  ///< or kMaxDecay
  std::vector<double> T2;                      ///< increasing, T1 <= T2 [s]
  /// Each for all methods that know it; the others are searched for.
  Parameters given;
};

/// The best design by a method for one T2, or why there is none.
struct SweepPoint {
  std::string method;
  double T2 = 0.0;
  /// The least gain, or the largest rate of convergence (drawn_quantity()); empty where there is no
  /// design.
  std::optional<double> value;
  /// With which it was made.
  Parameters parameters;
  double seconds = 0.0;
  std::string message;
};

/// What a method makes least or largest, with its unit: not the same for all.
std::string drawn_quantity(const DesignMethod& method, const CertificateSubject& subject,
                           Objective objective);

/// Whether `first` is a better value than `second`.
bool is_better(Objective objective, double first, double second);

/// T2 from `low` to `high` in equal steps, rounded to 6 digits.
/// @throws DesignError where these are no `points` different numbers > 0.
std::vector<double> sweep_times(double low, double high, std::size_t points);

/// All methods that are about the plant and can serve the objective, but for special cases of
/// others and those that are about another quantity than the first.
std::vector<const DesignMethod*> methods_for(const CertificateSubject& subject,
                                             Objective objective);

/// @throws DesignError for a method that is not about the plant, the objective or the same quantity
/// as the others, and for a parameter that no method knows or that is not finite.
void require_sense(const SweepRequest& request);

struct SweepOptions {
  unsigned jobs = 1;
  /// For one attempt within a point [s].
  double time_limit = 20.0;
  /// Points that need not be tried again.
  std::function<bool(const std::string& method, double T2)> is_done;
  /// Called after each point; with the design where there is one.
  std::function<void(const SweepPoint& point, const Design* design)> on_point;
  /// See WorkerOptions.
  std::function<bool()> is_cancelled;
  /// Those that share the points, or null: rank 0 asks is_done and calls on_point for all.
  Ranks* ranks = nullptr;
  /// What is asked for, by which rank 0 knows that all others were asked for the same.
  std::string request;
};

/// Finds the points of a request that are not done, `jobs` of them at a time on each rank.
/// @return how many were lost because their process died
/// @throws DesignError as require_sense(), Cancelled when told so; std::runtime_error where a rank
/// was asked for something else
std::size_t run_sweep(const SweepRequest& request, const SweepOptions& options);

/// Number of points of a request that are not done.
std::size_t remaining_points(const SweepRequest& request, const SweepOptions& options);

/// The best design known for a method and a T2. A design for a larger T2 holds for the smaller one
/// as well, since it holds for all times between samples from T1 to its own T2: where it is the
/// better one, it serves. So the curve of a method is monotone.
struct CurvePoint {
  std::string method;
  double T2 = 0.0;
  /// The point whose design it is; for another T2, possibly. Its value is empty where no design is
  /// known.
  SweepPoint design;
};

/// In the order of the methods' names, then of T2.
std::vector<CurvePoint> best_curves(const std::vector<SweepPoint>& points, Objective objective);

}  // namespace sampled_data_observers
