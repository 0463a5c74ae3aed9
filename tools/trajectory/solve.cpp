#include "tools/trajectory/solve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <memory>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "tools/trajectory/solve_case.h"

namespace hoof::tools::trajectory {
namespace {

using firmware::trajectory::Interface;
using Generator = GeneratorOf<double>;

enum class Curve { kPosition, kVelocity, kAcceleration };
constexpr std::array kCurves{Curve::kPosition, Curve::kVelocity, Curve::kAcceleration};
constexpr const char* kCurveNames[] = {"position", "velocity", "acceleration"};

struct Series {
  std::vector<double> time_s;
  std::vector<double> value;
};

Series sampled(const Generator& generator, int joint, Curve curve, int samples) {
  Series series;
  firmware::trajectory::Output<double, kMaxJoints> output;
  for (int k = 0; k < samples; ++k) {
    const double t = generator.duration_s() * k / (samples - 1);
    generator.at_time(t, output);
    series.time_s.push_back(t);
    series.value.push_back(curve == Curve::kPosition   ? output.position[joint]
                           : curve == Curve::kVelocity ? output.velocity[joint]
                                                       : output.acceleration[joint]);
  }
  return series;
}

void print_pieces(const Generator& generator, int joint, double start, std::ostream& out) {
  const auto& profile = generator.profile(joint);
  out << "axis " << joint << ": " << profile.duration_s() << " s";
  if (profile.brake_s() > 0) out << ", of them braking " << profile.brake_s() << " s";
  out << ", alone " << generator.minimum_duration_s(joint) << " s\n";
  const auto row = [&](double t, double p, double v, double a, const std::string& jerk) {
    out << std::setw(14) << t << std::setw(14) << p << std::setw(14) << v << std::setw(14) << a
        << std::setw(14) << jerk << "\n";
  };
  out << std::setw(14) << "time [s]" << std::setw(14) << "position" << std::setw(14) << "velocity"
      << std::setw(14) << "acceleration" << std::setw(14) << "jerk"
      << "\n";
  for (int i = 0; i < profile.pieces(); ++i) {
    const auto& piece = profile.piece(i);
    std::ostringstream jerk;
    jerk << std::setprecision(7) << piece.jerk;
    row(piece.begin_s, start + piece.state.position, piece.state.velocity, piece.state.acceleration,
        jerk.str());
  }
  const auto& end = profile.end();
  row(profile.duration_s(), end.position, end.velocity, end.acceleration, "");
}

// A plot of one curve in `kRows` lines of text.
void print_plot(const Series& series, const std::string& title, std::ostream& out) {
  constexpr int kRows = 12;
  const auto [low_it, high_it] = std::minmax_element(series.value.begin(), series.value.end());
  const double low = *low_it;
  const double range = *high_it > low ? *high_it - low : 1;
  const int columns = static_cast<int>(series.value.size());
  std::vector<std::string> lines(kRows, std::string(static_cast<std::size_t>(columns), ' '));
  const auto line_of = [&](double value) {
    return kRows - 1 - static_cast<int>(std::lround((value - low) / range * (kRows - 1)));
  };
  if (low <= 0 && low + range >= 0) lines[line_of(0)].assign(columns, '.');
  for (int k = 0; k < columns; ++k) lines[line_of(series.value[k])][k] = '*';
  out << "  " << title << "\n";
  for (int row = 0; row < kRows; ++row) {
    const double value = low + range * (kRows - 1 - row) / (kRows - 1);
    const bool labelled = row == 0 || row == kRows - 1;
    out << std::setw(12)
        << (labelled ? (std::ostringstream() << std::setprecision(5) << value).str()
                     : std::string())
        << " |" << lines[row] << "\n";
  }
}

// Three panels over one time axis, a line for each axis.
class SvgPlot {
 public:
  SvgPlot(const Generator& generator, int joints) : generator_(generator), joints_(joints) {}

