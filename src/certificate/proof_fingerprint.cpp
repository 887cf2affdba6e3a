#include "certificate/proof_fingerprint.h"

#include <boost/uuid/name_generator_sha1.hpp>
#include <boost/uuid/uuid_io.hpp>
#include <iomanip>
#include <limits>
#include <locale>
#include <sstream>

namespace sampled_data_observers {
namespace {

/// One way of writing numbers and matrices.
class CanonicalText {
 public:
  CanonicalText() {
    out_.imbue(std::locale::classic());
    out_ << std::setprecision(std::numeric_limits<double>::max_digits10);
  }

  void add(const std::string& name, const Eigen::MatrixXd& value) {
    out_ << name << ' ' << value.rows() << 'x' << value.cols();
    for (Eigen::Index i = 0; i < value.rows(); ++i) {
      for (Eigen::Index j = 0; j < value.cols(); ++j) {
        out_ << ' ' << value(i, j) + 0.0;  // no negative zero
      }
    }
    out_ << '\n';
  }
  void add(const std::string& name, double value) { add(name, scalar_matrix(value)); }

  std::string text() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

}  // namespace

std::string proof_fingerprint(const Certificate& certificate) {
  const PlantMatrices& plant = certificate.subject.plant;
  CanonicalText text;
  text.add(certificate.theorem->name() + " T1", certificate.subject.T1);
  text.add("T2", certificate.subject.T2);
  if (const auto& dwell_time = certificate.subject.dwell_time) {
    text.add("dwell time", dwell_time->tau);
    text.add("N0", dwell_time->N0);
  }
  for (std::size_t i = 0; i < certificate.subject.sensor_times.size(); ++i) {
    const SamplingTimes& times = certificate.subject.sensor_times[i];
    text.add("sensor " + plant.sampled[i].sensor + " T1", times.T1);
    text.add("T2", times.T2);
  }
  for (const std::vector<double>& nodes : certificate.subject.timer_nodes) {
    text.add("timer", Eigen::Map<const Eigen::RowVectorXd>(
                          nodes.data(), static_cast<Eigen::Index>(nodes.size())));
  }
  for (const ModeMatrices& mode : plant.modes) {
    text.add("mode", mode.label);
    text.add("A", mode.A);
    text.add("C", mode.C);
    text.add("C_c", mode.C_c);
    text.add("C_d", mode.C_d);
    if (mode.A_d) text.add("A_d", *mode.A_d);
  }
  text.add("G", plant.G);
  text.add("S", plant.S);
  if (plant.lipschitz_constant) text.add("lipschitz_constant", *plant.lipschitz_constant);
  if (const auto& jump = plant.lipschitz_jump) {
    text.add("jump_map/lipschitz_constant", jump->constant);
    text.add("J", jump->J);
  }
  for (const Eigen::MatrixXd& vertex : plant.vertices) text.add("vertex", vertex);
  for (const Eigen::MatrixXd& vertex : plant.flow_vertices) text.add("flow vertex", vertex);
  text.add("N", plant.N);
  text.add("C_p", plant.C_p);
  for (const auto& [name, value] : certificate.values) text.add("value " + name, value);
  const boost::uuids::name_generator_sha1 generator(boost::uuids::ns::url());
  return to_string(generator(text.text()));
}

}  // namespace sampled_data_observers
