#include "replay/estimate_comparison.h"

#include <rosbag/view.h>
#include <sampled_data_observers/StateEstimate.h>

#include <cmath>
#include <cstring>
#include <map>

#include "messages/time_conversion.h"
#include "replay/bag_source.h"

namespace sampled_data_observers {
namespace {

using Estimates = std::map<Stamp, StateEstimate::ConstPtr>;

Estimates read(const std::string& path, const std::string& topic, bool& repeated) {
  rosbag::Bag bag;
  open_for_reading(bag, path);
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  Estimates estimates;
  name_in_faults(path, [&] {
    for (const rosbag::MessageInstance& instance : view) {
      const StateEstimate::ConstPtr estimate = instantiate<StateEstimate>(instance);
      if (!estimates.emplace(to_stamp(estimate->header.stamp), estimate).second) repeated = true;
    }
  });
  if (estimates.empty()) throw ReplayError(path + ": no estimates on " + topic);
  return estimates;
}

bool rest_on_same_events(const StateEstimate& a, const StateEstimate& b) {
  return a.events == b.events && a.events_digest == b.events_digest;
}

/// NaN is as good as NaN: there is no bound.
bool is_same_bound(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

bool identical(const StateEstimate& a, const StateEstimate& b) {
  return a.state.size() == b.state.size() && is_same_bound(a.error_bound, b.error_bound) &&
         a.error_bounds == b.error_bounds &&
         std::memcmp(a.state.data(), b.state.data(), a.state.size() * sizeof(double)) == 0;
}

}  // namespace

EstimateComparison compare_estimates(const std::string& first_bag, const std::string& second_bag,
                                     const std::string& topic) {
  EstimateComparison result;
  const Estimates first = read(first_bag, topic, result.repeated_stamps);
  const Estimates second = read(second_bag, topic, result.repeated_stamps);
  result.first = first.size();
  result.second = second.size();
  for (const auto& [stamp, estimate] : first) {
    const auto other = second.find(stamp);
    if (other == second.end()) continue;
    ++result.common;
    if (!rest_on_same_events(*estimate, *other->second)) continue;
    ++result.same_events;
    if (identical(*estimate, *other->second)) ++result.identical;
  }
  return result;
}

}  // namespace sampled_data_observers
