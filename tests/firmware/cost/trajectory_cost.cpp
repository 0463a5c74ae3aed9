// hoof benchmark cost: how long one update() of the trajectory generator takes on the board.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstring>
#include <iomanip>
#include <iostream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/trajectory/generator.h"
#include "tests/firmware/cost/cpu_runner.h"
#include "tests/firmware/cost/cycle_rule.h"
#include "tools/trajectory/random_cases.h"
#include "tools/trajectory/solve_case.h"

namespace hoof::tests::cost {
namespace {

using firmware::trajectory::Generator;
using firmware::trajectory::Input;
using firmware::trajectory::Output;
using firmware::trajectory::Result;
using tools::emulator::ElfFile;
using tools::trajectory::Family;
using tools::trajectory::Random;

std::uint32_t symbol(const ElfFile& image, const std::string& name) {
  if (const auto address = image.address_of(name)) return *address;
  throw std::runtime_error("the image has no symbol " + name);
}

constexpr double kBar_us = 30;  // of any one update (issue 4)
constexpr int kMostUpdates = 2000;

struct Options {
  int moves = 500;  // per family
  std::uint64_t seed = 1;
  std::vector<int> joints{1, 2, 3, 7};
  std::vector<int> work{1, 2, 3};
  std::string level = "O2";
  bool families = false;
};

double microseconds(double cycles) {
  return cycles / kClockHz * 1e6;
}

struct Tally {
  std::uint64_t updates = 0;
  std::uint64_t planning = 0;  // updates in which a plan was being made or swapped
  std::uint64_t cycles = 0;
  std::uint64_t planning_cycles = 0;
  std::uint64_t most_cycles = 0;
  std::uint64_t most_instructions = 0;
  std::uint64_t wait_cycles = 0;
  std::uint64_t moves = 0;
  std::uint64_t delay = 0;  // updates from a new goal to the first sample of its profile
  int most_delay = 0;
  std::string worst;  // what the longest update did

  void merge(const Tally& o) {
    updates += o.updates;
    planning += o.planning;
    cycles += o.cycles;
    planning_cycles += o.planning_cycles;
    if (o.most_cycles > most_cycles) {
      most_cycles = o.most_cycles;
      most_instructions = o.most_instructions;
      worst = o.worst;
    }
    wait_cycles += o.wait_cycles;
    moves += o.moves;
    delay += o.delay;
    most_delay = std::max(most_delay, o.most_delay);
  }
};

// The same moves on the emulated board and here; every output must be the same, bit by bit.
template <int kJoints>
class Bench {
 public:
  using In = Input<float, kJoints>;
  using Out = Output<float, kJoints>;

  Bench(const ElfFile& image, int work)
      : image_(image), cpu_(image), work_(work), update_(symbol(image, "cost_update")) {
    state_bytes_ = cpu_.call(symbol(image, "cost_state_bytes"));
  }

  std::uint32_t state_bytes() const { return state_bytes_; }

  // From a standing or moving start to a goal, on to another goal before it is reached, a refused
  // goal, and back.
  Tally run(Family family, Random& random) {
    tally_ = {};
    family_ = name(family);
    cpu_.call(symbol(image_, "cost_make"), static_cast<std::uint32_t>(work_));
    host_ = std::make_unique<Generator<float, kJoints>>(0.001f);
    host_->set_work_per_update(work_);
    In first = input(family, random);
    follow(first, "first goal", random.integer(1, 60));
    In second = input(family, random);
    second.interface = first.interface;
    second.minimum_duration_s += 1e-3f;  // on the lattice the goals may be the same
    follow(second, "next goal", random.integer(1, 60));
    if (random.chance(0.2)) {
      In refused = second;
      refused.target_velocity[kJoints - 1] = std::numeric_limits<float>::quiet_NaN();
      follow(refused, "refused goal", 3);
      follow(second, "goal after a refusal", 3);
    }
    return tally_;
  }

 private:
  static In input(Family family, Random& random) {
    const auto in = tools::trajectory::converted<float>(
        tools::trajectory::random_input(family, random, kJoints));
    In out;
    copy(in, out);
    return out;
  }

