#include "sampled_data_observers/ros/observer_services.h"

#include <boost/function.hpp>
#include <thread>
#include <utility>

#include "messages/runtime_messages.h"
#include "messages/time_conversion.h"
#include "ros/paced_steps.h"
#include "sampled_data_observers/runtime/no_clock.h"

namespace sampled_data_observers {

ObserverServices::ObserverServices(const ros::NodeHandle& control, const ros::NodeHandle& queries,
                                   SharedRuntime& runtime, GainReloader& gains, NodeLog log)
    : runtime_(runtime), gains_(gains), log_(std::move(log)) {
  advertise(control, control_pace_, "reset", &ObserverServices::reset);
  advertise(queries, query_pace_, "get_estimate", &ObserverServices::get_estimate);
  advertise(queries, query_pace_, "reload_gains", &ObserverServices::reload_gains);
  advertise(control, control_pace_, "set_enabled", &ObserverServices::set_enabled);
  advertise(control, control_pace_, "enable_sensor", &ObserverServices::enable_sensor);
}

template <typename Request, typename Response>
void ObserverServices::advertise(ros::NodeHandle handle, CallPace& pace, const char* service,
                                 bool (ObserverServices::*serve)(Request&, Response&)) {
  const boost::function<bool(Request&, Response&)> paced =
      [this, &pace, serve](Request& request, Response& response) {
        std::this_thread::sleep_until(pace.turn(CallPace::Clock::now()));
        return (this->*serve)(request, response);
      };
  servers_.push_back(handle.advertiseService(service, paced));
}

std::vector<std::string> ObserverServices::names() const {
  std::vector<std::string> names;
  for (const ros::ServiceServer& server : servers_) names.push_back(server.getService());
  return names;
}

bool ObserverServices::reset(Reset::Request& request, Reset::Response& response) {
  runtime_.approach_present();
  const SharedRuntime::Access access = runtime_.access();
  if (access.now() == 0) {
    response.message = std::string("there is no time yet: ") + kNoClock;
  } else if (request.at_next_sample == 0) {
    response.message = access->restart(access.now(), request.state);
  } else if (request.state.empty()) {
    response.message = access->restart_at_next_sample(access.now());
  } else {
    response.message = "expected no state with at_next_sample, found one";
  }
  response.success = response.message.empty() ? 1 : 0;
  return true;
}

bool ObserverServices::get_estimate(GetEstimate::Request& request,
                                    GetEstimate::Response& response) {
  const OneAtATime::Turn turn = queries_.enter();
  if (turn.owns_lock()) {
    response.message = compute_estimate(request.stamp, response.estimate);
  } else {
    response.message = "busy: the estimate of another call is being computed";
  }
  response.success = response.message.empty() ? 1 : 0;
  return true;
}

/// Returns why there is none, or an empty text.
std::string ObserverServices::compute_estimate(const ros::Time& at, StateEstimate& message) {
  std::string frame_id;
  EstimateQuery query;  // outlives each use of the runtime: it may be the last one with its law
  {
    const SharedRuntime::Access access = runtime_.access();
    if (access.now() == 0) return std::string("there is no time yet: ") + kNoClock;
    const Stamp stamp = at.isZero() ? access.now() : to_stamp(at);
    const char* objection = access->begin_query(stamp, access.now(), query);
    if (objection != nullptr) return objection;
    frame_id = access->setup().frame_id;
  }
  for (PacedSteps pace(SharedRuntime::kSteps); !is_stopping_; pace.rest()) {
    const SharedRuntime::Access access = runtime_.access();
    pace.begin();
    if (query.proceed(pace.steps())) break;
    pace.end();
  }
  if (is_stopping_) return "the observer is being stopped";
  write(query, frame_id, message);
  return "";
}

bool ObserverServices::reload_gains(ReloadGains::Request& request,
                                    ReloadGains::Response& response) {
  try {
    response.message = gains_.reload(request.file);
    response.success = 1;
    log_.info("gains of '%s' loaded: %s", request.file.c_str(), response.message.c_str());
  } catch (const GainReloader::Busy& busy) {  // nothing for the log: it says whom to ask again
    response.message = busy.what();
  } catch (const std::exception& fault) {
    response.message = fault.what();
    log_.warn("gains of '%s' not loaded: %s", request.file.c_str(), fault.what());
  }
  return true;
}

bool ObserverServices::set_enabled(std_srvs::SetBool::Request& request,
                                   std_srvs::SetBool::Response& response) {
  runtime_.approach_present();
  {
    const SharedRuntime::Access access = runtime_.access();
    access->set_enabled(request.data != 0, access.now());
  }
  log_.info("switched %s", request.data != 0 ? "on" : "off");
  response.success = 1;
  return true;
}

bool ObserverServices::enable_sensor(EnableSensor::Request& request,
                                     EnableSensor::Response& response) {
  response.message = runtime_.access()->enable_sensor(request.name, request.enabled != 0);
  response.success = response.message.empty() ? 1 : 0;
  if (response.message.empty()) {
    log_.info("sensor %s switched %s", request.name.c_str(), request.enabled != 0 ? "on" : "off");
  }
  return true;
}

}  // namespace sampled_data_observers
