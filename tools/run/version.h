#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace hoof::tools {

/// What was built, fixed at build time.
struct Version {
  std::string_view code;        ///< `git describe --always --dirty`, "unknown" outside git
  std::string_view compiler;    ///< "GNU 12.2.0"
  std::string_view build_type;  ///< "Release"
};

Version build_version();

/// The same as the "version" object of result.json.
nlohmann::ordered_json version_json();

}  // namespace hoof::tools
