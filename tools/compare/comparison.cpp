#include "tools/compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/run/errors.h"

namespace hoof::tools {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kLengthRelative = 0.02, kLengthAbsolute_s = 0.005;
/// Times are read from decimal texts and shifted: equal ones may differ in the last places.
constexpr double kSameTime_s = 1e-9;

/// Looks values of one series up at rising times.
class Lookup {
 public:
  Lookup(const SignalSeries& series, double shift_s) : series_(series), shift_s_(shift_s) {}

  /// Not-a-number outside the series' own time.
  double at(double time_s) {
    const std::vector<double>& t = series_.time_s;
    const double own_s = time_s - shift_s_;
    if (t.empty() || own_s < t.front() - kSameTime_s || own_s > t.back() + kSameTime_s) {
      return kNothing;
    }
    while (next_ < t.size() && t[next_] <= own_s + kSameTime_s) ++next_;
    if (next_ == 0) return series_.values.front();
    const double before = series_.values[next_ - 1];
    if (series_.whole || next_ == t.size() || own_s <= t[next_ - 1] + kSameTime_s) return before;
    const double share = (own_s - t[next_ - 1]) / (t[next_] - t[next_ - 1]);
    return before + share * (series_.values[next_] - before);
  }

 private:
  const SignalSeries& series_;
  double shift_s_;
  std::size_t next_ = 0;
};

double mean_square(const SignalSeries& a, const SignalSeries& b, double shift_s) {
  Lookup lookup(b, shift_s);
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double other = lookup.at(a.time_s[i]);
    if (std::isnan(other) || std::isnan(a.values[i])) continue;
    sum += (other - a.values[i]) * (other - a.values[i]);
    ++count;
  }
  if (2 * count < std::min(a.values.size(), b.values.size())) {
    return std::numeric_limits<double>::infinity();
  }
  return sum / double(count);
}

const SignalSeries* find(const std::vector<SignalSeries>& all, const std::string& name) {
  for (const SignalSeries& series : all) {
    if (series.name == name) return &series;
  }
  return nullptr;
}

/// B's texts by A's numbers.
SignalSeries in_terms_of(const SignalSeries& a, const SignalSeries& b,
                         std::vector<std::string>& names) {
  names = a.value_names;
  SignalSeries out = b;
  for (double& value : out.values) {
    const std::string& text = b.value_names[std::size_t(value)];
    auto at = std::find(names.begin(), names.end(), text);
    if (at == names.end()) at = names.insert(names.end(), text);
    value = double(at - names.begin());
  }
  return out;
}

void note_difference(SignalComparison& c, double time_s, double a, double b, double& square_sum) {
  // Two that are both not a number are the same; one alone is as far off as can be.
  const bool equal = a == b || (std::isnan(a) && std::isnan(b));
  const double off = equal                            ? 0.0
                     : std::isnan(a) || std::isnan(b) ? std::numeric_limits<double>::infinity()
                                                      : std::abs(b - a);
  ++c.compared;
  square_sum += off * off;
  if (off > c.largest) {
    c.largest = off;
    c.largest_at_s = time_s;
  }
  if (off <= c.tolerance.at(a)) return;
  ++c.outside;
  if (!c.first_outside_s) c.first_outside_s = time_s;
}

SignalComparison compare_signal(const SignalSeries& a, const SignalSeries& b_as_read,
                                const CompareOptions& options, double shift_s) {
  SignalComparison c;
  c.name = a.name;
  c.whole = a.whole;
  c.tolerance = tolerance_of(a, options.tolerances);
  SignalSeries renamed;
  const bool texts = !a.value_names.empty() && !b_as_read.value_names.empty();
  if (texts) renamed = in_terms_of(a, b_as_read, c.value_names);
  const SignalSeries& b = texts ? renamed : b_as_read;
  Lookup lookup(b, shift_s);
  const double from_s = b.time_s.front() + shift_s - kSameTime_s;
  const double to_s = b.time_s.back() + shift_s + kSameTime_s;
  double square_sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const double time_s = a.time_s[i];
    const double other = lookup.at(time_s);
    c.time_s.push_back(time_s);
    c.a.push_back(a.values[i]);
    c.b.push_back(other);
    c.allowed.push_back(c.tolerance.at(a.values[i]));
    if (time_s < from_s || time_s > to_s) continue;
    note_difference(c, time_s, a.values[i], other, square_sum);
  }
  if (c.compared > 0) c.rms = std::sqrt(square_sum / double(c.compared));
  c.verdict = c.outside > 0 || c.compared == 0 ? SignalVerdict::kOut
              : c.largest > 0                  ? SignalVerdict::kWithin
                                               : SignalVerdict::kSame;
  return c;
}

