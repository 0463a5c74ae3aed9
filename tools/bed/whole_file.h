// A file that is there whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

#include "tools/run/output_file.h"

namespace hoof::tools {

/// Written beside its final path; commit() renames it there. Without commit() nothing is left.
/// Every failure throws UserError with the path and the reason.
class WholeFile {
 public:
  explicit WholeFile(std::filesystem::path path);
  ~WholeFile();

  void write(std::string_view text) { part_.write(text); }
  void commit();

 private:
  std::filesystem::path path_;
  OutputFile part_;
};

}  // namespace hoof::tools
