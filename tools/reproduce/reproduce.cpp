#include "tools/reproduce/reproduce.h"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "tools/reproduce/campaign.h"
#include "tools/reproduce/comparison.h"
#include "tools/reproduce/summary_page.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"
#include "tools/run/version.h"
#include "tools/study/table.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

std::string design_name(Design design) {
  return design == Design::kNight ? "night" : "full";
}

/// Units differ from row to row and stand in a column of their own.
std::string figure(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

Table table_of(const std::vector<Comparison>& rows) {
  Table table({{"target_name"},
               {"unit_name"},
               {"paper_name"},
               {"accepted_from_name"},
               {"accepted_to_name"},
               {"ours_name"},
               {"deviation_name"},
               {"beds_count"},
               {"result_name"},
               {"standing_name"},
               {"note_name"}});
  for (const Comparison& row : rows) {
    const bool band = row.low != 0 || row.high != 0;
    table.row({row.name, row.unit, figure(row.paper), band ? figure(row.low) : "",
               band ? figure(row.high) : "", row.ours ? figure(row.ours->mean) : "",
               row.ours ? figure(row.ours->deviation) : "",
               std::int64_t(row.ours ? row.ours->n : 0), to_string(row.judgement()),
               to_string(row.standing), row.note});
  }
  return table;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

void write_summary(const Campaign& campaign, const ReproduceOptions& options,
                   const std::vector<Comparison>& rows) {
  const fs::path& folder = campaign.folder();
  // CSV takes no commas within a text.
  std::vector<Comparison> plain = rows;
  for (Comparison& row : plain) {
    for (std::string* text : {&row.name, &row.note}) {
      for (char& c : *text) c = c == ',' ? ';' : c;
    }
  }
  table_of(plain).write_csv(folder / "summary.csv");
  nlohmann::ordered_json j;
  j["scale"] = options.scale, j["terrain"] = options.terrain;
  j["design"] = design_name(options.design);
  j["beds"] = options.beds, j["first_bed"] = options.first_bed;
  j["settings"] = options.settings;
  for (const auto& [foot, hash] : campaign.geometry_hashes()) j["geometry_sha256"][foot] = hash;
  for (const Comparison& row : rows) {
    nlohmann::ordered_json r;
    r["target"] = row.name, r["unit"] = row.unit, r["paper"] = row.paper;
    const bool band = row.low != 0 || row.high != 0;
    if (band) r["accepted"] = {row.low, row.high};
    if (row.ours) {
      r["ours"] = {{"mean", number(row.ours->mean)},
                   {"deviation", number(row.ours->deviation)},
                   {"standard_error", number(row.ours->standard_error)},
                   {"beds", row.ours->n}};
    }
    r["result"] = to_string(row.judgement()), r["standing"] = to_string(row.standing);
    if (!row.note.empty()) r["note"] = row.note;
    j["targets"].push_back(r);
  }
  j["version"] = version_json();
  const auto replace = [&](const std::string& name, const std::string& text) {
    const fs::path partial = folder / (name + ".partial");
    write_file(partial, text);
    fs::rename(partial, folder / name);
  };
  replace("summary.json", result_json_text(j));
  replace("report.html", summary_page(campaign, options, rows));
}

void print_plan(const Campaign& campaign) {
  std::size_t done = 0;
  for (const Cell& cell : campaign.cells()) {
    const bool there = campaign.done(cell);
    done += there ? 1 : 0;
    std::printf("%-8s %s\n", there ? "done" : "missing", cell.id().c_str());
  }
  std::printf("%zu runs, %zu done\n", campaign.cells().size(), done);
}

}  // namespace

void reproduce(const ReproduceOptions& options) {
  std::set<Part> parts = options.parts;
  if (parts.empty()) {
    for (const auto& [name, part] : part_names()) parts.insert(part);
  }
  std::vector<std::string> settings = {"use.bed=" + options.scale,
                                       "experiment.terrain=" + options.terrain};
  if (options.threads) settings.push_back("experiment.threads=" + std::to_string(*options.threads));
  settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  const fs::path out =
      options.out.empty() ? fs::path("runs") / ("reproduce-" + options.scale) : options.out;
  Campaign campaign(out, plan_cells(parts, options.design, options.beds, options.first_bed),
                    std::move(settings));
  if (options.plan_only) {
    print_plan(campaign);
    return;
  }
  const auto summary = [&] {
    const std::vector<Comparison> rows = compare_with_paper(campaign.outcomes());
    write_summary(campaign, options, rows);
    return rows;
  };
  const std::vector<std::string> failed =
      campaign.run(options.quiet, [&](const Cell&) { summary(); });
  std::vector<Comparison> rows = summary();
  const std::size_t all = rows.size();
  std::erase_if(rows, [](const Comparison& row) { return !row.ours; });
  std::cout << table_of(rows).markdown();
  if (rows.size() < all) std::cout << all - rows.size() << " more targets were not run\n";
  for (const auto& [foot, hash] : campaign.geometry_hashes()) {
    std::cout << "geometry of " << foot << ": SHA-256 " << hash << "\n";
  }
  std::cout << (campaign.folder() / "report.html").string() << std::endl;
  if (!failed.empty()) {
    throw CannotFinish(std::to_string(failed.size()) + " of " +
                       std::to_string(campaign.cells().size()) +
                       " runs could not be finished, the first: " + failed.front());
  }
}

}  // namespace hoof::tools
