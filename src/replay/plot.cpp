#include "sampled_data_observers/replay/plot.h"

#include <stdio.h>
#include <unistd.h>

#include <climits>
#include <csignal>
#include <nlohmann/json.hpp>

#include "sampled_data_observers/replay/bag_source.h"

namespace sampled_data_observers {
namespace {

std::string folder_of_this_program() {
  char path[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
  if (length <= 0) throw ReplayError("can't find the folder of this program");
  const std::string program(path, static_cast<std::size_t>(length));
  return program.substr(0, program.rfind('/'));
}

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

nlohmann::json to_json(const Series& series) {
  return {{"times", series.times}, {"values", series.values}};
}

}  // namespace

void draw_plot(const ReplaySummary& summary, const std::string& path) {
  nlohmann::json json;
  json["title"] = summary.observer + " on " + summary.bag.substr(summary.bag.rfind('/') + 1) +
                  ": " + std::to_string(summary.samples_used) + " samples used";
  json["sample_times"] = summary.sample_times;
  for (const QuantityPlot& plot : summary.plots) {
    json["quantities"].push_back({{"name", plot.name},
                                  {"truth", to_json(plot.truth)},
                                  {"samples", to_json(plot.samples)},
                                  {"estimate", to_json(plot.estimate)}});
  }
  const std::string text = json.dump();
  std::signal(SIGPIPE, SIG_IGN);
  FILE* pipe = popen((quoted(SDO_PYTHON) + " " + quoted(folder_of_this_program() + "/plot_replay") +
                      " " + quoted(path))
                         .c_str(),
                     "w");
  if (pipe == nullptr) throw ReplayError(path + ": can't start plot_replay");
  const bool written = fwrite(text.data(), 1, text.size(), pipe) == text.size();
  if (pclose(pipe) != 0 || !written) {
    throw ReplayError(path + ": plot_replay failed (see above; it needs python3-matplotlib)");
  }
}

}  // namespace sampled_data_observers
