#include "firmware/protocol/dbc.h"

#include <array>
#include <charconv>
#include <ostream>
#include <string>

#include "firmware/protocol/dictionary.h"
#include "firmware/protocol/protocol_hash.h"

namespace hoof::firmware::protocol {
namespace {

/// Shortest text that reads back as the same float, without an exponent: not every reader of DBC
/// files takes one.
std::string text(float value) {
  std::array<char, 32> buffer{};
  char* const last = buffer.data() + buffer.size();
  const auto end = std::to_chars(buffer.data(), last, value, std::chars_format::fixed).ptr;
  return {buffer.data(), end};
}

std::string_view name(Node node) {
  return kNodeNames[static_cast<std::size_t>(node)];
}

/// DBC counts bits from the least significant of each byte, and names a Motorola signal by the
/// place of its most significant bit.
int dbc_start_bit(const Signal& signal) {
  return 8 * (signal.first_bit / 8) + 7 - signal.first_bit % 8;
}

/// Whole numbers in full: a float would print 2^32 - 1 as 2^32.
std::string maximum_text(const Signal& signal) {
  const bool whole = signal.scale == 1.0f && signal.offset == 0.0f;
  return whole ? std::to_string(signal.largest_raw()) : text(signal.maximum);
}

void write_signal(std::ostream& out, const MessageSpec& message, const Signal& signal) {
  out << " SG_ " << signal.name << " : " << dbc_start_bit(signal) << '|' << int{signal.length}
      << "@0+ (" << text(signal.scale) << ',' << text(signal.offset) << ") ["
      << text(signal.minimum) << '|' << maximum_text(signal) << "] \"" << signal.unit << "\" "
      << name(message.receiver) << '\n';
}

void write_messages(std::ostream& out) {
  for (const MessageSpec& message : kMessages) {
    out << "BO_ " << message.id << ' ' << message.name << ": " << int{message.length} << ' '
        << name(message.sender) << '\n';
    for (const Signal& signal : message.signals) write_signal(out, message, signal);
    out << '\n';
  }
}

void write_comments(std::ostream& out) {
  for (const MessageSpec& message : kMessages) {
    out << "CM_ BO_ " << message.id << " \"" << message.comment << "\";\n";
    for (const Signal& signal : message.signals) {
      out << "CM_ SG_ " << message.id << ' ' << signal.name << " \"" << signal.comment << "\";\n";
    }
  }
}

std::string_view bus_text(BusMask buses) {
  if (buses == (kBus0 | kBus1)) return "0 and 1";
  return buses == kBus0 ? "0" : "1";
}

void write_attributes(std::ostream& out) {
  out << "BA_DEF_ \"ProtocolHash\" STRING ;\n"
      << "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\n"
      << "BA_DEF_ BO_ \"ShortestPeriod_ms\" INT 0 65535;\n"
      << "BA_DEF_ BO_ \"Bus\" STRING ;\n"
      << "BA_DEF_DEF_ \"ProtocolHash\" \"\";\n"
      << "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n"
      << "BA_DEF_DEF_ \"ShortestPeriod_ms\" 0;\n"
      << "BA_DEF_DEF_ \"Bus\" \"\";\n";
  std::array<char, 8> hex{};
  const auto end = std::to_chars(hex.data(), hex.data() + hex.size(), kProtocolHash, 16).ptr;
  out << "BA_ \"ProtocolHash\" \"" << std::string_view(hex.data(), end) << "\";\n";
  for (const MessageSpec& message : kMessages) {
    out << "BA_ \"GenMsgCycleTime\" BO_ " << message.id << ' ' << message.cycle_ms << ";\n"
        << "BA_ \"ShortestPeriod_ms\" BO_ " << message.id << ' ' << message.shortest_ms << ";\n"
        << "BA_ \"Bus\" BO_ " << message.id << " \"" << bus_text(message.buses) << "\";\n";
  }
}

void write_value_tables(std::ostream& out) {
  for (const MessageSpec& message : kMessages) {
    for (const Signal& signal : message.signals) {
      if (signal.values.empty()) continue;
      out << "VAL_ " << message.id << ' ' << signal.name;
      for (const ValueName& value : signal.values) {
        out << ' ' << value.value << " \"" << value.name << '"';
      }
      out << " ;\n";
    }
  }
}

}  // namespace

void write_dbc(std::ostream& out) {
  out << "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_:";
  for (const std::string_view node : kNodeNames) out << ' ' << node;
  out << "\n\n";
  write_messages(out);
  write_comments(out);
  write_attributes(out);
  write_value_tables(out);
}

}  // namespace hoof::firmware::protocol
