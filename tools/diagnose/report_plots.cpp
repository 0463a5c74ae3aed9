#include "tools/diagnose/report_plots.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "tools/diagnose/series.h"
#include "tools/diagnose/verdict_text.h"
#include "tools/report/html.h"
#include "tools/report/page.h"
#include "tools/run/csv_writer.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;
using Values = std::vector<double>;

constexpr std::size_t kMostSamples = 3000;  // a plot is 600 to 1200 pixels wide
/// Not folded away: what a reader sees without scrolling past everything else.
constexpr std::size_t kOpenOfEachRole = 2;

bool is_named(const Verdict& verdict, const ChannelTrace& trace) {
  const auto& names = verdict.recordings;
  return std::find(names.begin(), names.end(), trace.recording) != names.end();
}

std::string region_json(double from_s, double to_s) {
  return "{\"from_s\":" + format_number(from_s) + ",\"to_s\":" + format_number(to_s) + "}";
}

std::string regions_json(const Verdict& verdict, const ChannelTrace& trace) {
  std::string json = "[";
  for (const Interval& i : verdict.intervals) {
    if (i.recording != trace.recording) continue;
    json += (json.size() > 1 ? "," : "") + region_json(i.start_s, i.end_s);
  }
  return json + "]";
}

/// What is read off, where it is of this channel.
std::string planned_regions_json(const TellingReading& t, const std::string& channel) {
  if (t.channel != channel) return "[]";
  const std::string earlier =
      t.change ? region_json(t.earlier_from_s, t.earlier_to_s) + "," : std::string();
  return "[" + earlier + region_json(t.from_s, t.to_s) + "]";
}

std::string line_json(const std::string& label, const Values& values, bool band) {
  return "{\"label\":" + Json(label).dump() + ",\"band\":" + (band ? "true" : "false") +
         ",\"values\":" + json_numbers(values, 1) + "}";
}

Values picked(const Values& values, const std::vector<std::size_t>& at) {
  Values some;
  for (const std::size_t i : at) some.push_back(values.at(i));
  return some;
}

/// Measured less predicted.
Values residual(const Values& measured, const Values& predicted) {
  Values left(measured.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = measured[i] - predicted.at(i);
  return left;
}

/// Share of the signal's power that the model misses before and has after.
double explained(const ChannelTrace& t) {
  double before = 0, after = 0, mean = 0, power = 0;
  const Values valid = valid_of(t.measured);
  for (const double value : valid) mean += value / double(valid.size());
  for (std::size_t i = 0; i < t.measured.size(); ++i) {
    const double b = t.measured[i] - t.before.at(i), a = t.measured[i] - t.after.at(i);
    if (std::isnan(a) || std::isnan(b)) continue;
    before += b * b, after += a * a;
    power += (t.measured[i] - mean) * (t.measured[i] - mean);
  }
  const double share = (before - after) / power;
  return std::isfinite(share) ? share : 0;
}

class PlotWriter {
 public:
  PlotWriter(const Verdict& verdict, RigKind rig) : verdict_(verdict), rig_(rig) {}

  void add(const ChannelTrace& t) {
    const Values before = residual(t.measured, t.before), after = residual(t.measured, t.after);
    const auto at = thinned({&t.measured, &before, &after}, kMostSamples);
    const std::string role = element("span", t.holdout ? "held out" : "fitted", " class=\"role\"");
    html_ += "<section class=\"pair\"><h3>" + html_escape(t.recording + ": " + t.channel) + role +
             "</h3>\n<div class=\"plots\">\n";
    // Same colours in both: the model before is the first line but one.
    start_plot(t, at, "signal", t.channel);
    json_ += line_json("measured", picked(t.measured, at), false) + ",\n" +
             line_json("before", picked(t.before, at), false) + ",\n" +
             line_json("after", picked(t.after, at), false) + "]}";
    start_plot(t, at, "measured less model", t.channel + " error");
    const auto floor = verdict_.noise_floor.find(t.channel + "_rmse");
    const bool has_floor = floor != verdict_.noise_floor.end() && std::isfinite(floor->second);
    const double two_sigma = has_floor ? 2 * floor->second : NAN;
    json_ +=
        line_json(has_floor ? "+2 noise floors" : "no floor", Values(at.size(), two_sigma), true) +
        ",\n" + line_json("before", picked(before, at), false) + ",\n" +
        line_json("after", picked(after, at), false) + ",\n" +
        line_json(has_floor ? "-2 noise floors" : "no floor", Values(at.size(), -two_sigma), true) +
        "]}";
    html_ += "</div></section>\n";
  }

  /// One channel of an experiment that is yet to be made: what each hypothesis expects, and by how
  /// much the others differ from the first.
  void add_planned(const PlannedExperiment& plan, const std::string& channel) {
    const Values& time_s = plan.set.recordings.front().time_s;
    const Values& first = plan.outcomes.front().predicted.at(channel);
    std::vector<Values> differences;
    std::vector<const Values*> all;
    for (const ExpectedOutcome& o : plan.outcomes) {
      differences.push_back(residual(o.predicted.at(channel), first));
    }
    for (std::size_t i = 0; i < differences.size(); ++i) {
      all.insert(all.end(), {&plan.outcomes[i].predicted.at(channel), &differences[i]});
    }
    const auto at = thinned(all, kMostSamples);
    html_ += "<section class=\"pair\"><h3>" + html_escape("next experiment: " + channel) +
             element("span", "simulated", " class=\"role\"") + "</h3>\n<div class=\"plots\">\n";
    const std::string regions = planned_regions_json(plan.telling, channel);
    start_plot(channel, time_s, regions, at, "what each expects", channel);
    for (const ExpectedOutcome& o : plan.outcomes) {
      json_ += (&o == &plan.outcomes.front() ? "" : ",\n") +
               line_json(o.hypothesis, picked(o.predicted.at(channel), at), false);
    }
    json_ += "]}";
    start_plot(channel, time_s, regions, at, "less " + plan.outcomes.front().hypothesis,
               channel + " difference");
    Values wide(first.size());
    for (std::size_t k = 0; k < wide.size(); ++k) {
      wide[k] = plan.noise.at(channel) * plan.noise.at(channel);
      for (const ExpectedOutcome& o : plan.outcomes) {
        wide[k] += o.spread.at(channel)[k] * o.spread.at(channel)[k];
      }
      wide[k] = 2 * std::sqrt(wide[k]);
    }
    json_ += line_json("+2 sigma of noise and doubt", picked(wide, at), true);
    for (std::size_t i = 1; i < differences.size(); ++i) {
      json_ += ",\n" + line_json(plan.outcomes[i].hypothesis, picked(differences[i], at), false);
    }
    for (double& value : wide) value = -value;
    json_ += ",\n" + line_json("-2 sigma of noise and doubt", picked(wide, at), true) + "]}";
    html_ += "</div></section>\n";
  }

  void add_text(const std::string& html) { html_ += html; }

  /// What was written since the last call.
  std::string take_html() { return std::exchange(html_, ""); }
  std::string take_json() const {
    return "{\"time_s\":[],\"phases\":[],\"plots\":[" + json_ + "]}";
  }

 private:
  void start_plot(const ChannelTrace& t, const std::vector<std::size_t>& at,
                  const std::string& title, const std::string& axis) {
    start_plot(t.channel, t.time_s, regions_json(verdict_, t), at, title, axis);
  }
  void start_plot(const std::string& channel, const Values& time_s, const std::string& regions,
                  const std::vector<std::size_t>& at, const std::string& title,
                  const std::string& axis) {
    html_ += "<div class=\"plot\">" + element("h3", title) + "<div class=\"canvas\"></div></div>\n";
    json_ += (json_.empty() ? "" : ",\n") + std::string("{\"axis\":") + Json(axis).dump() +
             ",\"unit\":" + Json(channel_unit(rig_, channel)).dump() +
             ",\"time_s\":" + json_numbers(picked(time_s, at), 1) + ",\"regions\":" + regions +
             ",\"series\":[";
  }

  const Verdict& verdict_;
  RigKind rig_;
  std::string html_, json_;
};

}  // namespace

