#pragma once

#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <vector>

namespace sampled_data_observers {

/// Messages to publish by pointer without an allocation each: one is used again when no subscriber
/// holds it any more. When all are held, a new one is made, which is not used again.
template <class M>
class MessagePool {
 public:
  /// @param prototype  what every message of the pool starts as
  /// @param size       how many are kept, all made now
  MessagePool(const M& prototype, std::size_t size) : prototype_(prototype) {
    for (std::size_t i = 0; i < size; ++i) messages_.push_back(boost::make_shared<M>(prototype_));
  }

  /// A message that nobody else holds.
  boost::shared_ptr<M> take() {
    for (std::size_t i = 0; i < messages_.size(); ++i) {
      next_ = (next_ + 1) % messages_.size();
      if (messages_[next_].use_count() == 1) return messages_[next_];
    }
    return boost::make_shared<M>(prototype_);
  }

 private:
  M prototype_;
  std::vector<boost::shared_ptr<M>> messages_;
  std::size_t next_ = 0;
};

}  // namespace sampled_data_observers
