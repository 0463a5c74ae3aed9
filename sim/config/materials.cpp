#include "sim/config/materials.h"

#include "sim/config/material_card.h"

namespace hoof::sim {
namespace {

Material read_material(Reader section) {
  Material material;
  // From soft rubber to diamond: a slip of the unit by 1000 falls outside for all that a foot or
  // a bed is made of, softened grains (down to 1/1000) excepted.
  section.measured("young_MPa", material.young_Pa, kMegapascal, 0.1, 1.2e6);
  section.measured("poisson", material.poisson, kUnitless, 0.0, 0.49);
  section.measured("density_kg_m3", material.density_kg_m3, kKilogramPerCubicMetre, 100.0, 25e3);
  return material;
}

ContactPair read_pair(Reader section) {
  ContactPair pair;
  section.measured("restitution", pair.restitution, kUnitless, 0.01, 1.0);
  section.measured("static_friction", pair.static_friction, kUnitless, 0.0, 5.0);
  section.measured("rolling_friction", pair.rolling_friction, kUnitless, 0.0, 5.0);
  return pair;
}

}  // namespace

Materials read_materials(Reader section) {
  Materials materials;
  std::string name;
  section.text("name", name);
  materials.sand = read_material(section.section("sand"));
  materials.abs = read_material(section.section("abs"));
  materials.sand_sand = read_pair(section.section("sand_sand"));
  materials.sand_abs = read_pair(section.section("sand_abs"));
  if (section.has("card")) pass_over_card(section.section("card"));
  section.finish();
  return materials;
}

}  // namespace hoof::sim
