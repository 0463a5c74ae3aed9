#include "tools/reproduce/campaign.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "sim/config/config_error.h"
#include "tools/experiment/resume_folder.h"
#include "tools/experiment/run_experiment.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/progress_line.h"
#include "tools/run/result_json.h"
#include "tools/run/run_folder.h"
#include "tools/run/sha256.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

constexpr const char* kThreads = "experiment.threads";

/// The folder is made before it is locked.
const fs::path& made(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "cells", error);
  if (error) throw UserError((folder / "cells").string() + ": " + error.message());
  return folder;
}

std::string text_of(const sim::Settings& settings, const std::string& prefix) {
  std::string text;
  for (const auto& [key, entry] : settings.entries()) {
    if (key == kThreads || !key.starts_with(prefix)) continue;
    text += key + " = " + sim::to_text(entry.value) + "\n";
  }
  return text;
}

/// The first key whose value differs, and both values.
std::string difference(const sim::Settings& a, const sim::Settings& b) {
  const auto text = [](const sim::Settings& settings, const std::string& key) {
    const sim::Entry* entry = settings.find(key);
    return entry ? sim::to_text(entry->value) : std::string("nothing");
  };
  for (const sim::Settings* settings : {&a, &b}) {
    for (const auto& [key, entry] : settings->entries()) {
      if (key != kThreads && text(a, key) != text(b, key)) {
        return key + " is " + text(a, key) + " there and " + text(b, key) + " now";
      }
    }
  }
  return "the settings differ";
}

nlohmann::json read_json(const fs::path& file) {
  return nlohmann::json::parse(read_file(file), nullptr, false);
}

}  // namespace

std::string settings_hash(const sim::Settings& settings) {
  return sha256_hex(text_of(settings, ""));
}

std::string geometry_hash(const sim::Settings& settings) {
  return sha256_hex(text_of(settings, "foot."));
}

Campaign::Campaign(fs::path folder, std::vector<Cell> cells, std::vector<std::string> settings)
    : folder_(std::move(folder)),
      cells_(std::move(cells)),
      settings_(std::move(settings)),
      lock_(made(folder_)) {
  if (lock_.taken()) {
    throw UserError("--out " + folder_.string() + ": another process is working on this campaign");
  }
}

std::vector<std::string> Campaign::overrides(const Cell& cell) const {
  std::vector<std::string> all = cell.overrides();
  all.insert(all.end(), settings_.begin(), settings_.end());
  return all;
}

bool Campaign::done(const Cell& cell) const {
  const fs::path result = place(cell) / "result.json", settings = place(cell) / "settings.toml";
  if (!fs::exists(result) || !fs::exists(settings)) return false;
  const sim::Settings planned = read_run_settings(cell.kind(), overrides(cell)).tree;
  const sim::Settings there = sim::Settings::load_file(settings);
  if (settings_hash(planned) != settings_hash(there)) {
    throw UserError(place(cell).string() + ": was run with other settings: " +
                    difference(there, planned) + "; choose another --out, or remove it");
  }
  if (!fs::exists(seal(cell))) {
    // Killed between the run's end and its seal: a run's folder appears whole or not at all.
    return read_json(result).is_object();
  }
  const nlohmann::json sealed = read_json(seal(cell));
  return sealed.is_object() && sealed.value("result_sha256", "") == sha256_hex_of_file(result);
}

bool Campaign::can_be_resumed(const Cell& cell) const {
  if (!fs::exists(resume_path(place(cell)))) return false;
  try {
    ResumeFolder::open(resume_path(place(cell)), cell.kind());
    return true;
  } catch (const UserError& error) {  // begun by another build
    std::cerr << "hoof: " << error.what() << "; " << cell.id() << " is run anew\n";
    return false;
  }
}

bool Campaign::try_cell(const Cell& cell, bool quiet, std::string& why_not) const {
  RunOutput output;
  output.out = place(cell);
  output.quiet = quiet;
  output.silent = true;
  try {
    if (can_be_resumed(cell)) {
      resume_experiment(cell.kind(), resume_path(place(cell)), output);
      return true;
    }
    output.force = true;
    run_experiment(read_run_settings(cell.kind(), overrides(cell)), output);
    return true;
  } catch (const CannotFinish& error) {
    why_not = error.what();
    return false;
  } catch (const Interrupted& error) {
    throw Interrupted("stopped in " + cell.id() +
                          "; what is finished is kept, and the same command goes on from there",
                      error.exit_status());
  }
}

void Campaign::write_seal(const Cell& cell) const {
  const fs::path result = place(cell) / "result.json";
  const auto version = read_json(result);
  fs::path partial = seal(cell);
  partial += ".partial";
  write_result_json(
      partial,
      {{"settings_sha256", settings_hash(sim::Settings::load_file(place(cell) / "settings.toml"))},
       {"result_sha256", sha256_hex_of_file(result)},
       {"code", version.contains("version") ? version["version"].value("code", "") : ""}});
  fs::rename(partial, seal(cell));
}

std::vector<std::string> Campaign::run(bool quiet, const std::function<void(const Cell&)>& after) {
  std::vector<const Cell*> missing;
  for (const Cell& cell : cells_) {
    if (!done(cell)) {
      missing.push_back(&cell);
    } else if (!fs::exists(seal(cell))) {
      write_seal(cell);
    }
  }
  std::vector<std::string> failed;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < missing.size(); ++i) {
    const Cell& cell = *missing[i];
    if (!quiet) {
      const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - start;
      const std::string left =
          i == 0 ? ""
                 : ", about " +
                       format_duration(gone.count() / double(i) * double(missing.size() - i)) +
                       " left";
      std::cerr << "run " << i + 1 << " of " << missing.size() << left << ": " << cell.id()
                << std::endl;
    }
    std::string why_not;
    if (!try_cell(cell, quiet, why_not)) {
      failed.push_back(cell.id() + ": " + why_not);
      std::cerr << "hoof: " << failed.back() << "\n";
      continue;
    }
    write_seal(cell);
    after(cell);
  }
  return failed;
}

Outcomes Campaign::outcomes() const {
  Outcomes outcomes;
  for (const Cell& cell : cells_) {
    if (!done(cell)) continue;
    const nlohmann::json j = read_json(place(cell) / "result.json");
    Outcome o;
    if (cell.traction) {
      o.fx_peak_N = j.at("fx_peak_N"), o.fz_at_fx_peak_N = j.at("fz_at_fx_peak_N");
      o.coefficient = j.at("traction_coefficient");
    } else {
      o.sinkage_mm = 1e3 * j.at("max_depth_m").get<double>();
    }
    outcomes[cell.condition()][cell.bed] = o;
  }
  return outcomes;
}

std::vector<std::pair<std::string, std::string>> Campaign::geometry_hashes() const {
  std::vector<std::pair<std::string, std::string>> hashes;
  for (const Cell& cell : cells_) {
    const bool known = std::any_of(hashes.begin(), hashes.end(),
                                   [&](const auto& hash) { return hash.first == cell.foot; });
    if (known) continue;
    hashes.emplace_back(cell.foot,
                        geometry_hash(read_run_settings(cell.kind(), overrides(cell)).tree));
  }
  return hashes;
}

}  // namespace hoof::tools
