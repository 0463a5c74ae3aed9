#include "tools/qemu/slcan_client.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "hal/monotonic_clock.h"
#include "hal/slcan/line.h"

namespace hoof::tools::qemu {
namespace {

/// A board that starts hears nothing, so it is asked again.
constexpr std::int64_t kAskAgain_ns = 50'000'000;

constexpr char kEnd = char(hal::slcan::kEnd), kRefused = char(hal::slcan::kRefused);

}  // namespace

bool SlcanClient::open(std::int64_t longest_ns) {
  const hal::MonotonicClock clock;
  const std::int64_t give_up_ns = clock.now_ns() + longest_ns;
  while (!alive_ && failure_.empty() && clock.now_ns() < give_up_ns) {
    to_write_ = "V\r";  // its answer is like no other, also where the first bytes were lost
    flush();
    await(alive_, clock.now_ns() + kAskAgain_ns);
  }
  if (!alive_ || !failure_.empty()) return false;
  to_write_ = "O\r";
  flush();
  return await(open_, give_up_ns);
}

bool SlcanClient::await(const bool& what, std::int64_t give_up_ns) {
  const hal::MonotonicClock clock;
  for (;;) {
    if (!failure_.empty()) return false;
    if (what) return true;
    const std::int64_t left_ns = give_up_ns - clock.now_ns();
    if (left_ns <= 0) return false;
    wait(left_ns);
  }
}

hal::SendResult SlcanClient::send(const hal::CanFrame& frame) {
  const hal::slcan::Line line = hal::slcan::line_of(frame);
  if (line.length == 0) return hal::SendResult::kInvalid;
  if (!open_) return hal::SendResult::kDown;
  to_write_.append(line.bytes().begin(), line.bytes().end());
  ++untaken_;
  ++status_.sent;
  return hal::SendResult::kQueued;
}

bool SlcanClient::receive(hal::CanFrame& frame) {
  if (frames_.empty()) read();
  if (frames_.empty()) return false;
  frame = frames_.front();
  frames_.pop_front();
  ++status_.received;
  return true;
}

bool SlcanClient::flush() {
  while (!to_write_.empty() && failure_.empty()) {
    const ssize_t n = ::send(fd_, to_write_.data(), to_write_.size(), MSG_NOSIGNAL);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return false;
    if (n < 0) {
      failure_ = name_ + ": " + std::strerror(errno);
    } else {
      to_write_.erase(0, std::size_t(n));
    }
  }
  return to_write_.empty();
}

void SlcanClient::wait(std::int64_t longest_ns) {
  pollfd what{fd_, POLLIN, 0};
  const timespec longest{longest_ns / 1'000'000'000, longest_ns % 1'000'000'000};
  if (ppoll(&what, 1, &longest, nullptr) > 0) read();
}

void SlcanClient::read() {
  char bytes[4096];
  for (;;) {
    const ssize_t n = recv(fd_, bytes, sizeof bytes, 0);
    if (n < 0 && errno == EINTR) continue;
    if (n == 0) failure_ = name_ + " was closed";
    if (n < 0 && errno != EAGAIN) failure_ = name_ + ": " + std::strerror(errno);
    if (n <= 0) return;
    for (const char byte : std::string_view(bytes, std::size_t(n))) {
      if (byte == kEnd || byte == kRefused) {
        take_line(heard_, byte);
        heard_.clear();
      } else {
        heard_ += byte;
      }
    }
  }
}

void SlcanClient::take_line(const std::string& line, char end) {
  hal::CanFrame frame;
  const auto* text = reinterpret_cast<const std::uint8_t*>(line.data());
  if (end == kRefused) {
    // While it is asked for the first time, half a question may have come through.
    if (alive_) failure_ = name_ + ": the other end refused a line";
  } else if (hal::slcan::frame_of({text, line.size()}, frame)) {
    frames_.push_back(frame);
  } else if (line == "z" || line == "Z") {
    untaken_ = std::max(0, untaken_ - 1);
  } else if (line.starts_with('V')) {
    alive_ = true;
  } else if (line.empty()) {
    open_ = open_ || alive_;
  } else {
    failure_ = name_ + ": '" + line + "' is no answer";
  }
}

bool flush_in_order(SlcanClient& first, SlcanClient& then, std::int64_t longest_ns) {
  const hal::MonotonicClock clock;
  const std::int64_t give_up_ns = clock.now_ns() + longest_ns;
  while (first.failure().empty() && (!first.flush() || first.untaken() > 0)) {
    const std::int64_t left_ns = give_up_ns - clock.now_ns();
    if (left_ns <= 0) return false;
    first.wait(left_ns);
  }
  return then.flush() || !then.failure().empty();
}

}  // namespace hoof::tools::qemu
