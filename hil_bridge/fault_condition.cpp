#include "hil_bridge/fault_condition.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "firmware/protocol/dictionary.h"
#include "hil_bridge/session.h"

namespace hoof::bridge {
namespace {

using Record = const TickRecord&;

struct NamedSignal {
  std::string_view name;
  double (*read)(Record);
};

constexpr std::string_view kMode = "mode";

constexpr NamedSignal kSignals[] = {
    {"time_s", [](Record r) { return r.plant.time_s; }},
    {"tick", [](Record r) { return double(r.firmware.tick); }},
    {kMode, [](Record r) { return double(int(r.firmware.mode)); }},
    {"depth_m", [](Record r) { return r.plant.depth_m; }},
    {"sink_speed_m_s", [](Record r) { return r.plant.sink_speed_m_s; }},
    {"force_x_N", [](Record r) { return r.plant.ground_N.x(); }},
    {"force_z_N", [](Record r) { return r.plant.ground_N.z(); }},
    {"toe_rad", [](Record r) { return double(r.firmware.state[0].position_rad); }},
    {"hip_rad", [](Record r) { return double(r.firmware.state[1].position_rad); }},
    {"knee_rad", [](Record r) { return double(r.firmware.state[2].position_rad); }},
    {"phase_cycles", [](Record r) { return double(r.firmware.phase_cycles); }},
};

double mode_number(const std::string& name) {
  std::string names;
  for (const firmware::protocol::ValueName& mode : firmware::protocol::kModeNames) {
    if (mode.name == name) return double(mode.value);
    names += (names.empty() ? "" : ", ") + std::string(mode.name);
  }
  throw std::invalid_argument("no mode '" + name + "'; there are " + names);
}

double number(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  // Nothing compares with a "nan", which from_chars() takes.
  const bool whole = error == std::errc() && end == text.data() + text.size();
  if (!whole || !std::isfinite(value)) {
    throw std::invalid_argument("'" + text + "' is not a number");
  }
  return value;
}

}  // namespace

FaultCondition::FaultCondition(std::string_view text) : text_(text) {
  std::istringstream words(text_);
  std::string name, value, more;
  if (!(words >> name >> comparison_ >> value) || words >> more) {
    throw std::invalid_argument("must be SIGNAL COMPARISON VALUE, as in depth_m > 0.005");
  }
  for (const NamedSignal& s : kSignals) {
    if (s.name == name) signal_ = s.read;
  }
  if (signal_ == nullptr) {
    throw std::invalid_argument("no signal '" + name + "'; there are " + signal_names());
  }
  constexpr std::string_view kKnown[] = {">", ">=", "<", "<=", "==", "!="};
  bool known = false;
  for (const std::string_view c : kKnown) known = known || comparison_ == c;
  if (!known) {
    throw std::invalid_argument("no comparison '" + comparison_ +
                                "'; there are >, >=, <, <=, ==, !=");
  }
  value_ = name == kMode ? mode_number(value) : number(value);
}

std::string FaultCondition::signal_names() {
  std::string names;
  for (const NamedSignal& s : kSignals) {
    names += (names.empty() ? "" : ", ") + std::string(s.name);
  }
  return names;
}

bool FaultCondition::holds(const TickRecord& record) const {
  const double now = signal_(record);
  if (comparison_ == ">") return now > value_;
  if (comparison_ == ">=") return now >= value_;
  if (comparison_ == "<") return now < value_;
  if (comparison_ == "<=") return now <= value_;
  if (comparison_ == "==") return now == value_;
  return now != value_;
}

}  // namespace hoof::bridge
