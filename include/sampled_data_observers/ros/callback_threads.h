#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace sampled_data_observers {

/// A queue of callbacks of one nodelet, and the threads that work on it.
///
/// The queues that a nodelet gets from its manager may go before the nodelet does: where it is
/// unloaded while one of its callbacks ends, that callback's thread destroys it, later than
/// unload() returns. Timers and subscribers then look for their callbacks in a queue that is no
/// more, and a nodelet that is loaded meanwhile finds its topics and services taken. A queue of its
/// own also keeps its neighbours in the manager from occupying its threads.
class CallbackThreads {
 public:
  /// @param threads  how many callbacks may run at a time; they begin with start()
  explicit CallbackThreads(std::uint32_t threads);
  CallbackThreads(const CallbackThreads&) = delete;
  CallbackThreads& operator=(const CallbackThreads&) = delete;
  ~CallbackThreads();

  /// `nodelet`, a handle of the nodelet, with this queue in the place of the manager's. What is
  /// made with it must go before this does.
  ros::NodeHandle handle(const ros::NodeHandle& nodelet);

  /// From now on callbacks run.
  void start();

  /// Waits for the callbacks that run, and drops the others and all that come.
  void stop();

 private:
  ros::CallbackQueue queue_;
  std::atomic<bool> stopping_{false};
  std::vector<std::thread> threads_;
};

}  // namespace sampled_data_observers
