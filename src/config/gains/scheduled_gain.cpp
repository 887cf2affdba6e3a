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
std::vector<Eigen::MatrixXd> read_at_nodes(ConfigSection& section, const std::string& key,
                                           std::size_t nodes, Eigen::Index rows,
                                           Eigen::Index cols) {
  ConfigSection of_nodes = section.section(key);
  std::vector<Eigen::MatrixXd> result;
  for (std::size_t node = 0; node < nodes; ++node) {
    result.push_back(of_nodes.matrix(std::to_string(node), rows, cols));
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
  ConfigSection K = gains.section("K");
  for (const Sensor& sensor : sensors) {
    result.K.push_back(read_at_nodes(K, sensor.name, nodes, n, sensor.outputs()));
  }
  K.finish();
  return result;
}

}  // namespace sampled_data_observers
