#include "replay/report/report_configuration.h"

#include <yaml-cpp/yaml.h>

#include <cerrno>
#include <fstream>
#include <sstream>

#include "files/output_file.h"

namespace sampled_data_observers {
namespace {

constexpr std::size_t kMostOfFile = 200'000;  // bytes

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw OutputError(path, errno);
  return text.str();
}

void add_certificate(const std::string& text, nlohmann::json& certificate) {
  const YAML::Node section = YAML::Load(text)["certificate"];
  if (!section.IsDefined() || !section.IsMap()) return;
  for (const auto& entry : section) {
    if (!entry.second.IsScalar()) continue;
    certificate.push_back({entry.first.Scalar(), entry.second.Scalar()});
  }
}

}  // namespace

nlohmann::json configuration_of(const ObserverConfig& config,
                                const std::vector<std::string>& files) {
  nlohmann::json certificate = nlohmann::json::array();
  nlohmann::json texts = nlohmann::json::array();
  for (const std::string& path : files) {
    std::string text = text_of(path);
    add_certificate(text, certificate);
    if (text.size() > kMostOfFile) {
      text.resize(kMostOfFile);
      text += "\n... (the rest is left out)\n";
    }
    texts.push_back({{"name", path.substr(path.rfind('/') + 1)}, {"text", text}});
  }
  nlohmann::json warnings = config.warnings;
  if (!config.warning.empty()) warnings.insert(warnings.begin(), config.warning);
  return {{"guarantee", config.guarantee},
          {"certificate", certificate},
          {"warnings", warnings},
          {"files", texts}};
}

}  // namespace sampled_data_observers
