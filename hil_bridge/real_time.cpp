#include "hil_bridge/real_time.h"

#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>

#include "hal/monotonic_clock.h"

namespace hoof::bridge {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
/// The last part of the wait is a sleep to the deadline itself, which wakes more exactly than
/// poll(); a frame that comes then waits so long at most.
constexpr std::int64_t kLastSleep_ns = 60'000;
/// Above ordinary programs and the kernel's own default of 50 for interrupt threads' users.
constexpr int kPriority = 60;
/// Five of its drives' time-outs: the foot sends commands every millisecond, in every mode.
constexpr std::int64_t kSilence_ns = 100'000'000;

/// Ticks that may become due at once.
constexpr std::uint32_t kMostBehind = 100;

timespec timespec_of(std::int64_t t_ns) {
  return {t_ns / kSecond_ns, t_ns % kSecond_ns};
}

}  // namespace

std::vector<std::string> become_real_time() {
  std::vector<std::string> refused;
  sched_param priority{};
  priority.sched_priority = kPriority;
  if (sysconf(_SC_NPROCESSORS_ONLN) < 2) {
    refused.push_back(
        "SCHED_FIFO: not asked for, as on the one processor here the plant could keep "
        "everybody else from running");
  } else if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0) {
    refused.push_back("SCHED_FIFO " + std::to_string(kPriority) + ": " + std::strerror(errno) +
                      " (needs root, CAP_SYS_NICE, or rtprio in limits.conf)");
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) != 0) {
    refused.push_back(std::string("mlockall: ") + std::strerror(errno) +
                      " (needs root, CAP_IPC_LOCK, or memlock in limits.conf)");
  }
  if (prctl(PR_SET_TIMERSLACK, 1UL) != 0) {
    refused.push_back(std::string("timer slack of 1 ns: ") + std::strerror(errno));
  }
  return refused;
}

void RealTimePace::wait_for_frames(std::int64_t until_ns) const {
  std::vector<pollfd> entries;
  for (const int fd : descriptors_) entries.push_back({fd, POLLIN, 0});
  const timespec timeout =
      timespec_of(std::max<std::int64_t>(0, until_ns - hal::MonotonicClock().now_ns()));
  ppoll(entries.data(), entries.size(), &timeout, nullptr);
}

std::uint32_t RealTimePace::rest(const std::function<void()>& poll) {
  const hal::MonotonicClock clock;
  if (!schedule_) schedule_.emplace(clock.now_ns(), period_ns_);
  schedule_->work_done(clock.now_ns());
  const std::int64_t deadline_ns = schedule_->deadline_ns();
  while (clock.now_ns() < deadline_ns - kLastSleep_ns) {
    wait_for_frames(deadline_ns - kLastSleep_ns);
    poll();
  }
  const timespec deadline = timespec_of(deadline_ns);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &deadline, nullptr) == EINTR) {
  }
  const std::uint32_t due = schedule_->woke(clock.now_ns());
  // Catching up takes time as well: from here on it would only fall behind further.
  if (due > kMostBehind) {
    throw std::runtime_error("real time: the plant fell " + std::to_string(due) +
                             " ticks behind the wall's clock; this machine does not keep up");
  }
  return due;
}

void BusFoot::poll(std::uint32_t tick) {
  hal::CanFrame frame;
  for (hal::CanBus* bus : buses_) {
    while (bus->receive(frame)) telemetry_.take(frame, clock_.now_ns());
  }
  if (telemetry_.foot_frames() != heard_frames_) {
    heard_frames_ = telemetry_.foot_frames();
    heard_ns_ = clock_.now_ns();
    heard_tick_ = tick;
  }
  if (lost_.empty() && clock_.now_ns() - heard_ns_ > kSilence_ns) {
    lost_ = "the foot on " + name_ + " has been silent since SYNC " + std::to_string(heard_tick_) +
            ", for " + std::to_string(kSilence_ns / 1'000'000) + " ms";
  }
}

}  // namespace hoof::bridge
