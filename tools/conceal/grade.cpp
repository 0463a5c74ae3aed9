#include "tools/conceal/grade.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <ostream>

#include "tools/conceal/case_reader.h"
#include "tools/conceal/measures.h"
#include "tools/conceal/regression.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools::conceal {
namespace {

namespace fs = std::filesystem;
using Picks = std::vector<std::optional<Pick>>;

struct Method {
  std::string name;
  Picks picks;
};

template <typename... Args>
std::string text(const char* format, Args... args) {
  char line[300];
  std::snprintf(line, sizeof line, format, args...);
  return line;
}

std::string amount(const Measure& m, double value) {
  return m.is_share ? text("%5.1f %%", 100.0 * value) : text("%7.3f", value);
}

std::string bound(const Measure& m, double low, double high) {
  const double unit = m.is_share ? 100.0 : 1.0;
  const char* end = m.is_share ? " %" : "";
  if (low > 0.0 && high < 1.0) return text("%g-%g%s", unit * low, unit * high, end);
  return high < 1.0 ? text("<= %g%s", unit * high, end) : text(">= %g%s", unit * low, end);
}

std::string verdict_on(const Measure& m) {
  if (m.count == 0) return "no case";
  return m.meets_aim() ? "aim" : m.meets_floor() ? "floor" : "NOT MET";
}

void print_measures(const std::vector<Measure>& measures, std::ostream& out) {
  out << text("%-36s %8s %6s  %-18s %-10s %-10s %s\n", "measure", "value", "count", "95 % interval",
              "floor", "aim", "met");
  for (const Measure& m : measures) {
    // An interval is told of counted shares and of means alike; the calibration error has none.
    const bool told = m.count > 1 && m.name != "calibration error";
    const std::string interval =
        told ? amount(m, m.bounds.low) + " -" + amount(m, m.bounds.high) : "-";
    out << text("%-36s %8s %6d  %-18s %-10s %-10s %s\n", m.name.c_str(),
                m.count > 0 ? amount(m, m.value).c_str() : "-", m.count, interval.c_str(),
                bound(m, m.floor_low, m.floor_high).c_str(),
                bound(m, m.aim_low, m.aim_high).c_str(), verdict_on(m).c_str());
  }
}

/// @param left_out how many have no answer, where those do not count
std::vector<GradedCase> read_cases(const GradeOptions& options, std::size_t& left_out) {
  const fs::path truth = options.truth.empty() ? options.batch / "truth.json" : options.truth;
  std::vector<GradedCase> cases;
  for (const TruthCase& one : read_truth(truth, options.batch / "truth.sha256")) {
    if (options.answered && !fs::exists(options.answers / one.name)) {
      ++left_out;
      continue;
    }
    GradedCase graded{one, std::nullopt, ""};
    try {
      graded.answer = read_answer(options.answers / one.name);
    } catch (const UserError& e) {
      graded.complaint = e.what();
    }
    cases.push_back(std::move(graded));
  }
  return cases;
}

Picks picks_of(const std::vector<GradedCase>& cases,
               std::vector<std::string> (*choose)(const Answer&)) {
  Picks picks;
  for (const GradedCase& c : cases) {
    const std::vector<std::string> name = c.answer ? choose(*c.answer) : std::vector<std::string>{};
    picks.push_back(name.empty() ? std::nullopt : std::optional<Pick>(pick_named(name[0])));
  }
  return picks;
}

/// Those who look at the recordings themselves, each in its own way.
void add_regressions(const GradeOptions& options, const std::vector<TruthCase>& cases,
                     std::vector<Method>& methods) {
  Method sparse{"sparse", {}}, process{"Gaussian", {}};
  for (const TruthCase& c : cases) {
    const RegressionProblem problem =
        regression_of(read_case(options.batch / c.name / "dataset.toml"));
    sparse.picks.push_back(pick_named(pick_by_sparse_regression(problem)));
    process.picks.push_back(pick_named(pick_by_gaussian_process(problem)));
  }
  methods.push_back(sparse);
  methods.push_back(process);
}

/// Whoever always says what is most often so: of names, the commonest single effect.
Picks commonest(const std::vector<TruthCase>& cases) {
  std::map<std::string, int> counts;
  for (const TruthCase& c : cases) {
    if (c.kind == "one") ++counts[c.effects[0].name];
  }
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  const std::string name = most == counts.end() ? "none" : most->first;
  return Picks(cases.size(), pick_named(name));
}

void print_methods(const std::vector<TruthCase>& cases, const std::vector<Method>& methods,
                   std::ostream& out) {
  std::vector<std::vector<Measure>> columns;
  out << text("\n%-36s", "beside it");
  for (const Method& method : methods) {
    out << text(" %10s", method.name.c_str());
    columns.push_back(verdict_measures(cases, method.picks));
  }
  out << "\n";
  for (std::size_t row = 0; row < columns[0].size(); ++row) {
    out << text("%-36s", columns[0][row].name.c_str());
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const bool none = std::none_of(methods[m].picks.begin(), methods[m].picks.end(),
                                     [](const auto& pick) { return pick.has_value(); });
      const Measure& cell = columns[m][row];
      out << text(" %10s", none || cell.count == 0 ? "-" : amount(cell, cell.value).c_str());
    }
    out << "\n";
  }
}

