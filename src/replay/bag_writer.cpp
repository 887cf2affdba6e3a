#include "replay/bag_writer.h"

#include "replay/bag_source.h"

namespace sampled_data_observers {

BagWriter::BagWriter(const std::string& path) : path_(path), file_(path), bag_(new rosbag::Bag()) {
  attempt([&] { bag_->open(file_.path(), rosbag::bagmode::Write); });
}

void BagWriter::finish() {
  attempt([&] { bag_->close(); });
  file_.finish();
}

void BagWriter::fail(const std::exception& fault, int cause) const {
  if (cause != 0) throw OutputError(path_, cause);
  throw ReplayError(path_ + ": can't be written: " + fault.what());
}

}  // namespace sampled_data_observers
