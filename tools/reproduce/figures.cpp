#include "tools/reproduce/figures.h"

#include <cmath>
#include <functional>

#include "tools/reproduce/paper.h"
#include "tools/study/line_plot.h"
#include "tools/study/statistics.h"

namespace hoof::tools {
namespace {

using Value = std::function<double(const Outcome&)>;
using Stated = std::function<double(const std::string& condition)>;

struct Curve {
  std::string label;
  std::vector<std::pair<double, std::string>> places;  // x, and the condition there
};

struct Axes {
  std::string name, title, x_label, y_label;
};

const std::vector<std::pair<std::string, std::string>> kFeet = {
    {"bionic-toe0", "spined"}, {"bionic-plain-toe0", "plain"}, {"traditional", "traditional"}};
const std::vector<std::string> kSteps = {"0.45Hz", "1.12Hz"};
const std::vector<int> kOpenings = {0, 10, 20, 30, 40};

double coefficient(const Outcome& o) {
  return o.coefficient;
}

double stated_or_nan(double value) {
  return value > 0 ? value : NAN;
}

class Gallery {
 public:
  explicit Gallery(const Outcomes& outcomes) : outcomes_(outcomes) {}

  std::vector<Figure> figures;

  /// Left out where nothing of ours is there.
  void add(const Axes& axes, const std::vector<Curve>& curves, const Value& value,
           const Stated& stated) {
    std::vector<PlotLine> lines;
    int colour = 0;
    bool ours_there = false;
    for (const Curve& curve : curves) {
      PlotLine ours{curve.label + ", ours", {}, colour}, paper{curve.label + ", paper", {}, colour};
      paper.dashed = true;
      for (const auto& [x, condition] : curve.places) {
        if (std::isfinite(stated(condition))) paper.points.emplace_back(x, stated(condition));
        const auto found = outcomes_.find(condition);
        if (found == outcomes_.end()) continue;
        std::vector<double> values;
        for (const auto& [bed, outcome] : found->second) values.push_back(value(outcome));
        const Sample sample = sample_of(values);
        if (sample.n == 0) continue;
        ours.points.emplace_back(x, sample.mean);
        ours.half_range.push_back(std::isfinite(sample.deviation) ? sample.deviation : 0);
      }
      ours_there = ours_there || !ours.points.empty();
      if (!ours.points.empty()) lines.push_back(ours);
      if (!paper.points.empty()) lines.push_back(paper);
      ++colour;
    }
    if (!ours_there) return;
    figures.push_back({axes.name, draw_lines(axes.title, axes.x_label, axes.y_label, lines)});
  }

  /// Mean over the beds against time since first contact; the paper's peak as a level, as it gives
  /// no times.
  void traces(const Axes& axes, const std::string& step,
              const std::vector<double> ForceTrace::*force, double PaperTraction::*level) {
    std::vector<PlotLine> lines;
    int colour = 0;
    double end_s = 0;
    for (const auto& [foot, label] : kFeet) {
      const auto found = outcomes_.find("traction-" + foot + "-" + step);
      if (found != outcomes_.end()) {
        PlotLine line = mean_trace(found->second, force);
        line.label = label + ", ours", line.colour = colour;
        if (!line.points.empty()) end_s = std::max(end_s, line.points.back().first);
        lines.push_back(line);
      }
      ++colour;
    }
    if (lines.empty()) return;
    colour = 0;
    for (const auto& [foot, label] : kFeet) {
      const double value = paper_traction("traction-" + foot + "-" + step).*level;
      PlotLine line{label + ", paper", {{0, value}, {end_s, value}}, colour++};
      line.dashed = true;
      lines.push_back(line);
    }
    figures.push_back({axes.name, draw_lines(axes.title, axes.x_label, axes.y_label, lines)});
  }

 private:
  static constexpr std::size_t kBarEvery = 10;

  /// As long as the shortest of the beds; bars at every tenth point.
  static PlotLine mean_trace(const std::map<int, Outcome>& beds,
                             const std::vector<double> ForceTrace::*force) {
    std::size_t length = SIZE_MAX;
    for (const auto& [bed, o] : beds) length = std::min(length, (o.trace.*force).size());
    PlotLine line;
    for (std::size_t i = 0; i < length; ++i) {
      std::vector<double> values;
      for (const auto& [bed, o] : beds) values.push_back((o.trace.*force)[i]);
      const Sample sample = sample_of(values);
      line.points.emplace_back((double(i) + 0.5) * ForceTrace::kStep_s, sample.mean);
      const bool bar = i % kBarEvery == kBarEvery / 2 && std::isfinite(sample.deviation);
      line.half_range.push_back(bar ? sample.deviation : NAN);
    }
    return line;
  }

