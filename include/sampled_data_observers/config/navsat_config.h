#pragma once

#include <Eigen/Core>
#include <optional>

#include "sampled_data_observers/config/config_section.h"

namespace sampled_data_observers {

/// Where the local plane of satellite navigation touches the earth: east, north and up are measured
/// from there.
struct NavSatDatum {
  /// Latitude and longitude [deg] and altitude above the ellipsoid of WGS 84 [m]; nothing: those of
  /// the first fix that is used.
  std::optional<Eigen::Vector3d> position;
};

/// Reads the section `navsat`; nothing where there is none.
std::optional<NavSatDatum> read_navsat(ConfigSection& root);

}  // namespace sampled_data_observers
