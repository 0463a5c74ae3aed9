#include "tools/diagnose/channel_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/diagnose/csv_table.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

constexpr std::size_t kLeastSamples = 2;

ChannelSource read_source(const TomlView& channels, const std::string& channel) {
  if (!channels.is_table(channel)) {
    try {
      return {channels.text(channel), 1, 0, channels};
    } catch (const UserError&) {
      channels.fail(channel,
                    "must be the name of a column, or { column = ..., scale = ..., offset = ... }");
    }
  }
  static const std::array<std::string, 3> kParts = {"column", "scale", "offset"};
  const TomlView parts = channels.table(channel);
  parts.allow_only(kParts);
  ChannelSource source{parts.text("column"), 1, 0, channels};
  if (parts.has("scale")) source.scale = parts.number("scale", Allowed::kAny);
  if (source.scale == 0) parts.fail("scale", "must be a finite number other than zero");
  if (parts.has("offset")) source.offset = parts.number("offset", Allowed::kAny);
  return source;
}

std::vector<double> scaled(const std::vector<double>& column, const ChannelSource& source) {
  std::vector<double> values = column;
  for (double& value : values) value = source.scale * value + source.offset;
  return values;
}

int find_column(const CsvTable& table, const std::string& channel, const ChannelSource& source) {
  const int index = table.find(source.column);
  if (index >= 0) return index;
  source.stated_in.fail(channel, table.file + " has no column " + source.column +
                                     did_you_mean(source.column, "its columns", table.names));
}

/// Refuses time that is missing or does not increase.
void check_time(const CsvTable& table, const std::vector<double>& time_s,
                const ChannelSource& source) {
  const auto fail = [&](std::size_t row, const std::string& what) {
    throw UserError(table.file + ":" + std::to_string(table.lines[row]) + ": " + source.column +
                    what);
  };
  for (std::size_t i = 0; i < time_s.size(); ++i) {
    if (std::isnan(time_s[i])) fail(i, ": time is missing; every row needs it");
    if (i == 0 || time_s[i] > time_s[i - 1]) continue;
    fail(i, ": time " + format_number(time_s[i]) + " s follows " + format_number(time_s[i - 1]) +
                " s of line " + std::to_string(table.lines[i - 1]) + "; it must increase");
  }
}

/// Rows from first (included) to last (excluded) lie in the window.
std::pair<std::size_t, std::size_t> rows_within(const std::vector<double>& time_s,
                                                std::optional<TimeWindow> window,
                                                const TomlView& stated_in) {
  if (!window) return {0, time_s.size()};
  const auto first = std::lower_bound(time_s.begin(), time_s.end(), window->from_s);
  const auto last = std::upper_bound(first, time_s.end(), window->to_s);
  if (std::size_t(last - first) < kLeastSamples) {
    stated_in.fail("window", "must hold at least " + std::to_string(kLeastSamples) +
                                 " samples; the file runs from " + format_number(time_s.front()) +
                                 " to " + format_number(time_s.back()) + " s");
  }
  return {std::size_t(first - time_s.begin()), std::size_t(last - time_s.begin())};
}

}  // namespace

ChannelSources read_channel_sources(const TomlView& table, const RigKeys& rig,
                                    const ChannelSources& base) {
  table.allow_only(rig.channels, "channel of rig " + rig.name);
  ChannelSources sources = base;
  for (const std::string& channel : table.keys()) {
    sources.insert_or_assign(channel, read_source(table, channel));
  }
  return sources;
}

void read_channels(const ChannelSources& sources, std::optional<TimeWindow> window,
                   const TomlView& stated_in, Recording& recording) {
  std::set<std::string> wanted;
  for (const auto& [channel, source] : sources) wanted.insert(source.column);
  const CsvTable table = read_csv(recording.path, wanted);
  std::map<std::string, std::vector<double>> all;
  for (const auto& [channel, source] : sources) {
    all[channel] = scaled(table.columns[std::size_t(find_column(table, channel, source))], source);
  }
  const std::vector<double>& time_s = all.at("time");
  check_time(table, time_s, sources.at("time"));
  if (time_s.size() < kLeastSamples) {
    throw UserError(table.file + ": " + std::to_string(time_s.size()) +
                    " row(s) of numbers; at least " + std::to_string(kLeastSamples) +
                    " are needed");
  }
  const auto [first, last] = rows_within(time_s, window, stated_in);
  for (auto& [channel, values] : all) {
    std::vector<double> part(values.begin() + std::ptrdiff_t(first),
                             values.begin() + std::ptrdiff_t(last));
    if (channel != "time")
      recording.channels[channel] = std::move(part);
    else
      recording.time_s = std::move(part);
  }
}

}  // namespace hoof::tools
