#include "design/methods/sampled_plant.h"

#include <locale>
#include <sstream>

#include "design/observability.h"

namespace sampled_data_observers {

std::string undetectable_sampling(const CertificateSubject& subject) {
  const PlantMatrices& plant = subject.plant;
  const bool is_about_A =
      plant.flow_vertices.empty() && (plant.is_linear() || plant.vertices.empty());
  if (plant.modes.size() > 1 || plant.jumps() || plant.C().rows() == 0 || !is_about_A) return "";
  for (const PathologicalInterval& interval :
       pathological_intervals(plant.A(), plant.C(), subject.T2)) {
    if (interval.tau < subject.T1 || interval.decays) continue;
    std::ostringstream text;
    text.imbue(std::locale::classic());
    text << "samples " << interval.tau
         << " s apart do not show a mode that does not decay by itself: [T1, T2] must leave out "
            "this time";
    return text.str();
  }
  return "";
}

std::string on_the_edge(double margin) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.precision(2);
  text << "the solution lies on the edge of the inequalities (least eigenvalue " << margin
       << " once they are scaled to ones on their diagonals)";
  return text.str();
}

}  // namespace sampled_data_observers
