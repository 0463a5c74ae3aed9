#include "tools/materials/material_shelf.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "sim/config/settings.h"
#include "tools/calibrate/lab_text.h"
#include "tools/run/errors.h"
#include "tools/study/table.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;

constexpr double kDegree = std::numbers::pi / 180;

std::string brief(const std::optional<sim::Measured>& m, double unit, int digits) {
  return m ? text("%.*f", digits, m->value / unit) : "-";
}

/// Lines of values with doubt, range and source.
class Lines {
 public:
  explicit Lines(const sim::StatedRanges& ranges) : ranges_(ranges) {}

  void add(const std::string& section, const std::string& key, const sim::Measured& m,
           double unit) {
    const std::string value = with_doubt(m, unit, section + "." + key);
    text_ += text("  %-22s %-24s ", key.c_str(), value.c_str()) + m.source + "\n";
  }
  void add(const std::string& section, const sim::ContactPair& p) {
    add(section, "restitution", p.restitution, 1);
    add(section, "static_friction", p.static_friction, 1);
    add(section, "rolling_friction", p.rolling_friction, 1);
  }
  void add(const std::string& section, const sim::Material& m) {
    add(section, "young_MPa", m.young_Pa, 1e6);
    add(section, "poisson", m.poisson, 1);
    add(section, "density_kg_m3", m.density_kg_m3, 1);
  }
  void add_bulk(const std::string& section, const std::optional<sim::Measured>& repose_rad,
                const std::optional<sim::Measured>& bulk_kg_m3,
                const std::optional<sim::Measured>& d50_m) {
    if (repose_rad) add(section, "repose_deg", *repose_rad, kDegree);
    if (bulk_kg_m3) add(section, "bulk_density_kg_m3", *bulk_kg_m3, 1);
    if (d50_m) add(section, "d50_mm", *d50_m, 1e-3);
    if (!repose_rad && !bulk_kg_m3 && !d50_m) say("  nothing told");
  }
  void say(const std::string& line) { text_ += line + "\n"; }
  const std::string& text_so_far() const { return text_; }

 private:
  /// "0.34 +- 0.03 (0.1 to 0.4)".
  std::string with_doubt(const sim::Measured& m, double unit, const std::string& key) const {
    std::string out = text("%.5g", m.value / unit);
    if (m.sigma > 0) out += text(" +- %.3g", m.sigma / unit);
    const auto range = ranges_.find(key);
    if (range == ranges_.end()) return out;
    const auto bound = [](const std::optional<double>& b) { return b ? text("%.4g", *b) : "?"; };
    return out + " (" + bound(range->second.low) + " to " + bound(range->second.high) + ")";
  }

  const sim::StatedRanges& ranges_;
  std::string text_;
};

std::string reference_text(const std::vector<sim::Reference>& references) {
  std::string out = "References\n";
  for (const sim::Reference& r : references) {
    out +=
        "  " + r.cite + ": " + r.author + " (" + r.year + "), " + r.title + ". " + r.address + "\n";
  }
  return out;
}

