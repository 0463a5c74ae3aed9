#include "tools/reproduce/reproduce.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "tools/reproduce/campaign.h"
#include "tools/reproduce/comparison.h"
#include "tools/reproduce/cost.h"
#include "tools/reproduce/figures.h"
#include "tools/reproduce/other_campaign.h"
#include "tools/reproduce/paper_numbers.h"
#include "tools/reproduce/reasons.h"
#include "tools/reproduce/summary_page.h"
#include "tools/reproduce/table_targets.h"
#include "tools/reproduce/target_chart.h"
#include "tools/reproduce/variation.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"
#include "tools/run/version.h"
#include "tools/study/table.h"

namespace hoof::tools {
namespace fs = std::filesystem;

std::string design_name(Design design) {
  for (const auto& [name, known] : design_names()) {
    if (known == design) return name;
  }
  return "";
}

namespace {

/// Units differ from row to row and stand in a column of their own.
std::string figure(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// @param found whether with a column for it; a terminal has it as lines of its own
Table table_of(const std::vector<Comparison>& rows, bool found) {
  std::vector<Table::Column> columns = {
      {"target_name"},      {"unit_name"},     {"paper_name"},     {"accepted_from_name"},
      {"accepted_to_name"}, {"ours_name"},     {"deviation_name"}, {"beds_count"},
      {"result_name"},      {"standing_name"}, {"note_name"},      {"bed_cannot_tell_name"}};
  if (found) columns.push_back({"found_name"});
  Table table(columns);
  for (const Comparison& row : rows) {
    const bool band = row.low != 0 || row.high != 0;
    std::vector<Table::Cell> cells = {row.name,
                                      row.unit,
                                      figure(row.paper),
                                      band ? figure(row.low) : "",
                                      band ? figure(row.high) : "",
                                      row.ours ? figure(row.ours->mean) : "",
                                      row.ours ? figure(row.ours->deviation) : "",
                                      std::int64_t(row.ours ? row.ours->n : 0),
                                      to_string(row.judgement()),
                                      to_string(row.standing),
                                      row.note,
                                      row.cannot_tell_text()};
    if (found) cells.push_back(row.reasons());
    table.row(cells);
  }
  return table;
}

/// Each target with each change that was tried and moves it.
Table changes_table(const std::vector<Comparison>& rows) {
  Table table({{"target_name"},
               {"kind_name"},
               {"change_name"},
               {"what_name"},
               {"unit_name"},
               {"accepted_from_name"},
               {"accepted_to_name"},
               {"without_name"},
               {"with_name"},
               {"deviation_name"},
               {"beds_count"},
               {"result_name"}});
  for (const Comparison& row : rows) {
    const bool band = row.low != 0 || row.high != 0;
    for (const Tried& t : row.tried) {
      table.row({row.name, t.kind, t.name, t.what, row.unit, band ? figure(row.low) : "",
                 band ? figure(row.high) : "", figure(t.without.mean), figure(t.with.mean),
                 figure(t.with.deviation), std::int64_t(t.with.n),
                 !band      ? to_string(Judgement::kNoBand)
                 : t.inside ? to_string(Judgement::kInside)
                            : to_string(Judgement::kOutside)});
    }
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
  const auto without_commas = [](std::string& text) {
    std::replace(text.begin(), text.end(), ',', ';');
  };
  for (Comparison& row : plain) {
    without_commas(row.name), without_commas(row.note), without_commas(row.elsewhere);
    for (std::string& sentence : row.cannot_tell) without_commas(sentence);
    for (Tried& t : row.tried) without_commas(t.what);
  }
  table_of(plain, true).write_csv(folder / "summary.csv");
  changes_table(plain).write_csv(folder / "changes.csv");
  nlohmann::ordered_json j;
  j["scale"] = options.ground.scale, j["terrain"] = options.ground.terrain;
  j["design"] = design_name(options.design());
  j["beds"] = options.beds, j["first_bed"] = options.first_bed;
  j["settings"] = options.settings;
  for (const auto& [foot, hash] : campaign.geometry_hashes()) j["geometry_sha256"][foot] = hash;
  for (const Comparison& row : rows) {
    nlohmann::ordered_json r;
    r["target"] = row.name, r["unit"] = row.unit, r["paper"] = number(row.paper);
    const bool band = row.low != 0 || row.high != 0;
    if (band) r["accepted"] = {row.low, row.high};
    if (row.ours) {
      r["ours"] = {{"mean", number(row.ours->mean)},
                   {"deviation", number(row.ours->deviation)},
                   {"standard_error", number(row.ours->standard_error)},
                   {"beds", row.ours->n}};
    }
    if (row.undefined > 0) r["beds_without_value"] = row.undefined;
    if (row.least_below_one > 0) r["accepted_share_below_one"] = row.least_below_one;
    r["result"] = to_string(row.judgement()), r["standing"] = to_string(row.standing);
    if (!row.note.empty()) r["note"] = row.note;
    if (!row.found().empty()) r["found"] = row.found();
    if (!row.elsewhere.empty()) r["found_elsewhere"] = row.elsewhere;
    if (!row.cannot_tell.empty()) r["bed_cannot_tell"] = row.cannot_tell;
    for (const Tried& t : row.tried) {
      r["tried"].push_back({{"kind", t.kind},
                            {"name", t.name},
                            {"what", t.what},
                            {"with", number(t.with.mean)},
                            {"without", number(t.without.mean)},
                            {"beds", t.with.n},
                            {"inside", t.inside}});
    }
    j["targets"].push_back(r);
  }
  j["runs_made_by"] = campaign.codes();
  j["version"] = version_json();
  const auto replace = [&](const fs::path& name, const std::string& text) {
    const fs::path partial = folder / (name.string() + ".partial");
    write_file(partial, text);
    fs::rename(partial, folder / name);
  };
  replace("summary.json", result_json_text(j));
  const std::vector<Figure> figures = draw_figures(campaign.outcomes());
  fs::create_directories(folder / "figures");
  for (const Figure& figure : figures) {
    replace(fs::path("figures") / (figure.name + ".svg"), figure.svg);
  }
  const std::string glance = draw_targets(rows);
  if (!glance.empty()) replace(fs::path("figures") / "targets.svg", glance);
  replace("report.html", summary_page(campaign, options, rows, figures));
}

std::string design_text(const ReproduceOptions& options) {
  const std::string beds = "; " + std::to_string(options.beds) +
                           " beds of each, bed after bed, so that whatever stops it leaves whole "
                           "pairs on the beds that are through";
  switch (options.design()) {
    case Design::kNight:
      return "design night: what the bands are of (three feet at 10 and 40 kg, speed at 40 kg, 30 "
             "degrees at 60 kg, both steps with and without spines)" +
             beds;
    case Design::kStated:
      return "design stated: the conditions that the paper states numbers of, as only they can "
             "come out inside or outside, and sinkage at 20 degrees, which it draws" +
             beds;
    case Design::kFull:
      return "design full, for a cluster: every load from 10 to 60 kg, every opening at every "
             "load" +
             beds;
  }
  return "";
}

void print_plan(const Campaign& campaign, const ReproduceOptions& options,
                const std::vector<Variation>& variations) {
  std::vector<PlannedRun> all, missing;
  for (const Cell& cell : campaign.cells()) {
    const bool there = campaign.done(cell);
    all.push_back(campaign.planned(cell));
    if (!there) missing.push_back(all.back());
    std::printf("%-8s %s\n", there ? "done" : "missing", cell.id().c_str());
  }
  std::printf("%s\n", design_text(options).c_str());
  for (const Variation& v : variations) {
    const auto& asked = options.variations;
    if (std::find(asked.begin(), asked.end(), v.name) == asked.end()) continue;
    std::printf("%s (%s): %s\n", v.name.c_str(), v.kind.c_str(), v.what.c_str());
  }
  std::printf("%zu runs, %zu done\n", campaign.cells().size(),
              campaign.cells().size() - missing.size());
  const CostModel model(campaign.store(), all);
  const int cores = int(std::max(1U, std::thread::hardware_concurrency()));
  std::fputs(cost_text(model, missing, options.engine.jobs_at_once(cores),
                       options.engine.threads_each(cores))
                 .c_str(),
             stdout);
}

TableOptions table_options(const ReproduceOptions& options) {
  TableOptions tables;
  tables.campaign = options.folder();
  tables.heaps = options.beds;
  tables.threads = int(std::max(1U, std::thread::hardware_concurrency()));
  tables.quiet = options.quiet;
  return tables;
}

/// For a terminal: what a bed cannot tell as numbers in place of sentences, which would make a row
/// four hundred characters wide. @return the sentences, the first is number 1
std::vector<std::string> number_sentences(std::vector<Comparison>& rows) {
  std::vector<std::string> names;
  for (Comparison& row : rows) {
    std::set<std::size_t> numbers;
    for (const std::string& sentence : row.cannot_tell) {
      const std::string name = sentence.substr(0, sentence.find(": "));
      auto at = std::find(names.begin(), names.end(), name);
      if (at == names.end()) at = names.insert(names.end(), name);
      numbers.insert(std::size_t(at - names.begin()) + 1);
    }
    std::string text;
    for (const std::size_t n : numbers) text += (text.empty() ? "" : " ") + std::to_string(n);
    row.cannot_tell = {text};
  }
  return names;
}

/// The plan's conditions under the variations, bed after bed. @param named empty: all
std::vector<Cell> under(const std::vector<Variation>& variations,
                        const std::vector<std::string>& named, const std::vector<Cell>& plan,
                        int last_bed) {
  std::vector<Cell> cells;
  std::set<std::string> there;
  for (const Cell& cell : plan) {
    if (cell.bed > last_bed) continue;
    for (const Variation& v : variations) {
      if (!named.empty() && std::find(named.begin(), named.end(), v.name) == named.end()) continue;
      const Cell other = varied(cell, v);
      if (!other.variation.empty() && there.insert(other.id()).second) cells.push_back(other);
    }
  }
  return cells;
}

std::vector<Altered> changes(const Campaign& campaign, const std::vector<Variation>& variations) {
  const Outcomes base = campaign.outcomes();
  std::vector<Altered> all = {sole_reading(base)};
  for (const Variation& v : variations) {
    all.push_back(
        altered(v.kind, v.name, v.what, base, campaign.outcomes(v.name), unchanged(base, v)));
  }
  const std::size_t single = all.size();
  for (std::size_t i = 1; i < single; ++i) all.push_back(with_sole_reading(all[i]));
  return all;
}

std::set<Part> every_part() {
  std::set<Part> parts;
  for (const auto& [name, part] : part_names()) parts.insert(part);
  return parts;
}

void run_campaign(const ReproduceOptions& options) {
  CampaignSettings settings = options.ground.settings();
  settings.asked = options.settings;
  const std::vector<Variation> variations = all_variations(settings);
  const std::vector<Cell> plan =
      plan_cells(options.parts, options.design(), options.beds, options.first_bed);
  std::vector<Cell> cells = plan;
  if (!options.variations.empty()) {
    const std::vector<Cell> more =
        under(variations, options.variations, plan, options.first_bed + options.variation_beds - 1);
    cells.insert(cells.end(), more.begin(), more.end());
  }
  // The summary is of the folder: what an earlier call made on these beds counts, asked for or not.
  std::vector<Cell> others =
      plan_cells(every_part(), Design::kFull, options.beds, options.first_bed);
  const std::vector<Cell> stated =
      plan_cells(every_part(), Design::kStated, options.beds, options.first_bed);
  others.insert(others.end(), stated.begin(), stated.end());
  const std::vector<Cell> changed =
      under(variations, {}, others, options.first_bed + options.beds - 1);
  others.insert(others.end(), changed.begin(), changed.end());
  Campaign campaign(options.folder(), cells, settings, others);
  if (options.plan_only) {
    print_plan(campaign, options, variations);
    return;
  }
  const auto summary = [&] {
    std::vector<Comparison> rows = compare_with_paper(campaign.outcomes());
    try_changes(rows, changes(campaign, variations));
    const std::vector<Comparison> tables = table_targets(campaign.folder());
    rows.insert(rows.end(), tables.begin(), tables.end());
    if (!options.reasons_from.empty()) ask_other_campaign(rows, options.reasons_from);
    write_summary(campaign, options, rows);
    return rows;
  };
  const CampaignEnd end = campaign.run(options.engine, [&] { summary(); });
  std::vector<Comparison> rows = summary();
  const std::size_t all = rows.size();
  std::erase_if(rows, [](const Comparison& row) { return row.judgement() == Judgement::kNotRun; });
  const std::vector<std::string> sentences = number_sentences(rows);
  std::cout << table_of(rows, false).markdown();
  for (std::size_t i = 0; i < sentences.size(); ++i) {
    std::cout << (i == 0 ? "what a bed cannot tell, with the numbers in summary.csv\n" : "") << "  "
              << i + 1 << " " << sentences[i] << "\n";
  }
  bool first = true;
  for (const Comparison& row : rows) {
    if (row.reasons().empty()) continue;
    std::cout << (first ? "one thing changed; all of it in changes.csv and report.html\n" : "")
              << "  " << row.name << ": " << row.reasons() << "\n";
    first = false;
  }
  if (rows.size() < all) std::cout << all - rows.size() << " more targets were not run\n";
  for (const auto& [foot, hash] : campaign.geometry_hashes()) {
    std::cout << "geometry of " << foot << ": SHA-256 " << hash << "\n";
  }
  if (end.queued > 0) {
    std::cout << end.queued << " runs are in the cluster's queue or under way; the same command "
              << "looks again, hoof campaign status " << campaign.folder().string()
              << " tells how far they are\n";
  }
  std::cout << (campaign.folder() / "report.html").string() << std::endl;
  if (!end.failed.empty()) {
    throw CannotFinish(std::to_string(end.failed.size()) + " of " +
                       std::to_string(campaign.cells().size()) +
                       " runs could not be finished, the first: " + end.failed.front());
  }
}

}  // namespace

void reproduce(const ReproduceOptions& options) {
  if (!options.reasons_from.empty()) {  // a night is too late to say that it is none
    std::vector<Comparison> nothing;
    ask_other_campaign(nothing, options.reasons_from);
  }
  for (const std::string& figure : options.figures) std::cout << about_figure(figure) << "\n";
  for (const std::string& table : options.tables) {
    if (options.plan_only) {
      std::cout << table_plan(table, table_options(options)) << std::endl;
    } else {
      reproduce_table(table, table_options(options));
    }
  }
  if (!options.parts.empty()) run_campaign(options);
  if (options.parts.empty() && options.tables.empty()) {
    throw UserError("no figure of these can be drawn by its number");
  }
}

}  // namespace hoof::tools