void print_confusion(const std::vector<TruthCase>& cases, const Picks& picks, std::ostream& out) {
  struct Row {
    int count = 0, good = 0;
    std::map<std::string, int> taken_for;
  };
  std::map<std::string, Row> rows;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const TruthCase& c = cases[i];
    const bool unknown = c.kind == "unknown";
    Row& row = rows[unknown ? "unknown (" + c.effects[0].name + ")" : label(c)];
    ++row.count;
    if (picks[i] && right(c, *picks[i])) {
      ++row.good;
    } else {
      ++row.taken_for[picks[i] ? label(*picks[i]) : "no answer"];
    }
  }
  out << text("\n%-46s %5s %5s  %s\n", "what was hidden", "cases", "right", "taken for");
  for (const auto& [name, row] : rows) {
    std::string others;
    for (const auto& [what, count] : row.taken_for) {
      others += (others.empty() ? "" : ", ") + what + (count > 1 ? text(" x%d", count) : "");
    }
    out << text("%-46s %5d %5d  ", name.c_str(), row.count, row.good) << others << "\n";
  }
}

void print_times(const std::vector<GradedCase>& cases, std::ostream& out) {
  std::vector<double> seconds;
  for (const GradedCase& c : cases) {
    if (c.answer && c.answer->seconds >= 0.0) seconds.push_back(c.answer->seconds);
  }
  if (seconds.empty()) return;
  std::sort(seconds.begin(), seconds.end());
  out << text("\ntime of an answer: median %.1f s, longest %.1f s, %zu cases\n",
              seconds[seconds.size() / 2], seconds.back(), seconds.size());
}

void print_missing(const std::vector<GradedCase>& cases, std::ostream& out) {
  for (const GradedCase& c : cases) {
    if (!c.answer) out << "no answer, counted as wrong: " << c.complaint << "\n";
  }
}

void write_cases(const fs::path& file, const std::vector<GradedCase>& cases, const Picks& picks) {
  std::string rows =
      "case,rig,kind,truth,hidden,masked,effort_snr_db,verdict,answer,right,probability,seconds\n";
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const TruthCase& c = cases[i].truth;
    std::string hidden;
    for (const HiddenEffect& e : c.effects) hidden += (hidden.empty() ? "" : "+") + e.name;
    rows += c.name + "," + c.rig + "," + c.kind + "," + label(c) + "," + hidden + "," +
            (c.masked ? "1," : "0,") + text("%.2f,", c.effort_snr_db);
    if (picks[i]) {
      double most = 0.0;
      for (const auto& [name, p] : cases[i].answer->probabilities) most = std::max(most, p);
      rows += picks[i]->verdict + "," + label(*picks[i]) + "," + (right(c, *picks[i]) ? "1" : "0") +
              text(",%.4f,%.2f\n", most, cases[i].answer->seconds);
    } else {
      rows += ",,0,,\n";
    }
  }
  write_file(file, rows);
}

}  // namespace

void grade(const GradeOptions& options, std::ostream& out) {
  std::size_t left_out = 0;
  const std::vector<GradedCase> cases = read_cases(options, left_out);
  std::vector<TruthCase> truths;
  Picks tool;
  for (const GradedCase& c : cases) {
    truths.push_back(c.truth);
    tool.push_back(c.answer ? std::optional<Pick>(pick_of(*c.answer)) : std::nullopt);
  }
  std::vector<Measure> measures = verdict_measures(truths, tool);
  const std::vector<Measure> more = answer_measures(cases);
  measures.insert(measures.end(), more.begin(), more.end());
  if (left_out > 0) out << "not answered so far, and left out: " << left_out << '\n';
  out << cases.size()
      << " cases; truth as sealed: " << read_file(options.batch / "truth.sha256").substr(0, 64)
      << "\n\n";
  print_measures(measures, out);
  std::vector<Method> methods = {{"diagnose", tool},
                                 {"AIC", picks_of(cases, pick_by_aic)},
                                 {"BIC", picks_of(cases, pick_by_bic)}};
  add_regressions(options, truths, methods);
  methods.push_back({"commonest", commonest(truths)});
  print_methods(truths, methods, out);
  print_confusion(truths, tool, out);
  print_times(cases, out);
  print_missing(cases, out);
  if (!options.csv.empty()) write_cases(options.csv, cases, tool);
}

}  // namespace hoof::tools::conceal
