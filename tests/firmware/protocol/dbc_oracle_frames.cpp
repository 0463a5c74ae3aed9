// Prints hoof.dbc and frames of every message with the values that were packed into them, as one
// JSON text, for a DBC parser that is not ours (dbc_oracle.mjs).
#include <charconv>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <tuple>
#include <type_traits>

#include "firmware/protocol/codec.h"
#include "firmware/protocol/dbc.h"

using namespace hoof::firmware::protocol;
using hoof::hal::CanFrame;
using nlohmann::json;

namespace {

constexpr int kFramesPerMessage = 200;

class Printer {
 public:
  explicit Printer(unsigned seed) : random_(seed) {}

  template <typename M>
  void add() {
    for (int n = 0; n < kFramesPerMessage; ++n) {
      const M message = random_message<M>(spec(M::kMessage));
      add_frame(spec(M::kMessage), encode(message), message);
    }
  }

  void add_drive(Drive drive) {
    for (int n = 0; n < kFramesPerMessage; ++n) {
      const auto command = random_message<DriveCommand>(command_spec(drive));
      add_frame(command_spec(drive), encode_command(drive, command), command);
      auto reply = random_message<DriveReply>(reply_spec(drive));
      reply.drive_id = drive_id(drive);
      add_frame(reply_spec(drive), encode_reply(drive, reply), reply);
    }
  }

  const json& frames() const { return frames_; }

 private:
  template <typename M>
  M random_message(const MessageSpec& spec) {
    M message;
    const Signal* signal = spec.signals.data();
    const auto fill = [&](auto& member) { member = random_value<decltype(member)>(*signal++); };
    std::apply([&](auto... field) { (fill(message.*field), ...); }, M::fields());
    return message;
  }

  template <typename Member>
  std::remove_reference_t<Member> random_value(const Signal& signal) {
    using T = std::remove_reference_t<Member>;
    if constexpr (std::is_floating_point_v<T>) {
      return std::uniform_real_distribution<float>(signal.minimum, signal.maximum)(random_);
    } else if constexpr (std::is_enum_v<T>) {
      return static_cast<T>(signal.values[random_() % signal.values.size()].value);
    } else if constexpr (std::is_same_v<T, bool>) {
      return random_() % 2 != 0;
    } else {
      return static_cast<T>(random_() & signal.largest_raw());
    }
  }

  template <typename M>
  void add_frame(const MessageSpec& spec, const CanFrame& frame, const M& message) {
    json values = json::object();
    const Signal* signal = spec.signals.data();
    const auto note = [&](auto value) { values[std::string(signal++->name)] = number(value); };
    std::apply([&](auto... field) { (note(message.*field), ...); }, M::fields());
    if (spec.crc) note(frame.data[spec.length - 1u]);
    json bytes = json::array();
    for (int i = 0; i < frame.length; ++i) bytes.push_back(frame.data[i]);
    frames_.push_back({{"id", frame.id}, {"bytes", bytes}, {"values", values}});
  }

  template <typename T>
  static double number(T value) {
    return static_cast<double>(value);
  }

  std::mt19937 random_;
  json frames_ = json::array();
};

/// What the DBC must say of a signal, from the dictionary.
json described(const Signal& signal) {
  json names = json::object();
  for (const ValueName& value : signal.values) {
    names[std::to_string(value.value)] = std::string(value.name);
  }
  return {{"name", std::string(signal.name)},
          {"half_code", 0.5 * double{signal.scale}},
          {"minimum", signal.minimum},
          {"maximum", double{signal.offset} + double{signal.scale} * signal.largest_raw()},
          {"unit", std::string(signal.unit)},
          {"comment", std::string(signal.comment)},
          {"value_names", names}};
}

json described(const MessageSpec& message) {
  json signals = json::array();
  for (const Signal& signal : message.signals) signals.push_back(described(signal));
  return {{"name", std::string(message.name)},
          {"id", message.id},
          {"length", message.length},
          {"cycle_ms", message.cycle_ms},
          {"sender", std::string(kNodeNames[static_cast<std::size_t>(message.sender)])},
          {"comment", std::string(message.comment)},
          {"signals", signals}};
}

}  // namespace

int main(int argc, char** argv) {
  unsigned seed = 22;
  if (argc > 1) {
    const char* end = argv[1] + std::strlen(argv[1]);
    if (std::from_chars(argv[1], end, seed).ptr != end) {
      std::fprintf(stderr, "usage: %s [SEED]\n", argv[0]);
      return 2;
    }
  }
  Printer printer(seed);
  printer.add<EmergencyStop>();
  printer.add<Sync>();
  for (const Drive drive : kDrives) printer.add_drive(drive);
  printer.add<SupervisorOrder>();
  printer.add<OrderAcknowledge>();
  printer.add<SupervisorConnect>();
  printer.add<ParameterWrite>();
  printer.add<ServiceRequest>();
  printer.add<ServiceAnswer>();
  printer.add<Heartbeat>();
  printer.add<FootToe>();
  printer.add<FootLeg>();
  printer.add<FootGround>();
  printer.add<FootGate>();
  printer.add<FootCounters>();
  printer.add<FootLoad>();
  printer.add<FootFrames>();

  std::ostringstream dbc;
  write_dbc(dbc);
  json messages = json::array();
  for (const MessageSpec& message : kMessages) messages.push_back(described(message));
  const json all = {
      {"seed", seed}, {"dbc", dbc.str()}, {"messages", messages}, {"frames", printer.frames()}};
  std::cout << all << '\n';
  return 0;
}
