#include "tools/run/result_json.h"

#include <cmath>
#include <string>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

void require_finite(const nlohmann::ordered_json& value, const std::string& key) {
  if (value.is_structured()) {
    for (const auto& item : value.items()) {
      require_finite(item.value(), key.empty() ? item.key() : key + "." + item.key());
    }
  } else if (value.is_number_float() && !std::isfinite(value.get<double>())) {
    throw CannotFinish("result to be written: " + key + " is not a finite number");
  }
}

}  // namespace

std::string result_json_text(const nlohmann::ordered_json& result) {
  require_finite(result, "");
  return result.dump(2) + "\n";
}

void write_result_json(const std::filesystem::path& path, const nlohmann::ordered_json& result) {
  write_file(path, result_json_text(result));
}

}  // namespace hoof::tools
