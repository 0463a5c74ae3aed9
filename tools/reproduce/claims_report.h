// What hoof claims prints and writes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/reproduce/claims.h"

namespace hoof::tools {

/// A table, a row for each claim, and below it why each is not supported.
std::string claims_text(const std::vector<JudgedClaim>& claims);

/// claims.json (runs and intervals), claims.csv (a row for each contrast and variation),
/// claims.html (intervals drawn). Equal runs give equal bytes. @throws UserError
void write_claims(const std::filesystem::path& folder, const std::vector<JudgedClaim>& claims,
                  const std::vector<const Variation*>& variations);

}  // namespace hoof::tools
