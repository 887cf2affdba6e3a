#include "config/size_limits.h"

#include <cmath>

namespace sampled_data_observers {

void require_at_most(std::size_t most, std::size_t found, const std::string& what,
                     const ConfigSection& section, const std::string& key) {
  if (found <= most) return;
  throw section.error(key, "at most " + std::to_string(most) + " " + what, std::to_string(found));
}

void require_bounded(std::size_t variables, std::size_t modes, std::size_t most,
                     const ConfigSection& section, const std::string& key) {
  const double most_of_all = static_cast<double>(most) / std::cbrt(static_cast<double>(modes));
  require_at_most(static_cast<std::size_t>(most_of_all + 1e-9), variables,
                  "states, inputs and outputs together" +
                      (modes > 1 ? " with " + std::to_string(modes) + " modes" : std::string()),
                  section, key);
}

}  // namespace sampled_data_observers
