#include "hil_bridge/bus_log.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "hil_bridge/candump.h"
#include "hil_bridge/recording.h"

namespace hoof::bridge {
namespace {

constexpr std::size_t kFlushBytes = 64 * 1024;

}  // namespace

BusLogWriter::BusLogWriter(BusLogSettings settings) : settings_(std::move(settings)) {
  fd_ = open(settings_.path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (fd_ < 0) fail("cannot create ", errno);
  buffer_.reserve(kFlushBytes + 256);
}

BusLogWriter::~BusLogWriter() {
  try {
    close();
  } catch (const std::system_error&) {
    // Nobody is left to tell; documented at the destructor.
  }
}

void BusLogWriter::fail(const char* action, int error_number) const {
  throw std::system_error(error_number, std::generic_category(), action + settings_.path);
}

void BusLogWriter::write(int bus_index, const hal::CanFrame& frame) {
  append_candump_line(buffer_, kSimulatedEpoch_ns + frame.stamp_ns,
                      settings_.interfaces.at(static_cast<std::size_t>(bus_index)), frame);
  ++frames_;
  if (buffer_.size() >= kFlushBytes || frame.stamp_ns >= flushed_until_ns_ + kRecordingFlush_ns) {
    flush();
    flushed_until_ns_ = frame.stamp_ns;
  }
}

void BusLogWriter::flush() {
  std::size_t done = 0;
  while (done < buffer_.size()) {
    const ssize_t written = ::write(fd_, buffer_.data() + done, buffer_.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int error_number = errno;
      buffer_.erase(0, done);
      fail("cannot write ", error_number);
    }
    done += static_cast<std::size_t>(written);
  }
  buffer_.clear();
}

void BusLogWriter::close() {
  if (fd_ < 0) return;
  // Closed even when the last lines cannot be written.
  const int fd = fd_;
  int flush_error = 0;
  try {
    flush();
  } catch (const std::system_error& error) {
    flush_error = error.code().value();
  }
  fd_ = -1;
  buffer_.clear();
  const int close_error = ::close(fd) != 0 ? errno : 0;
  if (flush_error != 0 || close_error != 0) {
    fail("cannot write ", flush_error != 0 ? flush_error : close_error);
  }
}

}  // namespace hoof::bridge
