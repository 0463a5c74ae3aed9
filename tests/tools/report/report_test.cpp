#include "tools/report/report.h"

#include <catch2/catch.hpp>

#include "tests/tools/report/synthetic_run.h"
#include "tests/tools/run/scratch_folder.h"
#include "tools/report/headline.h"
#include "tools/report/plot_groups.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
using Catch::Contains;
using hoof::tests::ScratchFolder;
using hoof::tests::write_synthetic_run;

namespace {

SampleTable table_of(const std::vector<std::string>& names) {
  SampleTable table;
  for (const std::string& name : names) table.columns.push_back({name, {0.0}, {}});
  return table;
}

}  // namespace

TEST_CASE("columns are put into plots by name and unit") {
  const SampleTable table = table_of({"time_s", "phase_name", "depth_m", "velocity_m_s", "fx_N",
                                      "fz_N", "toe_command_rad", "hip_torque_Nm", "knee_torque_Nm",
                                      "hip_angle_rad", "carriage_m", "plate_N", "speed_x_m_s"});
  std::vector<std::string> plots;
  for (const PlotGroup& group : group_plots(table)) {
    std::string text = group.title + " [" + group.unit.symbol + "]:";
    for (const SampleColumn* column : group.columns) text += " " + column->name;
    plots.push_back(text);
  }
  CHECK(plots == std::vector<std::string>{
                     "Depth [mm]: depth_m", "Forces on the foot [N]: fx_N fz_N",
                     "Toe angle [°]: toe_command_rad", "Joint angles [°]: hip_angle_rad",
                     "Joint torques [N m]: hip_torque_Nm knee_torque_Nm",
                     "Speed [m/s]: velocity_m_s speed_x_m_s", "Length [mm]: carriage_m",
                     "Force [N]: plate_N"});
}

TEST_CASE("the headline shows what the run has, in the reader's units") {
  const ScratchFolder scratch;
  write_synthetic_run(scratch.path(), 10);
  std::vector<std::string> rows;
  for (const HeadlineRow& row : headline(read_run_data(scratch.path()))) {
    rows.push_back(row.label + ": " + row.value + " " + row.unit);
  }
  CHECK_THAT(rows, Catch::VectorContains(std::string("Foot: bionic ")));
  CHECK_THAT(rows, Catch::VectorContains(std::string("Load: 40 kg")));
  CHECK_THAT(rows, Catch::VectorContains(std::string("Greatest depth: 13.81 mm")));
  CHECK_THAT(rows, Catch::VectorContains(std::string("Toe angle commanded, per side: 30 °")));
  CHECK_THAT(rows, Catch::VectorContains(std::string("Peak torque, hip: 39 N m")));
  CHECK_THAT(rows, Catch::VectorContains(std::string("Bus load, bus1: 47 %")));
  for (const std::string& row : rows) CHECK_THAT(row, !Contains("raction coefficient"));
}

TEST_CASE("a report is one self-contained page with the refused claims, and always the same") {
  const ScratchFolder scratch;
  write_synthetic_run(scratch.path(), 50);
  const std::string page = read_file(write_report(scratch.path()));
  CHECK_THAT(page, Contains("<h1>Sinkage test</h1>"));
  CHECK_THAT(page, Contains("spine pitch / d50"));
  CHECK_THAT(page, Contains("<li>effect of the spines: less than 3 grains between two spines"));
  CHECK_THAT(page, Contains("<a href=\"./samples.csv\">"));
  CHECK_THAT(page, Contains("torque_peak_Nm.hip"));
  // Text from the run cannot become markup.
  CHECK_THAT(page, Contains("&lt;/script&gt;&lt;b&gt;&amp;"));
  // Nothing is fetched: no element with a source or a style sheet of its own.
  CHECK_THAT(page, !Contains(" src=") && !Contains("rel=\"stylesheet\"") && !Contains("@import"));
  CHECK(read_file(write_report(scratch.path())) == page);
}

TEST_CASE("malformed run folders are refused with file and line") {
  const ScratchFolder scratch;
  const auto& folder = scratch.path();
  CHECK_THROWS_WITH(make_report(folder / "absent"), Contains("is no run folder"));
  write_synthetic_run(folder, 3);

  const auto spoil = [&folder](const char* name, const std::string& text) {
    write_synthetic_run(folder, 3);
    write_file(folder / name, text);
  };
  spoil("samples.csv", "time_s,depth_m\n0,1\n1\n");
  CHECK_THROWS_WITH(make_report(folder), Contains("samples.csv:3: 1 cells for 2 columns"));
  spoil("samples.csv", "time_s,depth_m\n0,deep\n");
  CHECK_THROWS_WITH(make_report(folder), Contains("samples.csv:2: depth_m = 'deep'"));
  spoil("samples.csv", "time_s,depth_m\n0,1\n0.001,0.0");
  CHECK_THROWS_WITH(make_report(folder), Contains("cut short"));
  spoil("samples.csv", "depth_m\n1\n");
  CHECK_THROWS_WITH(make_report(folder), Contains("time_s"));
  spoil("settings.toml", "a = 1\nb = \n");
  CHECK_THROWS_WITH(make_report(folder), Contains("settings.toml:2:"));
  spoil("result.json", "{\"a\": }");
  CHECK_THROWS_AS(make_report(folder), UserError);
  spoil("result.json", "[1]");
  CHECK_THROWS_WITH(make_report(folder), Contains("is no JSON object"));
}

TEST_CASE("values that are not numbers become gaps, not broken JSON") {
  const ScratchFolder scratch;
  write_synthetic_run(scratch.path(), 3);
  write_file(scratch.path() / "samples.csv", "time_s,depth_m\n0,nan\n0.001,0.002\n");
  CHECK_THAT(make_report(scratch.path()), Contains("\"values\":[null,2]"));
}

TEST_CASE("text of the samples cannot end the script that holds it") {
  const ScratchFolder scratch;
  write_synthetic_run(scratch.path(), 3);
  write_file(scratch.path() / "samples.csv", "time_s,phase_name,depth_m\n0,</script><b>,1\n");
  const std::string page = make_report(scratch.path());
  CHECK_THAT(page, Contains("\\u003c/script>\\u003cb>") && !Contains("</script><b>"));
}