std::vector<fs::path> card_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& item : fs::directory_iterator(folder)) {
    if (item.path().extension() == ".toml") files.push_back(item.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void read_measured(Shelf& shelf, const fs::path& file) {
  const sim::Settings settings = sim::Settings::load_file(file);
  sim::Reader reader(settings);
  const sim::Reader sands = reader.section("sands");
  for (const std::string& id : sands.sections()) {
    sim::Reader one = sands.section(id);
    Shelf::MeasuredSand sand;
    sand.id = id;
    one.text("about", sand.about);
    sand.repose_rad = sim::read_repose(one);
    sand.bulk_density_kg_m3 = sim::read_bulk_density(one);
    sand.d50_m = sim::read_d50(one);
    shelf.measured.push_back(sand);
  }
  shelf.measured_references = sim::read_references(reader);
  reader.finish();
  sim::require_sources(settings, shelf.measured_references);
  shelf.measured_ranges = sim::stated_ranges(settings);
}

std::string show(const sim::MaterialCard& c) {
  const sim::Materials& m = c.materials;
  Lines out(c.ranges);
  out.say(c.name + ": " + c.about);
  out.say(c.status + "; found for: " + c.law);
  out.say("In bulk");
  out.add_bulk("card", c.repose_rad, c.bulk_density_kg_m3, c.d50_m);
  out.say("Grains");
  out.add("sand", m.sand);
  out.say("Grain on grain");
  out.add("sand_sand", m.sand_sand);
  out.say("Plastic of foot and walls");
  out.add("abs", m.abs);
  out.say("Grain on plastic");
  out.add("sand_abs", m.sand_abs);
  return out.text_so_far() + reference_text(c.references) +
         "A coefficient of rolling friction belongs to the law it was found with. Here: "
         "Hertz-Mindlin, a constant\ntorque against each grain's own spin (type A, as EDEM's "
         "standard model), spheres, no cohesion.\n";
}

}  // namespace

fs::path default_materials_dir() {
  return HOOF_MATERIALS_DIR;
}

Shelf read_shelf(const fs::path& config_dir, const fs::path& materials_dir) {
  Shelf shelf;
  for (const fs::path& file : card_files(config_dir / "materials")) {
    shelf.cards.push_back(sim::read_material_card(sim::Settings::load_file(file)));
  }
  read_measured(shelf, materials_dir / "measured_sands.toml");
  return shelf;
}

std::string shelf_text(const Shelf& shelf) {
  Table cards({{"name_name", 0},
               {"restitution_ratio", 3},
               {"rolling_friction_ratio", 3},
               {"static_friction_ratio", 3},
               {"repose_deg", 2},
               {"bulk_density_name", 0},
               {"about_name", 0}});
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const sim::MaterialCard& c : shelf.cards) {
    const sim::ContactPair& p = c.materials.sand_sand;
    cards.row({c.name, p.restitution.value, p.rolling_friction.value, p.static_friction.value,
               c.repose_rad ? c.repose_rad->value / kDegree : none,
               brief(c.bulk_density_kg_m3, 1, 0), c.about});
  }
  std::string out = "Cards, for a run by --set use.materials=NAME (hoof material show NAME):\n\n" +
                    cards.markdown() + "\nMeasured in bulk only:\n\n";
  Table sands({{"name_name", 0},
               {"repose_deg", 1},
               {"bulk_density_name", 0},
               {"about_name", 0},
               {"source_name", 0}});
  for (const Shelf::MeasuredSand& s : shelf.measured) {
    const sim::Measured& told = s.repose_rad ? *s.repose_rad : *s.bulk_density_kg_m3;
    sands.row({s.id, s.repose_rad ? s.repose_rad->value / kDegree : none,
               brief(s.bulk_density_kg_m3, 1, 0), s.about, told.source});
  }
  return out + sands.markdown();
}

std::string card_text(const Shelf& shelf, const std::string& name_or_file) {
  std::string names;
  for (const sim::MaterialCard& c : shelf.cards) {
    if (c.name == name_or_file) return show(c);
    names += (names.empty() ? "" : ", ") + c.name;
  }
  if (fs::path(name_or_file).extension() == ".toml") {
    return show(sim::read_material_card(sim::Settings::load_file(name_or_file)));
  }
  for (const Shelf::MeasuredSand& s : shelf.measured) {
    if (s.id != name_or_file) continue;
    Lines out(shelf.measured_ranges);
    out.say(s.id + ": " + s.about + "; measured in bulk only");
    out.add_bulk("sands." + s.id, s.repose_rad, s.bulk_density_kg_m3, s.d50_m);
    return out.text_so_far() + reference_text(shelf.measured_references);
  }
  throw UserError(name_or_file + ": no such card; there are " + names + ", or give a FILE.toml");
}

}  // namespace hoof::tools
