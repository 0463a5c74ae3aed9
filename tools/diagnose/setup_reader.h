// [setup] of a data set and its overrides.
#pragma once

#include "tools/diagnose/data_set.h"
#include "tools/diagnose/rig_keys.h"
#include "tools/diagnose/toml_view.h"

namespace hoof::tools {

/// `base` with the values of `table` over it. A plate's diameter takes the place of width and
/// length, and they of it.
/// @throws UserError for keys that the rig does not have and values it does not allow
Setup read_setup(const TomlView& table, const RigKeys& rig, const Setup& base);

}  // namespace hoof::tools
