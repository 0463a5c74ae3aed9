#include "tools/conceal/truth.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/sha256.h"

namespace hoof::tools::conceal {
namespace {

using Json = nlohmann::json;

HiddenEffect effect_of(const Json& json) {
  HiddenEffect effect{json.at("name"), json.at("listed"), {}};
  for (const auto& [name, p] : json.at("parameters").items()) {
    EffectParameter parameter{name, p.at("value"), p.at("unit")};
    parameter.period = p.value("period", 0.0);
    if (p.contains("other_readings")) {
      parameter.other_readings = p.at("other_readings").get<std::vector<double>>();
    }
    effect.parameters.push_back(parameter);
  }
  return effect;
}

TruthCase case_of(const Json& json) {
  TruthCase c;
  c.name = json.at("case");
  c.rig = json.at("rig");
  c.kind = json.at("kind");
  for (const Json& effect : json.at("effects")) c.effects.push_back(effect_of(effect));
  c.alike = json.at("alike").get<std::vector<std::string>>();
  c.effort_snr_db = json.at("effort_snr_db");
  c.masked = json.at("masked");
  c.foreseeable = json.at("foreseeable");
  for (const auto& [channel, change] : json.at("channels").items()) {
    c.channels[channel] = change.at("after_refit");
  }
  c.fit_recordings = json.at("fit_recordings").get<std::vector<std::string>>();
  for (const Json& i : json.at("intervals")) {
    c.intervals.push_back({i.at("recording"), i.at("start"), i.at("end")});
  }
  for (const auto& [key, value] : json.at("holdout_rmse").items()) c.holdout_rmse[key] = value;
  return c;
}

}  // namespace

std::string TruthCase::main_channel() const {
  const auto most = std::max_element(channels.begin(), channels.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  return most == channels.end() ? "" : most->first;
}

std::vector<std::string> TruthCase::clear_channels() const {
  std::vector<std::string> clear;
  for (const auto& [channel, change] : channels) {
    if (change >= 0.8 * channels.at(main_channel())) clear.push_back(channel);
  }
  return clear;
}

std::vector<TruthCase> read_truth(const std::filesystem::path& file,
                                  const std::filesystem::path& sealed_hash) {
  const std::string text = read_file(file);
  const std::string sealed = read_file(sealed_hash).substr(0, 64);
  if (sha256_hex(text) != sealed) {
    throw UserError(file.string() +
                    ": is not the truth that was sealed, its SHA-256 is not that of " +
                    sealed_hash.string());
  }
  try {
    std::vector<TruthCase> cases;
    const Json json = Json::parse(text);
    for (const Json& one : json.at("cases")) cases.push_back(case_of(one));
    return cases;
  } catch (const Json::exception& e) {
    throw UserError(file.string() + ": " + e.what());
  }
}

}  // namespace hoof::tools::conceal
