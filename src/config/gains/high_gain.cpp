#include <algorithm>

#include "config/expression_config.h"
#include "config/gains/readers.h"

namespace sampled_data_observers {
namespace {

Saturation read_saturations(ConfigSection& gains, const std::vector<std::string>& states) {
  Saturation saturation(static_cast<Eigen::Index>(states.size()));
  if (!gains.has("saturations")) return saturation;
  ConfigSection section = gains.section("saturations");
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!section.has(states[i])) continue;
    const Eigen::VectorXd bounds = section.vector(states[i], 2);
    if (!(bounds(0) < bounds(1))) {
      throw section.error(states[i], "a lower bound and a higher one", "low >= high");
    }
    saturation.bound(static_cast<Eigen::Index>(i), bounds(0), bounds(1));
  }
  section.finish();
  return saturation;
}

/// T: as many formulas of the states as K has numbers.
std::shared_ptr<const VectorMap> read_T(ConfigSection& gains, const ExpressionNames& names) {
  ExpressionNames of_T = names;
  of_T.u.clear();
  return ExpressionReader(of_T).read_list(gains, "T", 0);
}

bool has_name(const ExpressionNames& names, const std::string& name) {
  const auto is_it = [&](const auto& constant) { return constant.first == name; };
  return std::count(names.x.begin(), names.x.end(), name) > 0 ||
         std::count(names.u.begin(), names.u.end(), name) > 0 ||
         std::any_of(names.constants.begin(), names.constants.end(), is_it);
}

void check_names(ConfigSection& gains, const ExpressionNames& names,
                 const std::vector<std::string>& z) {
  for (const std::string& name : z) {
    if (!has_name(names, name)) continue;
    throw gains.error("form", "a plant whose names leave z1, z2, … to the transformed state",
                      "'" + name + "' among them");
  }
  if (!gains.has("definitions")) return;
  for (const auto& definition : gains.named_texts("definitions")) {
    const std::string& name = definition.first;
    if (!has_name(names, name) && std::count(z.begin(), z.end(), name) == 0) continue;
    throw gains.error("definitions", "names that nothing else has", "'" + name + "'");
  }
}

TransformedHighGainObserver::Maps read_maps(ConfigSection& gains, const LawContext& context) {
  TransformedHighGainObserver::Maps maps;
  maps.T = read_T(gains, context.names);
  ExpressionNames of_z;
  for (Eigen::Index i = 1; i <= maps.T->size(); ++i) of_z.x.push_back("z" + std::to_string(i));
  check_names(gains, context.names, of_z.x);
  of_z.constants = context.names.constants;
  ExpressionNames of_z_and_x = of_z;
  of_z_and_x.x.insert(of_z_and_x.x.end(), context.names.x.begin(), context.names.x.end());
  of_z_and_x.u = context.names.u;

  ExpressionReader theta(of_z);
  theta.read_definitions(gains, "definitions");
  maps.Theta = theta.read_map(gains, "Theta", context.names.x);
  ExpressionReader phi(of_z_and_x);
  phi.read_definitions(gains, "definitions");
  const auto outputs = static_cast<std::size_t>(context.plant().outputs(SensorTiming::kContinuous));
  maps.Phi = outputs > 1 ? phi.read_list(gains, "Phi", outputs) : phi.read_text(gains, "Phi");
  return maps;
}

/// One list for each continuous output, of as many numbers in all as T has formulas.
std::vector<Eigen::VectorXd> read_K(ConfigSection& gains, const Plant& plant, Eigen::Index d) {
  if (plant.outputs(SensorTiming::kContinuous) == 1) return {gains.vector("K", d)};
  std::vector<Eigen::VectorXd> K = gains.vectors("K");
  Eigen::Index numbers = 0;
  for (const Eigen::VectorXd& of_output : K) numbers += of_output.size();
  if (numbers != d) {
    throw gains.error("K", "as many numbers in all as T has formulas, " + std::to_string(d),
                      std::to_string(numbers));
  }
  return K;
}

/// Reads what each mode has, of a switched plant in gains/modes/LABEL, else in `gains` itself.
template <class Read>
void for_each_mode(ConfigSection& gains, const Plant& plant, const Read& read) {
  if (!plant.switches()) {
    read(gains);
    return;
  }
  ConfigSection modes = gains.section("modes");
  for (const PlantMode& mode : plant.modes()) {
    ConfigSection section = modes.section(std::to_string(mode.label));
    read(section);
    section.finish();
  }
  modes.finish();
}

}  // namespace

HighGains read_high_gains(ConfigSection& gains, const LawContext& context) {
  using Form = HighGains::Form;
  const std::string name = gains.choice("form", {"linear", "transformed", "original"});
  const Form form = name == "linear"        ? Form::kLinear
                    : name == "transformed" ? Form::kTransformed
                                            : Form::kOriginal;
  const double ell = gains.number("ell");
  HighGains result{
      form, {read_saturations(gains, context.plant().state_names()), ell, {}}, {}, 0.0};
  for_each_mode(gains, context.plant(), [&](ConfigSection& section) {
    if (form == Form::kLinear) {
      result.settings.K.push_back(section.vectors("K"));
      return;
    }
    TransformedHighGainObserver::Maps& maps = result.maps.emplace_back();
    if (form == Form::kTransformed) {
      maps = read_maps(section, context);
    } else {
      maps.T = read_T(section, context.names);
    }
    result.settings.K.push_back(read_K(section, context.plant(), maps.T->size()));
  });
  if (form == Form::kOriginal && gains.has("damping")) result.damping = gains.number("damping");
  return result;
}

}  // namespace sampled_data_observers
