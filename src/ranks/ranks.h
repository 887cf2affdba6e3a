#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace sampled_data_observers {

/// The processes that one `mpirun` started for a command, on one host or many: each has a number,
/// its rank, and they send each other bytes. To be used by one thread. A process that ends before
/// finish() ends all of them, as an error of MPI does.
class Ranks {
 public:
  struct Message {
    int from = 0;  ///< rank
    std::string bytes;
  };

  virtual ~Ranks() = default;

  virtual int rank() const = 0;
  virtual int size() const = 0;
  virtual std::string host() const = 0;

  /// May wait until it is received.
  virtual void send(int to, const std::string& bytes) = 0;
  /// The next message, if one has come; those of one rank come in the order sent.
  virtual std::optional<Message> receive() = 0;

  /// To be called once by each rank, which sends and receives no more: waits for all others.
  virtual void finish() = 0;
};

/// The ranks of this command; null where nobody else was started with it.
/// @throws std::runtime_error  where mpirun started several, but MPI is missing here or another one
Ranks* command_ranks();

/// On rank 0 what each rank has, in their order, elsewhere nothing. No other messages may be under
/// way.
std::vector<std::string> gathered(Ranks& ranks, const std::string& own);

/// Of `count` things those of this rank, from the first on to before the second: all without ranks.
std::pair<std::size_t, std::size_t> share_of(const Ranks* ranks, std::size_t count);

/// Does work, and says in the message of what it throws on which rank that was, but for rank 0.
void name_rank_in_faults(const Ranks* ranks, const std::function<void()>& work);

}  // namespace sampled_data_observers
