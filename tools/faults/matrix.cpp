#include "tools/faults/matrix.h"

#include <array>
#include <cstdio>
#include <deque>
#include <stdexcept>
#include <utility>

#include "hil_bridge/reaction.h"
#include "tools/faults/matrix_cell.h"
#include "tools/faults/matrix_child.h"

namespace hoof::tools {
namespace {

using firmware::control::Mode;

constexpr std::array kAllModes = {Mode::kOff,         Mode::kHoming,     Mode::kReady,
                                  Mode::kRunning,     Mode::kDampedStop, Mode::kFault,
                                  Mode::kEmergencyOff};
constexpr double kHalfTick_s = 0.5e-3;

std::string milliseconds(double time_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f ms", time_s * 1e3);
  return text;
}

void miss(MatrixCell& cell, const std::string& what) {
  cell.misses += (cell.misses.empty() ? "" : "; ") + what;
}

void judge_bits(MatrixCell& cell, const Expectation& expected) {
  const std::string names = bridge::fault_bit_names(cell.faults);
  if (expected.bits == 0 && cell.faults != 0) miss(cell, "not harmless: " + names);
  if (expected.bits != 0 && (cell.faults & expected.bits) == 0) {
    miss(cell, "no " + bridge::fault_bit_names(expected.bits));
  }
  if (expected.bits != 0 && (cell.faults & ~expected.bits) != 0) {
    miss(cell, "unexpected: " + bridge::fault_bit_names(cell.faults & ~expected.bits));
  }
}

void judge_times(MatrixCell& cell, const Expectation& expected) {
  if (cell.surge_s > expected.surge_s + kHalfTick_s) {
    miss(cell, "pushed too hard for " + milliseconds(cell.surge_s) + ", bound " +
                   milliseconds(expected.surge_s));
  }
  if (expected.goes_on(cell.mode)) return;
  if (!cell.safe_s) {
    miss(cell, "drives still push");
  } else if (*cell.safe_s > expected.safe_s + kHalfTick_s) {
    miss(cell,
         "safe after " + milliseconds(*cell.safe_s) + ", bound " + milliseconds(expected.safe_s));
  }
}

void judge_end(MatrixCell& cell, const Expectation& expected, Mode end) {
  if (expected.goes_on(cell.mode)) {
    if (!moving(end)) miss(cell, "ended in mode " + cell.end_mode);
    return;
  }
  if (!at_rest(end)) return miss(cell, "ended in mode " + cell.end_mode);
  if (!cell.reset) return miss(cell, "no reset");
  if (!cell.moves) miss(cell, "does not move again");
}

void judge(MatrixCell& cell, Expectation expected, Mode end) {
  if (cell.changed == 0 && expected.idle) {
    expected = {};
  } else if (cell.changed == 0) {
    miss(cell, "the fault changed nothing");
  }
  judge_bits(cell, expected);
  judge_times(cell, expected);
  judge_end(cell, expected, end);
}

MatrixCell finish(MatrixChild& child, const MatrixCase& c, Mode mode) {
  MatrixCell cell;
  cell.fault = c.name;
  cell.why = c.why;
  cell.mode = mode;
  Measured m;
  cell.misses = child.finish(m);
  if (!cell.misses.empty()) return cell;
  cell.faults = m.faults;
  cell.began_s = m.began_s;
  if (m.trip_s >= 0) cell.trip_s = m.trip_s;
  if (m.safe_s >= 0) cell.safe_s = m.safe_s;
  cell.surge_s = m.surge_s;
  cell.changed = m.changed;
  cell.end_mode = bridge::mode_name(m.end_mode);
  cell.reset = m.reset;
  cell.moves = m.moves;
  judge(cell, c.expected(mode), Mode(m.end_mode));
  if (c.gap) std::swap(cell.gaps, cell.misses);
  return cell;
}

JointTorques undisturbed(MatrixFoot& foot) {
  auto child = MatrixChild::start<JointTorques>([&foot] { return measure_undisturbed(foot); });
  JointTorques push_Nm{};
  if (const std::string trouble = child.finish(push_Nm); !trouble.empty()) {
    throw std::runtime_error("the foot without a fault " + trouble);
  }
  return push_Nm;
}

}  // namespace

std::vector<MatrixCell> run_matrix(const std::vector<MatrixCase>& all, const MatrixOptions& options,
                                   const std::function<bool(const MatrixCell&)>& done) {
  std::vector<MatrixCase> cases;
  for (const MatrixCase& c : all) {
    if (c.name.find(options.only) != std::string::npos) cases.push_back(c);
  }
  std::vector<Mode> modes = options.modes;
  if (modes.empty()) modes.assign(kAllModes.begin(), kAllModes.end());
  std::vector<MatrixCell> cells;
  bool go_on = true;
  for (const Mode mode : modes) {
    if (!go_on || cases.empty()) break;
    MatrixFoot foot;
    foot.bring_to(mode);
    const JointTorques needed = undisturbed(foot);
    std::deque<std::pair<MatrixChild, const MatrixCase*>> under_way;
    const auto collect = [&] {
      cells.push_back(finish(under_way.front().first, *under_way.front().second, mode));
      under_way.pop_front();
      if (done) go_on = done(cells.back()) && go_on;
    };
    for (const MatrixCase& c : cases) {
      if (int(under_way.size()) >= options.jobs) collect();
      if (!go_on) return cells;
      under_way.emplace_back(MatrixChild::start<Measured>([&] { return measure(foot, c, needed); }),
                             &c);
    }
    while (!under_way.empty() && go_on) collect();
  }
  return cells;
}

std::vector<MatrixCell> run_matrix(const MatrixOptions& options,
                                   const std::function<bool(const MatrixCell&)>& done) {
  return run_matrix(matrix_cases(), options, done);
}

}  // namespace hoof::tools
