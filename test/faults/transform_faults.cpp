// Transforms that are missing, late, or nonsense.
#include <limits>

#include "faults/fault.h"
#include "faults/messages.h"
#include "messages/time_conversion.h"
#include "support/stamps.h"

namespace sampled_data_observers::test {
namespace {

void measure(FaultBench& bench, Stamp stamp, const std::string& frame) {
  bench.publish("camera", point_ahead(stamp, frame, bench.truth(stamp)[0]));
}

/// Sends a point each period for a second; then time passes until they have waited long enough.
std::function<void(FaultBench&)> points(const std::function<void(FaultBench&, Stamp)>& send) {
  return [send](FaultBench& bench) {
    for (int i = 0; i < 10; ++i) {
      bench.set_clock(bench.now() + kSecond / 10);
      send(bench, bench.now());
    }
    bench.let_pass_until_answered();
  };
}

/// Points that find transforms to which something was done.
std::function<void(FaultBench&)> transforms(
    const std::function<void(geometry_msgs::TransformStamped&)>& spoil) {
  return points([spoil](FaultBench& bench, Stamp stamp) {
    tf2_msgs::TFMessage message = turntable(stamp);
    spoil(message.transforms[0]);
    bench.publish("/tf", message, 0);
    measure(bench, stamp, "lens");
  });
}

/// Each transform comes 0.3 s after its point.
void late_transforms(FaultBench& bench) {
  for (int i = 0; i < 13; ++i) {
    bench.set_clock(bench.now() + kSecond / 10);
    if (i < 10) measure(bench, bench.now(), "lens");
    if (i < 3) continue;
    const std::size_t answered = bench.statuses.size();
    bench.publish("/tf", turntable(bench.now() - 3 * kSecond / 10), 0);
    FaultBench::require([&] { return bench.statuses.size() > answered; }, "it waits for more");
  }
}

/// Beside the good ones, one from the far future, as a node whose clock was set wrongly sends it.
void from_the_future(FaultBench& bench) {
  bench.publish("/tf", turntable(bench.now() + 3600 * kSecond), 0);
  bench.go_on(1.0);
}

void beyond_the_last(FaultBench& bench) {
  const Stamp last = bench.now();
  for (int i = 1; i <= 10; ++i) measure(bench, last + i, "lens");
  bench.let_pass_until_answered();
}

void time_goes_back(FaultBench& bench) {
  bench.set_clock(bench.now() + kSecond / 10);
  measure(bench, bench.now(), "lens");
  bench.let_pass(0.2);
  bench.set_clock(bench.now() - 4 * kSecond / 10);
  bench.let_pass_until_answered();
  bench.let_pass(0.5);
}

}  // namespace

std::vector<Fault> transform_faults() {
  const std::map<std::uint8_t, int> dropped = {{EventStatus::NO_TRANSFORM, 10}};
  const auto in_frame = [](const std::string& frame) {
    return points([frame](FaultBench& bench, Stamp stamp) { measure(bench, stamp, frame); });
  };
  return {
      {"Missing", "camera", "1 s without transforms; points wait 0.5 s", in_frame("lens"), dropped},
      {"Late", "camera", "transforms that come 0.3 s after the points", late_transforms, {}},
      {"BeyondTheLast", "camera", "points after the last transform: nothing is extrapolated",
       beyond_the_last, dropped},
      {"UnknownFrame", "camera", "points in a frame that nobody knows", in_frame("nowhere"),
       dropped},
      {"NoFrame", "camera", "points without a frame", in_frame(""), dropped},
      {"OddFrame", "camera", "points in a frame with an odd name",
       in_frame("/\xff \n/../" + std::string(1000, '~')), dropped},
      {"NotANumber", "camera", "transforms with a translation that is NaN",
       transforms([](auto& transform) { transform.transform.translation.x = kNaN; }), dropped},
      {"RotationNotANumber", "camera", "transforms with a rotation that is NaN",
       transforms([](auto& transform) { transform.transform.rotation.w = kNaN; }), dropped},
      {"Zero", "camera", "transforms whose quaternion is zero",
       transforms([](auto& transform) { transform.transform.rotation.z = 0.0; }), dropped},
      {"NoRotation", "camera", "transforms whose quaternion has the norm 2",
       transforms([](auto& transform) { transform.transform.rotation.z = 2.0; }), dropped},
      {"ItsOwnParent", "camera", "transforms from a frame into itself",
       transforms([](auto& transform) { transform.header.frame_id = "turntable"; }), dropped},
      {"FromTheFuture",
       "camera",
       "a transform stamped an hour ahead, beside good ones",
       from_the_future,
       {}},
      {"TimeGoesBack",
       "camera",
       "time goes back by 0.4 s while a point waits: transforms are "
       "forgotten",
       time_goes_back,
       {{EventStatus::NO_TRANSFORM, 1}}},
  };
}

}  // namespace sampled_data_observers::test
