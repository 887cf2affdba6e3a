#include "config/claim_contradiction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "config/number_text.h"
#include "plant/bounded_slope_map.h"
#include "plant/lipschitz_map.h"
#include "plant/polytopic_map.h"

namespace sampled_data_observers {
namespace {

using Vector = Eigen::VectorXd;

/// Of the size of the centre, or 1.
constexpr double kScales[] = {1e-4, 1e-3, 1e-2, 1e-1, 1.0, 1e1, 1e2, 1e3, 1e4};
constexpr int kPairsPerScale = 120;
/// Every other pair is closer by this factor, to see slopes.
constexpr double kNear = 1e-3;
/// What is refuted is off by more than this share.
constexpr double kTolerance = 1e-6;
/// Of formulas and of the points themselves.
constexpr double kRounding = 256.0 * std::numeric_limits<double>::epsilon();
/// More sensors that could be injected than this are not tried in all combinations.
constexpr std::size_t kMostInjections = 6;

const char kEverywhere[] =
    " (it is stated for all of them; where the states stay in a region, write the formula so that "
    "it holds everywhere, such as with min and max)";

std::string in_digits(const Vector& values) {
  std::string text = "[";
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += (i == 0 ? "" : ", ") + number_text(values(i), 9);
  }
  return text + "]";
}

std::string with_input(const Vector& u) { return u.size() == 0 ? "" : ", u = " + in_digits(u); }

/// Two points and an input.
struct Pair {
  Vector a;
  Vector b;
  Vector u;
};

/// Calls `visit` with pairs until it returns true.
template <class Visit>
void visit_pairs(const Vector& centre, Eigen::Index inputs, Visit&& visit) {
  // Its sequence is the standard's; the distributions' would not be.
  std::mt19937_64 engine(1);
  const auto fill = [&engine](Vector values) -> Vector {
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      values(i) = std::ldexp(static_cast<double>(engine() >> 11), -52) - 1.0;  // in [-1, 1)
    }
    return values;
  };
  const double size = std::max(1.0, centre.size() > 0 ? centre.cwiseAbs().maxCoeff() : 0.0);
  Pair pair;
  for (const double scale : kScales) {
    for (int i = 0; i < kPairsPerScale; ++i) {
      pair.a = centre + scale * size * fill(Vector(centre.size()));
      const Vector other = scale * size * fill(Vector(centre.size()));
      pair.b = i % 2 == 0 ? Vector(centre + other) : Vector(pair.a + kNear * other);
      pair.u = scale * fill(Vector(inputs));
      if (visit(pair)) return;
    }
  }
}

Vector value_of(const VectorMap& map, const Vector& x, const Vector& u) {
  Vector out(map.size());
  map.evaluate(x.data(), u.data(), out.data());
  return out;
}

/// @param key   that states the constant
/// @param name  of the map
std::optional<Contradiction> refute_constant(const VectorMap& map, double constant,
                                             const std::string& key, const std::string& name,
                                             const Vector& centre, Eigen::Index inputs) {
  std::optional<Contradiction> found;
  double largest = 0.0;
  visit_pairs(centre, inputs, [&](const Pair& pair) {
    const Vector at_a = value_of(map, pair.a, pair.u);
    const Vector at_b = value_of(map, pair.b, pair.u);
    const double distance = (pair.a - pair.b).norm();
    const double change = (at_a - at_b).norm();
    const double blurred =
        kRounding * (at_a.norm() + at_b.norm() + constant * (pair.a.norm() + pair.b.norm()));
    const bool refutes = change > constant * distance * (1.0 + kTolerance) + blurred;
    if (!std::isfinite(change) || !refutes || change / distance <= largest) return false;
    largest = change / distance;
    found = Contradiction{key,
                          "at least |" + name + "(a) - " + name + "(b)| / |a - b|, which is " +
                              number_text(largest, 9) + " at a = " + in_digits(pair.a) +
                              ", b = " + in_digits(pair.b) + with_input(pair.u) + kEverywhere,
                          number_text(constant, 9)};
    return false;
  });
  return found;
}

