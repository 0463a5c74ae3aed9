#include "tools/faults/matrix.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <deque>
#include <stdexcept>

#include "hil_bridge/reaction.h"
#include "tools/faults/matrix_foot.h"

namespace hoof::tools {
namespace {

using firmware::control::Mode;
using firmware::protocol::Order;

constexpr double kLinger_s = 0.15;    // watched on behind the fault: what is slow to be noticed
constexpr double kStopLimit_s = 2.5;  // a damped stop lasts 2 s at most
constexpr double kResetLimit_s = 0.5;
constexpr double kMove_s = 0.1;  // of moving again without a fault

constexpr std::array kAllModes = {Mode::kOff,         Mode::kHoming,     Mode::kReady,
                                  Mode::kRunning,     Mode::kDampedStop, Mode::kFault,
                                  Mode::kEmergencyOff};

/// What a cell's process hands back: plain numbers.
struct Measured {
  std::uint32_t faults = 0;
  double began_s = 0;
  double trip_s = -1;  // below 0: never
  double safe_s = -1;
  std::uint64_t changed = 0;
  int end_mode = 0;
  bool reset = false;
  bool moves = false;
};

bool moving(Mode mode) {
  return mode == Mode::kHoming || mode == Mode::kReady || mode == Mode::kRunning;
}

bool at_rest(Mode mode) {
  return !moving(mode) && mode != Mode::kDampedStop;
}

/// The foot stands in the mode; from here on, the fault.
class CellRun {
 public:
  CellRun(MatrixFoot& foot, const MatrixCase& c) : foot_(foot), case_(c) {}

  Measured go() {
    before_ = foot_.lock_step().firmware().faults();
    began_s_ = foot_.now_s();
    bridge::FaultSpec fault = case_.fault;
    fault.at_s = began_s_;
    foot_.faults().add(fault);
    watch(*fault.for_s + kLinger_s, [] { return false; });
    watch(kStopLimit_s, [this] { return foot_.mode() != Mode::kDampedStop; });
    measured_.end_mode = int(foot_.mode());
    if (at_rest(foot_.mode())) recover();
    measured_.began_s = began_s_;
    measured_.changed = foot_.faults().outcomes().back().changed;
    return measured_;
  }

 private:
  template <typename Until>
  bool watch(double limit_s, const Until& until) {
    const double from_s = foot_.now_s();
    while (!until()) {
      if (foot_.now_s() - from_s >= limit_s - 0.5e-3) return false;
      foot_.tick();
      note();
    }
    return true;
  }

  void note() {
    const double since_s = foot_.now_s() - began_s_;
    const std::uint32_t now = foot_.lock_step().firmware().faults();
    measured_.faults |= now & ~before_;
    if (measured_.faults != 0 && measured_.trip_s < 0) measured_.trip_s = since_s;
    if (recovering_) return;
    if (!bridge::all_passive(foot_.plant())) {
      measured_.safe_s = -1;
    } else if (measured_.safe_s < 0) {
      // Seen at the end of the first tick: it was so from the begin.
      measured_.safe_s = since_s < 1.5e-3 ? 0 : since_s;
    }
  }

  void recover() {
    recovering_ = true;
    const std::uint32_t found = measured_.faults;
    bridge::Supervisor& supervisor = foot_.lock_step().supervisor();
    supervisor.order(Order::kReset);
    measured_.reset = watch(kResetLimit_s, [&] {
      return supervisor.accepted() && foot_.mode() == Mode::kOff &&
             foot_.lock_step().firmware().faults() == 0;
    });
    if (!measured_.reset) return;
    foot_.order_ready();
    const auto away = [this] { return moving(foot_.mode()); };
    measured_.moves = watch(kResetLimit_s, away) && !watch(kMove_s, [&] { return !away(); });
    measured_.faults = found;
  }

