#include "hil_bridge/fault_spec.h"

#include <algorithm>
#include <stdexcept>

#include "hil_bridge/wires.h"
#include "sim/config/config_error.h"
#include "sim/config/reader.h"

namespace hoof::bridge {
namespace {

using sim::Reader;

constexpr double kLongest_s = 3600;
constexpr sim::Unit kDegreePerSecond{"deg_s", sim::kDegree.numerator, sim::kDegree.denominator};
constexpr sim::Unit kVolt{"V"};

FaultKind read_kind(Reader& section) {
  std::string name;
  section.text("kind", name);
  const auto found = std::find(kFaultKindNames.begin(), kFaultKindNames.end(), name);
  if (found != kFaultKindNames.end()) return FaultKind(found - kFaultKindNames.begin());
  section.fail("kind", "must be one of " + fault_kind_names());
}

void read_start(Reader& section, FaultSpec& fault) {
  const int given = section.has("at_s") + section.has("at_tick") + section.has("when");
  if (given != 1) section.fail("kind", "needs one of at_s, at_tick and when");
  if (section.has("at_s")) section.number("at_s", fault.at_s, sim::kSecond, 0, kLongest_s);
  if (section.has("at_tick")) {
    std::int64_t tick = 0;
    section.integer("at_tick", tick, 0, std::int64_t(kLongest_s * 1000));
    fault.at_s = double(tick) * 1e-3;
  }
  if (!section.has("when")) return;
  std::string text;
  section.text("when", text);
  try {
    fault.when.emplace(text);
  } catch (const std::invalid_argument& error) {
    section.fail("when", error.what());
  }
}

void read_end(Reader& section, FaultSpec& fault) {
  if (section.has("for_s")) {
    double for_s = 0;
    section.number("for_s", for_s, sim::kSecond, 1e-3, kLongest_s);
    fault.for_s = for_s;
  }
  if (!section.has("until_s")) return;
  if (fault.for_s || fault.when) section.fail("until_s", "only with at_s or at_tick, not for_s");
  double until_s = 0;
  section.number("until_s", until_s, sim::kSecond, 1e-3, kLongest_s);
  if (until_s <= fault.at_s) section.fail("until_s", "must lie behind the start");
  fault.for_s = until_s - fault.at_s;
}

hal::ResetCause read_cause(Reader& section) {
  using hal::ResetCause;
  if (!section.has("cause")) return ResetCause::kPowerOn;
  std::string cause;
  section.choice("cause", cause, {"power_on", "pin", "software", "watchdog", "brown_out"});
  if (cause == "pin") return ResetCause::kPin;
  if (cause == "software") return ResetCause::kSoftware;
  if (cause == "watchdog") return ResetCause::kWatchdog;
  return cause == "brown_out" ? ResetCause::kBrownOut : ResetCause::kPowerOn;
}

void read_optional(Reader& section, const char* key, double& value, const sim::Unit& unit,
                   double min, double max) {
  if (section.has(key)) section.number(key, value, unit, min, max);
}

void read_parameters(Reader& section, FaultSpec& f) {
  switch (f.kind) {
    case FaultKind::kDrop:
      return read_optional(section, "probability", f.probability, sim::kUnitless, 1e-6, 1);
    case FaultKind::kDelay:
      return section.number("delay_ms", f.delay_s, sim::kMillisecond, 0.001, 10000);
    case FaultKind::kSyncJitter:
      return section.number("jitter_ms", f.delay_s, sim::kMillisecond, 0.001, 100);
    case FaultKind::kDuplicate:
      if (section.has("copies")) section.integer("copies", f.count, 1, 2);
      return;
    case FaultKind::kCorrupt:
      read_optional(section, "probability", f.probability, sim::kUnitless, 1e-6, 1);
      if (section.has("bits")) section.integer("bits", f.count, 1, 64);
      return;
    case FaultKind::kFlood:
      if (section.has("id")) section.integer("id", f.id, 0, 0x7FF);
      return read_optional(section, "rate_Hz", f.rate_Hz, sim::kHertz, 1, 20000);
    case FaultKind::kNodeRestart:
      f.cause = read_cause(section);
      return;
    case FaultKind::kEncoderJump:
      return section.number("jump_deg", f.amount, sim::kDegree, -3600, 3600);
    case FaultKind::kEncoderOffset:
      return section.number("offset_deg", f.amount, sim::kDegree, -3600, 3600);
    case FaultKind::kEncoderDrift:
      return section.number("drift_deg_s", f.amount, kDegreePerSecond, -3600, 3600);
    case FaultKind::kEncoderNoise:
      return section.number("noise_deg", f.amount, sim::kDegree, 1e-6, 360);
    case FaultKind::kTorqueLoss:
      return read_optional(section, "left_ratio", f.amount, sim::kUnitless, 0, 1);
    case FaultKind::kStall:
      f.amount = 2000;  // beyond any drive here
      return read_optional(section, "friction_Nm", f.amount, sim::kNewtonMetre, 0.001, 1e5);
    case FaultKind::kBrownOut:
      return read_optional(section, "supply_V", f.amount, kVolt, 0.1, 100);
    case FaultKind::kReorder:
    case FaultKind::kBusOff:
    case FaultKind::kNodeSilent:
    case FaultKind::kEncoderStuck:
    case FaultKind::kEstop:
      return;
  }
}

std::string default_target(FaultKind kind) {
  if (kind == FaultKind::kSyncJitter) return "Sync";
  return kind == FaultKind::kBrownOut ? "foot" : "";
}

FaultSpec read_fault(Reader section, const std::string& key, const sim::Settings& settings) {
  FaultSpec fault;
  fault.key = key;
  fault.kind = read_kind(section);
  if (const sim::Entry* kind = settings.find(key + ".kind")) fault.origin = kind->origin;
  fault.target = default_target(fault.kind);
  if (fault.target.empty() || section.has("target")) section.text("target", fault.target);
  read_start(section, fault);
  read_end(section, fault);
  // Without an end a node would not be back: time to start up.
  if (fault.kind == FaultKind::kNodeRestart && !fault.for_s) fault.for_s = 0.05;
  std::int64_t seed = 1;
  if (section.has("seed")) section.integer("seed", seed, 0, std::int64_t(1) << 53);
  fault.seed = std::uint64_t(seed);
  read_parameters(section, fault);
  section.finish();
  return fault;
}

}  // namespace

std::string FaultSpec::name() const {
  return key + " (" + kFaultKindNames[std::size_t(kind)] + " " + target + ")";
}

bool needs_board(const FaultSpec& fault) {
  if (fault.kind == FaultKind::kEstop) return fault.target == "line";
  if (fault.kind == FaultKind::kNodeRestart) return fault.target == kFootNode;
  return fault.kind == FaultKind::kBrownOut;
}

void refuse_without_board(const FaultSpec& fault) {
  throw sim::ConfigError(fault.origin.text() + ": " + fault.name() +
                         ": the firmware of this run is another process or a board, whose button, "
                         "supply and reset are out of reach; leave out --bus");
}

std::string fault_kind_names() {
  std::string names;
  for (const char* kind : kFaultKindNames) {
    names += (names.empty() ? "" : ", ") + std::string(kind);
  }
  return names;
}

std::vector<FaultSpec> read_faults(const sim::Settings& settings) {
  const Reader root(settings);
  if (!root.has("fault")) return {};
  const Reader all = root.section("fault");
  std::vector<std::string> numbers = all.sections();
  // As numbers: 10 comes behind 9.
  std::stable_sort(numbers.begin(), numbers.end(), [](const std::string& a, const std::string& b) {
    return a.size() != b.size() ? a.size() < b.size() : a < b;
  });
  std::vector<FaultSpec> faults;
  for (const std::string& number : numbers) {
    faults.push_back(read_fault(all.section(number), "fault." + number, settings));
  }
  all.finish();
  return faults;
}

}  // namespace hoof::bridge
