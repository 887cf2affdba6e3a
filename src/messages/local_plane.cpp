#include "messages/local_plane.h"

#include <cmath>
#include <limits>

namespace sampled_data_observers {

LocalPlane::LocalPlane(const NavSatDatum& datum) : is_set_(datum.position.has_value()) {
  if (!is_set_) return;
  put_at({datum.position->x(), datum.position->y(), datum.position->z()});
}

void LocalPlane::put_at(const GeodeticPosition& datum) {
  datum_ = datum;
  if (std::isnan(datum_.altitude)) datum_.altitude = 0.0;
  plane_.Reset(datum_.latitude, datum_.longitude, datum_.altitude);
}

std::optional<Eigen::Vector3d> LocalPlane::project(const GeodeticPosition& fix, Stamp stamp) {
  if (!is_set_) {
    put_at(fix);
    stamp_ = stamp;
  } else if (stamp < stamp_) {
    return std::nullopt;
  }
  const bool has_altitude = !std::isnan(fix.altitude);
  Eigen::Vector3d point;
  plane_.Forward(fix.latitude, fix.longitude, has_altitude ? fix.altitude : datum_.altitude,
                 point.x(), point.y(), point.z());
  if (!has_altitude) point.z() = std::numeric_limits<double>::quiet_NaN();
  return point;
}

GeodeticPosition LocalPlane::unproject(const Eigen::Vector3d& point) const {
  GeodeticPosition place;
  plane_.Reverse(point.x(), point.y(), point.z(), place.latitude, place.longitude, place.altitude);
  return place;
}

std::optional<GeodeticPosition> LocalPlane::datum() const {
  return is_set_ ? std::optional<GeodeticPosition>(datum_) : std::nullopt;
}

}  // namespace sampled_data_observers
