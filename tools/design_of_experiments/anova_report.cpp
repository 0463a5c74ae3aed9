#include "tools/design_of_experiments/anova_report.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/diagnose/csv_table.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

namespace hoof::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double kUsualDoubt = 0.05;  // of a factor's range

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[256];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

std::string p_text(double p) {
  return std::isnan(p) ? "" : p < 1e-4 ? "< 0.0001" : text("%.4f", p);
}

std::string number(double value) {
  return std::isnan(value) ? "" : text("%.6g", value);
}

Json json_number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// Bounds as told, else those of the data.
std::vector<Factor> factors_of(const AnovaOptions& options, const Runs& runs) {
  std::vector<Factor> factors;
  for (std::size_t f = 0; f < options.factors.size(); ++f) {
    Factor factor{options.factors[f], runs.factors[0][f], runs.factors[0][f]};
    for (const auto& run : runs.factors) {
      factor.low = std::min(factor.low, run[f]);
      factor.high = std::max(factor.high, run[f]);
    }
    factors.push_back(factor);
  }
  for (const std::string& range : options.ranges) {
    const Factor told = parse_factor(range);
    const auto at = std::find_if(factors.begin(), factors.end(),
                                 [&told](const Factor& f) { return f.name == told.name; });
    if (at == factors.end()) throw UserError("--range " + range + ": no factor " + told.name);
    *at = told;
  }
  for (const Factor& factor : factors) {
    if (!(factor.low < factor.high)) {
      throw UserError(runs.source + ": the factor " + factor.name + " is the same in all runs");
    }
  }
  return factors;
}

std::vector<double> doubts_of(const AnovaOptions& options, const std::vector<Factor>& factors) {
  std::vector<double> doubts;
  for (const Factor& f : factors) doubts.push_back(kUsualDoubt * (f.high - f.low));
  for (const std::string& told : options.doubts) {
    const std::size_t equals = told.find('=');
    double value = 0;
    const char* end = told.data() + told.size();
    const auto read = equals == std::string::npos
                          ? std::from_chars_result{told.data(), std::errc::invalid_argument}
                          : std::from_chars(told.data() + equals + 1, end, value);
    if (read.ec != std::errc() || read.ptr != end || !(value > 0)) {
      throw UserError("--second " + told + ": write NAME=DOUBT, e.g. mu_s=0.02");
    }
    const std::string name = told.substr(0, equals);
    const auto at = std::find_if(factors.begin(), factors.end(),
                                 [&name](const Factor& f) { return f.name == name; });
    if (at == factors.end()) throw UserError("--second " + told + ": no factor " + name);
    doubts[static_cast<std::size_t>(at - factors.begin())] = value;
  }
  return doubts;
}

std::string variance_text(const ResponseSurface& s) {
  std::string out = text("%-14s %14s %4s %14s %12s %9s\n", "source", "sum of squares", "df",
                         "mean square", "F", "p");
  for (const VarianceRow& r : s.variance()) {
    out +=
        text("%-14s %14s %4d %14s %12s %9s\n", r.source.c_str(), number(r.sum_of_squares).c_str(),
             r.freedom, number(r.mean_square).c_str(), number(r.f).c_str(), p_text(r.p).c_str());
  }
  if (s.residual_freedom() < 1) {
    return out +
           "\nAs many terms as runs: the surface goes through all of them; no variance is told.\n";
  }
  out += text(
      "\nR2 %.4f   adjusted %.4f   predicted %.4f   adequate precision %.1f   residual %.4g\n",
      s.r2(), s.adjusted_r2(), s.predicted_r2(), s.adequate_precision(), s.residual_deviation());
  return out;
}

std::string coefficients_text(const ResponseSurface& s) {
  std::string out = text("\n%-14s %14s %14s %14s\n", "term", "coded", "+- (1 sigma)", "natural");
  const Eigen::VectorXd natural = s.natural(), errors = s.coded_errors();
  for (std::size_t i = 0; i < s.terms().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    out += text("%-14s %14.6g %14.4g %14.6g\n", s.terms()[i].c_str(), s.coded()[at], errors[at],
                natural[at]);
  }
  return out;
}

std::string point_text(const ResponseSurface& s, const std::vector<double>& coded) {
  std::string out;
  for (std::size_t f = 0; f < coded.size(); ++f) {
    out += (f > 0 ? ", " : "") + s.factors()[f].name + " " + number(s.factors()[f].value(coded[f]));
  }
  return out;
}

std::string optimum_text(const ResponseSurface& s, const AnovaOptions& options) {
  const std::vector<double> x = s.optimum(!options.smallest);
  const bool edge =
      std::any_of(x.begin(), x.end(), [](double v) { return std::abs(v) > 1 - 1e-9; });
  return text("\n%s %s within the bounds: %.4g +- %.2g (95 %%; one new run +- %.2g) at ",
              options.smallest ? "smallest" : "largest", options.response.c_str(), s.at(x),
              s.mean_half95(x), s.run_half95(x)) +
         point_text(s, x) + (edge ? " (at a bound: no optimum inside)" : "") + "\n";
}

