// The frame of every page we write: one file, style and scripts inside, no network.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hoof::tools {

/// @param body HTML between heading and scripts
/// @param samples_json what page.js draws; see there
std::string make_page(const std::string& title, const std::string& body,
                      std::string_view samples_json);

/// A JSON array of `factor` times the values, in the digits that a plot shows; "null" where not
/// finite.
std::string json_numbers(const std::vector<double>& values, double factor);

}  // namespace hoof::tools
