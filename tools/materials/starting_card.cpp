#include "tools/materials/starting_card.h"

#include "sim/config/material_card.h"
#include "sim/config/settings.h"
#include "tools/calibrate/lab_text.h"
#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

const std::string kCite = "hoof material suggest";

std::string quoted(const std::string& text) {
  return sim::to_text(sim::Value(text));
}

std::string number(double value) {
  return text("%.6g", value);
}

std::string entry(const std::string& key, double value, const std::string& range,
                  const std::string& source) {
  return key + " = { value = " + number(value) + range + ", source = " + quoted(source) + " }\n";
}

/// One that is taken over.
std::string entry(const std::string& key, const sim::Measured& m, double unit) {
  return entry(key, m.value / unit, m.sigma > 0 ? ", sigma = " + number(m.sigma / unit) : "",
               m.source);
}

std::string coefficient(const std::string& key, double value, const Valley& v, std::size_t f,
                        const std::string& command) {
  return entry(key, value,
               ", low = " + number(std::min(v.low[f], value)) +
                   ", high = " + number(std::max(v.high[f], value)),
               kCite + ", middle and range of the set that gives the angle: " + command);
}

std::string reference(const std::string& id, const sim::Reference& r) {
  return "\n[card.references." + id + "]\ncite = " + quoted(r.cite) +
         "\nauthor = " + quoted(r.author) + "\nyear = " + quoted(r.year) +
         "\ntitle = " + quoted(r.title) + "\naddress = " + quoted(r.address) + "\n";
}

}  // namespace

std::string starting_card(const std::string& name, const std::string& command,
                          const ReposeSurface& surface, const StartingRequest& request,
                          const StartingRange& range) {
  if (range.members.empty()) {
    throw UserError("--out: no coefficients of the box give " + number(request.repose_deg) +
                    " degrees by " + surface.name + "; no card is written");
  }
  const sim::MaterialCard paper = sim::read_material_card(
      sim::Settings::load_file(sim::default_config_dir() / "materials" / "paper.toml"));
  const sim::Materials& m = paper.materials;
  const StartingRange::Member& middle = range.members.front();
  const std::string bulk = kCite + ", as measured: " + command;
  std::string out =
      "# A starting range, not a calibration: one of many sands with this angle. By " +
      surface.name + ",\n# " + surface.made_of + ".\nname = " + quoted(name) + "\n\n[sand]\n" +
      entry("young_MPa", m.sand.young_Pa, 1e6) + entry("poisson", m.sand.poisson, 1) +
      entry("density_kg_m3", request.grain_density_kg_m3(), "",
            kCite + ", bulk density over the solid share 0.598 of our beds");
  out += "\n[abs]\n" + entry("young_MPa", m.abs.young_Pa, 1e6) +
         entry("poisson", m.abs.poisson, 1) + entry("density_kg_m3", m.abs.density_kg_m3, 1);
  out += "\n[sand_sand]\n" +
         coefficient("restitution", middle.restitution, range.valley, 0, command) +
         coefficient("static_friction", middle.static_friction, range.valley, 2, command) +
         coefficient("rolling_friction", middle.rolling_friction, range.valley, 1, command);
  out += "\n[sand_abs]\n# Of the paper's sand.\n" +
         entry("restitution", m.sand_abs.restitution, 1) +
         entry("static_friction", m.sand_abs.static_friction, 1) +
         entry("rolling_friction", m.sand_abs.rolling_friction, 1);
  out += "\n[card]\nabout = " +
         quoted(text("%.4g degrees, %.4g kg/m3 in bulk", request.repose_deg,
                     request.bulk_density_kg_m3)) +
         "\nstatus = \"starting range\"\nlaw = " + quoted(paper.law) + "\n" +
         entry("repose_deg", request.repose_deg,
               ", low = " + number(request.repose_deg - request.tolerance_deg) +
                   ", high = " + number(request.repose_deg + request.tolerance_deg),
               bulk) +
         entry("bulk_density_kg_m3", request.bulk_density_kg_m3, "", bulk);
  if (request.d50_m) out += entry("d50_mm", 1e3 * *request.d50_m, "", bulk);
  out += reference("hoof", {kCite, "this project", "2026", "response surface of " + surface.made_of,
                            "tools/materials/README.md"});
  for (const sim::Reference& r : paper.references) out += reference("ji2026", r);
  return out;
}

}  // namespace hoof::tools