struct Span {
  double from_s = std::numeric_limits<double>::infinity();
  double to_s = -std::numeric_limits<double>::infinity();
};

Span span_of(const std::vector<SignalSeries>& all) {
  Span span;
  for (const SignalSeries& series : all) {
    if (series.time_s.empty()) continue;
    span.from_s = std::min(span.from_s, series.time_s.front());
    span.to_s = std::max(span.to_s, series.time_s.back());
  }
  return span;
}

}  // namespace

const char* to_string(SignalVerdict verdict) {
  switch (verdict) {
    case SignalVerdict::kSame:
      return "same";
    case SignalVerdict::kWithin:
      return "within";
    case SignalVerdict::kOut:
      return "OUT";
    case SignalVerdict::kOnlyA:
      return "ONLY IN A";
    case SignalVerdict::kOnlyB:
      return "ONLY IN B";
  }
  return "?";
}

bool Comparison::within() const {
  return !length_differs && std::all_of(signals.begin(), signals.end(), [](const auto& c) {
    return c.verdict == SignalVerdict::kSame || c.verdict == SignalVerdict::kWithin;
  });
}

double best_shift_s(const SignalSeries& a, const SignalSeries& b, double longest_shift_s) {
  if (a.time_s.size() < 2 || b.time_s.size() < 2) return 0;
  const double step_s =
      (b.time_s.back() - b.time_s.front()) / double(b.time_s.size() - 1);  // B's mean period
  const int steps = int(std::min(longest_shift_s / step_s, 20'000.0));
  double best = mean_square(a, b, 0), best_s = 0;
  // From small shifts to large ones: of equally good ones the smallest is taken.
  for (int i = 1; i <= steps; ++i) {
    for (const double shift_s : {i * step_s, -i * step_s}) {
      const double off = mean_square(a, b, shift_s);
      if (off < best) best = off, best_s = shift_s;
    }
  }
  return best_s;
}

Comparison compare(const std::vector<SignalSeries>& a, const std::vector<SignalSeries>& b,
                   const CompareOptions& options) {
  Comparison result;
  if (!options.align_signal.empty()) {
    const SignalSeries* in_a = find(a, options.align_signal);
    const SignalSeries* in_b = find(b, options.align_signal);
    if (in_a == nullptr || in_b == nullptr) {
      throw UserError("--align " + options.align_signal + ": not a signal of " +
                      (in_a == nullptr ? "A" : "B"));
    }
    result.shift_s = best_shift_s(*in_a, *in_b, options.longest_shift_s);
  }
  const Span of_a = span_of(a), of_b = span_of(b);
  result.a_ends_s = of_a.to_s;
  result.b_ends_s = of_b.to_s + result.shift_s;
  result.overlap_from_s = std::max(of_a.from_s, of_b.from_s + result.shift_s);
  result.overlap_to_s = std::min(result.a_ends_s, result.b_ends_s);
  if (!(result.overlap_from_s <= result.overlap_to_s)) {
    throw UserError("the two have no moment in common");
  }
  const double length_s = of_a.to_s - of_a.from_s;
  const double difference_s = std::abs((of_b.to_s - of_b.from_s) - length_s);
  result.length_differs = difference_s > std::max(kLengthAbsolute_s, kLengthRelative * length_s);
  for (const SignalSeries& series : a) {
    if (const SignalSeries* other = find(b, series.name)) {
      result.signals.push_back(compare_signal(series, *other, options, result.shift_s));
    } else {
      result.signals.push_back({});
      result.signals.back().name = series.name;
      result.signals.back().verdict = SignalVerdict::kOnlyA;
    }
  }
  for (const SignalSeries& series : b) {
    if (find(a, series.name) != nullptr) continue;
    result.signals.push_back({});
    result.signals.back().name = series.name;
    result.signals.back().verdict = SignalVerdict::kOnlyB;
  }
  return result;
}

}  // namespace hoof::tools
