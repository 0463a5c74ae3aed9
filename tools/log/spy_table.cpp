#include "tools/log/spy_table.h"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace hoof::tools {
namespace {

constexpr char kHeading[] = "bus      id       message            frames    rate Hz  bytes";
/// The chosen message shows its signals in at most half the window, and in this many lines at most.
constexpr int kMostDetails = 16;
constexpr char kReversed[] = "\x1b[7m", kPlain[] = "\x1b[0m";

std::string cut_to(std::string line, int width) {
  if (width > 0 && line.size() > std::size_t(width)) line.resize(std::size_t(width));
  return line;
}

/// One line for each signal; what is wrong with the frame where it does not read.
std::vector<std::string> signal_lines(const hal::CanFrame& frame) {
  const MessageSpec* message = find_message(frame);
  if (message == nullptr) return {"  not in the dictionary"};
  if (const auto fault = frame_fault(*message, frame); !fault.empty()) {
    return {"  " + std::string(fault)};
  }
  if (const auto action = drive_switch(*message, frame); !action.empty()) {
    return {"  switch: " + std::string(action)};
  }
  std::vector<std::string> lines;
  for (const Signal& signal : message->signals) {
    char line[64];
    std::snprintf(line, sizeof line, "  %-20s ", std::string(signal.name).c_str());
    lines.push_back(line + described_value(signal, value_of(signal, frame)));
  }
  return lines;
}

std::vector<std::string> signal_lines(const bridge::LcmEvent& event) {
  const auto read = bridge::read_fields(event);
  if (!read) return {"  of a type that is not known here"};
  std::vector<std::string> lines;
  for (const auto& [name, value] : read->fields) {
    char line[64];
    std::snprintf(line, sizeof line, "  %-24s ", name.c_str());
    lines.push_back(line + value);
  }
  return lines;
}

std::string number_columns(std::uint64_t count, double rate_Hz) {
  char text[40];
  std::snprintf(text, sizeof text, "%7llu %9.1f  ", static_cast<unsigned long long>(count),
                rate_Hz);
  return text;
}

/// Bus, identifier and name.
std::string name_columns(const std::string& interface, const hal::CanFrame& frame) {
  const MessageSpec* message = find_message(frame);
  char text[80];
  std::snprintf(text, sizeof text, "%-8s %-8s %-18s ", interface.c_str(), id_text(frame).c_str(),
                message       ? std::string(message->name).c_str()
                : frame.error ? "(error frame)"
                              : "(unknown)");
  return text;
}

std::string name_columns(const std::string& channel, const bridge::LcmEvent&) {
  char text[80];
  std::snprintf(text, sizeof text, "%-8s %-27s ", "lcm", channel.c_str());
  return text;
}

std::string content(const hal::CanFrame& frame) {
  return payload_hex(frame);
}

std::string content(const bridge::LcmEvent& event) {
  const auto read = bridge::read_fields(event);
  return std::to_string(event.data.size()) + " bytes, " + (read ? read->type : "unknown type");
}

}  // namespace

void SpyTable::add(const std::string& interface, const hal::CanFrame& frame,
                   std::int64_t stamp_ns) {
  const std::uint64_t id =
      std::uint64_t(frame.error) << 33 | std::uint64_t(frame.extended) << 32 | frame.id;
  Row& row = rows_[{interface, id}];
  row.last = frame;
  count(row, stamp_ns);
}

void SpyTable::add(const bridge::LcmEvent& event) {
  Row& row = rows_[{event.channel, 0}];
  row.last = event;
  count(row, event.stamp_ns);
}

void SpyTable::count(Row& row, std::int64_t stamp_ns) {
  ++row.count;
  ++frames_;
  newest_ns_ = std::max(newest_ns_, stamp_ns);
  row.recent_ns.push_back(stamp_ns);
  while (row.recent_ns.front() < stamp_ns - kRateWindow_ns) row.recent_ns.pop_front();
}

/// From the first to the last frame of the window, so that it is right before the window is full.
double SpyTable::rate_Hz(const Row& row) const {
  const auto first =
      std::lower_bound(row.recent_ns.begin(), row.recent_ns.end(), newest_ns_ - kRateWindow_ns);
  const auto count = row.recent_ns.end() - first;
  if (count < 2 || row.recent_ns.back() == *first) return 0;
  return double(count - 1) * 1e9 / double(row.recent_ns.back() - *first);
}

std::string SpyTable::line_of(const Key& key, const Row& row) const {
  return std::visit(
      [&](const auto& last) {
        return name_columns(key.first, last) + number_columns(row.count, rate_Hz(row)) +
               content(last);
      },
      row.last);
}

std::vector<std::string> SpyTable::details_of(const Row& row) {
  return std::visit([](const auto& last) { return signal_lines(last); }, row.last);
}

std::string SpyTable::render(const std::string& title, int selected, int width, int height) const {
  const bool bounded = height > 0;
  std::vector<std::string> out = {cut_to(title, width), cut_to(kHeading, width)};
  selected = std::clamp(selected, 0, std::max(0, messages() - 1));
  const int below = std::min(1 + kMostDetails, height / 2);  // a blank, and the signals
  const int room = bounded ? std::max(1, height - int(out.size()) - below) : messages();
  const int first = std::clamp(selected - room / 2, 0, std::max(0, messages() - room));
  int n = 0;
  std::vector<std::string> details;
  for (const auto& [key, row] : rows_) {
    const bool chosen = bounded && n == selected;
    if (chosen) details = details_of(row);
    if (n >= first && n < first + room) {
      const std::string line = cut_to(line_of(key, row), width);
      out.push_back(chosen ? kReversed + line + kPlain : line);
      if (!bounded) {
        for (std::string& signal : details_of(row)) out.push_back("         " + signal);
      }
    }
    ++n;
  }
  if (bounded) {
    out.emplace_back();
    for (const std::string& line : details) out.push_back(cut_to(line, width));
    if (int(out.size()) > height) out.resize(std::size_t(height));
  }
  std::string text;
  for (const std::string& line : out) text += line + "\n";
  return text;
}

}  // namespace hoof::tools
