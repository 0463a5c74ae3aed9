#include "tools/reproduce/claims_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/report/html.h"
#include "tools/report/page.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"
#include "tools/study/table.h"

namespace hoof::tools {
namespace fs = std::filesystem;
namespace {

constexpr const char* kRule =
    "Effects are of runs on the same bed; intervals are of 95 % (Student's t over the beds), of "
    "ratios by their logarithms: their means are geometric. "
    "A claim holds where the whole interval of each of its contrasts lies on the claimed side of "
    "the bound. Supported: under the base and under every variation. Fragile: under the base, not "
    "under some variation. Unsupported: not under the base. Open: not all was run, and nothing "
    "fails. sole-depth: the base's runs with depth as how far the sole, not the spines, is in the "
    "sand (the paper does not say which it means); no part of the verdict.";

std::string digits(double value) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

std::string interval(const Evidence& e) {
  std::string text = digits(e.mean());
  text += std::isfinite(e.sample.confidence)
              ? " (" + digits(e.low()) + " to " + digits(e.high()) + ")"
              : std::string(" (one bed)");
  if (e.infinite > 0) text += ", over nothing on " + std::to_string(e.infinite) + " more beds";
  return text;
}

std::string to_string(Finding finding) {
  return finding == Finding::kHolds ? "holds" : finding == Finding::kFails ? "fails" : "not run";
}

bool holds_there(const Contrast& contrast, const std::optional<Evidence>& evidence) {
  return evidence && evidence->beds.size() > 1 && holds(contrast, *evidence);
}

/// By how far the interval's nearer end is on the claimed side; the least decides. Contrasts of one
/// bed, which have no interval, count only where there are no others, and among themselves by their
/// values.
std::size_t weakest(const Claim& claim, const ClaimUnder& under) {
  std::size_t at = 0;
  std::pair<int, double> least = {3, 0};
  for (std::size_t i = 0; i < claim.contrasts.size(); ++i) {
    if (!under.evidence[i]) continue;
    const Contrast& c = claim.contrasts[i];
    const Evidence& e = *under.evidence[i];
    std::pair<int, double> here = {1, e.margin(c)};
    if (c.below && e.infinite > 0) here.first = 0;
    if (std::isnan(here.second)) here = {2, c.below ? c.bound - e.mean() : e.mean() - c.bound};
    if (here < least) least = here, at = i;
  }
  return at;
}

std::string counted(const JudgedClaim& j, Finding finding) {
  std::string names;
  for (std::size_t i = 1; i < j.under.size(); ++i) {
    const bool counts = j.under[i].kind != "reading";
    if (counts && j.under[i].finding == finding)
      names += (names.empty() ? "" : " ") + j.under[i].variation;
  }
  return names.empty() ? "-" : names;
}

std::string rejected(const JudgedClaim& j) {
  std::string text;
  for (const ClaimUnder& under : j.under) {
    for (std::size_t i = 0; i < j.claim->contrasts.size(); ++i) {
      const Contrast& c = j.claim->contrasts[i];
      if (!under.evidence[i] || under.evidence[i]->beds.size() < 2 ||
          holds_there(c, under.evidence[i])) {
        continue;
      }
      text += "  " + j.claim->name + ", " + under.variation + ": " + c.name + " is " +
              interval(*under.evidence[i]) + ", claimed " + (c.below ? "below " : "above ") +
              digits(c.bound) + "\n";
    }
  }
  return text;
}

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json json_of(const JudgedClaim& j) {
  nlohmann::ordered_json claim;
  claim["name"] = j.claim->name, claim["statement"] = j.claim->statement;
  claim["verdict"] = to_string(j.verdict);
  for (const ClaimUnder& under : j.under) {
    nlohmann::ordered_json u;
    u["variation"] = under.variation;
    if (!under.kind.empty()) u["kind"] = under.kind;
    u["finding"] = to_string(under.finding);
    for (std::size_t i = 0; i < j.claim->contrasts.size(); ++i) {
      const Contrast& c = j.claim->contrasts[i];
      nlohmann::ordered_json e;
      e["contrast"] = c.name, e["claimed"] = c.below ? "below" : "above", e["bound"] = c.bound;
      e["paper"] = number(c.paper);
      if (const auto& seen = under.evidence[i]) {
        e["mean"] = number(seen->mean());
        e["interval95"] = {number(seen->low()), number(seen->high())};
        if (seen->infinite > 0) e["beds_over_nothing"] = seen->infinite;
        e["beds"] = seen->beds, e["runs"] = under.runs[i];
        e["holds"] = holds_there(c, seen);
      }
      u["contrasts"].push_back(e);
    }
    claim["under"].push_back(u);
  }
  return claim;
}

/// Intervals of one contrast, a line for each variation, and the bound.
std::string drawing(const JudgedClaim& j, std::size_t at) {
  const Contrast& c = j.claim->contrasts[at];
  double low = c.bound, high = c.bound;
  for (const ClaimUnder& under : j.under) {
    if (!under.evidence[at]) continue;
    const Evidence& e = *under.evidence[at];
    const bool several = std::isfinite(e.sample.confidence);
    low = std::min(low, several ? e.low() : e.mean());
    high = std::max(high, several ? e.high() : e.mean());
  }
  if (high == low) high = low + 1;
  constexpr double kLeft = 130, kWide = 420, kRow = 18;
  const auto x = [&](double v) { return kLeft + kWide * (v - low) / (high - low); };
  const double tall = kRow * double(j.under.size()) + 24;
  char part[400];
  std::snprintf(part, sizeof part,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 %.0f\" "
                "style=\"max-width:720px\" "
                "font-family=\"sans-serif\" font-size=\"12\">\n"
                "<path d=\"M%.1f 0V%.1f\" stroke=\"#888\" stroke-dasharray=\"4 3\"/>"
                "<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%.3g</text>\n",
                tall, x(c.bound), tall - 18, x(c.bound), tall - 4, c.bound);
  std::string svg = part;
  double y = kRow / 2;
  for (const ClaimUnder& under : j.under) {
    svg += "<text x=\"0\" y=\"" + std::to_string(int(y) + 4) + "\">" +
           html_escape(under.variation) + "</text>";
    if (const auto& e = under.evidence[at]) {
      const char* colour = holds_there(c, e) ? "#009e73" : "#d55e00";
      const bool several = std::isfinite(e->sample.confidence);
      std::snprintf(part, sizeof part,
                    "<path d=\"M%.1f %.1fH%.1f\" stroke=\"%s\" stroke-width=\"2\"/>"
                    "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"4\" fill=\"%s\"/>"
                    "<text x=\"560\" y=\"%.1f\">%s</text>\n",
                    x(several ? e->low() : e->mean()), y, x(several ? e->high() : e->mean()),
                    colour, x(e->mean()), y, colour, y + 4, interval(*e).c_str());
      svg += part;
    }
    y += kRow;
  }
  return svg + "</svg>\n";
}

std::string page(const std::vector<JudgedClaim>& claims,
                 const std::vector<const Variation*>& variations) {
  std::string body = element("p", kRule);
  for (const Variation* v : variations) {
    body += element("p", v->name + " (" + v->kind + "): " + v->what);
  }
  for (const JudgedClaim& j : claims) {
    body += element("h2", j.claim->name + ": " + to_string(j.verdict)) +
            element("p", capitalised(j.claim->statement) + ".");
    for (std::size_t i = 0; i < j.claim->contrasts.size(); ++i) {
      const Contrast& c = j.claim->contrasts[i];
      const std::string paper = std::isfinite(c.paper) ? "; the paper: " + digits(c.paper) : "";
      body += element("p", c.name + ", claimed " + (c.below ? "below " : "above ") +
                               digits(c.bound) + paper) +
              "<figure>" + drawing(j, i) + "</figure>\n";
    }
  }
  return make_page("The paper's claims", body, "{}");
}

Table rows(const std::vector<JudgedClaim>& claims) {
  Table table({{"claim_name"},
               {"verdict_name"},
               {"variation_name"},
               {"contrast_name"},
               {"claimed_name"},
               {"bound_ratio", 3},
               {"mean_ratio", 4},
               {"low95_ratio", 4},
               {"high95_ratio", 4},
               {"beds_count"},
               {"paper_ratio", 4}});
  for (const JudgedClaim& j : claims) {
    for (const ClaimUnder& under : j.under) {
      for (std::size_t i = 0; i < j.claim->contrasts.size(); ++i) {
        const Contrast& c = j.claim->contrasts[i];
        const auto& e = under.evidence[i];
        std::string name = c.name;  // CSV takes no commas within a text
        std::replace(name.begin(), name.end(), ',', ';');
        table.row({j.claim->name, to_string(j.verdict), under.variation, name,
                   std::string(c.below ? "below" : "above"), c.bound, e ? e->mean() : NAN,
                   e ? e->low() : NAN, e ? e->high() : NAN, std::int64_t(e ? e->beds.size() : 0),
                   c.paper});
      }
    }
  }
  return table;
}

}  // namespace

std::string claims_text(const std::vector<JudgedClaim>& claims) {
  Table table({{"claim_name"},
               {"verdict_name"},
               {"weakest_contrast_name"},
               {"base_name"},
               {"beds_count"},
               {"holds_too_name"},
               {"fails_name"},
               {"not_run_name"}});
  std::string why, readings;
  for (const JudgedClaim& j : claims) {
    const ClaimUnder& base = j.under.front();
    const std::size_t at = weakest(*j.claim, base);
    const auto& e = base.evidence[at];
    table.row({j.claim->name, to_string(j.verdict), j.claim->contrasts[at].name,
               e ? interval(*e) : "not run", std::int64_t(e ? e->beds.size() : 0),
               counted(j, Finding::kHolds), counted(j, Finding::kFails),
               counted(j, Finding::kNotRun)});
    why += rejected(j);
    const ClaimUnder& last = j.under.back();
    if (last.kind != "reading" || last.finding == base.finding) continue;
    const std::size_t least = weakest(*j.claim, last);
    readings += "  " + j.claim->name + " " + to_string(last.finding) + ": " +
                j.claim->contrasts[least].name + " is " + interval(*last.evidence[least]) + "\n";
  }
  std::string text = table.markdown() + kRule + "\n";
  if (!why.empty()) text += "What does not hold:\n" + why;
  if (!readings.empty()) text += "Otherwise by the depth of the sole:\n" + readings;
  return text;
}

void write_claims(const fs::path& folder, const std::vector<JudgedClaim>& claims,
                  const std::vector<const Variation*>& variations) {
  nlohmann::ordered_json j;
  j["rule"] = kRule;
  for (const Variation* v : variations) {
    j["variations"].push_back({{"name", v->name}, {"kind", v->kind}, {"what", v->what}});
  }
  for (const JudgedClaim& claim : claims) j["claims"].push_back(json_of(claim));
  const auto replace = [&](const std::string& name, const std::string& text) {
    const fs::path partial = folder / (name + ".partial");
    write_file(partial, text);
    fs::rename(partial, folder / name);
  };
  replace("claims.json", result_json_text(j));
  rows(claims).write_csv(folder / "claims.csv");
  replace("claims.html", page(claims, variations));
}

}  // namespace hoof::tools
