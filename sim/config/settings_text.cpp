// Values and settings written as TOML.
#include <charconv>
#include <cmath>

#include "sim/config/settings.h"

namespace hoof::sim {
namespace {

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
  std::string text(digits, end);
  // TOML tells 5 from 5.0; a number read as floating point is written as one.
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      constexpr char kHex[] = "0123456789ABCDEF";
      out += "\\u00";
      out += kHex[(c >> 4) & 0xf];
      out += kHex[c & 0xf];
    } else {
      out += c;
    }
  }
  return out + "\"";
}

template <typename List, typename Write>
std::string list_text(const List& list, Write write) {
  std::string text = "[";
  for (const auto& each : list) text += (text.size() > 1 ? ", " : "") + write(each);
  return text + "]";
}

std::string origin_comment(const Origin& origin, const std::filesystem::path& config_dir) {
  if (origin.line == 0) return origin.file;
  std::string file = origin.file;
  const std::string folder = (config_dir / "").string();
  if (file.starts_with(folder)) file.erase(0, folder.size());
  return file + ":" + std::to_string(origin.line);
}

/// Writes the keys directly in `prefix`, then its sections: TOML wants values before sub-tables.
void write_section(const Settings::Entries& entries, const std::string& prefix,
                   const std::filesystem::path& config_dir, std::string& out) {
  std::string values;
  std::vector<std::string> sections;
  for (auto it = entries.lower_bound(prefix); it != entries.end(); ++it) {
    if (!it->first.starts_with(prefix)) break;
    const std::string rest = it->first.substr(prefix.size());
    const std::size_t dot = rest.find('.');
    if (dot == std::string::npos) {
      values += rest + " = " + to_text(it->second.value) + "  # " +
                origin_comment(it->second.origin, config_dir) + "\n";
    } else if (sections.empty() || sections.back() != rest.substr(0, dot)) {
      sections.push_back(rest.substr(0, dot));
    }
  }
  if (!values.empty()) {
    if (!prefix.empty()) out += "\n[" + prefix.substr(0, prefix.size() - 1) + "]\n";
    out += values;
  }
  for (const std::string& section : sections) {
    write_section(entries, prefix + section + ".", config_dir, out);
  }
}

}  // namespace

std::string Origin::text() const {
  if (line == 0) return file;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

std::string to_text(const Value& value) {
  struct Writer {
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t integer) const { return std::to_string(integer); }
    std::string operator()(double number) const { return number_text(number); }
    std::string operator()(const std::string& text) const { return quoted(text); }
    std::string operator()(const std::vector<double>& list) const {
      return list_text(list, number_text);
    }
    std::string operator()(const std::vector<std::string>& list) const {
      return list_text(list, quoted);
    }
  };
  return std::visit(Writer{}, value);
}

std::string Settings::to_toml(const std::filesystem::path& config_dir) const {
  std::string out;
  write_section(entries_, "", config_dir, out);
  return out;
}

}  // namespace hoof::sim
