#include "tools/diagnose/report_page.h"

#include "sim/effects/effect.h"
#include "tools/diagnose/experiment_text.h"
#include "tools/diagnose/report_plots.h"
#include "tools/diagnose/report_tables.h"
#include "tools/diagnose/verdict_text.h"
#include "tools/report/html.h"
#include "tools/report/page.h"

namespace hoof::tools {
namespace {

std::string names_of(const std::vector<DataSet>& sets) {
  std::string names;
  for (const DataSet& set : sets) names += (names.empty() ? "" : ", ") + set.name;
  return names;
}

std::string about(const std::vector<DataSet>& sets) {
  std::string text;
  for (const DataSet& set : sets) {
    std::size_t held_out = 0;
    for (const Recording& r : set.recordings) held_out += r.holdout ? 1 : 0;
    text += (text.empty() ? "" : "; ") + set.name + ": rig " + rig_name(set.rig) + ", " +
            std::to_string(set.recordings.size() - held_out) + " recording(s) fitted, " +
            std::to_string(held_out) + " held out";
  }
  return text + ".";
}

std::string answer_html(const Verdict& verdict, RigKind rig) {
  std::string html = "<div class=\"answer\">" + element("p", headline(verdict));
  for (const std::string& name : effects_in_question(verdict)) {
    const EffectFinding* finding = find_finding(verdict, name);
    if (finding == nullptr) continue;
    std::string text = name + ":";
    const char* between = " ";
    for (const ParameterEstimate& p : finding->parameters) {
      text += between + parameter_text(p);
      between = "; ";
    }
    html += element("p", text);
  }
  const bool held_out = !verdict.before.holdout.empty();
  html +=
      element("p", (held_out ? "Held-out error: " : "Error, of what was fitted: ") +
                       improvement_text(rig, held_out ? verdict.before.holdout : verdict.before.fit,
                                        held_out ? verdict.after.holdout : verdict.after.fit,
                                        verdict.noise_floor) +
                       ".");
  return html + "</div>\n";
}

std::string note_text(const QualityNote& note) {
  std::string text = note.recording;
  if (!note.channel.empty()) text += (text.empty() ? "" : ": ") + note.channel;
  return (text.empty() ? "" : text + ": ") + note.text;
}

/// What changes the worth of the answer stands beside it.
std::string warnings_html(const Verdict& verdict) {
  std::string items;
  for (const QualityNote& note : verdict.quality) {
    if (note.serious) items += element("li", note_text(note));
  }
  if (items.empty()) return "";
  return "<div class=\"refused\"><strong>The data limit what this answer is worth</strong><ul>" +
         items + "</ul></div>\n";
}

std::string where_html(const Verdict& verdict) {
  std::string html = element("h2", "Where it shows", " id=\"where\"");
  if (verdict.channels.empty()) {
    html +=
        element("p", "Nowhere in particular: measured and model differ by what noise explains.");
  } else {
    html += element("p", "In " + where_text(verdict) + ".");
  }
  html +=
      "<p class=\"note\">Shaded: where it is at work most. Before: the nominal model, refitted. "
      "After: with what was found. Drag to zoom, double-click to see all.</p>\n"
      "<noscript>The plots need JavaScript.</noscript>\n";
  return html;
}

/// To the sections.
std::string links_html(const Verdict& verdict) {
  std::string html;
  const auto add = [&html](const std::string& id, const std::string& name) {
    html += (html.empty() ? "" : " | ") + element("a", name, " href=\"#" + id + "\"");
  };
  add("where", "where it shows");
  add("what", "what it is");
  add("how-much", "how much");
  if (!verdict.setup.empty()) add("setup", "setup");
  add("quality", "data quality");
  add("next", "what next");
  return "<p class=\"note\">" + html + "</p>\n";
}

std::string quality_html(const Verdict& verdict) {
  std::string html = element("h2", "Data quality", " id=\"quality\"");
  if (verdict.quality.empty()) return html + element("p", "Nothing to say against the data.");
  html += "<ul>";
  for (const bool serious : {true, false}) {
    for (const QualityNote& note : verdict.quality) {
      if (note.serious == serious) {
        html += element("li", (serious ? "Serious: " : "") + note_text(note));
      }
    }
  }
  return html + "</ul>\n";
}

/// Files and plots of an experiment that was simulated.
std::string planned_html(const PlannedExperiment& plan, const std::string& plots) {
  std::string outputs;
  for (const std::string& name : plan.output_channels) {
    outputs += (outputs.empty() ? "" : ", ") + name;
  }
  return element("p", "Chosen among " + std::to_string(plan.looked_at) +
                          " that were simulated with each hypothesis, within what the recordings "
                          "show to be safe. Play " +
                          std::string(kExperimentTable) + ", record " + outputs + " into " +
                          plan.set.recordings.front().name + ", and give " + kExperimentFile +
                          " to hoof diagnose beside the data sets that were given now.") +
         "<p class=\"note\">Shaded: what tells best. Dashed: two sigma of noise and of what is "
         "uncertain of the hypotheses' numbers.</p>\n" +
         plots;
}

std::string next_html(const Verdict& verdict, const std::string& plots) {
  std::string html = element("h2", "What next", " id=\"next\"");
  if (!verdict.next_experiment.empty()) {
    html += element("p", "Experiment: " + verdict.next_experiment + ".");
  }
  if (verdict.planned_experiment) html += planned_html(*verdict.planned_experiment, plots);
  if (verdict.verdict == "missing_physics") {
    html +=
        "<p>improved.toml beside this page is the model with what was found; hoof simulate "
        "DATASET.toml --effects improved.toml --out DIR runs it.</p>\n";
  } else if (verdict.next_experiment.empty()) {
    html += element("p", "Nothing: the model does for what these recordings show.");
  }
  return html + element("p",
                        "Beside this page: verdict.json (this answer for programs), improved.toml, "
                        "residuals.csv (every sample), hypotheses.csv (all that competed).",
                        " class=\"note\"");
}

}  // namespace

std::string report_page(const Verdict& verdict, const std::vector<DataSet>& data_sets) {
  const RigKind rig = data_sets.front().rig;
  const ReportPlots plots = report_plots(verdict, rig);
  const std::string body = element("p", about(data_sets), " class=\"note\"") +
                           answer_html(verdict, rig) + warnings_html(verdict) +
                           links_html(verdict) + where_html(verdict) + plots.html +
                           what_html(verdict) + how_much_html(verdict, rig) + setup_html(verdict) +
                           quality_html(verdict) + next_html(verdict, plots.planned_html);
  return make_page("Diagnosis of " + names_of(data_sets), body, plots.json);
}

}  // namespace hoof::tools
