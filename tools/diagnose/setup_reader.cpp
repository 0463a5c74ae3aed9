#include "tools/diagnose/setup_reader.h"

#include <array>

#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

SetupValue read_value(const TomlView& setup, const SetupKey& key) {
  if (!setup.is_table(key.name)) {
    const std::string rule =
        "must be " + describe(key.allowed) + ", or { value = ..., sigma = ... }";
    try {
      return {setup.number(key.name, key.allowed), 0};
    } catch (const UserError&) {
      setup.fail(key.name, rule);
    }
  }
  static const std::array<std::string, 2> kParts = {"value", "sigma"};
  const TomlView parts = setup.table(key.name);
  parts.allow_only(kParts);
  return {parts.number("value", key.allowed), parts.number("sigma", Allowed::kNotNegative)};
}

/// A plate is a disc or a rectangle.
void keep_one_shape(const TomlView& table, Setup& setup) {
  const bool disc = table.has("diameter");
  const bool rectangle = table.has("width") || table.has("length");
  if (disc && rectangle) table.fail("diameter", "must stand without width and length");
  if (disc) {
    setup.values.erase("width");
    setup.values.erase("length");
  }
  if (rectangle) setup.values.erase("diameter");
}

}  // namespace

Setup read_setup(const TomlView& table, const RigKeys& rig, const Setup& base) {
  const std::vector<std::string> known = setup_key_names(rig);
  if (known.empty()) table.fail_here("rig = \"" + rig.name + "\" has no setup values");
  table.allow_only(known);
  Setup setup = base;
  keep_one_shape(table, setup);
  for (const SetupKey& key : rig.setup) {
    if (table.has(key.name)) setup.values[key.name] = read_value(table, key);
  }
  if (rig.has_law && table.has("law")) setup.law = law_of(table.choice("law", law_names()));
  return setup;
}

}  // namespace hoof::tools
