#include "tools/log/export.h"

#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "hil_bridge/candump.h"
#include "tools/log/decoded_frame.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

namespace protocol = firmware::protocol;

/// A column of the CSV table.
struct Column {
  const MessageSpec* message;
  const Signal* signal;
};

std::vector<Column> wanted_columns(const BusRecording& recording,
                                   const std::vector<std::string>& patterns) {
  std::set<const MessageSpec*> occurring;
  for (const LoggedFrame& logged : recording.frames) occurring.insert(find_message(logged.frame));
  std::vector<Column> columns;
  for (const MessageSpec& message : protocol::kMessages) {
    if (occurring.count(&message) == 0) continue;
    for (const Signal& signal : message.signals) {
      if (patterns.empty() || matches_any(patterns, signal_name(message, signal))) {
        columns.push_back({&message, &signal});
      }
    }
  }
  return columns;
}

/// Seconds with microseconds, as the log has them.
std::string time_text(const BusRecording& recording, const LoggedFrame& logged) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6f", recording.time_s(logged));
  return text;
}

/// Whether the frame's bytes are values of its message.
bool has_values(const MessageSpec* message, const hal::CanFrame& frame) {
  return message != nullptr && frame_fault(*message, frame).empty() &&
         drive_switch(*message, frame).empty();
}

}  // namespace

void export_csv(const BusRecording& recording, const std::vector<std::string>& signals,
                std::ostream& out) {
  const std::vector<Column> columns = wanted_columns(recording, signals);
  out << "time_s";
  for (const Column& c : columns) out << ',' << signal_name(*c.message, *c.signal);
  out << '\n';
  for (const LoggedFrame& logged : recording.frames) {
    const MessageSpec* message = find_message(logged.frame);
    if (!has_values(message, logged.frame)) continue;
    std::string row;
    bool any = false;
    for (const Column& c : columns) {
      row += ',';
      if (c.message != message) continue;
      row += value_text(*c.signal, value_of(*c.signal, logged.frame));
      any = true;
    }
    if (any) out << time_text(recording, logged) << row << '\n';
  }
}

std::string signals_json(const MessageSpec& message, const hal::CanFrame& frame) {
  std::string json = "{";
  for (const Signal& signal : message.signals) {
    if (json.size() > 1) json += ',';
    json += '"' + std::string(signal.name) + "\":" + value_text(signal, value_of(signal, frame));
  }
  return json + '}';
}

std::string frame_json(const BusRecording& recording, const LoggedFrame& logged) {
  const hal::CanFrame& frame = logged.frame;
  std::string json =
      "{\"time_s\":" + time_text(recording, logged) + ",\"bus\":" + std::to_string(logged.bus) +
      ",\"id\":" + std::to_string(frame.id) + ",\"data\":\"" + payload_hex(frame) + '"';
  if (frame.extended) json += ",\"extended\":true";
  if (frame.remote) json += ",\"remote\":true,\"length\":" + std::to_string(int{frame.length});
  if (frame.error) json += ",\"error\":true";
  if (frame.fd) json += ",\"fd\":true";
  const MessageSpec* message = find_message(frame);
  if (message == nullptr) return json + "}";
  json += ",\"name\":\"" + std::string(message->name) + '"';
  const std::string_view fault = frame_fault(*message, frame);
  if (!fault.empty()) return json + ",\"fault\":\"" + std::string(fault) + "\"}";
  if (const auto action = drive_switch(*message, frame); !action.empty()) {
    return json + ",\"switch\":\"" + std::string(action) + "\"}";
  }
  return json + ",\"signals\":" + signals_json(*message, frame) + "}";
}

void export_json(const BusRecording& recording, std::ostream& out) {
  for (const LoggedFrame& logged : recording.frames) out << frame_json(recording, logged) << '\n';
}

void export_candump(const BusRecording& recording, std::ostream& out) {
  std::string line;
  for (const LoggedFrame& logged : recording.frames) {
    line.clear();
    bridge::append_candump_line(line, logged.stamp_ns,
                                recording.interfaces[std::size_t(logged.bus)], logged.frame);
    out << line;
  }
}

}  // namespace hoof::tools
