// Frames by the dictionary, for tools: names and physical values instead of bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/protocol/codec.h"
#include "firmware/protocol/dictionary.h"

namespace hoof::tools {

using firmware::protocol::MessageSpec;
using firmware::protocol::Signal;

/// Null where the dictionary has no such identifier.
const MessageSpec* find_message(const hal::CanFrame& frame);

/// What is wrong with a frame of this identifier: empty, "wrong length", "bad CRC", ...
std::string_view frame_fault(const MessageSpec& message, const hal::CanFrame& frame);

/// "enter", "exit" or "set_zero" where a drive command is one of the three switches, whose bytes
/// are no values; else empty.
std::string_view drive_switch(const MessageSpec& message, const hal::CanFrame& frame);

/// True for signals that count, name or hold bits: no interpolation, no tolerance.
bool is_whole(const Signal& signal);

/// In the signal's unit. Whole numbers exactly, others as the firmware's own float.
double value_of(const Signal& signal, const hal::CanFrame& frame);

/// Shortest text that reads back as the same: of a float where the signal is one.
std::string value_text(const Signal& signal, double value);

/// With the value's name, where it has one: "3 (running)"; else the number and unit.
std::string described_value(const Signal& signal, double value);

/// "#AB12..." as in a candump line, in capitals.
std::string payload_hex(const hal::CanFrame& frame);
std::string id_text(const hal::CanFrame& frame);

/// "Message.signal".
std::string signal_name(const MessageSpec& message, const Signal& signal);

/// "*" stands for any run of characters.
bool matches_pattern(std::string_view pattern, std::string_view text);
bool matches_any(const std::vector<std::string>& patterns, std::string_view text);

/// @throws UserError naming the pattern that fits no signal of the dictionary, with a suggestion
void require_known_signals(const std::vector<std::string>& patterns);

}  // namespace hoof::tools
