#include "tools/terrain/fit_terrain.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "sim/config/config_error.h"
#include "sim/terrain/bed_file.h"
#include "sim/terrain/bed_store.h"
#include "sim/terrain/rft_law.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/progress_line.h"
#include "tools/run/stop_request.h"
#include "tools/terrain/push_sand.h"
#include "tools/terrain/push_table.h"
#include "tools/terrain/soil_fit.h"
#include "tools/terrain/soil_text.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

std::string hex(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

std::string hash_of(const std::string& key) {
  return hex(sim::fnv1a(key.data(), key.size()));
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw UserError("--out " + folder.string() + ": " + error.message());
}

void write_whole(const fs::path& file, const std::string& text) {
  fs::path partial = file;
  partial += ".partial";
  write_file(partial, text);
  fs::rename(partial, file);
}

/// All pushes of a fit in one bed, each kept as it is finished.
class Pushing {
 public:
  Pushing(const FitTerrainOptions& options, ChosenBed bed)
      : options_(options),
        bed_(std::move(bed)),
        cases_(options.out / "cases"),
        progress_("pushing", choose_progress_style(options.quiet), std::cerr) {
    make_folder(cases_);
  }

  std::vector<Push> run() {
    const std::vector<PushCase> plates = standard_pushes(options_.scale);
    for (const PushCase& plate : plates) {
      require_room(plate, bed_.bed);
      if (!fs::exists(file_of(plate))) total_ += steps_of(plate);
    }
    std::vector<Push> pushes;
    for (const PushCase& plate : plates) {
      if (!fs::exists(file_of(plate))) write_pushes(file_of(plate), {measure(plate)});
      std::vector<Push> kept = read_pushes(file_of(plate));
      pushes.insert(pushes.end(), kept.begin(), kept.end());
    }
    progress_.finish();
    return pushes;
  }

 private:
  double steps_of(const PushCase& plate) const {
    return push_steps(plate, bed_.bed, options_.speed_m_s);
  }

  fs::path file_of(const PushCase& plate) const {
    std::string name = plate.name;
    std::replace(name.begin(), name.end(), ' ', '_');
    return cases_ /
           (name + "-" + hash_of(push_key(plate, bed_.key(), options_.speed_m_s)) + ".csv");
  }

  Push measure(const PushCase& plate) {
    const double steps = steps_of(plate);
    try {
      settle();
      const Push push =
          push_in_sand(plate, bed_.bed, bed_.materials, state_, options_.speed_m_s, bed_.threads,
                       [&](double share) {
                         progress_.update((done_ + share * steps) / total_, plate.name);
                         return !stop_.requested();
                       });
      done_ += steps;
      return push;
    } catch (const std::invalid_argument&) {
      progress_.finish();
      throw;
    } catch (const std::runtime_error& error) {
      progress_.finish();
      if (!stop_.requested()) throw CannotFinish(plate.name + ": " + error.what());
      throw Interrupted("stopped; finished pushes are kept in " + cases_.string() +
                            " and the same command goes on from there",
                        stop_.exit_status());
    }
  }

  /// The bed of runs with such settings, made where it is not there.
  void settle() {
    if (!state_.grains.empty()) return;
    const sim::BedStore store(bed_.file.parent_path());
    sim::StoredBed stored =
        store.get(bed_.bed, bed_.materials, bed_.seed, bed_.threads, [this](double share) {
          progress_.update(0, "settling the bed, " + std::to_string(int(100 * share)) + " %");
          return !stop_.requested();
        });
    if (!stored.discarded.empty()) std::cerr << "hoof: " << stored.discarded << "; made anew\n";
    state_ = std::move(stored.state);
  }

  const FitTerrainOptions& options_;
  ChosenBed bed_;
  fs::path cases_;
  ProgressLine progress_;
  StopRequest stop_;
  sim::BedState state_;
  double total_ = 0, done_ = 0;
};

/// What the user would type again.
std::string command_of(const FitTerrainOptions& options) {
  std::string command = "hoof terrain fit";
  const auto add = [&command](const std::string& text) { command += " " + text; };
  if (!options.from.empty()) add("--from " + options.from.filename().string());
  if (options.from.empty()) {
    add("--bed " + fs::path(options.bed.bed).filename().string());
    if (options.bed.seed) add("--seed " + std::to_string(*options.bed.seed));
    add("--speed " + format_number(options.speed_m_s));
    if (options.scale != 1) add("--scale " + format_number(options.scale));
    for (const std::string& setting : options.bed.settings) add("--set " + setting);
  }
  add("--law " + options.law);
  return command;
}

std::string with_speed(const FitTerrainOptions& options, const ChosenBed& bed) {
  return "bed " + bed.bed.name + " (" + hash_of(bed.key()) + "), plates at " +
         format_number(options.speed_m_s) + " m/s";
}

}  // namespace

