#include "tools/conceal/case_data.h"

#include <cmath>
#include <cstdio>

#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools::conceal {
namespace {

std::string number(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

/// TOML asks for a point or an exponent in a floating-point number; both kinds are allowed here,
/// but a reader should not have to care.
std::string toml_number(double value) {
  std::string text = number(value, 9);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string toml_value(const SetupEntry& entry) {
  if (!entry.word.empty()) return "\"" + entry.word + "\"";
  if (entry.sigma <= 0.0) return toml_number(entry.value);
  return "{ value = " + toml_number(entry.value) + ", sigma = " + toml_number(entry.sigma) + " }";
}

std::string inline_table(const std::vector<SetupEntry>& entries) {
  std::string text = "{ ";
  for (std::size_t i = 0; i < entries.size(); ++i) {
    text += (i > 0 ? ", " : "") + entries[i].key + " = " + toml_value(entries[i]);
  }
  return text + " }";
}

std::string channel_line(const RecordedChannel& c) {
  if (c.scale == 1.0 && c.offset == 0.0) return c.channel + " = \"" + c.column + "\"\n";
  return c.channel + " = { column = \"" + c.column + "\", scale = " + number(c.scale, 17) +
         ", offset = " + toml_number(c.offset) + " }\n";
}

std::string dataset_text(const CaseData& data) {
  std::string text = "format = 1\nname = \"" + data.name + "\"\nrig = \"" + data.rig + "\"\n";
  if (!data.noise.empty()) text += "noise = " + inline_table(data.noise) + "\n";
  text += "\n[setup]\n";
  for (const SetupEntry& entry : data.setup) text += entry.key + " = " + toml_value(entry) + "\n";
  for (const RecordingData& recording : data.recordings) {
    text += "\n[[recording]]\ndata = \"" + recording.file + "\"\nrole = \"" +
            (recording.holdout ? "holdout" : "fit") + "\"\n";
    if (!recording.setup.empty()) text += "setup = " + inline_table(recording.setup) + "\n";
    text += "[recording.channels]\n";
    for (const RecordedChannel& c : recording.channels) text += channel_line(c);
  }
  return text;
}

std::string csv_text(const RecordingData& recording) {
  std::string text;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    text += (i > 0 ? "," : "") + recording.channels[i].column;
  }
  text += "\n";
  for (std::size_t row = 0; row < recording.channels.front().values.size(); ++row) {
    for (std::size_t i = 0; i < recording.channels.size(); ++i) {
      const RecordedChannel& c = recording.channels[i];
      if (i > 0) text += ",";
      if (std::isfinite(c.values[row])) {
        text += number((c.values[row] - c.offset) / c.scale, c.digits);
      }
    }
    text += "\n";
  }
  return text;
}

}  // namespace

void write_case(const std::filesystem::path& folder, const std::string& file,
                const CaseData& data) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw UserError(folder.string() + ": " + error.message());
  for (const RecordingData& recording : data.recordings) {
    write_file(folder / recording.file, csv_text(recording));
  }
  write_file(folder / file, dataset_text(data));
  for (const CaseData& other : data.beside) write_case(folder, "rigid.toml", other);
}

}  // namespace hoof::tools::conceal
