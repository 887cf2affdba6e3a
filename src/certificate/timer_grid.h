#pragma once

#include <vector>

#include "certificate/certificate.h"
#include "linear_algebra/tensor_grid.h"

namespace sampled_data_observers {

/// Cells of each timer where nobody says how many.
constexpr int kDefaultCells = 8;

/// A subject with timer_nodes that divide the times of each timer evenly on either side of its
/// shortest time, into so many cells in all, or one more.
/// @pre all times are finite
CertificateSubject with_cells(CertificateSubject subject, int cells = kDefaultCells);

/// The same with new times, where the nodes keep their places between 0, the shortest and the
/// longest time. Without nodes, only T2 changes, and the longest times of sensors in proportion.
CertificateSubject with_longest_time(CertificateSubject subject, double T2);

/// The same with another shortest time, up to T2; those of several timers change by the same
/// factor, or where they are 0 are that part of T2, and are at most their T2.
CertificateSubject with_shortest_time(CertificateSubject subject, double T1);

/// The grid of the timers of a subject: its timer_nodes, or those of with_cells().
TensorGrid grid_of(const CertificateSubject& subject);

/// A corner of a cell of a grid.
struct CellCorner {
  std::size_t node = 0;
  /// For each timer the lower and the upper end of the cell's edge along it through this corner.
  struct Edge {
    std::size_t low = 0;
    std::size_t high = 0;
    double length = 0.0;  ///< [s], rounded
  };
  std::vector<Edge> edges;
};

/// The corners of all cells, cell by cell.
std::vector<std::vector<CellCorner>> cells_of(const TensorGrid& grid);

/// How far weights between nodes may be off by rounding: those of a cell that is narrow beside its
/// time the most.
double weight_rounding(const TensorGrid& grid);

}  // namespace sampled_data_observers
