#include "sim/config/toml_entries.h"

#include <toml++/toml.h>

#include <algorithm>

#include "sim/config/config_error.h"

namespace hoof::sim {
namespace {

class Flattener {
 public:
  explicit Flattener(std::string file) : file_(std::move(file)) {}

  void add_table(const toml::table& table, const std::string& prefix) {
    for (const auto& [key, node] : table) {
      const std::string name(key.str());
      const Origin origin = origin_at(key.source().begin);
      if (!is_bare(name)) {
        throw ConfigError(origin.text() + ": key \"" + prefix + name +
                          "\": must be letters, digits, _ or -");
      }
      add_node(node, prefix + name, origin);
    }
  }

  std::vector<std::pair<std::string, Entry>> take() { return std::move(entries_); }

 private:
  static bool is_bare(const std::string& name) {
    constexpr std::string_view kAllowed =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    return !name.empty() && name.find_first_not_of(kAllowed) == std::string::npos;
  }

  Origin origin_at(const toml::source_position& position) const {
    return {file_, static_cast<int>(position.line), static_cast<int>(position.column)};
  }

  void add_node(const toml::node& node, const std::string& key, const Origin& origin) {
    if (const toml::table* table = node.as_table()) return add_table(*table, key + ".");
    if (const toml::array* array = node.as_array()) return add_array(*array, key, origin);
    if (const auto* flag = node.as_boolean()) return put(key, flag->get(), origin);
    if (const auto* integer = node.as_integer()) return put(key, integer->get(), origin);
    if (const auto* number = node.as_floating_point()) return put(key, number->get(), origin);
    if (const auto* text = node.as_string()) return put(key, text->get(), origin);
    throw ConfigError(origin.text() + ": " + key + ": must not be a date or time");
  }

  void add_array(const toml::array& array, const std::string& key, const Origin& origin) {
    const auto all = [&array](auto test) { return std::all_of(array.begin(), array.end(), test); };
    if (!array.empty() && all([](const toml::node& n) { return n.is_table(); })) {
      for (std::size_t i = 0; i < array.size(); ++i) {
        add_table(*array[i].as_table(), key + "." + std::to_string(i) + ".");
      }
    } else if (all([](const toml::node& n) { return n.is_number(); })) {
      std::vector<double> numbers;
      for (const toml::node& n : array) numbers.push_back(*n.value<double>());
      put(key, std::move(numbers), origin);
    } else if (all([](const toml::node& n) { return n.is_string(); })) {
      std::vector<std::string> texts;
      for (const toml::node& n : array) texts.push_back(n.as_string()->get());
      put(key, std::move(texts), origin);
    } else {
      throw ConfigError(origin.text() + ": " + key +
                        ": must hold only numbers, only strings or only tables");
    }
  }

  void put(const std::string& key, Value value, const Origin& origin) {
    entries_.emplace_back(key, Entry{std::move(value), origin});
  }

  std::string file_;
  std::vector<std::pair<std::string, Entry>> entries_;
};

}  // namespace

std::vector<std::pair<std::string, Entry>> toml_entries(std::string_view text,
                                                        const std::string& name) {
  Flattener flattener(name);
  try {
    const toml::table root = toml::parse(text, std::string_view(name));
    flattener.add_table(root, "");
  } catch (const toml::parse_error& error) {
    std::string why(error.description());
    std::replace_if(
        why.begin(), why.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    const toml::source_position& at = error.source().begin;
    const Origin origin{name, static_cast<int>(at.line), static_cast<int>(at.column)};
    throw ConfigError(origin.text() + ": not TOML: " + why);
  }
  return flattener.take();
}

}  // namespace hoof::sim
