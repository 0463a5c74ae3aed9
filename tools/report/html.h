#pragma once

#include <string>
#include <string_view>

namespace hoof::tools {

/// `text` with & < > " as entities, safe in HTML text and in attribute values.
std::string html_escape(std::string_view text);

/// JSON text made safe inside a <script> element: "<" can neither close it nor open a comment.
std::string json_for_script(std::string_view json);

/// "<tag>escaped text</tag>"; `attributes` as " class=\"number\"", with its leading blank.
std::string element(std::string_view tag, std::string_view text, std::string_view attributes = "");

/// The first letter as a capital: "angular speed" -> "Angular speed".
std::string capitalised(std::string text);

}  // namespace hoof::tools