sim::RftTerrainSettings load_soil(const std::string& name_or_file) {
  const bool file = name_or_file.find('/') != std::string::npos || name_or_file.ends_with(".toml");
  sim::Settings settings;
  settings.merge(sim::Settings::load_file(file ? fs::path(name_or_file)
                                               : sim::default_config_dir() / "rft_terrain" /
                                                     (name_or_file + ".toml")),
                 "rft_terrain");
  return sim::read_rft_terrain(sim::Reader(settings).section("rft_terrain"));
}

void fit_terrain(const FitTerrainOptions& options) {
  sim::RftTerrainSettings soil = load_soil(options.start);
  soil.pressure_law =
      options.law == "bekker" ? sim::PressureLaw::kBekker : sim::PressureLaw::kLinear;
  make_folder(options.out);
  std::vector<Push> pushes;
  if (options.from.empty()) {
    const ChosenBed bed = choose_bed(options.bed);
    soil.name = bed.bed.name;
    soil.surface_friction = bed.materials.sand_abs.static_friction.value;
    soil.fitted_to = with_speed(options, bed);
    pushes = Pushing(options, bed).run();
    write_pushes(options.out / "pushes.csv", pushes);
  } else {
    pushes = read_pushes(options.from);
    soil.name = options.from.stem().string();
    soil.fitted_to =
        options.from.filename().string() + " (" + hash_of(read_file(options.from)) + ")";
  }
  const SoilFit fit = fit_soil(pushes, soil);
  fit.soil.validate();
  write_whole(options.out / "soil.toml", soil_toml(fit.soil, command_of(options)));
  std::fputs(fit_table(fit).c_str(), stdout);
  std::fflush(stdout);
  if (options.from.empty()) std::cout << (options.out / "pushes.csv").string() << "\n";
  std::cout << (options.out / "soil.toml").string() << std::endl;
}

void show_terrain(const ShowTerrainOptions& options) {
  const sim::RftTerrainSettings soil = load_soil(options.soil);
  const double b_m = std::min(options.length_m, options.width_m);
  const double area_m2 = options.length_m * options.width_m;
  std::printf("soil '%s' (%s), fitted to %s\n", soil.name.c_str(), hex(soil.hash()).c_str(),
              soil.fitted_to.c_str());
  std::printf("flat plate of %g x %g mm, straight down\n  depth    pressure       force\n",
              options.length_m * 1e3, options.width_m * 1e3);
  constexpr int kRows = 10;
  for (int i = 1; i <= kRows; ++i) {
    const double z_m = options.depth_m * i / kRows;
    const double p_Pa =
        soil.pressure_law == sim::PressureLaw::kLinear
            ? soil.xi_n_N_m3.value * z_m * sim::rft::flat_plate_alpha()
            : sim::rft::bekker_pressure_Pa(soil.bekker_k_c_N_m, soil.bekker_k_phi_Pa,
                                           soil.bekker_exponent, b_m, z_m);
    std::printf("%5.1f mm %8.2f kPa %9.1f N\n", z_m * 1e3, p_Pa * 1e-3, p_Pa * area_m2);
  }
}

}  // namespace hoof::tools
