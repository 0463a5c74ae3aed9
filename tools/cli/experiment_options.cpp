#include "tools/cli/experiment_options.h"

#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "tools/experiment/two_processes.h"

namespace hoof::tools {
namespace {

constexpr double kToeMax_deg = 40.0;  // the paper's widest opening and the foot's mechanical range

const std::string kStlEnding = ".stl";
const std::vector<std::string> kFeet = {"bionic", "bionic-plain", "traditional"};
const std::vector<std::string> kBeds = {"demo", "medium", "bench", "paper"};

const std::string kResume = "--resume";
const std::string kCheckpointEvery = "--checkpoint-every";

// The settings that the flags stand for, spelled once.
constexpr std::string_view kFootKey = "use.foot";
constexpr std::string_view kFootMeshKey = "foot.mesh_file";
constexpr std::string_view kStlFoot = "stl";  // preset of sim/config/feet for any mesh
constexpr std::string_view kLoadMassKey = "experiment.load_kg";
constexpr std::string_view kLoadForceKey = "experiment.load_N";
constexpr std::string_view kLoadAsKey = "experiment.load_as";
constexpr std::string_view kSpeedKey = "experiment.speed_m_s";
constexpr std::string_view kFrequencyKey = "experiment.frequency_Hz";
constexpr std::string_view kToeKey = "experiment.toe_deg";
constexpr std::string_view kBedKey = "use.bed";
constexpr std::string_view kTerrainKey = "experiment.terrain";
constexpr std::string_view kSoilKey = "use.rft_terrain";
constexpr std::string_view kFieldsKey = "experiment.fields";
constexpr std::string_view kDriveKey = "experiment.drive";
constexpr std::string_view kBusKey = "experiment.bus";
constexpr std::string_view kFirmwareKey = "experiment.firmware";
constexpr std::string_view kSeedKey = "experiment.seed";
constexpr std::string_view kThreadsKey = "experiment.threads";

// A checker returns the complaint, or nothing; CLI11 puts the flag's name in front of it.
std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

CLI::Validator positive(const std::string& unit) {
  return CLI::Validator(
      [unit](const std::string& text) -> std::string {
        const std::optional<double> value = parse_number(text);
        if (!value) return "'" + text + "' is not a number (in " + unit + ")";
        if (*value <= 0.0) return text + " " + unit + " is not above 0";
        return "";
      },
      "");
}

CLI::Validator not_negative(const std::string& unit) {
  return CLI::Validator(
      [unit](const std::string& text) -> std::string {
        const std::optional<double> value = parse_number(text);
        if (!value) return "'" + text + "' is not a number (in " + unit + ")";
        if (*value < 0.0) return text + " " + unit + " is below 0";
        return "";
      },
      "");
}

struct Load {
  std::string_view number;
  std::string_view unit;
};

Load split_load(std::string_view text) {
  const std::size_t end = text.find_last_of("0123456789.");
  if (end == std::string_view::npos) return {text, ""};
  const std::string_view unit = text.substr(end + 1);
  return {text.substr(0, end + 1), unit.empty() ? "kg" : unit};
}

std::string check_load(const std::string& text) {
  const auto [number, unit] = split_load(text);
  const std::optional<double> value = parse_number(number);
  if (!value) return "'" + text + "' is not a load such as 40, 40kg or 400N";
  if (unit != "kg" && unit != "N") {
    return "'" + text + "' has the unit '" + std::string(unit) + "'; known are kg and N";
  }
  if (*value <= 0.0) return text + " is not above 0 " + std::string(unit);
  return "";
}

std::string check_toe(const std::string& text) {
  const std::optional<double> value = parse_number(text);
  if (!value) return "'" + text + "' is not a number (in degrees)";
  if (*value < 0.0 || *value > kToeMax_deg) return text + " degrees is outside 0..40";
  return "";
}

/// One of `names`, or a file that exists and ends in `ending` ("" for any).
CLI::Validator name_or_file(const std::vector<std::string>& names, const std::string& ending) {
  return CLI::Validator(
      [names, ending](const std::string& text) -> std::string {
        for (const std::string& name : names) {
          if (text == name) return "";
        }
        std::error_code error;
        const bool is_file = std::filesystem::is_regular_file(text, error);
        if (is_file && text.ends_with(ending)) return "";
        if (is_file) return "'" + text + "' does not end in " + ending;
        return "'" + text + "' is none of " + CLI::detail::join(names, ", ") + " and no file";
      },
      "");
}

CLI::Validator one_of(const std::vector<std::string>& names) {
  return CLI::Validator(
      [names](const std::string& text) -> std::string {
        for (const std::string& name : names) {
          if (text == name) return "";
        }
        return "'" + text + "' is none of " + CLI::detail::join(names, ", ");
      },
      "");
}

/// `text` as a TOML basic string (toml.io, v1.0): quotes, backslashes and control characters
/// escaped.
std::string toml_string(std::string_view text) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += {'\\', c};
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += {'\\', 'u', '0', '0', kDigits[byte >> 4], kDigits[byte & 0xf]};
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

std::string examples(Experiment experiment) {
  if (experiment == Experiment::kSinkage) {
    return "Examples:\n"
           "  hoof sinkage\n"
           "  hoof sinkage --foot traditional --load 40 --speed 0.1 --bed bench --seed 3\n"
           "  hoof sinkage --foot bionic --toe 30 --load 400N --out runs/toe-30 --force\n"
           "  hoof sinkage --fields vtk                         ParaView: RUN/fields/fields.pvd\n"
           "  hoof sinkage --terrain rigid --faults tools/faults/example.toml\n"
           "  hoof sinkage --terrain rft --soil soil.toml\n"
           "  hoof sinkage --terrain rft --effects answer/improved.toml\n"
           "  hoof sinkage --terrain rft --effects play.toml --conceal truth.toml --out "
           "runs/sealed\n"
           "  hoof sinkage --terrain rigid --firmware emulated\n"
           "  hoof sinkage --terrain rigid --firmware qemu      the same image in QEMU, by its "
           "serial lines\n"
           "  hoof sinkage --resume runs/toe-30.resume\n"
           "  hoof sinkage --bus vcan0                          firmware and plant as two "
           "processes\n"
           "  hoof sinkage --bus vcan0 --clock real-time --terrain rigid";
  }
  return "Examples:\n"
         "  hoof traction\n"
         "  hoof traction --foot bionic-plain --frequency 1.12 --toe 20\n"
         "  hoof traction --drive prescribed --set bed.depth_mm=100 --threads 2\n"
         "  hoof traction --bed medium --set bed.box_length_mm=530   its own box is too short\n"
         "  hoof traction --terrain rigid --fault kind=torque_loss,target=hip,at_s=2.5,for_s=0.5\n"
         "  hoof traction --bed paper --out runs/paper --checkpoint-every 10\n"
         "  hoof traction --resume runs/paper.resume";
}

/// With --resume, what the run is cannot be said anew.
void refuse_beside_resume(const CLI::App& command) {
  const std::set<std::string> also = {kResume, kCheckpointEvery, "--force", "--live", "--quiet"};
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() > 0 && !also.contains(option->get_name())) {
      throw CLI::ValidationError(kResume, "goes on with the settings of the run; " +
                                              option->get_name() + " cannot be given with it");
    }
  }
}

