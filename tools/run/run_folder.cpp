#include "tools/run/run_folder.h"

#include <unistd.h>

#include <ctime>
#include <system_error>
#include <utility>

#include "tools/run/errors.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void fail(const fs::path& path, const std::string& action,
                       const std::error_code& error) {
  throw UserError(path.string() + ": cannot " + action + ": " + error.message());
}

// Local calendar date; it names default folders only and appears in no file.
std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[sizeof "2026-01-31"];
  std::strftime(text, sizeof text, "%Y-%m-%d", &local);
  return text;
}

bool stands_at(const fs::path& path) {
  std::error_code error;
  return fs::symlink_status(path, error).type() != fs::file_type::not_found;
}

// --force must never delete a folder of somebody's that merely has the name.
bool may_be_replaced(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(fs::symlink_status(path, error))) return false;
  return fs::is_empty(path, error) || fs::exists(path / "settings.toml", error) ||
         fs::exists(path / "result.json", error);
}

constexpr char kPartial[] = ".partial";

std::string hidden_name(const fs::path& path, const std::string& ending) {
  return "." + path.filename().string() + ending + "-";
}

fs::path hidden_sibling(const fs::path& path, const std::string& ending) {
  return path.parent_path() / (hidden_name(path, ending) + std::to_string(getpid()));
}

// "a/b/" and "a/b" name the same folder, but only the latter has a file name.
fs::path without_trailing_slash(const fs::path& path) {
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

fs::path resume_path(const fs::path& run) {
  return run.string() + kResumeEnding;
}

RunFolder::RunFolder(RunFolderOptions options) : options_(std::move(options)) {
  final_path_ = options_.out.empty()
                    ? next_default_path()
                    : without_trailing_slash(fs::absolute(options_.out).lexically_normal());
  if (stands_at(final_path_)) {
    if (!options_.force) {
      throw UserError("--out " + final_path_.string() + ": exists already (--force replaces it)");
    }
    if (!may_be_replaced(final_path_)) {
      throw UserError("--out " + final_path_.string() +
                      ": is not a run folder; --force replaces only those and empty folders");
    }
  }
  std::error_code error;
  fs::create_directories(final_path_.parent_path(), error);
  if (error) fail(final_path_.parent_path(), "make this folder", error);
  remove_abandoned();
  make_working_folder();
}

void RunFolder::remove_abandoned() {
  std::error_code error;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(final_path_.parent_path(), error)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(hidden_name(final_path_, kPartial))) found.push_back(entry.path());
  }
  for (const fs::path& folder : found) {
    const FolderLock lock(folder);
    if (lock.held() && fs::remove_all(folder, error) > 0 && !error) removed_.push_back(folder);
  }
}

void RunFolder::make_working_folder() {
  // It gets its name once it is locked: at no time does it look abandoned.
  const fs::path fresh = hidden_sibling(final_path_, ".new");
  std::error_code error;
  fs::create_directory(fresh, error);
  if (error) fail(fresh, "make this folder", error);
  lock_.emplace(fresh);
  const fs::path partial = hidden_sibling(final_path_, kPartial);
  fs::rename(fresh, partial, error);
  if (error) fail(partial, "make this folder", error);
  working_path_ = partial;
}

RunFolder::~RunFolder() {
  std::error_code ignored;  // a destructor has nobody to tell
  if (!working_path_.empty()) fs::remove_all(working_path_, ignored);
}

fs::path RunFolder::next_default_path() const {
  const std::string stem = options_.experiment + "-" + today() + "-";
  for (int n = 1;; ++n) {
    fs::path path = fs::absolute(options_.runs_root) / (stem + std::to_string(n));
    if (!stands_at(path) && !stands_at(resume_path(path))) return path;
  }
}

fs::path RunFolder::commit() {
  if (stands_at(final_path_)) {
    if (options_.out.empty()) {
      final_path_ = next_default_path();
    } else if (options_.force && may_be_replaced(final_path_)) {
      replace(final_path_);
      return final_path_;
    } else {
      const fs::path kept = keep_as("new");
      throw UserError("--out " + final_path_.string() + ": appeared while running; this run is " +
                      kept.string());
    }
  }
  std::error_code error;
  fs::rename(working_path_, final_path_, error);
  if (error) fail(final_path_, "move the finished run here", error);
  working_path_.clear();
  return final_path_;
}

void RunFolder::replace(const fs::path& old_run) {
  const fs::path set_aside = hidden_sibling(old_run, ".old");
  std::error_code error;
  fs::rename(old_run, set_aside, error);
  if (error) fail(old_run, "replace this folder", error);
  fs::rename(working_path_, old_run, error);
  if (error) {
    std::error_code ignored;
    fs::rename(set_aside, old_run, ignored);
    fail(old_run, "replace this folder", error);
  }
  working_path_.clear();
  fs::remove_all(set_aside, error);
  if (error) fail(set_aside, "remove the replaced run", error);
}

fs::path RunFolder::keep_as(const std::string& ending) {
  const std::string stem = final_path_.filename().string() + "-" + ending;
  fs::path kept = final_path_.parent_path() / stem;
  for (int n = 2; stands_at(kept); ++n) {
    kept = final_path_.parent_path() / (stem + "-" + std::to_string(n));
  }
  std::error_code error;
  fs::rename(working_path_, kept, error);
  if (error) fail(kept, "keep the unfinished run here", error);
  working_path_.clear();
  return kept;
}

}  // namespace hoof::tools
