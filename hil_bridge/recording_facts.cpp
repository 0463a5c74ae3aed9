#include "hil_bridge/recording_facts.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "firmware/protocol/protocol_hash.h"

namespace hoof::bridge {
namespace {

using firmware::app::Parameters;
using Json = nlohmann::ordered_json;

std::string hex(std::uint32_t value) {
  char text[8];
  return std::string(text, std::to_chars(text, text + sizeof text, value, 16).ptr);
}

std::string shortest(float value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

class FactsReader {
 public:
  FactsReader(const std::string& text, const std::string& source) : source_(source) {
    try {
      json_ = Json::parse(text);
    } catch (const Json::exception& error) {
      throw std::invalid_argument(source + ": " + error.what());
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::invalid_argument(source_ + ": " + what);
  }

  bool has(const char* key) const { return json_.contains(key); }

  template <typename T>
  T value(const char* key) const {
    if (!json_.contains(key)) fail("no '" + std::string(key) + "'");
    try {
      return json_.at(key).get<T>();
    } catch (const Json::exception&) {
      fail("'" + std::string(key) + "' = " + json_.at(key).dump() + " is of another kind");
    }
  }

  std::uint32_t hash(const char* key) const {
    const auto text = value<std::string>(key);
    std::uint32_t read = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), read, 16);
    if (error != std::errc{} || end != text.data() + text.size()) {
      fail("'" + std::string(key) + "' = '" + text + "' is not a hexadecimal number of 32 bits");
    }
    return read;
  }

  /// Values go in as they stand: a value that was in range then must not be refused now.
  void parameters(RecordingFacts& facts) const {
    const auto table = value<Json>("parameters");
    if (!table.is_object()) fail("'parameters' is not a table");
    std::set<std::string> named;
    for (const auto& [name, number] : table.items()) {
      named.insert(name);
      if (!number.is_number()) fail("parameters." + name + " = " + number.dump() + " is no number");
      const auto* entry = firmware::app::find_parameter(name);
      if (entry == nullptr) {
        facts.notes.push_back("this firmware has no parameter " + name + " (recorded as " +
                              number.dump() + ")");
      } else {
        entry->value(facts.parameters) = number.get<float>();
      }
    }
    for (const auto& entry : firmware::app::parameter_table()) {
      if (named.count(std::string(entry.name)) != 0) continue;
      facts.notes.push_back("the recording has no parameter " + std::string(entry.name) +
                            "; its default " + shortest(entry.default_value()) + " is taken");
    }
  }

 private:
  std::string source_;
  Json json_;
};

}  // namespace

RecordingFacts recording_facts(std::string wires, double exchange_s, const Parameters& parameters) {
  RecordingFacts facts;
  facts.wires = std::move(wires);
  facts.exchange_ns = std::llround(exchange_s * 1e9);
  facts.protocol_hash = firmware::protocol::kProtocolHash;
  facts.parameter_table_hash = firmware::app::parameter_table_hash();
  facts.parameters = parameters;
  return facts;
}

std::string to_json(const RecordingFacts& facts) {
  Parameters parameters = facts.parameters;
  std::string text = "{\n  \"format\": " + std::to_string(facts.format) +
                     ",\n  \"wires\": " + Json(facts.wires).dump() +
                     ",\n  \"exchange_ns\": " + std::to_string(facts.exchange_ns) +
                     ",\n  \"mailboxes\": " + std::to_string(facts.mailboxes) +
                     ",\n  \"protocol_hash\": \"" + hex(facts.protocol_hash) +
                     "\",\n  \"parameter_table_hash\": \"" + hex(facts.parameter_table_hash) +
                     "\",\n  \"unseen_faults\": " + Json(facts.unseen_faults).dump() +
                     ",\n  \"parameters\": {";
  const char* between = "\n";
  for (const auto& entry : firmware::app::parameter_table()) {
    text += between + ("    " + Json(std::string(entry.name)).dump()) + ": " +
            shortest(entry.value(parameters));
    between = ",\n";
  }
  return text + "\n  }\n}\n";
}

RecordingFacts parse_recording_facts(const std::string& text, const std::string& source) {
  const FactsReader reader(text, source);
  RecordingFacts facts;
  facts.format = reader.value<int>("format");
  if (facts.format < 1 || facts.format > RecordingFacts::kFormat) {
    reader.fail("'format' = " + std::to_string(facts.format) + ": this program reads 1 to " +
                std::to_string(RecordingFacts::kFormat));
  }
  facts.wires = reader.value<std::string>("wires");
  facts.exchange_ns = reader.value<std::int64_t>("exchange_ns");
  if (facts.exchange_ns <= 0) reader.fail("'exchange_ns' must be above 0");
  facts.mailboxes = reader.value<int>("mailboxes");
  if (facts.mailboxes < 1 || facts.mailboxes > 64) reader.fail("'mailboxes' must be 1 to 64");
  facts.protocol_hash = reader.hash("protocol_hash");
  facts.parameter_table_hash = reader.hash("parameter_table_hash");
  // Recordings of before there were faults do not have it.
  if (reader.has("unseen_faults")) {
    facts.unseen_faults = reader.value<std::vector<std::string>>("unseen_faults");
  }
  reader.parameters(facts);
  return facts;
}

}  // namespace hoof::bridge
