#include "tools/report/html.h"

#include <cctype>

namespace hoof::tools {

std::string html_escape(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string json_for_script(std::string_view json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";  // the same character to a JSON parser
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string element(std::string_view tag, std::string_view text, std::string_view attributes) {
  std::string html = "<";
  html += tag;
  html += attributes;
  html += '>';
  html += html_escape(text);
  html += "</";
  html += tag;
  html += '>';
  return html;
}

std::string capitalised(std::string text) {
  if (!text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  return text;
}

}  // namespace hoof::tools