/// A vector w for which w·d is larger than all w·corner (one column each) by more than `blurred`
/// per unit of |w|; nothing where none is found. Gilbert's algorithm for the nearest point.
/// @param spread  what may be added to all corners: spread φ with |φ| <= 1
std::optional<Vector> separating_direction(const Eigen::MatrixXd& corners, const Vector& d,
                                           double blurred,
                                           const Eigen::MatrixXd& spread = Eigen::MatrixXd()) {
  Vector nearest = corners.rowwise().mean();
  for (int step = 0; step < 60; ++step) {
    const Vector w = d - nearest;
    if (w.norm() <= blurred) return std::nullopt;
    Eigen::Index corner = 0;
    double support = (corners.transpose() * w).maxCoeff(&corner);
    Vector farthest = corners.col(corner);
    if (spread.cols() > 0) {
      const Vector along = spread.transpose() * w;
      support += along.norm();
      if (along.norm() > 0.0) farthest += spread * along.normalized();
    }
    if (w.dot(d) - support > blurred * w.norm()) return w;
    const Vector towards = farthest - nearest;
    const double length = towards.squaredNorm();
    if (length == 0.0) return std::nullopt;
    nearest += std::clamp(w.dot(towards) / length, 0.0, 1.0) * towards;
  }
  return std::nullopt;
}

std::optional<Contradiction> refute_vertices(const LipschitzDescription& map, const Vector& centre,
                                             Eigen::Index inputs) {
  std::optional<Contradiction> found;
  visit_pairs(centre, inputs, [&](const Pair& pair) {
    const Vector error = pair.a - pair.b;
    const Vector psi_a = value_of(*map.psi, map.S * pair.a, pair.u);
    const Vector psi_b = value_of(*map.psi, map.S * pair.b, pair.u);
    const Vector d = map.G * (psi_a - psi_b);
    if (!d.allFinite()) return false;
    Eigen::MatrixXd corners(d.size(), static_cast<Eigen::Index>(map.vertices.size()));
    double slope = 0.0;
    for (std::size_t i = 0; i < map.vertices.size(); ++i) {
      corners.col(static_cast<Eigen::Index>(i)) = map.vertices[i] * error;
      slope = std::max(slope, map.vertices[i].norm());
    }
    const double blurred = kTolerance * (slope * error.norm()) +
                           kRounding * (map.G.norm() * (psi_a.norm() + psi_b.norm()) +
                                        slope * (pair.a.norm() + pair.b.norm()));
    if (!separating_direction(corners, d, blurred)) return false;
    found =
        Contradiction{"vertices",
                      "matrices Psi_i with G (psi(S x) - psi(S x^)) = " + in_digits(d) +
                          " in the convex hull of all Psi_i (x - x^), at x = " + in_digits(pair.a) +
                          ", x^ = " + in_digits(pair.b) + with_input(pair.u) + kEverywhere,
                      std::to_string(map.vertices.size()) + " whose hull lacks it"};
    return true;
  });
  return found;
}

std::optional<Contradiction> refute_flow_vertices(const PolytopicMap& map, const Vector& centre,
                                                  Eigen::Index inputs) {
  const PolytopicDescription& description = map.description();
  std::optional<Contradiction> found;
  visit_pairs(centre, inputs, [&](const Pair& pair) {
    const Vector error = pair.a - pair.b;
    const Vector f_a = value_of(map, pair.a, pair.u);
    const Vector f_b = value_of(map, pair.b, pair.u);
    const Vector d = f_a - f_b;
    if (!d.allFinite()) return false;
    Eigen::MatrixXd corners(d.size(), static_cast<Eigen::Index>(description.vertices.size()));
    double slope = 0.0;
    for (std::size_t i = 0; i < description.vertices.size(); ++i) {
      corners.col(static_cast<Eigen::Index>(i)) = description.vertices[i] * error;
      slope = std::max(slope, description.vertices[i].norm());
    }
    const double blurred =
        kTolerance * (slope * error.norm()) +
        kRounding * (f_a.norm() + f_b.norm() + slope * (pair.a.norm() + pair.b.norm()));
    const Eigen::MatrixXd spread =
        description.lipschitz_constant * (description.S * error).norm() * description.G;
    if (!separating_direction(corners, d, blurred, spread)) return false;
    found = Contradiction{
        "jacobian_vertices",
        "matrices A_i with f(x) - f(x^) = " + in_digits(d) +
            " in the convex hull of all A_i (x - x^)" +
            (spread.cols() > 0 ? ", but for what G and lipschitz_constant allow," : "") +
            " at x = " + in_digits(pair.a) + ", x^ = " + in_digits(pair.b) + with_input(pair.u) +
            kEverywhere,
        std::to_string(description.vertices.size()) + " whose hull lacks it"};
    return true;
  });
  return found;
}

