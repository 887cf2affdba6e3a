#include "config/gains/readers.h"
#include "config/number_text.h"
#include "config/size_limits.h"

namespace sampled_data_observers {
namespace {

constexpr char kNodes[] =
    "a list of two times [s] or more, 0 first, each greater than the one before";

/// The nodes of one sensor's time.
std::vector<double> read_nodes(ConfigSection& timers, const std::string& sensor) {
  const Eigen::VectorXd times = timers.vectors(sensor).front();
  if (timers.is_matrix(sensor)) throw timers.error(sensor, kNodes, "a list of lists");
  std::string found;
  std::vector<double> nodes;
  bool increase = true;
  for (Eigen::Index i = 0; i < times.size(); ++i) {
    found += (i == 0 ? "" : ", ") + number_text(times(i));
    increase = increase && (i == 0 ? times(i) == 0.0 : times(i) > nodes.back());
    nodes.push_back(times(i));
  }
  if (nodes.size() < 2 || !increase) throw timers.error(sensor, kNodes, "[" + found + "]");
  return nodes;
}

/// One matrix per node of the grid, below its number.
/// @param instead  other matrices: where one has a node, none is read of it
std::vector<Eigen::MatrixXd> read_at_nodes(ConfigSection& section, const std::string& key,
                                           std::size_t nodes, Eigen::Index rows, Eigen::Index cols,
                                           const std::vector<Eigen::MatrixXd>& instead = {}) {
  ConfigSection of_nodes = section.section(key);
  std::vector<Eigen::MatrixXd> result;
  for (std::size_t node = 0; node < nodes; ++node) {
    const bool is_given = node >= instead.size() || instead[node].size() == 0;
    result.push_back(is_given ? of_nodes.matrix(std::to_string(node), rows, cols)
                              : Eigen::MatrixXd());
  }
  of_nodes.finish();
  return result;
}

/// What stands for the gains at some of the nodes; empty at others.
std::vector<Eigen::MatrixXd> read_instead(ConfigSection& Z, const Sensor& sensor,
                                          std::size_t nodes) {
  std::vector<Eigen::MatrixXd> result(nodes);
  if (!Z.has(sensor.name)) return result;
  ConfigSection of_nodes = Z.section(sensor.name);
  for (std::size_t node = 0; node < nodes; ++node) {
    const std::string key = std::to_string(node);
    if (!of_nodes.has(key)) continue;
    result[node] = of_nodes.matrix(key, sensor.outputs(), sensor.outputs());
  }
  of_nodes.finish();
  return result;
}

}  // namespace

ScheduledGains read_scheduled_gains(ConfigSection& gains, const LawContext& context) {
  const std::vector<Sensor>& sensors = context.plant().sensors();
  const Eigen::Index n = context.plant().states();
  require_at_most(TensorGrid::kMaxDimensions, sensors.size(), "sensors", gains, "timers");
  ScheduledGains result;
  ConfigSection timers = gains.section("timers");
  std::size_t nodes = 1;
  for (const Sensor& sensor : sensors) {
    result.timers.push_back(read_nodes(timers, sensor.name));
    nodes *= result.timers.back().size();
  }
  timers.finish();
  result.P = read_at_nodes(gains, "P", nodes, n, n);
  ConfigSection Z = gains.section_or_empty("Z");
  for (const Sensor& sensor : sensors) result.Z.push_back(read_instead(Z, sensor, nodes));
  Z.finish();
  ConfigSection K = gains.section("K");
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    result.K.push_back(
        read_at_nodes(K, sensors[i].name, nodes, n, sensors[i].outputs(), result.Z[i]));
  }
  K.finish();
  return result;
}

}  // namespace sampled_data_observers
