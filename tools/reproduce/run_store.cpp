#include "tools/reproduce/run_store.h"

#include <iostream>
#include <system_error>

#include "sim/config/config_error.h"
#include "tools/experiment/resume_folder.h"
#include "tools/experiment/run_experiment.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"
#include "tools/run/run_folder.h"
#include "tools/run/sha256.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

/// What decides nothing of a run: how it is computed, and what is kept beside its result.
bool decides(const std::string& key) {
  return key != "experiment.threads" && key != "experiment.fields";
}

std::string text_of(const sim::Settings& settings, const std::string& prefix) {
  std::string text;
  for (const auto& [key, entry] : settings.entries()) {
    if (!decides(key) || !key.starts_with(prefix)) continue;
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
      if (decides(key) && text(a, key) != text(b, key)) {
        return key + " is " + text(a, key) + " there and " + text(b, key) + " now";
      }
    }
  }
  return "the settings differ";
}

nlohmann::json read_json(const fs::path& file) {
  return nlohmann::json::parse(read_file(file), nullptr, false);
}

void replace(const fs::path& file, const nlohmann::ordered_json& json) {
  fs::path partial = file;
  partial += ".partial";
  write_result_json(partial, json);
  fs::rename(partial, file);
}

}  // namespace

std::string settings_hash(const sim::Settings& settings) {
  return sha256_hex(text_of(settings, ""));
}

std::string geometry_hash(const sim::Settings& settings) {
  return sha256_hex(text_of(settings, "foot."));
}

PlannedRun planned_run(const std::string& id, const std::string& kind,
                       std::vector<std::string> settings) {
  PlannedRun run{id, kind, std::move(settings), ""};
  run.settings_sha256 = settings_hash(read_run_settings(run.kind, run.settings).tree);
  return run;
}

RunStore::RunStore(fs::path folder) : folder_(std::move(folder)) {
  for (const char* part : {"cells", "attempts"}) {
    std::error_code error;
    fs::create_directories(folder_ / part, error);
    if (error) throw UserError((folder_ / part).string() + ": " + error.message());
  }
}

bool RunStore::has(const PlannedRun& run) const {
  const fs::path settings = place(run.id) / "settings.toml";
  return fs::exists(settings) &&
         settings_hash(sim::Settings::load_file(settings)) == run.settings_sha256 && done(run);
}

bool RunStore::done(const PlannedRun& run) const {
  const fs::path result = place(run.id) / "result.json";
  const fs::path settings = place(run.id) / "settings.toml";
  if (!fs::exists(result) || !fs::exists(settings)) return false;
  const sim::Settings there = sim::Settings::load_file(settings);
  if (settings_hash(there) != run.settings_sha256) {
    throw UserError(place(run.id).string() + ": was run with other settings: " +
                    difference(there, read_run_settings(run.kind, run.settings).tree) +
                    "; choose another --out, or remove it");
  }
  if (!fs::exists(seal(run.id))) {
    // Killed between the run's end and its seal: a run's folder appears whole or not at all.
    return read_json(result).is_object();
  }
  const nlohmann::json sealed = read_json(seal(run.id));
  return sealed.is_object() && sealed.value("result_sha256", "") == sha256_hex_of_file(result);
}

bool RunStore::can_be_resumed(const PlannedRun& run) const {
  if (!fs::exists(resume_path(place(run.id)))) return false;
  try {
    ResumeFolder::open(resume_path(place(run.id)), run.kind);
    return true;
  } catch (const UserError& error) {  // begun by another build
    std::cerr << "hoof: " << error.what() << "; " << run.id << " is run anew\n";
    return false;
  }
}

bool RunStore::make(const PlannedRun& run, bool quiet, std::string& why_not) const {
  RunOutput output;
  output.out = place(run.id);
  output.quiet = quiet;
  output.silent = true;
  output.force = true;  // what is there is damaged, or it would be done
  try {
    if (can_be_resumed(run)) {
      resume_experiment(run.kind, resume_path(place(run.id)), output);
    } else {
      run_experiment(read_run_settings(run.kind, run.settings), output);
    }
  } catch (const CannotFinish& error) {
    why_not = error.what();
    return false;
  } catch (const Interrupted& error) {
    throw Interrupted("stopped in " + run.id +
                          "; what is finished is kept, and the same command goes on from there",
                      error.exit_status());
  }
  write_seal(run);
  return true;
}

void RunStore::seal_if_open(const PlannedRun& run) const {
  if (!fs::exists(seal(run.id))) write_seal(run);
}

void RunStore::write_seal(const PlannedRun& run) const {
  const fs::path result = place(run.id) / "result.json";
  const auto version = read_json(result);
  replace(seal(run.id),
          {{"settings_sha256",
            settings_hash(sim::Settings::load_file(place(run.id) / "settings.toml"))},
           {"result_sha256", sha256_hex_of_file(result)},
           {"code", version.contains("version") ? version["version"].value("code", "") : ""}});
}

std::unique_ptr<FolderLock> RunStore::lock(const std::string& name) const {
  const fs::path folder = folder_ / "locks" / name;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw UserError(folder.string() + ": " + error.message());
  return std::make_unique<FolderLock>(folder);
}

RunTime RunStore::run_time(const std::string& id) const {
  const fs::path file = place(id) / "timing.json";
  if (!fs::exists(file)) return {};
  const nlohmann::json timing = read_json(file);
  if (!timing.is_object()) return {};
  return {timing.value("run_s", 0.0), timing.value("threads", 1)};
}

std::string RunStore::code(const std::string& id) const {
  if (!fs::exists(seal(id))) return "";
  const nlohmann::json sealed = read_json(seal(id));
  return sealed.is_object() ? sealed.value("code", "") : "";
}

std::optional<Attempt> RunStore::attempt(const std::string& id) const {
  const fs::path file = folder_ / "attempts" / (id + ".json");
  if (!fs::exists(file)) return {};
  const nlohmann::json j = read_json(file);
  if (!j.is_object()) return {};
  return Attempt{j.value("state", ""), j.value("why", ""), j.value("where", ""),
                 j.value("tries", 0)};
}

void RunStore::note_attempt(const std::string& id, const Attempt& a) const {
  replace(folder_ / "attempts" / (id + ".json"),
          {{"state", a.state}, {"why", a.why}, {"where", a.where}, {"tries", a.tries}});
}

}  // namespace hoof::tools
