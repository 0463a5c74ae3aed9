#include "tools/bed/bed_source.h"

#include <algorithm>
#include <stdexcept>

#include "sim/config/settings.h"
#include "sim/terrain/bed_file.h"
#include "sim/terrain/bed_key.h"
#include "sim/terrain/bed_store.h"
#include "tools/experiment/run_settings.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

/// The flags as settings, those of --set last, so that a later entry wins.
std::vector<std::string> overrides_of(const BedOptions& options) {
  std::vector<std::string> all = {"use.bed=" + sim::to_text(sim::Value(options.bed))};
  const auto add = [&all](const char* key, const sim::Value& value) {
    all.push_back(std::string(key) + "=" + sim::to_text(value));
  };
  if (options.seed) add("experiment.seed", *options.seed);
  if (options.threads) add("experiment.threads", std::int64_t(*options.threads));
  if (options.periodic) add("bed.sides", std::string("periodic"));
  if (!options.sieve.empty()) add("bed.sieve_file", options.sieve);
  if (!options.sieve_range_mm.empty()) add("bed.sieve_range_mm", options.sieve_range_mm);
  if (options.sieve_scale) add("bed.sieve_scale_ratio", *options.sieve_scale);
  all.insert(all.end(), options.settings.begin(), options.settings.end());
  return all;
}

bool names_settings(const std::string& bed) {
  const std::filesystem::path preset = sim::default_config_dir() / "beds" / (bed + ".toml");
  return bed.ends_with(".toml") || std::filesystem::exists(preset);
}

}  // namespace

std::string ChosenBed::key() const {
  return sim::bed_key(bed, materials, seed);
}

ChosenBed kept_bed(const sim::BedSettings& bed, const sim::Materials& materials, std::uint64_t seed,
                   int threads) {
  const sim::BedStore store(std::filesystem::path(HOOF_CACHE_DIR) / "beds");
  return {bed, materials, seed, threads, store.file(bed, materials, seed)};
}

ChosenBed choose_bed(const BedOptions& options) {
  // Materials, seed and threads are a run's; a sinkage run has all that a bed needs.
  const RunSettings run = read_run_settings("sinkage", overrides_of(options));
  return kept_bed(run.bed, run.materials, run.seed, run.threads);
}

OpenedBed open_bed(const BedOptions& options) {
  const bool by_settings = names_settings(options.bed);
  std::filesystem::path file = options.bed;
  ChosenBed chosen;
  if (by_settings) {
    chosen = choose_bed(options);
    file = chosen.file;
  }
  if (!std::filesystem::exists(file)) {
    throw UserError(by_settings
                        ? file.string() + ": this bed was not made yet; hoof bed make --bed " +
                              options.bed + " makes it"
                        : options.bed +
                              ": no such file, and no bed of this name: presets are demo, "
                              "medium, bench, paper");
  }
  try {
    sim::KeptBed kept = sim::read_bed_file(file);
    const sim::BedOrigin origin = sim::parse_bed_key(kept.key);
    OpenedBed opened{{origin.bed, origin.materials, origin.seed, 1, file}, std::move(kept.state)};
    opened.origin.bed.name = by_settings ? chosen.bed.name : file.stem().string();
    return opened;
  } catch (const std::runtime_error& error) {
    const std::string what = error.what();
    const bool named = what.find(file.string()) != std::string::npos;
    throw UserError(named ? what : file.string() + " " + what);
  }
}

}  // namespace hoof::tools
