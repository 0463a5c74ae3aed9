#pragma once

#include <string>
#include <vector>

namespace hoof::tools::conceal {

/// What a case is to be, drawn before anything else of it.
struct CaseRequest {
  std::string kind;  ///< "none", "none_wrong_parameters", "one", "pair", "unknown", "not_decidable"
  std::vector<std::string> effects;  ///< to hide
  std::vector<std::string> alike;    ///< not_decidable: the set that the data cannot tell apart
  bool stiff = false;                ///< under a stiff position loop
};

}  // namespace hoof::tools::conceal