  MatrixFoot& foot_;
  const MatrixCase& case_;
  std::uint32_t before_ = 0;
  double began_s_ = 0;
  bool recovering_ = false;
  Measured measured_;
};

/// The whole foot is copied by fork: a mode is reached once, not once for each fault.
struct Child {
  pid_t pid = -1;
  int fd = -1;
  const MatrixCase* c = nullptr;
};

Child start(MatrixFoot& foot, const MatrixCase& c) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error(std::string("pipe: ") + std::strerror(errno));
  const pid_t pid = fork();
  if (pid < 0) throw std::runtime_error(std::string("fork: ") + std::strerror(errno));
  if (pid == 0) {
    close(ends[0]);
    int status = 1;
    try {
      const Measured measured = CellRun(foot, c).go();
      status = write(ends[1], &measured, sizeof measured) == ssize_t(sizeof measured) ? 0 : 1;
    } catch (const std::exception& error) {
      const std::string text = std::string("hoof: ") + c.name + ": " + error.what() + "\n";
      if (write(STDERR_FILENO, text.data(), text.size()) < 0) status = 1;
    }
    _exit(status);
  }
  close(ends[1]);
  return {pid, ends[0], &c};
}

std::string milliseconds(double time_s) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0f ms", time_s * 1e3);
  return text;
}

void miss(MatrixCell& cell, const std::string& what) {
  cell.misses += (cell.misses.empty() ? "" : "; ") + what;
}

void judge(MatrixCell& cell, Expectation expected, int end_mode) {
  if (cell.changed == 0 && expected.idle) {
    expected = {};
  } else if (cell.changed == 0) {
    miss(cell, "the fault changed nothing");
  }
  const std::string names = bridge::fault_bit_names(cell.faults);
  if (expected.bits == 0 && cell.faults != 0) miss(cell, "not harmless: " + names);
  if (expected.bits != 0 && (cell.faults & expected.bits) == 0) {
    miss(cell, "no " + bridge::fault_bit_names(expected.bits));
  }
  if (expected.bits != 0 && (cell.faults & ~expected.bits) != 0) {
    miss(cell, "unexpected: " + bridge::fault_bit_names(cell.faults & ~expected.bits));
  }
  const bool goes_on = expected.bits == 0 && moving(cell.mode) && expected.safe_s == 0;
  if (goes_on) {
    if (!moving(Mode(end_mode))) miss(cell, "ended in mode " + cell.end_mode);
    return;
  }
  if (!cell.safe_s) {
    miss(cell, "drives still push");
  } else if (*cell.safe_s > expected.safe_s + 0.5e-3) {
    miss(cell,
         "safe after " + milliseconds(*cell.safe_s) + ", bound " + milliseconds(expected.safe_s));
  }
  if (!at_rest(Mode(end_mode))) return miss(cell, "ended in mode " + cell.end_mode);
  if (!cell.reset) return miss(cell, "no reset");
  if (!cell.moves) miss(cell, "does not move again");
}

MatrixCell finish(const Child& child, Mode mode) {
  Measured m;
  const bool read_all = read(child.fd, &m, sizeof m) == ssize_t(sizeof m);
  close(child.fd);
  int status = 0;
  waitpid(child.pid, &status, 0);
  MatrixCell cell;
  cell.fault = child.c->name;
  cell.mode = mode;
  if (!read_all) {
    cell.misses = WIFSIGNALED(status) ? "ended by signal " + std::to_string(WTERMSIG(status))
                                      : "could not be run";
    return cell;
  }
  cell.faults = m.faults;
  cell.began_s = m.began_s;
  if (m.trip_s >= 0) cell.trip_s = m.trip_s;
  if (m.safe_s >= 0) cell.safe_s = m.safe_s;
  cell.changed = m.changed;
  cell.end_mode = bridge::mode_name(m.end_mode);
  cell.reset = m.reset;
  cell.moves = m.moves;
  judge(cell, child.c->expected(mode), m.end_mode);
  return cell;
}

}  // namespace

std::vector<MatrixCell> run_matrix(const MatrixOptions& options,
                                   const std::function<void(const MatrixCell&)>& done) {
  std::vector<MatrixCase> cases;
  for (MatrixCase& c : matrix_cases()) {
    if (c.name.find(options.only) != std::string::npos) cases.push_back(std::move(c));
  }
  std::vector<Mode> modes = options.modes;
  if (modes.empty()) modes.assign(kAllModes.begin(), kAllModes.end());
  std::vector<MatrixCell> cells;
  for (const Mode mode : modes) {
    MatrixFoot foot;
    foot.bring_to(mode);
    std::deque<Child> under_way;
    const auto collect = [&] {
      cells.push_back(finish(under_way.front(), mode));
      under_way.pop_front();
      if (done) done(cells.back());
    };
    for (const MatrixCase& c : cases) {
      if (int(under_way.size()) >= options.jobs) collect();
      under_way.push_back(start(foot, c));
    }
    while (!under_way.empty()) collect();
  }
  return cells;
}

}  // namespace hoof::tools
