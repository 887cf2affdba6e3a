#include "design/sweep_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>
#include <utility>

#include "files/csv.h"
#include "files/output_file.h"

namespace sampled_data_observers {
namespace {

namespace fs = std::filesystem;

std::string listed(const Eigen::MatrixXd& matrix) {
  std::string text;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) text += shortest_decimal(matrix(i, j)) + ' ';
    text += ';';
  }
  return text;
}

std::vector<std::string> parameters_of(const SweepRequest& request) {
  std::set<std::string> names;
  CertificateSubject subject = request.subject;
  subject.T2 = request.T2.back();
  for (const DesignMethod* method : request.methods) {
    for (const DesignParameter& parameter : method->parameters(subject))
      names.insert(parameter.name);
  }
  // It has a column of its own as what is looked for.
  if (request.objective == Objective::kMinGamma) names.erase("gamma");
  return {names.begin(), names.end()};
}

/// Waits a little for the workers of an interrupted sweep to end: they hold its files open.
bool lock(int file) {
  for (int i = 0; i < 20; ++i) {
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

double number(const std::string& field) {
  std::size_t used = 0;
  const double value = std::stod(field, &used);
  if (used != field.size()) throw std::invalid_argument("not a number: " + field);
  return value;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

std::string request_line(const SweepRequest& request, const std::string& plant_hash) {
  std::ostringstream words;
  words << to_string(request.objective) << " for T1 = " << shortest_decimal(request.subject.T1)
        << " s, T2 = " << shortest_decimal(request.T2.front()) << " ... "
        << shortest_decimal(request.T2.back()) << " s (" << request.T2.size() << " points), by";
  for (const DesignMethod* method : request.methods) words << ' ' << method->name();
  for (const auto& [name, value] : request.given) {
    words << ", " << name << " = " << shortest_decimal(value);
  }
  std::string all = words.str() + plant_hash + listed(request.subject.plant.N) +
                    listed(request.subject.plant.C_p);
  for (const double T2 : request.T2) all += ' ' + shortest_decimal(T2);
  const boost::uuids::name_generator_sha1 generator(boost::uuids::ns::url());
  return "# " + to_string(generator(all)) + ": " + words.str() + ", plant " + plant_hash;
}

SweepFolder::SweepFolder(std::string path, const SweepRequest& request,
                         const std::string& plant_hash)
    : path_(std::move(path)), objective_(request.objective), parameters_(parameters_of(request)) {
  std::error_code fault;
  fs::create_directories(path_ + "/gains", fault);
  if (fault) throw SweepFolderError(path_ + ": can't make this folder: " + fault.message());
  const std::string name = path_ + "/points.csv";
  file_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file_ < 0) throw OutputError(name, errno);
  try {
    if (!lock(file_)) throw SweepFolderError(path_ + ": another sweep is writing to this folder");
    read_points(request_line(request, plant_hash));
  } catch (...) {
    ::close(file_);
    throw;
  }
}

SweepFolder::~SweepFolder() { ::close(file_); }

void SweepFolder::read_points(const std::string& header) {
  const std::string name = path_ + "/points.csv";
  const std::string start = header + '\n' + csv_line(columns()) + '\n';
  const std::string text = text_of(name);
  if (text.size() < start.size() && start.compare(0, text.size(), text) == 0) {
    if (::ftruncate(file_, 0) != 0) throw OutputError(name, errno);
    append(start);
    return;
  }
  if (text.compare(0, start.size(), start) != 0) {
    throw SweepFolderError(path_ + ": holds the results of another request\n  there: " +
                           text.substr(0, text.find('\n')) + "\n  now:   " + header +
                           "\nGive another folder, or remove this one.");
  }
  std::size_t at = start.size();
  for (std::size_t end = text.find('\n', at); end != std::string::npos;
       at = end + 1, end = text.find('\n', at)) {
    try {
      const std::vector<std::string> fields = csv_fields(text.substr(at, end - at));
      SweepPoint point;
      point.method = fields.at(0);
      point.T2 = number(fields.at(1));
      if (!fields.at(2).empty()) point.value = number(fields.at(2));
      for (std::size_t i = 0; i < parameters_.size(); ++i) {
        const std::string& field = fields.at(3 + i);
        if (!field.empty()) point.parameters[parameters_[i]] = number(field);
      }
      point.seconds = number(fields.at(3 + parameters_.size()));
      point.message = fields.at(4 + parameters_.size());
      forget(point);
      points_.push_back(std::move(point));
    } catch (const std::logic_error&) {
      throw SweepFolderError(name + ": not a line of a sweep: '" + text.substr(at, end - at) +
                             "'\nRemove the line to have its point tried again.");
    }
  }
  if (::ftruncate(file_, static_cast<off_t>(at)) != 0) {
    throw OutputError(name, errno);
  }
}

void SweepFolder::append(const std::string& lines) {
  const int fault = write_fully(file_, lines);
  if (fault != 0) throw OutputError(path_ + "/points.csv", fault);
}

std::vector<std::string> SweepFolder::columns() const {
  std::vector<std::string> names = {"method", "T2",
                                    objective_ == Objective::kMinGamma ? "gamma" : "decay_rate"};
  names.insert(names.end(), parameters_.begin(), parameters_.end());
  names.insert(names.end(), {"seconds", "message"});
  return names;
}

std::vector<std::string> SweepFolder::fields_of(const SweepPoint& point) const {
  std::vector<std::string> fields = {point.method, shortest_decimal(point.T2),
                                     point.value ? shortest_decimal(*point.value) : ""};
  for (const std::string& name : parameters_) {
    const auto found = point.parameters.find(name);
    fields.push_back(found == point.parameters.end() ? "" : shortest_decimal(found->second));
  }
  return fields;
}

bool SweepFolder::has(const std::string& method, double T2) const {
  return std::any_of(points_.begin(), points_.end(), [&](const SweepPoint& point) {
    return point.method == method && point.T2 == T2;
  });
}

void SweepFolder::forget(const SweepPoint& point) {
  const auto is_same = [method = point.method, T2 = point.T2](const SweepPoint& other) {
    return other.method == method && other.T2 == T2;
  };
  points_.erase(std::remove_if(points_.begin(), points_.end(), is_same), points_.end());
}

void SweepFolder::add(const SweepPoint& point, const Design* design, const GainFileOrigin& origin) {
  if (design != nullptr) {
    std::ostringstream text;
    write_gain_file(*design, origin, text);
    write_whole(gain_file(point), text.str());
  }
  std::vector<std::string> fields = fields_of(point);
  fields.push_back(shortest_decimal(std::round(1e3 * point.seconds) / 1e3));
  fields.push_back(point.message);
  const std::string line = csv_line(fields) + '\n';
  append(line);
  points_.push_back(point);
}

void SweepFolder::write_curve() const {
  std::vector<std::string> names = columns();
  names.resize(names.size() - 2);
  names.insert(names.end(), {"designed_for_T2", "gains"});
  std::string text = csv_line(names) + '\n';
  for (const CurvePoint& point : best_curves(points_, objective_)) {
    SweepPoint shown = point.design;
    shown.T2 = point.T2;
    std::vector<std::string> fields = fields_of(shown);
    fields.push_back(point.design.value ? shortest_decimal(point.design.T2) : "");
    fields.push_back(point.design.value ? gain_file(point.design) : "");
    text += csv_line(fields) + '\n';
  }
  write_whole("curve.csv", text);
}

std::string SweepFolder::gain_file(const SweepPoint& design) {
  return "gains/" + design.method + "_T2_" + shortest_decimal(design.T2) + ".yaml";
}

void SweepFolder::write_whole(const std::string& name, const std::string& text) const {
  write_output(path_ + '/' + name, text);
}

}  // namespace sampled_data_observers
