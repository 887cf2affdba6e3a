#pragma once

#include <Eigen/Core>
#include <GeographicLib/LocalCartesian.hpp>
#include <optional>

#include "sampled_data_observers/config/navsat_config.h"
#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// A place on the earth, by WGS 84.
struct GeodeticPosition {
  double latitude = 0.0;   ///< [deg]
  double longitude = 0.0;  ///< [deg]
  double altitude = 0.0;   ///< above the ellipsoid [m]; NaN where it is not known
};

/// The plane that touches the earth at a datum, with axes to the east, to the north and up. For one
/// thread; allocates nothing.
///
/// Where the datum is the first fix, it is set by the first good one, whether or not the estimate
/// lets it through a gate, and those of earlier stamps that come after it are too old: so it is a
/// matter of events alone, and of the earliest stamp among all that the estimate rests on.
class LocalPlane {
 public:
  explicit LocalPlane(const NavSatDatum& datum);

  /// East, north and up of a fix [m]: of one without altitude as if it had that of the datum, and
  /// with NaN as its last. Nothing for a fix that is older than the datum. As long as there is no
  /// datum the fix is proposed as one.
  std::optional<Eigen::Vector3d> project(const GeodeticPosition& fix, Stamp stamp);

  /// Told that the fix that was projected last is good: where there is no datum, it becomes that.
  void confirm() { is_set_ = true; }

  /// Where time begins anew: the datum stays, and no fix is older than it.
  void forget_stamp() { stamp_ = 0; }

  /// The place of a point [m].
  GeodeticPosition unproject(const Eigen::Vector3d& point) const;

  /// Where it touches the earth; nothing as long as that is not known.
  std::optional<GeodeticPosition> datum() const;

 private:
  void put_at(const GeodeticPosition& datum);

  bool is_set_ = false;
  GeodeticPosition datum_;  ///< or what is proposed as such
  Stamp stamp_ = 0;         ///< of it; 0 where fixes are never older
  GeographicLib::LocalCartesian plane_;
};

}  // namespace sampled_data_observers
