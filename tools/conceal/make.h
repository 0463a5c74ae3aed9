#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace hoof::tools::conceal {

struct MakeOptions {
  std::uint64_t seed = 1;
  int count = 40;
  std::string rig = "all";
  std::filesystem::path out, truth;  ///< `truth` empty = out/truth.json
  int threads = 1;
  bool quiet = false;
};

/// Draws a batch, writes each case's folder, then out/truth.sha256, and at last the truth itself.
/// The same options give the same bytes, for any number of threads. Prints the hash.
void make(const MakeOptions& options);

/// "case_0001" for index 0.
std::string case_name(std::size_t index);

}  // namespace hoof::tools::conceal