  template <typename Wide>
  static void copy(const Wide& in, In& out) {
    out.interface = in.interface;
    out.synchronisation = in.synchronisation;
    out.minimum_duration_s = in.minimum_duration_s;
    out.duration_step_s = in.duration_step_s;
    for (int i = 0; i < kJoints; ++i) {
      out.position[i] = in.position[i];
      out.velocity[i] = in.velocity[i];
      out.acceleration[i] = in.acceleration[i];
      out.target_position[i] = in.target_position[i];
      out.target_velocity[i] = in.target_velocity[i];
      out.target_acceleration[i] = in.target_acceleration[i];
      out.max_velocity[i] = in.max_velocity[i];
      out.min_velocity[i] = in.min_velocity[i];
      out.max_acceleration[i] = in.max_acceleration[i];
      out.min_acceleration[i] = in.min_acceleration[i];
      out.max_jerk[i] = in.max_jerk[i];
    }
  }

  // Until its plan runs, and `more` updates on.
  void follow(const In& in, const char* what, int more) {
    cpu_.write(symbol(image_, "cost_input"), &in, sizeof in);
    bool planned = false;
    for (int k = 0; k < kMostUpdates && more > 0; ++k) {
      k_ = k;
      const bool running = update(in, what, !planned);
      if (running && !planned) {
        planned = true;
        ++tally_.moves;
        tally_.delay += static_cast<std::uint64_t>(k);
        tally_.most_delay = std::max(tally_.most_delay, k);
      }
      if (planned) --more;
    }
    if (!planned) throw std::runtime_error(std::string(what) + " was never planned");
  }

  // True when the plan asked for has begun or been refused.
  bool update(const In& in, const char* what, bool planning) {
    Out here{};
    const Result result = host_->update(in, here);
    const auto there_result = static_cast<std::int8_t>(cpu_.call(update_));
    Out there{};
    cpu_.read(symbol(image_, "cost_output"), &there, sizeof there);
    if (there_result != static_cast<std::int8_t>(result) || !same(here, there)) {
      throw std::runtime_error("the board's output differs from the host's (" + family_ + ", " +
                               what + ", update " + std::to_string(k_) + ")");
    }
    add(what, planning);
    return is_failure(result) || (here.new_plan && !here.stopping);
  }

  static bool same(const Out& a, const Out& b) {
    const auto equal = [](const auto& x, const auto& y) {
      return std::memcmp(&x, &y, sizeof x) == 0;
    };
    return equal(a.position, b.position) && equal(a.velocity, b.velocity) &&
           equal(a.acceleration, b.acceleration) && equal(a.jerk, b.jerk) &&
           equal(a.time_s, b.time_s) && equal(a.duration_s, b.duration_s) &&
           a.new_plan == b.new_plan && a.stopping == b.stopping;
  }

  void add(const char* what, bool planning) {
    const Cost& cost = cpu_.cost();
    ++tally_.updates;
    tally_.cycles += cost.cycles;
    tally_.wait_cycles += cost.flash_wait_cycles;
    if (planning) {
      ++tally_.planning;
      tally_.planning_cycles += cost.cycles;
    }
    if (cost.cycles <= tally_.most_cycles) return;
    tally_.most_cycles = cost.cycles;
    tally_.most_instructions = cost.instructions;
    tally_.worst =
        family_ + ", " + what + (planning ? ", update " + std::to_string(k_) : ", running");
  }

