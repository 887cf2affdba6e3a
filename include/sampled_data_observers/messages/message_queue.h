#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "sampled_data_observers/messages/message_source.h"

namespace sampled_data_observers {

/// Messages of several channels between the threads that receive and the one that uses them, in
/// the order of their arrival. It never waits for the latter: of a channel that has too many, the
/// oldest is dropped, and handed over as such. Allocates nothing after construction.
class MessageQueue {
 public:
  /// A message that waits.
  struct Message {
    std::size_t channel = 0;  ///< its number
    MessagePointer message;   ///< of the type that the channel's source has
    Stamp receipt = 0;        ///< when it came; 0 before a simulated clock begins
    Stamp stamp = 0;          ///< of the event that it would be
  };

  /// Messages of a channel that were dropped; in general one.
  struct Drop {
    std::size_t channel = 0;  ///< its number
    Stamp first = 0;          ///< the earliest of the stamps; 0 where none has one
    Stamp last = 0;           ///< the latest of them
    std::uint64_t count = 0;  ///< how many there are
  };

  /// What is to be done next.
  struct Next {
    std::optional<Drop> drop;        ///< to be answered
    std::optional<Message> message;  ///< to be used
    /// Whether take() is to be called again; otherwise push() will ask for it.
    bool more = false;
  };

  /// @param channels  how many there are
  /// @param capacity  messages kept for each of them, > 0, and as many drops
  MessageQueue(std::size_t channels, std::size_t capacity);

  /// Takes in a message; for any thread. Returns whether take() is to be called, and nobody was
  /// asked to yet.
  bool push(const Message& message);

  /// The next message and the next drop, where there are such; for one thread.
  Next take();

  /// For who was asked to call take() and can't: the next push() asks again.
  void suspend();

 private:
  /// Of fixed capacity, the oldest first.
  template <class Item>
  class Ring {
   public:
    explicit Ring(std::size_t capacity) : items_(capacity) {}
    bool empty() const { return size_ == 0; }
    bool full() const { return size_ == items_.size(); }
    Item& front() { return items_[first_]; }
    Item& back() { return items_[(first_ + size_ - 1) % items_.size()]; }
    void push(Item item) { items_[(first_ + size_++) % items_.size()] = std::move(item); }
    Item pop() {
      Item item = std::exchange(items_[first_], Item());
      first_ = (first_ + 1) % items_.size();
      --size_;
      return item;
    }

   private:
    std::vector<Item> items_;
    std::size_t first_ = 0;
    std::size_t size_ = 0;
  };

  struct Waiting {
    Message message;
    std::uint64_t number = 0;  ///< of its arrival
  };

  struct Channel {
    explicit Channel(std::size_t capacity) : waiting(capacity), drops(capacity) {}
    Ring<Waiting> waiting;
    Ring<Drop> drops;
  };

  void note_drop(const Message& message);

  std::mutex mutex_;
  std::vector<Channel> channels_;
  std::uint64_t arrived_ = 0;
  std::size_t left_ = 0;  ///< messages and drops in all rings
  bool is_asked_ = false;
};

}  // namespace sampled_data_observers
