#pragma once

#include <functional>
#include <string>
#include <vector>

#include "design/gain_file.h"
#include "design/sweep.h"

namespace sampled_data_observers {

/// A folder that can't take a sweep, with what to do.
class SweepFolderError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Where a sweep keeps its results, so that it can go on after an interruption:
///   points.csv   each finished point, as it came; its first line says what was asked for
///   curve.csv    the curves (see best_curves()), in the same order whatever came first
///   gains/       the design of each point as gain file
/// A point is added by one write, after its gain file is complete. What an interruption left of a
/// line is removed when the folder is opened again.
class SweepFolder {
 public:
  /// Makes or opens the folder, for this process alone.
  /// @throws SweepFolderError where it holds another request, is in use or can't be written.
  SweepFolder(std::string path, const SweepRequest& request, const std::string& plant_hash);
  ~SweepFolder();
  SweepFolder(const SweepFolder&) = delete;
  SweepFolder& operator=(const SweepFolder&) = delete;

  const std::vector<SweepPoint>& points() const { return points_; }
  bool has(const std::string& method, double T2) const;

  /// @param design  null where there is none
  void add(const SweepPoint& point, const Design* design, const GainFileOrigin& origin);

  void write_curve() const;

  /// The gain file of a design, as the folder names it.
  static std::string gain_file(const SweepPoint& design);

 private:
  void read_points(const std::string& header);
  std::vector<std::string> columns() const;
  std::vector<std::string> fields_of(const SweepPoint& point) const;
  void write_whole(const std::string& name, const std::string& text) const;

  std::string path_;
  Objective objective_;
  /// Of all methods.
  std::vector<std::string> parameters_;
  std::vector<SweepPoint> points_;
  int file_ = -1;
};

}  // namespace sampled_data_observers
