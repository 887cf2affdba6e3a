#include "certificate/timer_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sampled_data_observers {
namespace {

/// Nodes from `low` to `high` without `low`.
void add_nodes(double low, double high, int cells, std::vector<double>& nodes) {
  for (int i = 1; i < cells; ++i) nodes.push_back(low + (high - low) * i / cells);
  nodes.push_back(high);
}

std::vector<double> even_nodes(const SamplingTimes& times, int cells) {
  std::vector<double> nodes = {0.0};
  int before = 0;
  if (times.T1 > 0.0) {
    before = std::max(1, static_cast<int>(std::lround(cells * times.T1 / times.T2)));
    add_nodes(0.0, times.T1, before, nodes);
  }
  if (times.T2 > times.T1) add_nodes(times.T1, times.T2, std::max(1, cells - before), nodes);
  return nodes;
}

/// A time at the same place between 0, T1 and T2.
double moved(double node, const SamplingTimes& from, const SamplingTimes& to) {
  if (node == 0.0) return 0.0;
  if (node == from.T1) return to.T1;
  if (node == from.T2) return to.T2;
  if (node < from.T1) return node * (to.T1 / from.T1);
  return to.T1 + (node - from.T1) * ((to.T2 - to.T1) / (from.T2 - from.T1));
}

}  // namespace

CertificateSubject with_cells(CertificateSubject subject, int cells) {
  subject.timer_nodes.clear();
  for (const SamplingTimes& times : times_of_timers(subject)) {
    subject.timer_nodes.push_back(even_nodes(times, cells));
  }
  return subject;
}

CertificateSubject with_longest_time(CertificateSubject subject, double T2) {
  const std::vector<SamplingTimes> before = times_of_timers(subject);
  std::vector<SamplingTimes> after = before;
  for (SamplingTimes& times : after) {
    times.T2 = times.T2 == subject.T2 ? T2 : times.T2 * (T2 / subject.T2);
    times.T1 = std::min(times.T1, times.T2);
  }
  if (subject.sensor_times.empty()) {
    subject.T2 = T2;  // T1 > T2 is for who asks to refuse
    after.front().T1 = subject.T1;
  } else {
    set_sensor_times(subject, after);
  }
  for (std::size_t i = 0; i < subject.timer_nodes.size(); ++i) {
    std::vector<double>& nodes = subject.timer_nodes[i];
    for (double& node : nodes) node = moved(node, before[i], after[i]);
    // None is left between T1 and T2 where these are the same.
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return subject;
}

CertificateSubject with_shortest_time(CertificateSubject subject, double T1) {
  const std::vector<SamplingTimes> before = times_of_timers(subject);
  std::vector<SamplingTimes> after = before;
  for (SamplingTimes& times : after) {
    const double whole = subject.T1 > 0.0 ? subject.T1 : subject.T2;
    const double part = times.T1 > 0.0 ? times.T1 : times.T2;
    times.T1 = std::min(part == whole ? T1 : part * (T1 / whole), times.T2);
  }
  if (subject.sensor_times.empty()) {
    subject.T1 = after.front().T1;
  } else {
    set_sensor_times(subject, after);
  }
  for (std::size_t i = 0; i < subject.timer_nodes.size(); ++i) {
    std::vector<double>& nodes = subject.timer_nodes[i];
    for (double& node : nodes) node = moved(node, before[i], after[i]);
    nodes.insert(nodes.end(), {after[i].T1, after[i].T2});
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  }
  return subject;
}

TensorGrid grid_of(const CertificateSubject& subject) {
  return TensorGrid(subject.timer_nodes.empty() ? with_cells(subject).timer_nodes
                                                : subject.timer_nodes);
}

std::vector<std::vector<CellCorner>> cells_of(const TensorGrid& grid) {
  const std::size_t timers = grid.dimensions();
  std::vector<std::vector<CellCorner>> cells;
  for (std::size_t lowest = 0; lowest < grid.size(); ++lowest) {
    bool is_lowest = true;  // of a cell
    for (std::size_t timer = 0; timer < timers; ++timer) {
      is_lowest &= grid.position(lowest, timer) + 1 < grid.nodes(timer).size();
    }
    if (!is_lowest) continue;
    std::vector<CellCorner> corners(std::size_t{1} << timers);
    for (std::size_t bits = 0; bits < corners.size(); ++bits) {
      CellCorner& corner = corners[bits];
      corner.node = lowest;
      for (std::size_t timer = 0; timer < timers; ++timer) {
        if ((bits >> timer & 1U) != 0) corner.node += grid.stride(timer);
      }
      for (std::size_t timer = 0; timer < timers; ++timer) {
        const bool is_upper = (bits >> timer & 1U) != 0;
        CellCorner::Edge edge;
        edge.low = is_upper ? corner.node - grid.stride(timer) : corner.node;
        edge.high = edge.low + grid.stride(timer);
        edge.length = grid.nodes(timer)[grid.position(edge.high, timer)] -
                      grid.nodes(timer)[grid.position(edge.low, timer)];
        corner.edges.push_back(edge);
      }
    }
    cells.push_back(std::move(corners));
  }
  return cells;
}

double weight_rounding(const TensorGrid& grid) {
  double largest = 0.0;
  for (std::size_t timer = 0; timer < grid.dimensions(); ++timer) {
    const std::vector<double>& nodes = grid.nodes(timer);
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      largest = std::max(largest, nodes[i] / (nodes[i] - nodes[i - 1]));
    }
  }
  return 16.0 * std::numeric_limits<double>::epsilon() * largest;
}

}  // namespace sampled_data_observers
