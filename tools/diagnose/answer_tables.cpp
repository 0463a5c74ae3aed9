#include "tools/diagnose/answer_tables.h"

#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

std::string row(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ",") + format_number(number);
  return text;
}

}  // namespace

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n#") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string residuals_csv(const std::vector<ChannelTrace>& traces) {
  std::string text =
      "recording,role,channel,time,measured,before,after,residual_before,residual_after\n";
  for (const ChannelTrace& t : traces) {
    const std::string head =
        csv_cell(t.recording) + (t.holdout ? ",holdout," : ",fit,") + csv_cell(t.channel) + ",";
    for (std::size_t i = 0; i < t.time_s.size(); ++i) {
      const double measured = t.measured.at(i), before = t.before.at(i), after = t.after.at(i);
      text += head +
              row({t.time_s[i], measured, before, after, measured - before, measured - after}) +
              "\n";
    }
  }
  return text;
}

std::string hypotheses_csv(const std::vector<HypothesisScore>& hypotheses) {
  std::string text =
      "name,parameters_count,log_likelihood,samples_count,evidence,holdout_gain,probability\n";
  for (const HypothesisScore& h : hypotheses) {
    text += csv_cell(h.name) + "," + std::to_string(h.parameters_count) + "," +
            row({h.log_likelihood, h.samples_count, h.evidence, h.holdout_gain, h.probability}) +
            "\n";
  }
  return text;
}

std::string prediction_csv(const Recording& recording, const std::vector<std::string>& channels,
                           const Prediction& prediction) {
  std::string text = "time";
  for (const std::string& channel : channels) text += "," + csv_cell(channel);
  for (const std::string& channel : channels) text += "," + csv_cell(channel + "_measured");
  text += "\n";
  for (std::size_t i = 0; i < recording.time_s.size(); ++i) {
    text += format_number(recording.time_s[i]);
    for (const auto& predicted : prediction) text += "," + format_number(predicted.at(i));
    for (const std::string& channel : channels) {
      text += "," + format_number(recording.channels.at(channel).at(i));
    }
    text += "\n";
  }
  return text;
}

}  // namespace hoof::tools
