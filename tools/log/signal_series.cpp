#include "tools/log/signal_series.h"

#include <algorithm>
#include <map>

#include "tools/log/decoded_frame.h"
#include "tools/report/sample_table.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

bool wanted(const std::vector<std::string>& patterns, const std::string& name) {
  return patterns.empty() || matches_any(patterns, name);
}

/// Texts as numbers, in the order of their first appearance.
void take_texts(const SampleColumn& column, SignalSeries& series) {
  auto& names = series.value_names;
  for (const std::string& text : column.texts) {
    auto at = std::find(names.begin(), names.end(), text);
    if (at == names.end()) at = names.insert(names.end(), text);
    series.values.push_back(double(at - names.begin()));
  }
}

}  // namespace

std::vector<SignalSeries> series_of(const BusRecording& recording,
                                    const std::vector<std::string>& patterns) {
  struct Curve {
    const Signal* signal;
    SignalSeries series;
  };
  // By place in the dictionary, so that curves come in its order.
  std::map<const MessageSpec*, std::vector<Curve>> curves;
  for (const MessageSpec& message : firmware::protocol::kMessages) {
    for (const Signal& signal : message.signals) {
      const std::string name = signal_name(message, signal);
      if (!wanted(patterns, name)) continue;
      curves[&message].push_back({&signal, {name, is_whole(signal), {}, {}, {}}});
    }
  }
  for (const LoggedFrame& logged : recording.frames) {
    const MessageSpec* message = find_message(logged.frame);
    const auto found = curves.find(message);
    if (message == nullptr || found == curves.end()) continue;
    const bool twice =
        message->id == firmware::protocol::spec(firmware::protocol::Message::kSync).id;
    if (twice && logged.bus != 0) continue;
    if (!frame_fault(*message, logged.frame).empty()) continue;
    if (!drive_switch(*message, logged.frame).empty()) continue;
    for (Curve& curve : found->second) {
      curve.series.time_s.push_back(recording.time_s(logged));
      curve.series.values.push_back(value_of(*curve.signal, logged.frame));
    }
  }
  std::vector<SignalSeries> all;
  for (auto& [message, of_message] : curves) {
    for (Curve& curve : of_message) {
      if (!curve.series.values.empty()) all.push_back(std::move(curve.series));
    }
  }
  return all;
}

std::vector<SignalSeries> series_of_samples(const std::filesystem::path& samples_csv,
                                            const std::vector<std::string>& patterns) {
  const SampleTable table = read_samples(samples_csv);
  const SampleColumn* time = table.find("time_s");
  if (time == nullptr) throw UserError(samples_csv.string() + ": no column time_s");
  std::vector<SignalSeries> all;
  for (const SampleColumn& column : table.columns) {
    if (&column == time || !wanted(patterns, column.name)) continue;
    SignalSeries series{column.name, column.is_text(), time->numbers, column.numbers, {}};
    if (column.is_text()) take_texts(column, series);
    all.push_back(std::move(series));
  }
  return all;
}

}  // namespace hoof::tools
