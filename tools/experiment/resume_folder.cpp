#include "tools/experiment/resume_folder.h"

#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>
#include <vector>

#include "sim/terrain/checkpoint_file.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"
#include "tools/run/run_folder.h"
#include "tools/run/sha256.h"
#include "tools/run/version.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

constexpr char kSettings[] = "settings.toml";
constexpr char kIdentity[] = "identity.json";

// Results are promised to be the same bytes from the same program only.
const std::string& program_sha256() {
  static const std::string sha256 = sha256_hex_of_file("/proc/self/exe");
  return sha256;
}

nlohmann::json read_identity(const fs::path& folder) {
  const fs::path file = folder / kIdentity;
  const auto json = nlohmann::json::parse(read_file(file), nullptr, false);
  for (const char* key : {"experiment", "program_sha256", "code"}) {
    if (!json.is_object() || !json.contains(key) || !json[key].is_string()) {
      throw UserError(file.string() + ": does not say who wrote it (no text \"" + key + "\")");
    }
  }
  return json;
}

/// Empties a folder of ours that holds nothing of worth. Somebody else's is left alone.
void empty(const fs::path& folder) {
  if (fs::is_empty(folder)) return;
  if (!fs::exists(folder / kIdentity)) {
    throw UserError(folder.string() + ": stands where the run keeps what it takes to resume it; " +
                    "move it away");
  }
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder)) found.push_back(entry.path());
  for (const fs::path& path : found) fs::remove_all(path);
}

}  // namespace

std::string resume_command(const std::string& experiment, const fs::path& folder) {
  return "hoof " + experiment + " --resume " + folder.string();
}

std::unique_ptr<ResumeFolder> ResumeFolder::begin(const fs::path& run,
                                                  const std::string& experiment,
                                                  const std::string& settings_toml, bool force) {
  const fs::path path = resume_path(run);
  std::error_code error;
  const bool fresh = fs::create_directory(path, error);
  if (error) throw UserError(path.string() + ": cannot make this folder: " + error.message());
  std::unique_ptr<ResumeFolder> folder(new ResumeFolder(path));
  if (folder->lock_.taken()) return nullptr;
  if (!fresh && sim::CheckpointFiles::any_in(path) && !force) {
    const std::string its = read_identity(path)["experiment"];
    throw UserError("--out " + run.string() +
                    ": a run of this name was not finished; to finish it: " +
                    resume_command(its, path) + " (--force discards it)");
  }
  empty(path);
  // First, as it says whose folder this is.
  write_result_json(path / kIdentity, {{"experiment", experiment},
                                       {"program_sha256", program_sha256()},
                                       {"code", build_version().code}});
  write_file(path / kSettings, settings_toml);
  folder->is_new_ = true;
  return folder;
}

std::unique_ptr<ResumeFolder> ResumeFolder::open(const fs::path& folder,
                                                 const std::string& experiment) {
  const std::string flag = "--resume " + folder.string();
  fs::path path = fs::absolute(folder).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  if (path.extension() != kResumeEnding) path = resume_path(path);
  if (!fs::is_directory(path)) throw UserError(flag + ": there is no folder " + path.string());
  std::unique_ptr<ResumeFolder> unfinished(new ResumeFolder(path));
  if (unfinished->lock_.taken()) throw UserError(flag + ": another process is working on this run");
  const nlohmann::json identity = read_identity(path);
  const std::string its = identity["experiment"], code = identity["code"];
  if (its != experiment) {
    throw UserError(flag + ": is a " + its + " run; " + resume_command(its, folder));
  }
  if (identity["program_sha256"] != program_sha256()) {
    throw UserError(flag + ": was begun by another build of hoof (" + code + ", this one is " +
                    std::string(build_version().code) +
                    "), whose grains may move otherwise; finish it with that build, or remove " +
                    path.string() + " and begin anew");
  }
  return unfinished;
}

ResumeFolder::ResumeFolder(fs::path path) : path_(std::move(path)), lock_(path_) {}

ResumeFolder::~ResumeFolder() {
  if (!path_.empty() && is_new_ && !has_checkpoint()) remove();
}

fs::path ResumeFolder::run_path() const {
  return path_.parent_path() / path_.stem();
}

fs::path ResumeFolder::settings_file() const {
  return path_ / kSettings;
}

std::string ResumeFolder::settings_toml() const {
  return read_file(settings_file());
}

std::string ResumeFolder::key() const {
  return "settings " + sha256_hex(settings_toml()) + " program " + program_sha256();
}

bool ResumeFolder::has_checkpoint() const {
  return sim::CheckpointFiles::any_in(path_);
}

void ResumeFolder::remove() {
  std::error_code ignored;  // nothing that is needed any more
  fs::remove_all(path_, ignored);
  path_.clear();
}

}  // namespace hoof::tools
