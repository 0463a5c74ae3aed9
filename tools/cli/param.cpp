#include "tools/cli/param.h"

#include <charconv>
#include <cstdio>
#include <iomanip>
#include <ostream>

#include "sim/config/suggestion.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

using firmware::app::parameter_table;
using firmware::app::ParameterEntry;

std::string number(float value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::uint8_t index_of(const std::string& name) {
  const auto table = parameter_table();
  std::vector<std::string> names;
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].name == name) return static_cast<std::uint8_t>(i);
    names.emplace_back(table[i].name);
  }
  const std::string near = sim::suggest(name, names);
  throw UserError("the firmware has no parameter '" + name + "'" +
                  (near.empty() ? "; hoof param list shows all" : "; did you mean " + near + "?"));
}

Assignment parse(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw UserError("'" + text + "': expected NAME=VALUE");
  const std::uint8_t index = index_of(text.substr(0, equals));
  const ParameterEntry& entry = parameter_table()[index];
  const char* const begin = text.data() + equals + 1;
  const char* const end = text.data() + text.size();
  float value = 0;
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (error != std::errc{} || stop != end) {
    throw UserError("'" + text + "': the value is not a number");
  }
  if (!(value >= entry.minimum && value <= entry.maximum)) {
    throw UserError(std::string(entry.name) + " = " + number(value) + ": must be from " +
                    number(entry.minimum) + " to " + number(entry.maximum) + " " +
                    std::string(entry.unit));
  }
  return {index, value};
}

void print(std::ostream& out, const ParameterEntry& entry, float value) {
  out << entry.name << " = " << number(value) << ' ' << entry.unit << '\n';
}

}  // namespace

void list_parameters(bridge::ServiceClient* client, std::ostream& out) {
  const auto table = parameter_table();
  out << std::left << std::setw(30) << "name";
  if (client != nullptr) out << std::setw(12) << "value";
  out << std::setw(12) << "default" << std::setw(22) << "range" << std::setw(10) << "unit"
      << "meaning\n";
  for (std::size_t i = 0; i < table.size(); ++i) {
    const ParameterEntry& entry = table[i];
    out << std::setw(30) << entry.name;
    if (client != nullptr) {
      out << std::setw(12) << number(client->read_parameter(static_cast<std::uint8_t>(i)));
    }
    out << std::setw(12) << number(entry.default_value()) << std::setw(22)
        << number(entry.minimum) + " ... " + number(entry.maximum) << std::setw(10) << entry.unit
        << entry.description << '\n';
  }
}

void get_parameters(bridge::ServiceClient& client, const std::vector<std::string>& names,
                    std::ostream& out) {
  std::vector<std::uint8_t> indices;
  for (const std::string& name : names) indices.push_back(index_of(name));
  for (const std::uint8_t index : indices) {
    print(out, parameter_table()[index], client.read_parameter(index));
  }
}

std::vector<Assignment> parse_assignments(const std::vector<std::string>& texts) {
  std::vector<Assignment> assignments;
  for (const std::string& text : texts) assignments.push_back(parse(text));
  return assignments;
}

void set_parameters(bridge::ServiceClient& client, const std::vector<Assignment>& assignments,
                    std::ostream& out) {
  for (const Assignment& a : assignments) {
    client.write_parameter(a.index, a.value);
    const float now = client.read_parameter(a.index);
    print(out, parameter_table()[a.index], now);
    if (now != a.value) throw CannotFinish("the foot holds another value than was written");
  }
}

void calibrate_joint(bridge::ServiceClient& client, const std::string& joint, std::ostream& out) {
  const std::uint8_t index = joint == "toe" ? 0 : joint == "hip" ? 1 : 2;
  const float zero_rad = client.calibrate_zero(index);
  out << joint << "_zero_rad = " << number(zero_rad) << " rad\n";
}

}  // namespace hoof::tools
