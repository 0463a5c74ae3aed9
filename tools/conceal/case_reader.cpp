#include "tools/conceal/case_reader.h"

#include <toml++/toml.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools::conceal {
namespace {

namespace fs = std::filesystem;

using Table = std::map<std::string, std::vector<double>>;

Table read_columns(const fs::path& file) {
  std::istringstream lines(read_file(file));
  std::string line, cell;
  std::getline(lines, line);
  std::vector<std::string> names;
  for (std::istringstream cells(line); std::getline(cells, cell, ',');) names.push_back(cell);
  Table table;
  while (std::getline(lines, line)) {
    std::size_t from = 0;
    for (const std::string& name : names) {
      const std::size_t to = std::min(line.find(',', from), line.size());
      table[name].push_back(to > from ? std::strtod(line.c_str() + from, nullptr)
                                      : std::numeric_limits<double>::quiet_NaN());
      from = to + 1;
    }
  }
  return table;
}

void take_setup(const toml::table* setup, std::map<std::string, double>& into) {
  if (setup == nullptr) return;
  for (const auto& [key, node] : *setup) {
    const toml::node* number = &node;
    if (const toml::table* doubt = node.as_table()) number = doubt->get("value");
    if (const auto value = number->value<double>()) into[std::string(key.str())] = *value;
  }
}

void drop_missing(ReadRecording& recording) {
  const std::size_t count = recording.at("time").size();
  std::vector<bool> whole(count, true);
  for (const auto& [name, values] : recording.channels) {
    for (std::size_t i = 0; i < count; ++i) whole[i] = whole[i] && std::isfinite(values[i]);
  }
  for (auto& [name, values] : recording.channels) {
    std::vector<double> kept;
    for (std::size_t i = 0; i < count; ++i) {
      if (whole[i]) kept.push_back(values[i]);
    }
    values = kept;
  }
}

}  // namespace

double ReadRecording::value(const std::string& key, double otherwise) const {
  const auto found = setup.find(key);
  return found == setup.end() ? otherwise : found->second;
}

ReadCase read_case(const fs::path& dataset) {
  try {
    const toml::table root = toml::parse_file(dataset.string());
    ReadCase out;
    out.rig = root["rig"].value_or("");
    out.law = root["setup"]["law"].value_or("");
    for (const toml::node& node : *root["recording"].as_array()) {
      const toml::table& table = *node.as_table();
      ReadRecording recording;
      recording.holdout = table["role"].value_or(std::string()) == "holdout";
      take_setup(root["setup"].as_table(), recording.setup);
      take_setup(table["setup"].as_table(), recording.setup);
      const Table columns = read_columns(dataset.parent_path() / table["data"].value_or(""));
      for (const auto& [channel, source] : *table["channels"].as_table()) {
        const bool plain = source.is_string();
        const toml::node_view view(source);
        const std::string column = plain ? view.value_or("") : view["column"].value_or("");
        std::vector<double> values = columns.at(column);
        for (double& v : values) {
          v = view["scale"].value_or(1.0) * v + view["offset"].value_or(0.0);
        }
        recording.channels[std::string(channel.str())] = values;
      }
      drop_missing(recording);
      out.recordings.push_back(recording);
    }
    return out;
  } catch (const toml::parse_error& e) {
    throw UserError(dataset.string() + ": " + std::string(e.description()));
  }
}

}  // namespace hoof::tools::conceal
