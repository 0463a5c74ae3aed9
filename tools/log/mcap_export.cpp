#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "hil_bridge/recording.h"
#include "hil_bridge/telemetry_reader.h"
#include "tools/log/decoded_frame.h"
#include "tools/log/export.h"
#include "tools/log/mcap_writer.h"
#include "tools/report/sample_table.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;
namespace protocol = firmware::protocol;
using Json = nlohmann::ordered_json;

Json object_schema(const std::string& title) {
  return {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
          {"title", title},
          {"type", "object"},
          {"properties", Json::object()}};
}

std::string frame_schema() {
  Json schema = object_schema("CAN frame");
  Json& p = schema["properties"];
  p["id"] = {{"type", "integer"}, {"description", "Identifier"}};
  p["length"] = {{"type", "integer"}, {"description", "Bytes of data"}};
  p["data"] = {{"type", "array"}, {"items", {{"type", "integer"}}}};
  for (const char* flag : {"extended", "remote", "error", "fd"}) p[flag] = {{"type", "boolean"}};
  return schema.dump();
}

/// Each signal with its unit and meaning, as the dictionary has them.
std::string message_schema(const MessageSpec& message) {
  Json schema = object_schema(std::string(message.name));
  schema["description"] = std::string(message.comment);
  for (const Signal& signal : message.signals) {
    Json entry = {{"type", is_whole(signal) ? "integer" : "number"}};
    std::string description(signal.comment);
    if (!signal.unit.empty()) description += " [" + std::string(signal.unit) + "]";
    for (const protocol::ValueName& v : signal.values) {
      description += (&v == &signal.values.front() ? ": " : ", ") + std::to_string(v.value) + " " +
                     std::string(v.name);
    }
    if (!description.empty()) entry["description"] = description;
    schema["properties"][std::string(signal.name)] = std::move(entry);
  }
  return schema.dump();
}

std::string raw_json(const hal::CanFrame& frame) {
  std::string json = "{\"id\":" + std::to_string(frame.id) +
                     ",\"length\":" + std::to_string(int{frame.length}) + ",\"data\":[";
  for (int i = 0; i < frame.length && !frame.remote; ++i) {
    json += (i > 0 ? "," : "") + std::to_string(int{frame.data[i]});
  }
  const auto flag = [&](const char* name, bool set) {
    json += std::string(",\"") + name + "\":" + (set ? "true" : "false");
  };
  json += ']';
  flag("extended", frame.extended);
  flag("remote", frame.remote);
  flag("error", frame.error);
  flag("fd", frame.fd);
  return json + '}';
}

/// One message that waits for its turn in time.
struct Pending {
  std::int64_t time_ns;
  std::uint16_t channel;
  std::string json;
};

/// samples.csv, its rows at the simulated time they tell.
void add_samples(McapWriter& writer, const fs::path& file, std::vector<Pending>& out) {
  const SampleTable table = read_samples(file);
  const SampleColumn* time = table.find("time_s");
  if (time == nullptr) return;
  Json schema = object_schema("samples.csv");
  for (const SampleColumn& c : table.columns) {
    schema["properties"][c.name] = {{"type", c.is_text() ? "string" : "number"}};
  }
  const std::uint16_t channel = writer.add_channel("/samples", "samples", schema.dump());
  for (std::size_t i = 0; i < time->numbers.size(); ++i) {
    std::string json = "{";
    for (const SampleColumn& c : table.columns) {
      if (json.size() > 1) json += ',';
      json += '"' + c.name + "\":";
      if (c.is_text()) {
        json += Json(c.texts[i]).dump();
      } else {
        json += std::isfinite(c.numbers[i]) ? format_number(c.numbers[i]) : "null";
      }
    }
    out.push_back(
        {bridge::kSimulatedEpoch_ns + std::llround(time->numbers[i] * 1e9), channel, json + '}'});
  }
}

/// The per-joint values of one telemetry row by name, as they are in telemetry.lcm.
std::vector<std::pair<std::string, double>> joint_values(const bridge::TelemetryRow& row) {
  std::vector<std::pair<std::string, double>> values;
  const char* const joints[] = {"toe", "hip", "knee"};
  for (std::size_t j = 0; j < 3; ++j) {
    const auto add = [&](const char* kind, const bridge::TelemetryJoint& joint) {
      const std::string name = std::string(kind) + "_" + joints[j];
      values.emplace_back(name + "_rad", joint.position_rad);
      values.emplace_back(name + "_rad_s", joint.velocity_rad_s);
      values.emplace_back(name + "_Nm", joint.torque_Nm);
    };
    add("desired", row.desired[j]);
    add("measured", row.measured[j]);
  }
  return values;
}

