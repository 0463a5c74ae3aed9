#pragma once

#include <filesystem>

namespace hoof::tests {

/// Writes settings.toml, result.json and samples.csv of a made-up sinkage test (no physics: a
/// smooth settling curve and loads to match) with `sample_count` rows of 25 columns.
void write_synthetic_run(const std::filesystem::path& folder, int sample_count);

}  // namespace hoof::tests
