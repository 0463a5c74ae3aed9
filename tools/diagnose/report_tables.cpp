#include "tools/diagnose/report_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/effects/effect.h"
#include "tools/diagnose/verdict_text.h"
#include "tools/report/display_unit.h"
#include "tools/report/html.h"

namespace hoof::tools {
namespace {

constexpr int kDigits = 3;
constexpr std::size_t kShownHypotheses = 12;
constexpr double kFarFromStated = 3;  // sigma

std::string number(double value) {
  if (std::isinf(value)) return "diverged";
  return std::isnan(value) ? "-" : format_significant(value + 0.0, kDigits);  // no -0
}

std::string bound(double value) {
  return std::isfinite(value) ? number(value) : "open";
}

std::string bar(double share) {
  char width[16];
  std::snprintf(width, sizeof width, "%.1f", 100 * std::clamp(share, 0.0, 1.0));
  return "<td><span class=\"bar\"><i style=\"width:" + std::string(width) + "%\"></i></span></td>";
}

std::string cell(const std::string& text) {
  return element("td", text);
}

std::string number_cell(const std::string& text) {
  return element("td", text, " class=\"number\"");
}

/// Headings that begin with # are of numbers.
std::string table(const std::vector<std::string>& headings, const std::string& rows) {
  std::string html = "<div class=\"wide\"><table><tr>";
  for (const std::string& heading : headings) {
    const bool of_numbers = heading.starts_with('#');
    html += element("th", of_numbers ? heading.substr(1) : heading,
                    of_numbers ? " scope=\"col\" class=\"number\"" : " scope=\"col\"");
  }
  return html + "</tr>\n" + rows + "</table></div>\n";
}

/// none, unknown and each effect that may be at work.
std::string probabilities_html(const Verdict& verdict) {
  constexpr double kLeastShown = 0.01;
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [name, probability] : verdict.probabilities) {
    const bool fixed = name == "none" || name == "unknown";
    if (fixed || probability >= kLeastShown) order.emplace_back(probability, name);
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string rows;
  for (const auto& [probability, name] : order) {
    const std::string words = name == "none"      ? "nothing is missing"
                              : name == "unknown" ? "something that is not in the list"
                                                  : name;
    rows += "<tr>" + cell(words) + number_cell(probability_text(probability)) + bar(probability) +
            "</tr>\n";
  }
  return table({"what", "#probability", ""}, rows);
}

std::string hypotheses_html(const Verdict& verdict) {
  std::string rows;
  for (std::size_t i = 0; i < std::min(kShownHypotheses, verdict.hypotheses.size()); ++i) {
    const HypothesisScore& h = verdict.hypotheses[i];
    rows +=
        "<tr>" + cell(h.name) + number_cell(probability_text(h.probability)) + bar(h.probability) +
        number_cell(number(h.evidence)) +
        cell(h.name == "none" ? "what the others are compared with" : evidence_words(h.evidence)) +
        number_cell(number(h.holdout_gain)) + number_cell(std::to_string(h.parameters_count)) +
        "</tr>\n";
  }
  std::string html = table(
      {"hypothesis", "probability", "", "log evidence", "in words", "held-out gain", "parameters"},
      rows);
  html +=
      "<p class=\"note\">Log evidence (natural) and the gain in log density of what was held "
      "out are relative to \"none\", the model as it was with its doubtful numbers refitted. "
      "In parentheses: stand-ins for physics that is not in the list.";
  if (verdict.hypotheses.size() > kShownHypotheses) {
    html += " " + std::to_string(verdict.hypotheses.size() - kShownHypotheses) +
            " more in hypotheses.csv.";
  }
  return html + "</p>\n";
}

std::string effect_html(const EffectFinding& finding) {
  std::string html = element("h3", finding.name);
  if (const sim::EffectInfo* info = sim::find_effect(finding.name)) {
    html += "<p>" + html_escape(capitalised(std::string(info->summary))) + ".</p>\n" +
            element("pre", info->equation) +
            element("p", "Source: " + std::string(info->source), " class=\"note\"") + "\n";
  }
  std::string rows;
  for (const ParameterEstimate& p : finding.parameters) {
    rows += "<tr>" + cell(p.name) + number_cell(number(p.value)) + cell(p.unit) +
            cell(bound(p.low95) + " to " + bound(p.high95)) + "</tr>\n";
  }
  return html + (rows.empty() ? "" : table({"parameter", "#value", "unit", "95 % interval"}, rows));
}

std::string list_html(const std::string& heading, const std::vector<std::string>& sentences) {
  if (sentences.empty()) return "";
  std::string html = "<section>" + element("h3", heading) + "<ul>";
  for (const std::string& sentence : sentences) html += element("li", sentence);
  return html + "</ul></section>\n";
}

std::string unknown_html(const UnknownTerm& term) {
  std::string inputs;
  for (const std::string& input : term.inputs) inputs += (inputs.empty() ? "" : ", ") + input;
  return element("h3", "A stand-in for what is not in the list") + "<p>It depends on " +
         html_escape(inputs) + " and accounts for " + number(100 * term.residual_share) +
         " % of the residual's power.</p>\n" + element("pre", term.form);
}

double at(const Errors& errors, const std::string& key) {
  const auto found = errors.find(key);
  return found == errors.end() ? NAN : found->second;
}

/// Share of the error that is gone.
std::string removed(double before, double after) {
  if (!std::isfinite(before) || !std::isfinite(after) || before <= 0) return "-";
  return number(100 * (1 - after / before)) + " %";
}

std::vector<std::string> keys_of(const Verdict& verdict) {
  std::vector<std::string> keys;
  for (const Errors* errors :
       {&verdict.before.fit, &verdict.before.holdout, &verdict.after.fit, &verdict.after.holdout}) {
    for (const auto& [key, value] : *errors) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
  }
  return keys;
}

std::string ablation_html(const Verdict& verdict, RigKind rig) {
  std::string html;
  for (const std::string& key : keys_of(verdict)) {
    const bool held_out = !verdict.before.holdout.empty();
    const auto error = [&](const AblationRow& row) {
      return at(held_out ? row.holdout : row.fit, key);
    };
    double largest = 0;
    for (const AblationRow& row : verdict.ablation) {
      if (std::isfinite(error(row))) largest = std::max(largest, error(row));
    }
    std::string rows;
    for (const AblationRow& row : verdict.ablation) {
      const double value = error(row);
      rows += "<tr>" + cell(row.model) + number_cell(number(value)) +
              bar(std::isfinite(value) && largest > 0 ? value / largest : 1) + "</tr>\n";
    }
    const std::string channel = channel_of_error(key), unit = channel_unit(rig, channel);
    html += table({"model",
                   channel + " error, " + (held_out ? "held out" : "fitted") +
                       (unit.empty() ? "" : " [" + unit + "]"),
                   ""},
                  rows);
  }
  return html;
}

}  // namespace

std::string evidence_words(double evidence) {
  // Their bounds are of twice the natural logarithm of the Bayes factor.
  const double size = 2 * std::abs(evidence);
  const std::string side = evidence < 0 ? "against it" : "for it";
  if (!(size >= 2)) return "not worth more than a bare mention";
  if (size < 6) return "positive evidence " + side;
  return (size < 10 ? "strong evidence " : "very strong evidence ") + side;
}

std::string what_html(const Verdict& verdict) {
  std::string html = element("h2", "What it is", " id=\"what\"");
  html += probabilities_html(verdict) + element("h3", "Models that competed") +
          hypotheses_html(verdict);
  for (const std::string& name : effects_in_question(verdict)) {
    if (const EffectFinding* finding = find_finding(verdict, name)) html += effect_html(*finding);
  }
  if (verdict.unknown_term) html += unknown_html(*verdict.unknown_term);
  if (!verdict.evidence_for.empty() || !verdict.evidence_against.empty()) {
    html += "<div class=\"columns\">" + list_html("What speaks for it", verdict.evidence_for) +
            list_html("What speaks against it", verdict.evidence_against) + "</div>\n";
  }
  return html;
}

std::string how_much_html(const Verdict& verdict, RigKind rig) {
  std::string rows;
  for (const std::string& key : keys_of(verdict)) {
    const std::string channel = channel_of_error(key), unit = channel_unit(rig, channel);
    const double fit = at(verdict.before.fit, key), fit_after = at(verdict.after.fit, key);
    const double held = at(verdict.before.holdout, key);
    const double held_after = at(verdict.after.holdout, key);
    rows += "<tr>" + cell(channel + (unit.empty() ? "" : " [" + unit + "]")) +
            number_cell(number(fit)) + number_cell(number(fit_after)) +
            number_cell(removed(fit, fit_after)) + number_cell(number(held)) +
            number_cell(number(held_after)) + number_cell(removed(held, held_after)) +
            number_cell(number(at(verdict.noise_floor, key))) + "</tr>\n";
  }
  std::string html = element("h2", "How much", " id=\"how-much\"") +
                     table({"channel", "#fitted: before", "#after", "#less by", "#held out: before",
                            "#after", "#less by", "#noise floor"},
                           rows) +
                     "<p class=\"note\">Root mean square of measured less model, rolled out from "
                     "the first sample by the recorded inputs alone. Before: the nominal model, "
                     "its doubtful numbers already refitted. Nothing was fitted to what is held "
                     "out.</p>\n";
  if (!verdict.ablation.empty()) {
    html +=
        element("h3", "Each explanation alone, and taken away again") + ablation_html(verdict, rig);
  }
  return html;
}

std::string setup_html(const Verdict& verdict) {
  if (verdict.setup.empty()) return "";
  std::string rows;
  for (const SetupEstimate& s : verdict.setup) {
    const double off = s.sigma > 0 ? (s.after - s.stated) / s.sigma : 0;
    const bool far = !s.guessed && std::abs(off) > kFarFromStated;
    rows +=
        (far ? "<tr class=\"refused\">" : "<tr>") + cell(s.name) +
        number_cell((s.guessed ? "(guess) " : "") + number(s.stated) + " ± " + number(s.sigma)) +
        number_cell(number(s.before)) + number_cell(number(s.after)) + number_cell(number(off)) +
        "</tr>\n";
  }
  return element("h2", "Values of the setup, stated and refitted", " id=\"setup\"") +
         table({"value", "#stated", "#refitted, nominal model", "#refitted, with what was found",
                "#off by, in sigma"},
               rows);
}

}  // namespace hoof::tools
