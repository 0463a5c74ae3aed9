// All numbers of a moment, as fields.json and result.json hold them.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/fields/field_scene.h"

namespace hoof::tools {

/// Keys end in their units; shares are ratios. Values that a moment does not have are null.
/// @param contact the scene at first contact, from which changes count
nlohmann::ordered_json measure_fields(const FieldScene& scene, const FieldScene& contact);

/// The few numbers of a moment that stand in result.json, flat.
nlohmann::ordered_json field_headline(const nlohmann::ordered_json& moment);

}  // namespace hoof::tools
