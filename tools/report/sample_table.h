#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace hoof::tools {

/// One column of samples.csv: numbers, or texts where its name ends in "_name".
struct SampleColumn {
  std::string name;
  std::vector<double> numbers;
  std::vector<std::string> texts;

  bool is_text() const { return name.ends_with("_name"); }
};

/// samples.csv as CsvWriter (tools/run) writes it.
struct SampleTable {
  std::vector<SampleColumn> columns;

  /// Nullptr where there is no such column.
  const SampleColumn* find(const std::string& name) const;
};

/// UserError with file and line where a row has the wrong width or a number does not read.
SampleTable read_samples(const std::filesystem::path& path);

}  // namespace hoof::tools