Json telemetry_json(const bridge::TelemetryRow& row) {
  Json json = {{"tick", row.tick},
               {"depth_m", row.depth_m},
               {"sink_speed_m_s", row.sink_speed_m_s},
               {"fx_N", row.foot_force_N[0]},
               {"fy_N", row.foot_force_N[1]},
               {"fz_N", row.foot_force_N[2]},
               {"mx_Nm", row.foot_torque_Nm[0]},
               {"my_Nm", row.foot_torque_Nm[1]},
               {"mz_Nm", row.foot_torque_Nm[2]}};
  for (const auto& [name, value] : joint_values(row)) json[name] = value;
  json["mode"] = row.mode;
  json["fault_bits"] = row.fault_bits;
  json["limit_bits"] = row.limit_bits;
  return json;
}

void add_telemetry(McapWriter& writer, const fs::path& file, std::vector<Pending>& out) {
  Json schema = object_schema("telemetry.lcm");
  const Json example = telemetry_json({});
  for (const auto& [name, value] : example.items()) {
    schema["properties"][name] = {{"type", value.is_number_float() ? "number" : "integer"}};
  }
  const std::uint16_t channel = writer.add_channel("/telemetry", "telemetry", schema.dump());
  for (const bridge::TelemetryRow& row : bridge::read_telemetry(file.string())) {
    out.push_back({bridge::kSimulatedEpoch_ns + row.time_ns, channel, telemetry_json(row).dump()});
  }
}

class BusChannels {
 public:
  explicit BusChannels(McapWriter& writer) : writer_(writer) {}

  void write(const BusRecording& recording, const LoggedFrame& logged) {
    auto& raw = raw_[logged.bus];
    if (raw == 0) {
      raw = writer_.add_channel("/bus" + std::to_string(logged.bus), "can_frame", frame_schema(),
                                {{"interface", recording.interfaces[std::size_t(logged.bus)]}});
    }
    writer_.message(raw, logged.stamp_ns, raw_json(logged.frame));
    const MessageSpec* message = find_message(logged.frame);
    if (message == nullptr || !frame_fault(*message, logged.frame).empty()) return;
    if (!drive_switch(*message, logged.frame).empty()) return;  // no values: see the raw frame
    auto& decoded = decoded_[{message->id, logged.bus}];
    if (decoded == 0) decoded = add(*message, logged.bus);
    writer_.message(decoded, logged.stamp_ns, signals_json(*message, logged.frame));
  }

 private:
  /// SYNC goes over both buses: there the topic tells which.
  std::uint16_t add(const MessageSpec& message, int bus) {
    const bool both = message.buses == (protocol::kBus0 | protocol::kBus1);
    const std::string name(message.name);
    return writer_.add_channel("/" + name + (both ? "/bus" + std::to_string(bus) : ""), name,
                               message_schema(message));
  }

  McapWriter& writer_;
  std::map<int, std::uint16_t> raw_;
  std::map<std::pair<std::uint32_t, int>, std::uint16_t> decoded_;
};

}  // namespace

std::uint64_t export_mcap(const BusRecording& recording, const fs::path& run_folder,
                          const fs::path& path) {
  McapWriter writer(path);
  writer.metadata("recording", {{"source", recording.path.filename().string()},
                                {"origin_ns", std::to_string(recording.origin_ns)}});
  std::vector<Pending> pending;
  if (!run_folder.empty() && fs::exists(run_folder / "samples.csv")) {
    add_samples(writer, run_folder / "samples.csv", pending);
  }
  if (!run_folder.empty() && fs::exists(run_folder / "telemetry.lcm")) {
    add_telemetry(writer, run_folder / "telemetry.lcm", pending);
  }
  std::stable_sort(pending.begin(), pending.end(),
                   [](const Pending& a, const Pending& b) { return a.time_ns < b.time_ns; });
  BusChannels channels(writer);
  auto next = pending.begin();
  const auto write_until = [&](std::int64_t time_ns) {
    for (; next != pending.end() && next->time_ns < time_ns; ++next) {
      writer.message(next->channel, next->time_ns, next->json);
    }
  };
  for (const LoggedFrame& logged : recording.frames) {
    write_until(logged.stamp_ns);
    channels.write(recording, logged);
  }
  write_until(INT64_MAX);
  writer.close();
  return writer.messages();
}

}  // namespace hoof::tools