/// x̂ with the states that an observer takes from outputs of x.
Vector injected(const Plant& plant, const std::vector<OutputInjection>& injections,
                const Pair& pair) {
  Vector result = pair.b;
  for (const OutputInjection& injection : injections) {
    const VectorMap& output = *plant.modes().front().outputs[injection.sensor];
    result(injection.state) = value_of(output, pair.a, pair.u)(0);
  }
  return result;
}

/// `text` is the map in words, with what it is taken at.
std::optional<Contradiction> refute_map(const Plant& plant, const VectorMap* map,
                                        const std::string& key, const Eigen::MatrixXd& stated,
                                        const std::vector<OutputInjection>& injections,
                                        const Vector& centre) {
  std::optional<Contradiction> found;
  const std::string letter = key == "A" ? "f" : "g";
  visit_pairs(centre, plant.inputs(), [&](const Pair& pair) {
    const Vector other = injected(plant, injections, pair);
    // A plant without jump map stays where it is.
    const Vector at_x = map != nullptr ? value_of(*map, pair.a, pair.u) : pair.a;
    const Vector at_other = map != nullptr ? value_of(*map, other, pair.u) : other;
    const Vector error = pair.a - pair.b;
    const Vector off = at_x - at_other - stated * error;
    const Vector size =
        at_x.cwiseAbs() + at_other.cwiseAbs() + stated.cwiseAbs() * error.cwiseAbs();
    const bool refutes = ((off.cwiseAbs() - kTolerance * size).array() > 0.0).any();
    if (!off.allFinite() || !refutes) return false;
    found = Contradiction{key,
                          "the map of the error: " + letter + "(x) - " + letter + "(x^) = " +
                              in_digits(Vector(at_x - at_other)) + " at x = " + in_digits(pair.a) +
                              ", x^ = " + in_digits(pair.b) + with_input(pair.u) +
                              (injections.empty() || key == "A_d"
                                   ? ""
                                   : ", with output_injection: " + in_words(plant, injections)),
                          key + " (x - x^) = " + in_digits(Vector(stated * error))};
    return true;
  });
  return found;
}

}  // namespace

std::optional<Contradiction> refute_jump_constant(const Plant& plant, const Vector& centre) {
  const auto* map = dynamic_cast<const BoundedSlopeMap*>(plant.modes().front().jump.get());
  if (map == nullptr) return std::nullopt;
  return refute_constant(*map, map->constant(), "jump_map/lipschitz_constant", "g", centre,
                         plant.inputs());
}

std::optional<Contradiction> refute_lipschitz_claims(const Plant& plant, const Vector& centre) {
  const VectorMap* flow = plant.modes().front().flow.get();
  if (const auto* polytopic = dynamic_cast<const PolytopicMap*>(flow)) {
    return refute_flow_vertices(*polytopic, centre, plant.inputs());
  }
  const auto* map = dynamic_cast<const LipschitzMap*>(flow);
  if (map == nullptr) return std::nullopt;
  const LipschitzDescription& description = map->description();
  std::optional<Contradiction> found;
  if (description.lipschitz_constant) {
    found = refute_constant(*description.psi, *description.lipschitz_constant, "lipschitz_constant",
                            "psi", description.S * centre, plant.inputs());
  }
  if (!found && !description.vertices.empty()) {
    found = refute_vertices(description, centre, plant.inputs());
  }
  return found;
}

