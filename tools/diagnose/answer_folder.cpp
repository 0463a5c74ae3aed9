#include "tools/diagnose/answer_folder.h"

#include <unistd.h>

#include <algorithm>
#include <system_error>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

constexpr char kPartial[] = ".hoof-partial-";

[[noreturn]] void fail(const fs::path& path, const std::string& action,
                       const std::error_code& error) {
  throw UserError(path.string() + ": cannot " + action + ": " + error.message());
}

}  // namespace

AnswerFolder::AnswerFolder(const fs::path& folder, std::string last, bool force)
    : folder_(folder), last_(std::move(last)) {
  std::error_code error;
  if (folder_.empty()) throw UserError("--out: must name a folder");
  if (fs::exists(folder_, error) && !fs::is_directory(folder_, error)) {
    throw UserError("--out " + folder_.string() + ": is not a folder");
  }
  if (!force && fs::exists(folder_ / last_, error)) {
    throw UserError("--out " + folder_.string() + ": holds an earlier " + last_ +
                    " (--force replaces it)");
  }
  made_folder_ = fs::create_directories(folder_, error);
  if (error) fail(folder_, "make this folder", error);
  remove_abandoned();
  working_ = folder_ / (kPartial + std::to_string(getpid()));
  fs::create_directory(working_, error);
  if (error) fail(working_, "make this folder", error);
  lock_.emplace(working_);
}

AnswerFolder::~AnswerFolder() {
  std::error_code ignored;  // a destructor has nobody to tell
  fs::remove_all(working_, ignored);
  if (made_folder_ && fs::is_empty(folder_, ignored)) fs::remove(folder_, ignored);
}

void AnswerFolder::remove_abandoned() const {
  std::error_code error;
  std::vector<fs::path> found;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    if (entry.path().filename().string().starts_with(kPartial)) found.push_back(entry.path());
  }
  for (const fs::path& partial : found) {
    const FolderLock lock(partial);
    if (lock.held()) fs::remove_all(partial, error);
  }
}

void AnswerFolder::write(const std::string& name, std::string_view text) {
  write_file(working_ / name, text);
  names_.push_back(name);
}

void AnswerFolder::commit() {
  std::error_code error;
  // An answer of old and new files must not look whole, should this be cut off in the middle.
  fs::remove(folder_ / last_, error);
  if (error) fail(folder_ / last_, "replace this file", error);
  for (const std::string& name : left_out_) {
    fs::remove(folder_ / name, error);
    if (error) fail(folder_ / name, "remove this file of an earlier answer", error);
  }
  std::stable_partition(names_.begin(), names_.end(),
                        [this](const std::string& name) { return name != last_; });
  for (const std::string& name : names_) {
    fs::rename(working_ / name, folder_ / name, error);
    if (error) fail(folder_ / name, "move the finished file here", error);
  }
}

}  // namespace hoof::tools
