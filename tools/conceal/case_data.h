#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace hoof::tools::conceal {

/// One key of [setup]: a number, a number with its doubt, or a word.
struct SetupEntry {
  std::string key;
  double value = 0.0;
  double sigma = 0.0;  ///< 0 = known exactly
  std::string word = {};
};

/// One column: rig channel = scale * column + offset.
struct RecordedChannel {
  std::string channel, column;
  std::vector<double> values;  ///< as the rig channel, SI; not-a-number = missing
  double scale = 1.0, offset = 0.0;
  int digits = 9;  ///< significant digits written
};

struct RecordingData {
  std::string file;
  bool holdout = false;
  std::vector<SetupEntry> setup = {};
  std::vector<RecordedChannel> channels = {};  ///< the first is time
};

/// What is laid before the one who is examined, and the truth about it.
struct CaseData {
  std::string name, rig;
  std::vector<SetupEntry> noise = {}, setup = {};
  std::vector<RecordingData> recordings = {};
  nlohmann::ordered_json truth = {};
  std::vector<CaseData> beside = {};  ///< data sets of the same machine: rigid.toml
};

/// Writes dataset.toml and the recordings by the contract's section 1. `file` is the data set's.
void write_case(const std::filesystem::path& folder, const std::string& file, const CaseData& data);

}  // namespace hoof::tools::conceal