std::optional<Contradiction> refute_error_maps(const Plant& plant, const StatedErrorMaps& stated,
                                               const std::vector<OutputInjection>& injections,
                                               const Vector& centre) {
  const PlantMode& mode = plant.modes().front();
  std::optional<Contradiction> found;
  if (stated.A) found = refute_map(plant, mode.flow.get(), "A", *stated.A, injections, centre);
  if (!found && stated.A_d) {
    found = refute_map(plant, mode.jump.get(), "A_d", *stated.A_d, {}, centre);
  }
  return found;
}

std::optional<Contradiction> refute_injection_constants(const Plant& plant,
                                                        const OutputInjection& injection,
                                                        const Vector& constants,
                                                        const Vector& centre) {
  const VectorMap& flow = *plant.modes().front().flow;
  std::optional<Contradiction> found;
  double worst = 1.0;
  visit_pairs(centre, plant.inputs(), [&](const Pair& pair) {
    Vector other = pair.a;
    other(injection.state) = pair.b(injection.state);
    const double distance = std::abs(pair.a(injection.state) - other(injection.state));
    const Vector at_a = value_of(flow, pair.a, pair.u);
    const Vector at_other = value_of(flow, other, pair.u);
    for (Eigen::Index i = 0; i < constants.size(); ++i) {
      const double change = std::abs(at_a(i) - at_other(i));
      const double allowed =
          constants(i) * distance * (1.0 + kTolerance) +
          kRounding * (at_a.norm() + at_other.norm() + pair.a.norm() + other.norm());
      if (!std::isfinite(change) || !(change > worst * allowed)) continue;
      worst = change / allowed;
      const std::string& name = plant.state_names()[static_cast<std::size_t>(i)];
      found = Contradiction{
          "injection_lipschitz",
          "for " + name + " at least what the injected output makes of its derivative, which is " +
              number_text(change / distance, 9) + " per unit between " + in_digits(pair.a) +
              " and " + in_digits(other) + with_input(pair.u) + kEverywhere,
          number_text(constants(i), 9)};
    }
    return false;
  });
  return found;
}

std::optional<std::vector<OutputInjection>> injections_that_explain(const Plant& plant,
                                                                    const StatedErrorMaps& stated,
                                                                    const Vector& centre) {
  // Each state from each sensor that an output_injection may name.
  std::vector<OutputInjection> all;
  for (std::size_t i = 0; i < plant.sensors().size(); ++i) {
    const Sensor& sensor = plant.sensors()[i];
    if (sensor.timing != SensorTiming::kContinuous || sensor.outputs() != 1) continue;
    const AffineMap* output = plant.modes().front().outputs[i]->affine();
    for (Eigen::Index state = 0; output != nullptr && state < plant.states(); ++state) {
      if (output->M()(0, state) != 0.0) all.push_back({state, i});
    }
  }
  if (all.size() > kMostInjections) all.resize(kMostInjections);
  for (std::size_t chosen = 0; chosen < std::size_t{1} << all.size(); ++chosen) {
    std::vector<OutputInjection> injections;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if ((chosen >> i & 1U) != 0) injections.push_back(all[i]);
    }
    if (!refute_error_maps(plant, stated, injections, centre)) return injections;
  }
  return std::nullopt;
}

std::string in_words(const Plant& plant, const std::vector<OutputInjection>& injections) {
  std::string text = "{";
  for (const OutputInjection& injection : injections) {
    text += (text.size() > 1 ? ", " : "") +
            plant.state_names()[static_cast<std::size_t>(injection.state)] + ": " +
            plant.sensors()[injection.sensor].name;
  }
  return text + "}";
}

void require_no_contradiction(const Plant& plant, const StatedErrorMaps& stated,
                              ConfigSection& plant_section, ConfigSection& stated_section) {
  const Vector centre = Vector::Zero(plant.states());
  if (const auto found = refute_jump_constant(plant, centre)) {
    throw plant_section.error(found->key, found->expected, found->found);
  }
  if (!stated.A) {
    if (const auto found = refute_lipschitz_claims(plant, centre)) {
      throw plant_section.error(found->key, found->expected, found->found);
    }
  }
  if (stated.is_empty() || injections_that_explain(plant, stated, centre)) return;
  const auto found = refute_error_maps(plant, stated, {}, centre);
  throw stated_section.error(found->key, found->expected + ", and no output injection makes it so",
                             found->found);
}

}  // namespace sampled_data_observers