  void write(std::ostream& out) const {
    out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << kWidth << "\" height=\""
        << 3 * kPanel << "\" font-family=\"sans-serif\" font-size=\"12\">\n"
        << "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n";
    for (const Curve curve : kCurves) panel(curve, out);
    out << "</svg>\n";
  }

 private:
  static constexpr int kWidth = 800;
  static constexpr int kPanel = 220;
  static constexpr int kMargin = 60;
  static constexpr int kSamples = 600;

  void panel(Curve curve, std::ostream& out) const {
    std::vector<Series> all;
    double low = 0;
    double high = 0;
    for (int i = 0; i < joints_; ++i) {
      all.push_back(sampled(generator_, i, curve, kSamples));
      low = std::min(low, *std::min_element(all[i].value.begin(), all[i].value.end()));
      high = std::max(high, *std::max_element(all[i].value.begin(), all[i].value.end()));
    }
    const int index = static_cast<int>(curve);
    const double top = index * kPanel + 20;
    const double height = kPanel - 45;
    const double range = high > low ? high - low : 1;
    const double duration_s = std::max(generator_.duration_s(), 1e-12);
    const auto x = [&](double t) { return kMargin + t / duration_s * (kWidth - kMargin - 20); };
    const auto y = [&](double value) { return top + (high - value) / range * height; };
    out << "<text x=\"" << kMargin << "\" y=\"" << top - 6 << "\">" << kCurveNames[index]
        << "</text>\n<text x=\"4\" y=\"" << y(high) + 4 << "\">" << high
        << "</text>\n<text x=\"4\" y=\"" << y(low) + 4 << "\">" << low << "</text>\n"
        << "<path d=\"M" << x(0) << " " << y(0) << " H" << x(duration_s)
        << "\" stroke=\"#aaa\" fill=\"none\"/>\n";
    constexpr const char* kColours[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                        "#56b4e9", "#e69f00", "#000000", "#999999"};
    for (int i = 0; i < joints_; ++i) {
      out << "<polyline fill=\"none\" stroke=\"" << kColours[i] << "\" points=\"";
      for (std::size_t k = 0; k < all[i].value.size(); ++k) {
        out << x(all[i].time_s[k]) << "," << y(all[i].value[k]) << " ";
      }
      out << "\"/>\n";
    }
    if (curve == kCurves.back()) {
      out << "<text x=\"" << x(duration_s) << "\" y=\"" << top + height + 18
          << "\" text-anchor=\"end\">" << generator_.duration_s() << " s</text>\n";
    }
  }

  const Generator& generator_;
  int joints_;
};

void print_refusal(const firmware::trajectory::ValidationError<double>& error, std::ostream& out) {
  out << name(error.quantity);
  if (error.joint >= 0) out << " of axis " << error.joint;
  out << " is " << error.value << ": it " << name(error.rule);
  if (error.rule != firmware::trajectory::Rule::kFinite) out << " " << error.bound;
  out << "\n";
}

}  // namespace

int run_trajectory_solve(const SolveRequest& request, std::ostream& out) {
  const auto generator = std::make_unique<Generator>(0.001);
  const auto result = generator->plan(request.input);
  if (is_failure(result)) {
    out << name(result) << " (" << static_cast<int>(result) << ")\n";
    if (generator->validation_error()) print_refusal(generator->validation_error(), out);
    return 1;
  }
  out << std::setprecision(7);
  for (int i = 0; i < request.input.joints; ++i) {
    print_pieces(*generator, i, request.input.position[i], out);
    constexpr int kColumns = 72;
    for (const Curve curve : kCurves) {
      print_plot(sampled(*generator, i, curve, kColumns), kCurveNames[static_cast<int>(curve)],
                 out);
    }
  }
  if (request.svg) {
    std::ofstream file(*request.svg);
    if (!file) {
      out << request.svg->string() << ": cannot be written\n";
      return 1;
    }
    SvgPlot(*generator, request.input.joints).write(file);
  }
  return 0;
}

}  // namespace hoof::tools::trajectory
