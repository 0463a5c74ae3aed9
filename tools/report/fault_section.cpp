#include "tools/report/fault_section.h"

#include <cstdio>

#include "tools/report/html.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Null where the run has none, or where somebody else wrote it.
const Json* object_in(const Json& result, const char* key) {
  const auto found = result.find(key);
  return found != result.end() && found->is_object() ? &*found : nullptr;
}

const Json* time_in(const Json& values, const char* key) {
  const auto found = values.find(key);
  return found != values.end() && found->is_number() ? &*found : nullptr;
}

std::string seconds(const Json& values, const char* key, const char* otherwise) {
  const Json* time_s = time_in(values, key);
  if (time_s == nullptr) return otherwise;
  char text[32];
  std::snprintf(text, sizeof text, "%.3f s", time_s->get<double>());
  return text;
}

std::string text_in(const Json& values, const char* key) {
  const auto found = values.find(key);
  if (found == values.end()) return "";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

std::string cell(const std::string& text) {
  return element("td", text);
}

std::string row(const char* label, const std::string& value) {
  return "<tr>" + element("th", label, " scope=\"row\"") + cell(value) + "</tr>\n";
}

std::string reaction_table(const Json& reaction) {
  const std::string bits = text_in(reaction, "faults");
  std::string html = "<table>";
  html += row("Firmware's faults", bits.empty() ? "none" : bits);
  html += row("first told at", seconds(reaction, "tripped_s", "never"));
  html += row("no drive pushed from", seconds(reaction, "safe_s", "never"));
  html += row("from the begin of the last fault before it to there",
              seconds(reaction, "from_fault_to_safe_s", "never"));
  html +=
      row("reset worked at", seconds(reaction, "reset_s", bits.empty() ? "not needed" : "never"));
  html += row("mode at the end", text_in(reaction, "mode"));
  if (const std::string why = text_in(reaction, "ended_by"); !why.empty()) {
    html += row("ended the test", why);
  }
  return html + "</table>";
}

void add_mark(Json& marks, const Json& values, const char* key, const std::string& name) {
  if (const Json* time_s = time_in(values, key)) {
    marks.push_back({{"time_s", *time_s}, {"name", name}});
  }
}

}  // namespace

std::string fault_section(const Json& result) {
  const Json* faults = object_in(result, "faults");
  const Json* reaction = object_in(result, "reaction");
  if (faults == nullptr || reaction == nullptr) return "";
  std::string html =
      "<h2>Faults put in</h2>\n<table class=\"faults\"><tr><th>fault</th><th>began</th>"
      "<th>ended</th><th>changed</th></tr>\n";
  for (const auto& [name, fault] : faults->items()) {
    html += "<tr>" + element("th", name, " scope=\"row\"") +
            cell(seconds(fault, "began_s", "never")) +
            cell(seconds(fault, "ended_s", "with the run")) + cell(text_in(fault, "changed")) +
            "</tr>\n";
  }
  return html +
         "</table>\n<p class=\"note\">Changed: frames, samples, torques or ticks that were not as "
         "without the fault.</p>\n" +
         reaction_table(*reaction) + "\n";
}

std::string json_fault_marks(const Json& result) {
  Json marks = Json::array();
  if (const Json* faults = object_in(result, "faults")) {
    for (const auto& [name, fault] : faults->items()) {
      add_mark(marks, fault, "began_s", name);
      add_mark(marks, fault, "ended_s", "end");
    }
  }
  if (const Json* reaction = object_in(result, "reaction")) {
    add_mark(marks, *reaction, "tripped_s", text_in(*reaction, "faults"));
    add_mark(marks, *reaction, "safe_s", "safe");
  }
  return marks.dump();
}

}  // namespace hoof::tools
