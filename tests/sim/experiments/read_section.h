// Settings of an experiment from the text of its TOML file.
#pragma once

#include <string>

#include "sim/config/reader.h"
#include "sim/config/settings.h"

namespace hoof::tests {

/// @param file what errors call it  @param read what makes them of the section `experiment`; a key
/// that it leaves unread is an error
template <class Read>
auto read_section(const std::string& toml, const std::string& file, Read read) {
  sim::Settings run;
  run.merge(sim::Settings::parse(toml, file), "experiment");
  const sim::Reader section = sim::Reader(run).section("experiment");
  const auto settings = read(section);
  section.finish();
  return settings;
}

}  // namespace hoof::tests
