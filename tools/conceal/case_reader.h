#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace hoof::tools::conceal {

struct ReadRecording {
  bool holdout = false;
  std::map<std::string, double> setup;  ///< the case's and the recording's own, doubts left out
  std::map<std::string, std::vector<double>> channels;

  const std::vector<double>& at(const std::string& channel) const { return channels.at(channel); }
  bool has(const std::string& channel) const { return channels.contains(channel); }
  double value(const std::string& key, double otherwise) const;
};

struct ReadCase {
  std::string rig, law;
  std::vector<ReadRecording> recordings;
};

/// Reads a case as `make` wrote it, for the baselines: what the tool gets, and nothing of the
/// truth. Samples with a missing value are left out.
ReadCase read_case(const std::filesystem::path& dataset);

}  // namespace hoof::tools::conceal
