#include "design/rank_tasks.h"

#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>

#include "design/packing.h"

namespace sampled_data_observers {
namespace {

/// How long a rank may wait for an answer while another one computes [s].
constexpr double kAnswerWithin = 5e-3;

/// In place of a task.
constexpr std::int64_t kNoneLeft = -1;

void pause() { std::this_thread::sleep_for(std::chrono::duration<double>(kAnswerWithin / 5.0)); }

std::string packed(std::int64_t number) {
  Packer packer;
  packer.add(number);
  return packer.bytes();
}

/// What ranks send to rank 0: that they want a task, or the outcome of one.
std::string packed(const std::string& request) {
  Packer packer;
  packer.add(request);
  packer.add(kNoneLeft);
  return packer.bytes();
}

std::string packed(const std::string& request, std::size_t task, const WorkerOutcome& outcome) {
  Packer packer;
  packer.add(request);
  packer.add(static_cast<std::int64_t>(task));
  packer.add(static_cast<std::int64_t>(outcome.status));
  packer.add(outcome.result);
  packer.add(outcome.seconds);
  return packer.bytes();
}

/// Rank 0 towards the others.
class Leader {
 public:
  Leader(Ranks& ranks, const std::string& request, const NextTask& next,
         const WorkerOptions& options)
      : ranks_(ranks), request_(request), next_(next), options_(options) {}

  /// Answers what has come.
  void answer() {
    while (const auto message = ranks_.receive()) {
      Unpacker unpacker(message->bytes);
      const std::string request = unpacker.text();
      if (request != request_) {
        throw std::runtime_error("rank " + std::to_string(message->from) +
                                 " was asked for something else, or has other files\n  there: " +
                                 request + "\n  here:  " + request_);
      }
      const std::int64_t task = unpacker.integer();
      if (task == kNoneLeft) {
        give_next(message->from);
      } else {
        take(static_cast<std::size_t>(task), unpacker);
      }
    }
  }

  /// Whether all others know that no task is left, and the outcomes of theirs are here.
  bool is_done() const { return dismissed_ == ranks_.size() - 1 && given_ == 0; }

 private:
  void give_next(int rank) {
    const std::optional<std::size_t> task = next_();
    ++(task ? given_ : dismissed_);
    ranks_.send(rank, packed(task ? static_cast<std::int64_t>(*task) : kNoneLeft));
  }

  void take(std::size_t task, Unpacker& unpacker) {
    WorkerOutcome outcome;
    outcome.status = static_cast<WorkerOutcome::Status>(unpacker.integer());
    outcome.result = unpacker.text();
    outcome.seconds = unpacker.number();
    --given_;
    options_.on_outcome(task, outcome);
  }

  Ranks& ranks_;
  const std::string& request_;
  const NextTask& next_;
  const WorkerOptions& options_;
  int given_ = 0;  ///< tasks whose outcomes are not here
  int dismissed_ = 0;
};

}  // namespace

void lead_tasks(Ranks& ranks, const std::string& request, const NextTask& next,
                const std::function<std::string(std::size_t)>& task, const WorkerOptions& options) {
  Leader leader(ranks, request, next, options);
  const auto is_cancelled = [&] {
    leader.answer();
    return options.is_cancelled && options.is_cancelled();
  };
  WorkerOptions own = options;
  own.is_cancelled = is_cancelled;
  own.patience = kAnswerWithin;
  run_tasks(next, task, own);
  while (!leader.is_done()) {
    if (is_cancelled()) throw Cancelled();
    pause();
  }
}

void follow_tasks(Ranks& ranks, const std::string& request,
                  const std::function<std::string(std::size_t)>& task,
                  const WorkerOptions& options) {
  WorkerOptions own = options;
  own.on_outcome = [&](std::size_t number, const WorkerOutcome& outcome) {
    ranks.send(0, packed(request, number, outcome));
  };
  const auto next = [&]() -> std::optional<std::size_t> {
    ranks.send(0, packed(request));
    for (;; pause()) {
      if (options.is_cancelled && options.is_cancelled()) throw Cancelled();
      const auto message = ranks.receive();
      if (!message) continue;
      const std::int64_t number = Unpacker(message->bytes).integer();
      if (number == kNoneLeft) return std::nullopt;
      return static_cast<std::size_t>(number);
    }
  };
  run_tasks(next, task, own);
}

}  // namespace sampled_data_observers
