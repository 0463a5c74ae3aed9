#include "tools/log/spy_table.h"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace hoof::tools {
namespace {

constexpr char kHeading[] = "bus      id       message            frames    rate Hz  bytes";
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

}  // namespace

void SpyTable::add(const std::string& interface, const hal::CanFrame& frame,
                   std::int64_t stamp_ns) {
  const std::uint64_t id =
      std::uint64_t(frame.error) << 33 | std::uint64_t(frame.extended) << 32 | frame.id;
  Row& row = rows_[{interface, id}];
  row.frame = frame;
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
  const MessageSpec* message = find_message(row.frame);
  char line[160];
  std::snprintf(line, sizeof line, "%-8s %-8s %-18s %7llu %9.1f  ", key.first.c_str(),
                id_text(row.frame).c_str(),
                message           ? std::string(message->name).c_str()
                : row.frame.error ? "(error frame)"
                                  : "(unknown)",
                static_cast<unsigned long long>(row.count), rate_Hz(row));
  return line + payload_hex(row.frame);
}

std::string SpyTable::render(const std::string& title, int selected, int width, int height) const {
  const bool bounded = height > 0;
  std::vector<std::string> out = {cut_to(title, width), cut_to(kHeading, width)};
  selected = std::clamp(selected, 0, std::max(0, messages() - 1));
  const int below = 9;  // a blank, and the most signals that a message has
  const int room = bounded ? std::max(1, height - int(out.size()) - below) : messages();
  const int first = std::clamp(selected - room / 2, 0, std::max(0, messages() - room));
  int n = 0;
  std::vector<std::string> details;
  for (const auto& [key, row] : rows_) {
    const bool chosen = bounded && n == selected;
    if (chosen) details = signal_lines(row.frame);
    if (n >= first && n < first + room) {
      const std::string line = cut_to(line_of(key, row), width);
      out.push_back(chosen ? kReversed + line + kPlain : line);
      if (!bounded) {
        for (std::string& signal : signal_lines(row.frame)) out.push_back("         " + signal);
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
