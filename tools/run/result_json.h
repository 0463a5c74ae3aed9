#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace hoof::tools {

/// The text of result.json and the like: keys in the order they were put, two blanks of indent,
/// shortest numbers that read back exactly. JSON has no not-a-number and nlohmann would write null
/// in its place, so a value that is not finite throws CannotFinish, which names its key.
std::string result_json_text(const nlohmann::ordered_json& result);
/// Writes that as a file.
void write_result_json(const std::filesystem::path& path, const nlohmann::ordered_json& result);

}  // namespace hoof::tools
