#include "tools/diagnose/toml_view.h"

#include <algorithm>
#include <cmath>

#include "sim/config/suggestion.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

constexpr std::size_t kShownTextLength = 60;
constexpr std::size_t kShownElements = 8;

/// A text of the file in quotes, cut where long, in one line.
std::string quoted(std::string text) {
  if (text.size() > kShownTextLength) text = text.substr(0, kShownTextLength) + "...";
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  }
  return '"' + text + '"';
}

std::string shown(const toml::node& node) {
  if (const auto* text = node.as_string()) return quoted(text->get());
  if (const auto* integer = node.as_integer()) return std::to_string(integer->get());
  if (const auto* number = node.as_floating_point()) return format_number(number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* array = node.as_array()) {
    std::string text;
    for (const toml::node& element : *array) text += (text.empty() ? "" : ", ") + shown(element);
    return array->size() > kShownElements ? "[...]" : "[" + text + "]";
  }
  return node.is_table() ? "{a table}" : "a date or time";
}

}  // namespace

std::string describe(Allowed allowed) {
  switch (allowed) {
    case Allowed::kNotNegative:
      return "a number, zero or above";
    case Allowed::kPositive:
      return "a number above zero";
    default:
      return "a finite number";
  }
}

bool is_allowed(double value, Allowed allowed) {
  if (!std::isfinite(value)) return false;
  return allowed == Allowed::kAny || value > 0 || (allowed == Allowed::kNotNegative && value == 0);
}

std::string one_of(std::span<const std::string> words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

std::string did_you_mean(const std::string& name, const std::string& what,
                         std::span<const std::string> known) {
  const std::string meant = sim::suggest(name, known);
  if (!meant.empty()) return ", did you mean " + meant + "?";
  std::string text;
  for (const std::string& each : known) text += (text.empty() ? "" : ", ") + each;
  return "; " + what + ": " + (text.empty() ? "none" : text);
}

TomlView::TomlView(const toml::table& table, std::string file, std::string path)
    : table_(&table), file_(std::move(file)), path_(std::move(path)) {}

std::string TomlView::full(const std::string& key) const {
  return path_.empty() ? key : path_ + "." + key;
}

std::string TomlView::place(const toml::source_region& region) const {
  if (region.begin.line == 0) return file_;
  return file_ + ":" + std::to_string(region.begin.line) + ":" +
         std::to_string(region.begin.column);
}

std::vector<std::string> TomlView::keys() const {
  std::vector<std::pair<toml::source_position, std::string>> placed;
  for (const auto& [key, node] : *table_) {
    placed.emplace_back(key.source().begin, std::string(key.str()));
  }
  std::sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first.line, a.first.column) < std::pair(b.first.line, b.first.column);
  });
  std::vector<std::string> names;
  for (auto& [position, name] : placed) names.push_back(std::move(name));
  return names;
}

void TomlView::allow_only(std::span<const std::string> known, const std::string& kind) const {
  for (const std::string& key : keys()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    fail(key, "unknown " + kind + did_you_mean(key, "allowed", known));
  }
}

bool TomlView::is_table(std::string_view key) const {
  const toml::node* node = table_->get(key);
  return node != nullptr && node->is_table();
}

const toml::node& TomlView::take(const std::string& key, const std::string& rule) const {
  const toml::node* node = table_->get(key);
  if (node == nullptr) fail(key, rule);
  return *node;
}

double TomlView::number(const std::string& key, Allowed allowed) const {
  const std::string rule = "must be " + describe(allowed);
  const toml::node& node = take(key, rule);
  if (!node.is_number()) fail(key, rule);
  const double value = *node.value<double>();
  if (!is_allowed(value, allowed)) fail(key, rule);
  return value;
}

void TomlView::require(const std::string& key, int value) const {
  const std::string rule = "must be " + std::to_string(value);
  const auto* number = take(key, rule).as_integer();
  if (number == nullptr || number->get() != value) fail(key, rule);
}

std::string TomlView::text(const std::string& key) const {
  const std::string rule = "must be a string that is not empty";
  const auto* text = take(key, rule).as_string();
  if (text == nullptr || text->get().empty()) fail(key, rule);
  return text->get();
}

std::string TomlView::choice(const std::string& key, std::span<const std::string> allowed) const {
  const std::string rule = "must be " + one_of(allowed);
  const auto* text = take(key, rule).as_string();
  if (text != nullptr && std::find(allowed.begin(), allowed.end(), text->get()) != allowed.end()) {
    return text->get();
  }
  const std::string meant = text == nullptr ? "" : sim::suggest(text->get(), allowed);
  fail(key, rule + (meant.empty() ? "" : "; did you mean " + meant + "?"));
}

TomlView TomlView::table(const std::string& key) const {
  const std::string rule = "must be a table";
  const toml::table* table = take(key, rule).as_table();
  if (table == nullptr) fail(key, rule);
  return {*table, file_, full(key)};
}

std::vector<TomlView> TomlView::tables(const std::string& key) const {
  std::vector<TomlView> views;
  const toml::node* node = table_->get(key);
  if (node == nullptr) return views;
  const std::string rule = "must be a list of tables, [[" + full(key) + "]]";
  const toml::array* array = node->as_array();
  if (array == nullptr) fail(key, rule);
  for (const toml::node& element : *array) {
    if (!element.is_table()) fail(key, rule);
    views.emplace_back(*element.as_table(), file_, full(key));
  }
  return views;
}

std::vector<double> TomlView::numbers(const std::string& key, std::size_t count) const {
  const std::string rule = "must be a list of " + std::to_string(count) + " finite numbers";
  const toml::array* array = take(key, rule).as_array();
  if (array == nullptr || array->size() != count) fail(key, rule);
  std::vector<double> values;
  for (const toml::node& element : *array) {
    if (!element.is_number()) fail(key, rule);
    values.push_back(*element.value<double>());
    if (!std::isfinite(values.back())) fail(key, rule);
  }
  return values;
}

void TomlView::fail(const std::string& key, const std::string& rule) const {
  for (const auto& [name, node] : *table_) {
    if (name.str() != key) continue;
    throw UserError(place(name.source()) + ": " + full(key) + " = " + shown(node) + ": " + rule);
  }
  throw UserError((path_.empty() ? file_ : place(table_->source())) + ": " + full(key) +
                  ": missing; " + rule);
}

void TomlView::fail_here(const std::string& rule) const {
  throw UserError(place(table_->source()) + ": " + (path_.empty() ? "" : path_ + ": ") + rule);
}

toml::table parse_toml_file(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  try {
    return toml::parse(text, std::string_view(file.native()));
  } catch (const toml::parse_error& error) {
    std::string why(error.description());
    for (char& c : why) {
      if (c == '\n' || c == '\r') c = ' ';
    }
    const toml::source_position& at = error.source().begin;
    throw UserError(file.string() + ":" + std::to_string(at.line) + ":" +
                    std::to_string(at.column) + ": not TOML: " + why);
  }
}

}  // namespace hoof::tools