  const ElfFile& image_;
  CpuRunner cpu_;
  int work_;
  std::uint32_t update_;
  std::uint32_t state_bytes_ = 0;
  std::unique_ptr<Generator<float, kJoints>> host_;
  std::string family_;
  int k_ = 0;  // the update since the goal was given
  Tally tally_;
};

void print_head(std::ostream& out) {
  out << "joints work  updates  plans  planning    mean us  planning us    max us  instructions  "
         "wait  delay mean/max  longest\n";
}

void print_row(int joints, int work, const Tally& t, std::ostream& out) {
  const auto mean = [](std::uint64_t sum, std::uint64_t n) {
    return n > 0 ? static_cast<double>(sum) / static_cast<double>(n) : 0.0;
  };
  out << std::fixed << std::setw(6) << joints << std::setw(5) << work << std::setw(9) << t.updates
      << std::setw(7) << t.moves << std::setprecision(0) << std::setw(8)
      << 100 * mean(t.planning, t.updates) << " %" << std::setprecision(2) << std::setw(11)
      << microseconds(mean(t.cycles, t.updates)) << std::setw(13)
      << microseconds(mean(t.planning_cycles, t.planning)) << std::setw(10)
      << microseconds(static_cast<double>(t.most_cycles)) << std::setw(14) << t.most_instructions
      << std::setprecision(0) << std::setw(4) << 100 * mean(t.wait_cycles, t.cycles) << " %"
      << std::setprecision(1) << std::setw(11) << mean(t.delay, t.moves) << " / " << t.most_delay
      << "  " << t.worst << "\n";
}

// Names of software floating-point doubles and of 64-bit conversions in the image.
int count_doubles(const ElfFile& image, std::ostream& out) {
  int found = 0;
  for (const ElfFile::Symbol& each : image.symbols) {
    const std::string& name = each.name;
    if (name.rfind("__aeabi_d", 0) == 0 || name.rfind("__aeabi_l", 0) == 0 ||
        name.rfind("__aeabi_ul", 0) == 0 || name == "__aeabi_f2d") {
      out << "software double: " << name << "\n";
      ++found;
    }
  }
  return found;
}

enum class Outcome { kNotMeasured, kKept, kMissed };

void worsen(Outcome& outcome, bool kept) {
  if (!kept) outcome = Outcome::kMissed;
  if (kept && outcome == Outcome::kNotMeasured) outcome = Outcome::kKept;
}

template <int kJoints>
void measure(const Options& options, Outcome& outcome, std::ostream& out) {
  const ElfFile image =
      tools::emulator::read_elf_file(std::string(HOOF_COST_IMAGE_DIR) + "/trajectory-" +
                                     std::to_string(kJoints) + "-" + options.level + ".elf");
  if (count_doubles(image, out) > 0) outcome = Outcome::kMissed;
  std::uint32_t state_bytes = 0;
  for (const int work : options.work) {
    Random random(options.seed);
    Bench<kJoints> bench(image, work);
    state_bytes = bench.state_bytes();
    Tally all;
    for (int f = 0; f < static_cast<int>(Family::kCount); ++f) {
      Tally family;
      for (int i = 0; i < options.moves; ++i) {
        family.merge(bench.run(static_cast<Family>(f), random));
      }
      if (options.families) print_row(kJoints, work, family, out);
      all.merge(family);
    }
    print_row(kJoints, work, all, out);
    if (work == 1) worsen(outcome, microseconds(static_cast<double>(all.most_cycles)) <= kBar_us);
  }
  out << "       a Generator<float, " << kJoints << "> holds " << state_bytes << " bytes\n";
}

int run(const Options& options, std::ostream& out) {
  out << "Cortex-M4F at 168 MHz, -" << options.level << ", by the rule of cycle_rule.h; seed "
      << options.seed << ", " << options.moves
      << " runs of two or more moves per family; every output equal to the host's, bit by bit\n";
  print_head(out);
  Outcome outcome = Outcome::kNotMeasured;
  for (const int joints : options.joints) {
    if (joints == 1) measure<1>(options, outcome, out);
    if (joints == 2) measure<2>(options, outcome, out);
    if (joints == 3) measure<3>(options, outcome, out);
    if (joints == 7) measure<7>(options, outcome, out);
  }
  out << "no software doubles, at most 30 us of any update with one unit of work: "
      << (outcome == Outcome::kKept     ? "kept"
          : outcome == Outcome::kMissed ? "MISSED"
                                        : "not measured")
      << "\n";
  return outcome == Outcome::kMissed ? 1 : 0;
}

}  // namespace
}  // namespace hoof::tests::cost

int main(int argc, char** argv) {
  hoof::tests::cost::Options options;
  CLI::App app{"The trajectory generator's time per update on a Cortex-M4F, by emulation"};
  app.add_option("--moves", options.moves, "Runs per family")->capture_default_str();
  app.add_option("--seed", options.seed, "Seed of the random moves")->capture_default_str();
  app.add_option("--joints", options.joints, "1, 2, 3 or 7")
      ->check(CLI::IsMember({1, 2, 3, 7}))
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--work", options.work, "Units of work per update; 0: a plan at once")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--level", options.level, "Optimisation: O2 or Os")
      ->check(CLI::IsMember({"O2", "Os"}))
      ->capture_default_str();
  app.add_flag("--families", options.families, "A line for each family too");
  app.footer("Example:\n  hoof benchmark cost --joints 3 --work 1,2 --moves 2000");
  CLI11_PARSE(app, argc, argv);
  try {
    return hoof::tests::cost::run(options, std::cout);
  } catch (const std::exception& error) {
    std::cerr << "hoof benchmark cost: " << error.what() << "\n";
    return 3;
  }
}