void add_resume_options(CLI::App& command, ExperimentOptions& options) {
  const CLI::Option* resume =
      command.add_option(kResume, options.resume, "Finish a run that was cut off: DIR.resume")
          ->type_name("DIR");
  command
      .add_option(kCheckpointEvery, options.checkpoint_every_min,
                  "Minutes between checkpoints of the grains; 0: none, cannot be resumed")
      ->type_name("MIN")
      ->check(not_negative("minutes"))
      ->capture_default_str();
  command.parse_complete_callback([&command, resume] {
    if (resume->count() > 0) refuse_beside_resume(command);
  });
}

const char* name_of(Experiment experiment) {
  return experiment == Experiment::kSinkage ? "sinkage" : "traction";
}

/// hoof-firmware and hoof-bridge with the same settings.
void run_on_bus(const RunSettings& run, const RunOutput& output,
                const std::vector<std::string>& overrides, const ExperimentOptions& options) {
  std::vector<std::string> what = {"--experiment", run.kind};
  const auto add = [&what](const std::string& flag, const std::string& value) {
    what.insert(what.end(), {flag, value});
  };
  add("--clock", output.bus.real_time ? "real-time" : "lock-step");
  add("--patience", std::to_string(output.bus.patience_s));
  for (const std::string& setting : overrides) add("--set", setting);
  if (!options.faults.file.empty()) add("--faults", options.faults.file);
  if (!options.effects.empty()) add("--effects", options.effects);
  if (!options.conceal.empty()) add("--conceal", options.conceal.string());
  if (!output.out.empty()) add("--out", output.out.string());
  if (output.force) what.emplace_back("--force");
  if (output.live) what.emplace_back("--live");
  if (output.quiet) what.emplace_back("--quiet");
  check_bus_choice(run, output.bus);
  // Which drives there are counts from the start of the firmware; all else is set over the bus.
  const std::vector<std::string> firmware = {
      "--clock", output.bus.real_time ? "real-time" : "lock-step",
      "--set",   "toe_present=" + std::to_string(run.parameters.toe_present),
      "--set",   "leg_present=" + std::to_string(run.parameters.leg_present)};
  run_two_processes({run.bus, firmware, what});
}

}  // namespace