  const Outcomes& outcomes_;
};

void load_figures(Gallery& gallery) {
  for (const std::string speed : {"0.1", "0.4"}) {
    std::vector<Curve> curves;
    for (const auto& [foot, label] : kFeet) {
      Curve curve{label, {}};
      for (const int load : {10, 20, 30, 40, 50, 60}) {
        curve.places.emplace_back(
            load, "sinkage-" + foot + "-" + std::to_string(load) + "kg-" + speed + "m_s");
      }
      curves.push_back(curve);
    }
    gallery.add(
        {"sinkage-load-" + speed + "m_s", "Sinkage against load, " + speed + " m/s, toes closed",
         "load, kg", "sinkage, mm"},
        curves, [](const Outcome& o) { return o.sinkage_mm; }, paper_sinkage_mm);
  }
}

void opening_figure(Gallery& gallery) {
  std::vector<Curve> curves;
  for (const int load : {10, 60}) {
    for (const std::string speed : {"0.1", "0.4"}) {
      Curve curve{std::to_string(load) + " kg, " + speed + " m/s", {}};
      for (const int toe : kOpenings) {
        curve.places.emplace_back(toe, "sinkage-bionic-toe" + std::to_string(toe) + "-" +
                                           std::to_string(load) + "kg-" + speed + "m_s");
      }
      curves.push_back(curve);
    }
  }
  gallery.add(
      {"sinkage-opening", "Sinkage against opening, spined foot", "opening of each toe, degrees",
       "sinkage, mm"},
      curves, [](const Outcome& o) { return o.sinkage_mm; }, paper_sinkage_mm);
}

void traction_figures(Gallery& gallery) {
  struct Quantity {
    Axes axes;
    Value value;
    double PaperTraction::*paper;
  };
  const Quantity quantities[] = {
      {{"traction-coefficient", "Traction coefficient against step frequency, toes closed",
        "step frequency, Hz", "Fx at its peak over Fz then"},
       coefficient,
       &PaperTraction::coefficient},
      {{"traction-fx", "Peak of Fx against step frequency, toes closed", "step frequency, Hz",
        "Fx peak, N"},
       [](const Outcome& o) { return o.fx_peak_N; },
       &PaperTraction::fx_peak_N},
      {{"traction-fz", "Fz at the peak of Fx against step frequency, toes closed",
        "step frequency, Hz", "Fz then, N"},
       [](const Outcome& o) { return o.fz_at_fx_peak_N; },
       &PaperTraction::fz_at_fx_peak_N}};
  std::vector<Curve> curves;
  for (const auto& [foot, label] : kFeet) {
    Curve curve{label, {}};
    for (const std::string& step : kSteps) {
      curve.places.emplace_back(std::stod(step), "traction-" + foot + "-" + step);
    }
    curves.push_back(curve);
  }
  for (const Quantity& q : quantities) {
    gallery.add(q.axes, curves, q.value, [&](const std::string& condition) {
      return stated_or_nan(paper_traction(condition).*q.paper);
    });
  }
  for (const std::string& step : kSteps) {
    gallery.traces({"traction-fx-time-" + step, "Fx over a stance, toes closed, " + step,
                    "time since first contact, s", "Fx, N"},
                   step, &ForceTrace::fx_N, &PaperTraction::fx_peak_N);
    gallery.traces({"traction-fz-time-" + step, "Fz over a stance, toes closed, " + step,
                    "time since first contact, s", "Fz, N; the paper's: at the peak of Fx"},
                   step, &ForceTrace::fz_N, &PaperTraction::fz_at_fx_peak_N);
  }
}

void traction_opening_figure(Gallery& gallery) {
  std::vector<Curve> curves;
  for (const std::string& step : kSteps) {
    Curve curve{step, {}};
    for (const int toe : kOpenings) {
      curve.places.emplace_back(toe, "traction-bionic-toe" + std::to_string(toe) + "-" + step);
    }
    curves.push_back(curve);
  }
  gallery.add({"traction-opening", "Traction coefficient against opening, spined foot",
               "opening of each toe, degrees", "Fx at its peak over Fz then"},
              curves, coefficient, [](const std::string& condition) {
                return stated_or_nan(paper_traction(condition).coefficient);
              });
}

}  // namespace

std::vector<Figure> draw_figures(const Outcomes& outcomes) {
  Gallery gallery(outcomes);
  load_figures(gallery);
  opening_figure(gallery);
  traction_figures(gallery);
  traction_opening_figure(gallery);
  return std::move(gallery.figures);
}

}  // namespace hoof::tools
