#include "sampled_data_observers/config/navsat_config.h"

#include <cmath>

namespace sampled_data_observers {

std::optional<NavSatDatum> read_navsat(ConfigSection& root) {
  if (!root.has("navsat")) return std::nullopt;
  ConfigSection section = root.section("navsat");
  const std::string expected =
      "first_fix, or [latitude, longitude, altitude]: -90 to 90 and -180 to 180 degrees, and "
      "metres above the ellipsoid of WGS 84";
  if (!section.has("datum")) throw section.error("datum", expected, section.absence_of("datum"));
  NavSatDatum datum;
  if (section.is_list("datum")) {
    datum.position = section.vector("datum", 3);
    const Eigen::Vector3d& position = *datum.position;
    const bool is_on_earth = std::abs(position.x()) <= 90.0 && std::abs(position.y()) <= 180.0 &&
                             std::abs(position.z()) <= 1e5;
    if (!is_on_earth) throw section.error("datum", expected, "another place");
  } else if (section.text("datum") != "first_fix") {
    throw section.error("datum", expected, "'" + section.text("datum") + "'");
  }
  section.finish();
  return datum;
}

}  // namespace sampled_data_observers