std::vector<std::size_t> thinned(const std::vector<const Values*>& series, std::size_t most) {
  const std::size_t size = series.front()->size();
  std::set<std::size_t> kept;
  const std::size_t per_bucket = 2 * series.size();
  const std::size_t buckets = std::max<std::size_t>(1, most / per_bucket);
  for (std::size_t b = 0; b < buckets; ++b) {
    const std::size_t first = b * size / buckets, last = (b + 1) * size / buckets;
    for (std::size_t i = first; size <= most && i < last; ++i) kept.insert(i);
    for (const Values* values : series) {
      std::size_t low = last, high = last;
      for (std::size_t i = first; i < last; ++i) {
        const double v = (*values)[i];
        if (std::isnan(v)) continue;
        if (low == last || v < (*values)[low]) low = i;
        if (high == last || v > (*values)[high]) high = i;
      }
      if (low < last) kept.insert({low, high});
    }
  }
  return {kept.begin(), kept.end()};
}

std::vector<std::size_t> traces_to_open(const Verdict& verdict) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < verdict.traces.size(); ++i) order.push_back(i);
  const auto rank = [&verdict](std::size_t i) {
    const ChannelTrace& t = verdict.traces[i];
    return std::pair(is_named(verdict, t) ? 0 : 1, -explained(t));
  };
  std::stable_sort(order.begin(), order.end(),
                   [&rank](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  std::size_t fitted = 0, held_out = 0;
  std::erase_if(order, [&](std::size_t i) {
    return (verdict.traces[i].holdout ? held_out : fitted)++ >= kOpenOfEachRole;
  });
  return order;
}

ReportPlots report_plots(const Verdict& verdict, RigKind rig) {
  PlotWriter plots(verdict, rig);
  const std::vector<std::size_t> open = traces_to_open(verdict);
  for (const std::size_t i : open) plots.add(verdict.traces[i]);
  const std::size_t folded = verdict.traces.size() - open.size();
  if (folded > 0) {
    plots.add_text("<details><summary>Other recordings and channels (" + std::to_string(folded) +
                   ")</summary>\n");
    for (std::size_t i = 0; i < verdict.traces.size(); ++i) {
      if (std::find(open.begin(), open.end(), i) == open.end()) plots.add(verdict.traces[i]);
    }
    plots.add_text("</details>\n");
  }
  ReportPlots made;
  made.html = plots.take_html();
  if (verdict.planned_experiment) {
    const PlannedExperiment& plan = *verdict.planned_experiment;
    for (const auto& [channel, noise] : plan.noise) plots.add_planned(plan, channel);
    made.planned_html = plots.take_html();
  }
  made.json = plots.take_json();
  return made;
}

}  // namespace hoof::tools
