#pragma once

#include <rosbag/bag.h>

#include <cerrno>
#include <exception>
#include <memory>
#include <string>

#include "files/output_file.h"

namespace sampled_data_observers {

/// A bag as output of a tool, whole or not there.
class BagWriter {
 public:
  /// @throws OutputError where it can't be written, as all that follows.
  explicit BagWriter(const std::string& path);

  /// As rosbag::Bag::write().
  template <class... Arguments>
  void write(const Arguments&... arguments) {
    attempt([&] { bag_->write(arguments...); });
  }

  /// To be called when all is written.
  void finish();

 private:
  /// A bag writes its end when it is destroyed, and ends the program where the disk is full. That
  /// of an unfinished one is of no use: it is left to the end of the process.
  struct LeavesWhatIsOpen {
    void operator()(rosbag::Bag* bag) const {
      if (!bag->isOpen()) delete bag;
    }
  };
  template <class Action>
  void attempt(const Action& action) {
    errno = 0;
    try {
      action();
    } catch (const std::exception& fault) {
      fail(fault, errno);
    }
  }
  [[noreturn]] void fail(const std::exception& fault, int cause) const;

  std::string path_;
  OutputFile file_;
  std::unique_ptr<rosbag::Bag, LeavesWhatIsOpen> bag_;
};

}  // namespace sampled_data_observers
