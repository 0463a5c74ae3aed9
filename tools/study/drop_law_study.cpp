#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <limits>

#include "tools/run/errors.h"
#include "tools/study/drop_law.h"
#include "tools/study/table.h"

namespace hoof::tools {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

double value_of(const DropLaw& law, const std::vector<double>& values, const std::string& name) {
  for (std::size_t i = 0; i < law.parameters.size(); ++i) {
    if (law.parameters[i].name == name) return values[i];
  }
  return kNone;
}

Table law_table(const std::vector<DropFit>& fits) {
  Table table({{"law_name", 0},
               {"parameter_count", 0},
               {"height_mm", 2},
               {"height_after_mm", 2},
               {"kept_tangential_ratio", 3},
               {"kept_plus_minus_ratio", 3},
               {"rms_mm", 3},
               {"held_out_rms_mm", 3}});
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const DropLaw& law = drop_laws()[i];
    table.row({law.name, static_cast<std::int64_t>(law.parameters.size()),
               value_of(law, fits[i].values, "H"), value_of(law, fits[i].values, "H2"),
               value_of(law, fits[i].values, "k_t"), value_of(law, fits[i].interval, "k_t"),
               fits[i].rms_mm, fits[i].held_out_rms_mm});
  }
  return table;
}

Table row_table(const DropFit& before, const DropFit& after) {
  Table table({{"e_ratio", 3}, {"travel_mm", 2}, {"off_before_mm", 2}, {"off_after_mm", 2}});
  const auto& rows = paper_drop_table();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    table.row({rows[i].e, rows[i].travel_mm, before.held_out_mm[i], after.held_out_mm[i]});
  }
  return table;
}

void print_summary(const std::vector<DropFit>& fits) {
  const DropFit& before = fits[kPaperLaw];
  const DropFit& after = fits[kRetainedLaw];
  const DropFit& floor = fits[kFreeCurve];
  const double kept = after.values[1], half = after.interval[1];
  std::printf(
      "\nHeld-out error: %.2f mm with L = 2 e H, %.2f mm with retained tangential speed, %.2f mm\n"
      "for a free curve. Kept share of tangential speed: %.3f, 95 %% interval %.3f to %.3f.\n",
      before.held_out_rms_mm, after.held_out_rms_mm, floor.held_out_rms_mm, kept, kept - half,
      kept + half);
  const DropFit& offset = fits[kOffsetLaw];
  std::printf(
      "A fixed offset of %.1f mm beside 2 e H comes near it (%.2f mm), but no part of the test\n"
      "would make one of that size.\n",
      offset.values[1], offset.held_out_rms_mm);
  const DropFit& both = fits[kRetainedTwoHeightsLaw];
  std::printf(
      "If the fall after the impact may have another height, the share is %.2f +- %.2f: this "
      "table\n"
      "cannot tell friction in the impact from a second height. Stating both heights decides, or\n"
      "recording how high the grain rises after the impact.\n",
      both.values[1], both.interval[1]);
}

}  // namespace

void run_drop_law_study(const std::string& out) {
  if (!out.empty()) {
    std::error_code error;
    std::filesystem::create_directories(out, error);
    if (error) throw UserError("--out " + out + ": cannot be made: " + error.message());
  }
  std::vector<DropFit> fits;
  for (const DropLaw& law : drop_laws()) fits.push_back(fit_drop_law(law, paper_drop_table()));
  const Table laws = law_table(fits);
  const Table rows = row_table(fits[kPaperLaw], fits[kRetainedLaw]);
  std::cout
      << "Travel of a grain that drops on a plate at 45 degrees, 13 simulated rows (Ji et al. "
         "2026, table 3)\n\n"
      << laws.markdown()
      << "\nEach row predicted from the others: before is 2 e H, after is k_t free\n\n"
      << rows.markdown() << std::flush;
  print_summary(fits);
  if (out.empty()) return;
  laws.write_csv(std::filesystem::path(out) / "laws.csv");
  rows.write_csv(std::filesystem::path(out) / "rows.csv");
}

}  // namespace hoof::tools
