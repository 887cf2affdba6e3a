#include "replay/replay.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <map>
#include <thread>
#include <utility>

#include "replay/message_stream.h"
#include "replay/replay_run.h"

namespace sampled_data_observers {
namespace {

using Clock = std::chrono::steady_clock;

/// So many messages are read before the runs are given them: enough for threads to be worth while.
constexpr std::size_t kBlock = 1000;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One of several runs, and what it needs.
struct Run {
  ReplayOptions options;
  const ObserverConfig* config = nullptr;
  std::unique_ptr<ReplayRun> run;
};

/// The runs of one thread. A law is used by one thread at a time, so each has configurations of its
/// own.
struct Worker {
  std::map<std::vector<std::string>, ObserverConfig> configs;
  std::vector<Run*> runs;

  void take(const std::vector<RecordedMessage>& messages) const {
    for (Run* run : runs) {
      for (const RecordedMessage& message : messages) run->run->take(message);
    }
  }
};

void give(const std::vector<RecordedMessage>& messages, const std::vector<Worker>& workers) {
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < workers.size(); ++i) {
    others.push_back(std::async(std::launch::async, [&, i] { workers[i].take(messages); }));
  }
  workers.front().take(messages);
  for (std::future<void>& other : others) other.get();
}

/// What a message is for does not depend on gains.
void require_same_channels(const ObserverConfig& config, const ObserverConfig& first) {
  const std::vector<EventChannel> channels = event_channels(config);
  const std::vector<EventChannel> expected = event_channels(first);
  const auto is_same = [](const EventChannel& a, const EventChannel& b) {
    return a.kind == b.kind && a.name == b.name && a.source.topic == b.source.topic;
  };
  if (!std::equal(channels.begin(), channels.end(), expected.begin(), expected.end(), is_same)) {
    throw ReplayError("expected configurations that take the same events, found others");
  }
}

}  // namespace

ReplaySummary replay(const ObserverConfig& config, const ReplayOptions& options,
                     RunRecord* record) {
  const Clock::time_point start = Clock::now();
  ReplaySummary summary;
  name_in_faults(name_of(options.bags), [&] {
    const MessageStream messages(config, options);
    ReplayRun run(config, options, messages, messages.thinned_stamps(), record);
    messages.read([&](const RecordedMessage& message) { run.take(message); });
    summary = run.finish(messages);
  });
  summary.wall_seconds = seconds_since(start);
  return summary;
}

std::vector<ReplaySummary> replay_all(const std::vector<ReplayCase>& cases,
                                      const ReplayOptions& options, const ConfigLoader& load) {
  const Clock::time_point start = Clock::now();
  const std::size_t threads =
      std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, cases.size());
  std::vector<Worker> workers(threads);
  std::deque<Run> runs;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Worker& worker = workers[i * threads / cases.size()];
    auto known = worker.configs.find(cases[i].config);
    if (known == worker.configs.end()) {
      known = worker.configs.emplace(cases[i].config, load(cases[i].config)).first;
    }
    Run& run = runs.emplace_back();
    run.options = options;
    if (run.options.thinning) run.options.thinning->seed = cases[i].seed;
    run.config = &known->second;
    require_same_channels(*run.config, *runs.front().config);
    worker.runs.push_back(&run);
  }
  std::vector<ReplaySummary> summaries;
  name_in_faults(name_of(options.bags), [&] {
    const MessageStream messages(*runs.front().config, options);
    const MessageStream::SampleStamps stamps = messages.thinned_stamps();
    for (Run& run : runs) {
      run.run = std::make_unique<ReplayRun>(*run.config, run.options, messages, stamps, nullptr);
    }
    // The next messages are read while the runs take the last ones.
    std::vector<RecordedMessage> taken;
    std::vector<RecordedMessage> block;
    std::future<void> pending;
    const auto give_block = [&] {
      if (pending.valid()) pending.get();
      taken.swap(block);
      block.clear();
      pending = std::async(std::launch::async, [&] { give(taken, workers); });
    };
    messages.read([&](RecordedMessage message) {
      block.push_back(std::move(message));
      if (block.size() == kBlock) give_block();
    });
    give_block();
    pending.get();
    for (const Run& run : runs) summaries.push_back(run.run->finish(messages));
  });
  for (ReplaySummary& summary : summaries) summary.wall_seconds = seconds_since(start);
  return summaries;
}

}  // namespace sampled_data_observers
