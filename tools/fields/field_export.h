// Moments for ParaView: grains, contacts and the foot, one frame a moment.
#pragma once

#include "tools/bed/vtk_file.h"
#include "tools/fields/field_scene.h"

namespace hoof::tools {

/// grain_points() (tools/bed) of the kept region with two arrays more: displacement since the
/// contact (m) and f_foot, the foot's force on the grain (N), which f does not hold.
PolyData field_grains(const FieldScene& scene, const FieldMoment& contact);

/// Contacts of grains with the foot: lines from the grain's centre to the spot, with the arrays id,
/// body, part (1 sole, 2 spine, 0 else), force and force_normal (on the grain, N).
PolyData foot_contacts(const FieldScene& scene);

/// Triangles of all bodies with the arrays pressure (Pa), body and part.
PolyData foot_pressure(const FieldScene& scene);

/// Adds the moment as a frame: parts grains, contacts, foot-contacts and foot.
void add_frame(VtkSeries& series, const FieldScene& scene, const FieldMoment& contact);

}  // namespace hoof::tools
