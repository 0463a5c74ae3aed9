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
#include "tools/reproduce/paper_numbers.h"
#include "tools/reproduce/summary_page.h"
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
               {"note_name"},
               {"reason_name"}});
  for (const Comparison& row : rows) {
    const bool band = row.low != 0 || row.high != 0;
    table.row({row.name, row.unit, figure(row.paper), band ? figure(row.low) : "",
               band ? figure(row.high) : "", row.ours ? figure(row.ours->mean) : "",
               row.ours ? figure(row.ours->deviation) : "",
               std::int64_t(row.ours ? row.ours->n : 0), to_string(row.judgement()),
               to_string(row.standing), row.note, row.reason});
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
    for (std::string* text : {&row.name, &row.note, &row.reason}) {
      for (char& c : *text) c = c == ',' ? ';' : c;
    }
  }
  table_of(plain).write_csv(folder / "summary.csv");
  nlohmann::ordered_json j;
  j["scale"] = options.ground.scale, j["terrain"] = options.ground.terrain;
  j["design"] = design_name(options.design());
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
    if (!row.reason.empty()) r["reason"] = row.reason;
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
  const std::vector<Figure> figures = draw_figures(campaign.outcomes(), options.parts);
  fs::create_directories(folder / "figures");
  for (const Figure& figure : figures) {
    replace(fs::path("figures") / (figure.name + ".svg"), figure.svg);
  }
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
             "come out inside or outside" +
             beds;
    case Design::kFull:
      return "design full, for a cluster: every load from 10 to 60 kg, every opening at every "
             "load" +
             beds;
  }
  return "";
}

void print_plan(const Campaign& campaign, const ReproduceOptions& options) {
  std::vector<PlannedRun> all, missing;
  for (const Cell& cell : campaign.cells()) {
    const bool there = campaign.done(cell);
    all.push_back(campaign.planned(cell));
    if (!there) missing.push_back(all.back());
    std::printf("%-8s %s\n", there ? "done" : "missing", cell.id().c_str());
  }
  std::printf("%s\n", design_text(options).c_str());
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
std::vector<std::string> number_reasons(std::vector<Comparison>& rows) {
  std::vector<std::string> names;
  for (Comparison& row : rows) {
    if (!row.reason.starts_with(kBedCannotTell)) continue;
    std::set<std::size_t> numbers;
    std::istringstream parts(row.reason.substr(std::string(kBedCannotTell).size()));
    for (std::string part; std::getline(parts, part, ';');) {
      const std::size_t begin = part.find_first_not_of(' ');
      const std::string name = part.substr(begin, part.find(": ") - begin);
      auto at = std::find(names.begin(), names.end(), name);
      if (at == names.end()) at = names.insert(names.end(), name);
      numbers.insert(std::size_t(at - names.begin()) + 1);
    }
    row.reason = "bed:";
    for (const std::size_t n : numbers) row.reason += " " + std::to_string(n);
  }
  return names;
}

void run_campaign(const ReproduceOptions& options) {
  CampaignSettings settings = options.ground.settings();
  settings.asked = options.settings;
  Campaign campaign(options.folder(),
                    plan_cells(options.parts, options.design(), options.beds, options.first_bed),
                    settings);
  if (options.plan_only) {
    print_plan(campaign, options);
    return;
  }
  const auto summary = [&] {
    const std::vector<Comparison> rows = compare_with_paper(campaign.outcomes());
    write_summary(campaign, options, rows);
    return rows;
  };
  const CampaignEnd end = campaign.run(options.engine, [&] { summary(); });
  std::vector<Comparison> rows = summary();
  const std::size_t all = rows.size();
  std::erase_if(rows, [](const Comparison& row) { return !row.ours; });
  const std::vector<std::string> reasons = number_reasons(rows);
  std::cout << table_of(rows).markdown();
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    std::cout << (i == 0 ? "bed: what it cannot tell, with the numbers in summary.csv\n" : "")
              << "  " << i + 1 << " " << reasons[i] << "\n";
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
