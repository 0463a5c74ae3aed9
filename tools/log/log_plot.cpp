#include "tools/log/log_plot.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/log/decoded_frame.h"
#include "tools/log/signal_series.h"
#include "tools/report/display_unit.h"
#include "tools/report/html.h"
#include "tools/report/page.h"
#include "tools/run/column_unit.h"
#include "tools/run/errors.h"
#include "tools/study/line_plot.h"

namespace hoof::tools {
namespace {

using Json = nlohmann::ordered_json;

std::vector<SignalSeries> wanted_series(const BusRecording& recording,
                                        const std::vector<std::string>& signals) {
  require_known_signals(signals);
  std::vector<SignalSeries> all = series_of(recording, signals);
  if (all.empty()) {
    throw UserError(recording.path.string() + ": no frame with a value of these signals");
  }
  return all;
}

/// Curves of one message with one unit: they have the same times.
struct Panel {
  std::string title;
  DisplayUnit unit;
  std::vector<const SignalSeries*> series;
};

std::string message_of(const SignalSeries& series) {
  return series.name.substr(0, series.name.find('.'));
}

std::vector<Panel> panels_of(const std::vector<SignalSeries>& all) {
  std::vector<Panel> panels;
  for (const SignalSeries& series : all) {
    const std::string message = message_of(series);
    const DisplayUnit unit = display_unit(series.name);
    const auto same = [&](const Panel& p) {
      // Whole numbers differ too much in size to share an axis.
      return p.title == message && p.unit.symbol == unit.symbol && !series.whole &&
             p.unit.quantity == unit.quantity && !p.series.front()->whole;
    };
    auto panel = std::find_if(panels.begin(), panels.end(), same);
    if (panel == panels.end()) panel = panels.insert(panels.end(), Panel{message, unit, {}});
    panel->series.push_back(&series);
  }
  return panels;
}

std::string short_name(const SignalSeries& series) {
  return column_label(series.name.substr(series.name.find('.') + 1));
}

std::string json_panel(const Panel& panel) {
  const SignalSeries& first = *panel.series.front();
  const std::string axis = panel.series.size() == 1 ? short_name(first) : panel.unit.quantity;
  std::string json = "{\"axis\":" + Json(axis).dump() +
                     ",\"unit\":" + Json(panel.unit.symbol).dump() +
                     ",\"time_s\":" + json_numbers(first.time_s, 1) + ",\"series\":[";
  for (const SignalSeries* series : panel.series) {
    if (series != panel.series.front()) json += ",\n";
    json += "{\"label\":" + Json(short_name(*series)).dump() +
            ",\"step\":" + (series->whole ? "true" : "false") +
            ",\"values\":" + json_numbers(series->values, panel.unit.factor) + "}";
  }
  return json + "]}";
}

}  // namespace

std::string plot_page(const BusRecording& recording, const std::vector<std::string>& signals) {
  const std::vector<SignalSeries> all = wanted_series(recording, signals);
  std::string body = element("p",
                             "From " + recording.path.string() +
                                 ". Drag to zoom, double-click to see all; click a name in the "
                                 "legend to hide its line.",
                             " class=\"note\"") +
                     "<noscript>The plots need JavaScript.</noscript>\n<div class=\"plots\">\n";
  std::string json = "{\"time_s\":[],\"phases\":[],\"plots\":[";
  const char* between = "";
  for (const Panel& panel : panels_of(all)) {
    std::string title = panel.title;
    if (panel.series.size() == 1) title += ": " + short_name(*panel.series.front());
    body += "<div class=\"plot\">" + element("h3", title) + "<div class=\"canvas\"></div></div>\n";
    json += between + json_panel(panel);
    between = ",\n";
  }
  return make_page("Signals of the bus", body + "</div>\n", json + "]}");
}

std::string plot_svg(const BusRecording& recording, const std::vector<std::string>& signals) {
  const std::vector<SignalSeries> all = wanted_series(recording, signals);
  const DisplayUnit unit = display_unit(all.front().name);
  std::vector<PlotLine> lines;
  for (const SignalSeries& series : all) {
    if (display_unit(series.name).symbol != unit.symbol) {
      throw UserError("a drawing has one axis: " + all.front().name + " and " + series.name +
                      " have different units; choose with --signal, or write a page (.html)");
    }
    PlotLine line;
    line.label = series.name;
    line.colour = int(lines.size());
    for (std::size_t i = 0; i < series.values.size(); ++i) {
      line.points.emplace_back(series.time_s[i], unit.factor * series.values[i]);
    }
    lines.push_back(std::move(line));
  }
  const std::string axis = unit.quantity.empty() ? short_name(all.front()) : unit.quantity;
  return draw_lines(recording.path.filename().string(), "time [s]",
                    axis + (unit.symbol.empty() ? "" : " [" + unit.symbol + "]"), lines);
}

}  // namespace hoof::tools
