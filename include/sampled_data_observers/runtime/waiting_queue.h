#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "sampled_data_observers/hybrid/time.h"

namespace sampled_data_observers {

/// Items that wait until they can be used, each for a bounded time after its arrival. Which of them
/// are used is a function of the times of arrival and of when they became usable, not of how often
/// the queue is gone through in between. Allocates nothing after construction.
template <class Item>
class WaitingQueue {
 public:
  /// @pre timeout >= 0
  WaitingQueue(std::size_t capacity, Duration timeout) : capacity_(capacity), timeout_(timeout) {
    entries_.reserve(capacity);
  }

  /// Takes in an item that arrived at `now`. Returns false when it is full, or nothing may wait.
  bool push(Item item, Stamp now) {
    if (entries_.size() == capacity_ || timeout_ == 0) return false;
    entries_.push_back({std::move(item), now});
    return true;
  }

  /// Calls `use` for each item, in the order of arrival, and forgets those for which it returns
  /// true; where an item has waited longer than the timeout, calls `drop` instead. To be called
  /// whenever items may have become usable, and now and then to get rid of others.
  template <class Use, class Drop>
  void go_through(Stamp now, Use&& use, Drop&& drop) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      if (now - entries_[i].arrival > timeout_) {
        drop(entries_[i].item);
      } else if (!use(entries_[i].item)) {
        if (kept != i) entries_[kept] = std::move(entries_[i]);
        ++kept;
      }
    }
    entries_.resize(kept);
  }

  /// Calls `drop` for all items and forgets them.
  template <class Drop>
  void drop_all(Drop&& drop) {
    for (Entry& entry : entries_) drop(entry.item);
    entries_.clear();
  }

  /// Whether nothing waits.
  bool empty() const { return entries_.empty(); }

 private:
  struct Entry {
    Item item;
    Stamp arrival = 0;
  };

  std::size_t capacity_;
  Duration timeout_;
  std::vector<Entry> entries_;
};

}  // namespace sampled_data_observers
