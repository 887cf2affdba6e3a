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

/// The line that says what was asked for: in words, and a fingerprint of all that matters.
std::string request_line(const SweepRequest& request, const std::string& plant_hash);

/// Where a sweep keeps its results, so that it can go on after an interruption:
///   points.csv   each finished point, as it came; its first line says what was asked for
///   curve.csv    the curves (see best_curves()), in the same order whatever came first
///   gains/       the design of each point as gain file
/// A point is added by one write, after its gain file is complete. What an interruption left of a
/// line is removed when the folder is opened again. Of several lines for a point the last one
/// counts.
class SweepFolder {
 public:
  /// Makes or opens the folder, for this process alone.
  /// @throws SweepFolderError where it holds another request, or is in use.
  /// @throws OutputError where it can't be written, as add() and write_curve().
  SweepFolder(std::string path, const SweepRequest& request, const std::string& plant_hash);
  ~SweepFolder();
  SweepFolder(const SweepFolder&) = delete;
  SweepFolder& operator=(const SweepFolder&) = delete;

  const std::vector<SweepPoint>& points() const { return points_; }
  bool has(const std::string& method, double T2) const;

  /// To have a point tried again, though points.csv has it.
  void forget(const SweepPoint& point);

  /// @param design  null where there is none
  void add(const SweepPoint& point, const Design* design, const GainFileOrigin& origin);

  void write_curve() const;

  /// The gain file of a design, and what else is written, as the folder names it.
  static std::string gain_file(const SweepPoint& design);
  static std::vector<std::string> tables() { return {"points.csv", "curve.csv"}; }

 private:
  void read_points(const std::string& header);
  void append(const std::string& lines);
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