void run_or_resume(const ExperimentOptions& options, Experiment experiment) {
  constexpr double kMinute_s = 60;
  const std::string kind = name_of(experiment);
  const RunOutput output{options.run.out,
                         options.run.force,
                         options.run.live,
                         options.run.quiet,
                         options.checkpoint_every_min * kMinute_s,
                         bus_choice(options.bus),
                         options.conceal};
  if (!options.resume.empty()) {
    resume_experiment(kind, options.resume, output);
    return;
  }
  const std::vector<std::string> overrides = settings_overrides(options);
  const RunSettings run = read_run_settings(kind, overrides, options.faults.file, options.effects);
  if (run.bus == kInProcess) {
    run_experiment(run, output);
  } else {
    run_on_bus(run, output, overrides, options);
  }
}

void add_experiment_options(CLI::App& command, ExperimentOptions& options, Experiment experiment) {
  command.add_option("--foot", options.foot, "bionic, bionic-plain, traditional or FILE.stl")
      ->type_name("FOOT")
      ->check(name_or_file(kFeet, kStlEnding));
  command.add_option("--load", options.load, "On the foot: 40 or 40kg is a mass, 400N a force")
      ->type_name("LOAD")
      ->check(CLI::Validator(check_load, ""));
  command.add_option("--load-as", options.load_as, "The load acts as a force or as a mass")
      ->type_name("force|mass")
      ->check(one_of({"force", "mass"}));
  if (experiment == Experiment::kSinkage) {
    command.add_option("--speed", options.speed, "Downward speed at first contact")
        ->type_name("M_PER_S")
        ->check(positive("m/s"));
  } else {
    command.add_option("--frequency", options.frequency, "Of the stance ellipse")
        ->type_name("HZ")
        ->check(positive("Hz"));
    command.add_option("--drive", options.drive, "Legs moved by the firmware or as prescribed")
        ->type_name("firmware|prescribed")
        ->check(one_of({"firmware", "prescribed"}));
  }
  command.add_option("--toe", options.toe, "Opening of each toe, 0..40 degrees")
      ->type_name("DEG")
      ->check(CLI::Validator(check_toe, ""));
  command.add_option("--bed", options.bed, "Preset demo, medium, bench or paper, or a file")
      ->type_name("PRESET|FILE")
      ->check(name_or_file(kBeds, ""));
  command
      .add_option("--terrain", options.terrain, "Grains (dem), a fast law (rft) or a rigid plane")
      ->type_name("dem|rft|rigid")
      ->check(one_of({"dem", "rft", "rigid"}));
  command
      .add_option("--soil", options.soil, "Of --terrain rft: demo, or a file of hoof terrain fit")
      ->type_name("NAME|FILE")
      ->check(name_or_file({"demo"}, ".toml"));
  command
      .add_option("--fields", options.fields,
                  "Of the sand under the foot: nothing, numbers and maps, or ParaView files too")
      ->type_name("none|report|vtk")
      ->check(one_of({"none", "report", "vtk"}));
  command
      .add_option("--firmware", options.firmware,
                  "The loop in this process, or the board's image: in our emulator, or in QEMU")
      ->type_name("host|emulated|qemu")
      ->check(one_of({"host", "emulated", "qemu"}));
  add_bus_options(command, options.bus);
  add_fault_options(command, options.faults);
  add_effect_options(command, options.effects, options.conceal);
  add_run_options(command, options.run);
  add_resume_options(command, options);
  command.footer(fault_help() + examples(experiment));
}

std::vector<std::string> settings_overrides(const ExperimentOptions& options) {
  std::vector<std::string> overrides;
  const auto add = [&overrides](std::string_view key, std::string_view value) {
    overrides.push_back(std::string(key) + "=" + std::string(value));
  };
  const auto add_text = [&add](std::string_view key, const std::string& value) {
    if (!value.empty()) add(key, toml_string(value));
  };
  const auto add_number = [&add](std::string_view key, const std::string& value) {
    if (!value.empty()) add(key, value);
  };

  const bool is_mesh = options.foot.ends_with(kStlEnding);
  add_text(kFootKey, is_mesh ? std::string(kStlFoot) : options.foot);
  if (is_mesh) add_text(kFootMeshKey, options.foot);
  if (!options.load.empty()) {
    const auto [number, unit] = split_load(options.load);
    add(unit == "N" ? kLoadForceKey : kLoadMassKey, number);
  }
  add_text(kLoadAsKey, options.load_as);
  add_number(kSpeedKey, options.speed);
  add_number(kFrequencyKey, options.frequency);
  add_number(kToeKey, options.toe);
  add_text(kBedKey, options.bed);
  add_text(kTerrainKey, options.terrain);
  add_text(kSoilKey, options.soil);
  add_text(kFieldsKey, options.fields);
  add_text(kDriveKey, options.drive);
  add_text(kBusKey, options.bus.bus);
  add_text(kFirmwareKey, options.firmware);
  add_fault_overrides(options.faults, overrides);
  if (options.run.seed) add(kSeedKey, std::to_string(*options.run.seed));
  if (options.run.threads) add(kThreadsKey, std::to_string(*options.run.threads));
  overrides.insert(overrides.end(), options.run.settings.begin(), options.run.settings.end());
  return overrides;
}

}  // namespace hoof::tools