std::string valley_text(const ResponseSurface& s, const Valley& v, const AnovaOptions& options) {
  std::string out =
      text("\n%s %.6g +- %.4g: %.1f %% of the bounds' box cannot be told apart",
           options.response.c_str(), options.target, options.tolerance, 100 * v.share);
  if (v.points.empty()) return out + ": nothing there reaches it\n";
  out += "\n";
  for (std::size_t f = 0; f < s.factors().size(); ++f) {
    out += text("  %-12s from %.4g to %.4g\n", s.factors()[f].name.c_str(), v.low[f], v.high[f]);
  }
  out += text("  %-26s %14s  width left of the others\n", "a second test of one alone",
              "share that stays");
  for (std::size_t f = 0; f < s.factors().size(); ++f) {
    out += text("  %-12s to +- %-9.4g %12.1f %%   ", s.factors()[f].name.c_str(), v.left[f].doubt,
                100 * v.left[f].share);
    for (std::size_t o = 0; o < s.factors().size(); ++o) {
      if (o != f) out += text(" %s %.0f %%", s.factors()[o].name.c_str(), 100 * v.left[f].width[o]);
    }
    out += f == static_cast<std::size_t>(v.most_telling()) ? "   <- tells most\n" : "\n";
  }
  return out;
}

Json json_of(const ResponseSurface& s, const AnovaOptions& options) {
  Json json;
  json["format"] = 1;
  json["response"] = options.response;
  for (const Factor& f : s.factors()) {
    json["factors"].push_back({{"name", f.name}, {"low", f.low}, {"high", f.high}});
  }
  const Eigen::VectorXd natural = s.natural(), errors = s.coded_errors();
  for (std::size_t i = 0; i < s.terms().size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    json["terms"].push_back({{"term", s.terms()[i]},
                             {"coded", s.coded()[at]},
                             {"coded_sigma", json_number(errors[at])},
                             {"natural", natural[at]}});
  }
  for (const VarianceRow& r : s.variance()) {
    json["variance"].push_back({{"source", r.source},
                                {"sum_of_squares", r.sum_of_squares},
                                {"df", r.freedom},
                                {"mean_square", json_number(r.mean_square)},
                                {"f", json_number(r.f)},
                                {"p", json_number(r.p)}});
  }
  json["r2"] = s.r2();
  json["adjusted_r2"] = json_number(s.adjusted_r2());
  json["predicted_r2"] = json_number(s.predicted_r2());
  json["adequate_precision"] = json_number(s.adequate_precision());
  return json;
}

void write_files(const ResponseSurface& s, const Runs& runs, const Valley& valley,
                 const AnovaOptions& options) {
  fs::create_directories(options.out);
  write_file(options.out / "anova.json", json_of(s, options).dump(1) + "\n");
  std::string names;
  for (const Factor& f : s.factors()) names += f.name + ",";
  std::string rows = names + options.response + ",predicted,left\n";
  for (std::size_t i = 0; i < runs.response.size(); ++i) {
    for (const double v : runs.factors[i]) rows += number(v) + ",";
    const auto at = static_cast<Eigen::Index>(i);
    rows += number(runs.response[i]) + "," + number(s.fitted()[at]) + "," +
            number(s.residuals()[at]) + "\n";
  }
  write_file(options.out / "predicted.csv", rows);
  if (!options.has_target) return;
  rows = names + "predicted\n";
  for (const auto& point : valley.points) {
    for (std::size_t f = 0; f < point.size(); ++f) {
      rows += number(s.factors()[f].value(point[f])) + ",";
    }
    rows += number(s.at(point)) + "\n";
  }
  write_file(options.out / "valley.csv", rows);
}

}  // namespace

Runs read_runs(const fs::path& file, const std::vector<std::string>& factors,
               const std::string& response) {
  std::set<std::string> wanted(factors.begin(), factors.end());
  if (wanted.size() != factors.size()) throw UserError("a factor is named twice");
  if (!wanted.insert(response).second) throw UserError(response + " is a factor and the response");
  const CsvTable table = read_csv(file, wanted);
  Runs runs;
  runs.source = file.string();
  for (const std::string& name : wanted) {
    if (table.find(name) >= 0) continue;
    std::string known;
    for (const std::string& other : table.names) known += (known.empty() ? "" : ", ") + other;
    throw UserError(file.string() + ": no column " + name + "; there are " + known);
  }
  const auto& y = table.columns[static_cast<std::size_t>(table.find(response))];
  for (std::size_t i = 0; i < y.size(); ++i) {
    std::vector<double> x;
    bool whole = std::isfinite(y[i]);
    for (const std::string& name : factors) {
      x.push_back(table.columns[static_cast<std::size_t>(table.find(name))][i]);
      whole = whole && std::isfinite(x.back());
    }
    if (!whole) continue;
    runs.factors.push_back(x);
    runs.response.push_back(y[i]);
  }
  if (runs.response.empty()) throw UserError(file.string() + ": no run with all of its numbers");
  return runs;
}

std::string run_anova(const AnovaOptions& options) {
  const Runs runs = read_runs(options.data, options.factors, options.response);
  const ResponseSurface surface(factors_of(options, runs), runs, options.model);
  std::string out =
      variance_text(surface) + coefficients_text(surface) + optimum_text(surface, options);
  Valley valley;
  if (options.has_target) {
    valley = find_valley(surface, options.target, options.tolerance,
                         doubts_of(options, surface.factors()));
    out += valley_text(surface, valley, options);
  }
  if (!options.out.empty()) write_files(surface, runs, valley, options);
  return out;
}

}  // namespace hoof::tools
