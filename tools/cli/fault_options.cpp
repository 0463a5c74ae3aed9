#include "tools/cli/fault_options.h"

#include <algorithm>
#include <string_view>

#include "hil_bridge/fault_spec.h"

namespace hoof::tools {
namespace {

constexpr std::size_t kHelpWidth = 96;

/// Words of a list, broken into indented lines.
std::string wrapped(const std::string& words) {
  std::string text = " ";
  std::size_t column = 1;
  for (std::string_view rest = words; !rest.empty();) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
    if (column + 1 + word.size() > kHelpWidth) {
      text += "\n ";
      column = 1;
    }
    text += " " + std::string(word);
    column += 1 + word.size();
  }
  return text + "\n";
}

/// Takes the text up to the next comma off the front.
std::string_view take_word(std::string_view& rest) {
  const std::string_view word = rest.substr(0, rest.find(','));
  rest.remove_prefix(std::min(rest.size(), word.size() + 1));
  return word;
}

std::string check_fault(const std::string& text) {
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view word = take_word(rest);
    const std::size_t equals = word.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      return "'" + std::string(word) + "' is not of the form key=value";
    }
  }
  return "";
}

}  // namespace

void add_fault_options(CLI::App& command, FaultOptions& options) {
  CLI::Option* file =
      command.add_option("--faults", options.file, "Faults to put in: TOML, [[fault]] entries")
          ->type_name("FILE")
          ->check(CLI::ExistingFile);
  command
      .add_option("--fault", options.faults,
                  "One fault, e.g. kind=drop,target=HipReply,at_s=1.2,for_s=0.05; may be repeated")
      ->type_name("KEY=VALUE,...")
      ->allow_extra_args(false)
      ->excludes(file)
      ->check(CLI::Validator(check_fault, ""));
}

std::string fault_help() {
  return "Kinds of fault (keys and units of each: hil_bridge/README.md):\n" +
         wrapped(bridge::fault_kind_names()) +
         "A fault begins at_s, at_tick, or when a signal meets a value, as in when=depth_m > "
         "0.005:\n" +
         wrapped(bridge::FaultCondition::signal_names());
}

void add_fault_overrides(const FaultOptions& options, std::vector<std::string>& overrides) {
  for (std::size_t i = 0; i < options.faults.size(); ++i) {
    std::string_view rest = options.faults[i];
    while (!rest.empty()) {
      overrides.push_back("fault." + std::to_string(i) + "." + std::string(take_word(rest)));
    }
  }
}

}  // namespace hoof::tools
