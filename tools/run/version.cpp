#include "tools/run/version.h"

#include "tools/run/version_data.h"

namespace hoof::tools {

Version build_version() {
  return {kVersionCode, kVersionCompiler, kVersionBuildType};
}

nlohmann::ordered_json version_json() {
  const Version version = build_version();
  return {{"code", version.code}, {"compiler", version.compiler}, {"build", version.build_type}};
}

}  // namespace hoof::tools
