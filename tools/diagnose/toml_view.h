// A table of a TOML file that a user wrote, read key by key; every complaint names its place.
//
// Beside sim/config's Settings, which flattens its files: a data set is lists of tables, and what
// is missing in one of them is best said with the line of that table.
#pragma once

#include <toml++/toml.h>

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hoof::tools {

/// What numbers a key allows, all of them finite.
enum class Allowed { kAny, kNotNegative, kPositive };

/// "a number that is not negative" and so on, for messages.
std::string describe(Allowed allowed);
bool is_allowed(double value, Allowed allowed);

/// "a, b or c".
std::string one_of(std::span<const std::string> words);

/// ", did you mean position?", or, where nothing is near, "; `what`: time, position".
std::string did_you_mean(const std::string& name, const std::string& what,
                         std::span<const std::string> known);

/// A view: the table must outlive it. All failures throw UserError,
/// "set.toml:3:5: setup.kt = -1: must be a number above zero".
class TomlView {
 public:
  /// @param path "setup": what stands before the keys in messages; "" for the root
  TomlView(const toml::table& table, std::string file, std::string path);

  /// Throws for the first key, in the file's order, that is not among `known`.
  /// @param kind what a key is called: "key", "channel"
  void allow_only(std::span<const std::string> known, const std::string& kind = "key") const;

  bool has(std::string_view key) const { return table_->contains(key); }
  bool is_table(std::string_view key) const;
  /// In the order of the file.
  std::vector<std::string> keys() const;

  double number(const std::string& key, Allowed allowed) const;
  /// The whole number `value` and nothing else.
  void require(const std::string& key, int value) const;
  std::string text(const std::string& key) const;
  std::string choice(const std::string& key, std::span<const std::string> allowed) const;
  TomlView table(const std::string& key) const;
  /// Elements of an array of tables; none where the key is absent.
  std::vector<TomlView> tables(const std::string& key) const;
  /// Exactly `count` finite numbers.
  std::vector<double> numbers(const std::string& key, std::size_t count) const;

  /// Complains about a key that is there, or is missing.
  [[noreturn]] void fail(const std::string& key, const std::string& rule) const;
  /// Complains about the table as a whole.
  [[noreturn]] void fail_here(const std::string& rule) const;

  const std::string& file() const { return file_; }

 private:
  const toml::node& take(const std::string& key, const std::string& rule) const;
  std::string full(const std::string& key) const;
  std::string place(const toml::source_region& region) const;

  const toml::table* table_;
  std::string file_, path_;
};

/// @throws UserError where the file cannot be read or is not TOML
toml::table parse_toml_file(const std::filesystem::path& file);

}  // namespace hoof::tools
