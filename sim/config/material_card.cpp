#include "sim/config/material_card.h"

#include <algorithm>

#include "sim/config/config_error.h"

namespace hoof::sim {
namespace {

std::optional<Measured> optional_measured(Reader& section, std::string_view key, const Unit& unit,
                                          double min, double max) {
  if (!section.has(key)) return {};
  Measured value;
  section.measured(key, value, unit, min, max);
  return value;
}

void read_into(MaterialCard& card, Reader section) {
  section.text("about", card.about);
  section.choice("status", card.status, {"published", "starting range"});
  section.text("law", card.law);
  card.repose_rad = read_repose(section);
  card.bulk_density_kg_m3 = read_bulk_density(section);
  card.d50_m = read_d50(section);
  card.references = read_references(section);
}

}  // namespace

std::optional<Measured> read_repose(Reader& section) {
  return optional_measured(section, "repose_deg", kDegree, 1, 89);
}

std::optional<Measured> read_bulk_density(Reader& section) {
  // From pumice to iron ore: a slip of the unit falls outside.
  return optional_measured(section, "bulk_density_kg_m3", kKilogramPerCubicMetre, 300, 5000);
}

std::optional<Measured> read_d50(Reader& section) {
  return optional_measured(section, "d50_mm", kMillimetre, 0.001, 100);
}

StatedRanges stated_ranges(const Settings& file) {
  StatedRanges out;
  for (const auto& [key, entry] : file.entries()) {
    const auto put = [&, &path = key, &value = entry.value](std::string_view part, auto member) {
      if (!path.ends_with(part)) return;
      double number = 0;
      if (const auto* whole = std::get_if<std::int64_t>(&value)) number = double(*whole);
      if (const auto* real = std::get_if<double>(&value)) number = *real;
      out[path.substr(0, path.size() - part.size())].*member = number;
    };
    put(".low", &StatedRange::low);
    put(".high", &StatedRange::high);
  }
  return out;
}

std::vector<Reference> read_references(const Reader& section) {
  std::vector<Reference> out;
  const Reader all = section.section("references");
  for (const std::string& id : all.sections()) {
    Reader one = all.section(id);
    Reference r;
    one.text("cite", r.cite);
    one.text("author", r.author);
    one.text("year", r.year);
    one.text("title", r.title);
    one.text("address", r.address);
    out.push_back(r);
  }
  return out;
}

void require_sources(const Settings& file, const std::vector<Reference>& references) {
  std::string cites;
  for (const Reference& r : references) cites += (cites.empty() ? "" : ", ") + r.cite;
  for (const auto& [key, entry] : file.entries()) {
    if (!key.ends_with(".source")) continue;
    const auto* source = std::get_if<std::string>(&entry.value);
    const auto begins = [source](const Reference& r) {
      return source != nullptr && source->starts_with(r.cite);
    };
    if (std::any_of(references.begin(), references.end(), begins)) continue;
    throw ConfigError(entry.origin.text() + ": " + key + " = " + to_text(entry.value) +
                      ": must begin with a reference of the file (" +
                      (cites.empty() ? "it has none" : cites) + ")");
  }
}

void pass_over_card(Reader section) {
  MaterialCard card;
  read_into(card, section);
}

MaterialCard read_material_card(const Settings& file) {
  MaterialCard card;
  Reader reader(file);
  reader.text("name", card.name);
  read_into(card, reader.section("card"));
  card.materials = read_materials(reader);  // finishes, so that unknown keys of the card are found
  require_sources(file, card.references);
  card.ranges = stated_ranges(file);
  return card;
}

}  // namespace hoof::sim
