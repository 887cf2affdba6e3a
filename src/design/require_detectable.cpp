#include "design/require_detectable.h"

#include <cmath>
#include <locale>
#include <sstream>

#include "design/design_method.h"
#include "design/observability.h"

namespace sampled_data_observers {
namespace {

/// A state that moves by less than this part of the one that moves most is not named.
constexpr double kSmallPart = 0.05;

std::string states_moved_by(const Mode& mode, const std::vector<std::string>& names) {
  const Eigen::VectorXd sizes = mode.directions.rowwise().norm();
  std::string text;
  for (Eigen::Index i = 0; i < sizes.size(); ++i) {
    if (sizes(i) < kSmallPart * sizes.maxCoeff()) continue;
    text += (text.empty() ? "" : ", ") + names.at(static_cast<std::size_t>(i));
  }
  return text;
}

}  // namespace

void require_detectable(const PlantMatrices& plant) {
  const bool is_about_A =
      plant.flow_vertices.empty() && (plant.is_linear() || plant.vertices.empty());
  if (plant.modes.size() > 1 || plant.jumps() || plant.C().rows() == 0 || !is_about_A) return;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  for (const Mode& mode : unseen_modes(plant.A(), plant.C())) {
    if (mode.decays(TimeDomain::kContinuous)) continue;
    text << (text.tellp() > 0 ? ", nor that of " : "") << mode.eigenvalue.real();
    if (mode.eigenvalue.imag() != 0.0) text << " +- " << mode.eigenvalue.imag() << "i";
    text << " 1/s, which moves " << states_moved_by(mode, plant.state_names);
  }
  if (text.tellp() == 0) return;
  throw DesignError(
      "the pair (A, C) is not detectable: the outputs don't show the mode of eigenvalue " +
      text.str() + ", and it does not decay. Measure another output");
}

}  // namespace sampled_data_observers
