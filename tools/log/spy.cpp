#include "tools/log/spy.h"

#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iostream>
#include <memory>
#include <vector>

#include "hal/socketcan/socketcan_bus.h"
#include "hil_bridge/candump.h"
#include "hil_bridge/lcm_event.h"
#include "tools/log/bus_recording.h"
#include "tools/log/spy_table.h"
#include "tools/run/errors.h"
#include "tools/run/stop_request.h"

namespace hoof::tools {
namespace {

/// Where frames come from.
class SpySource {
 public:
  virtual ~SpySource() = default;
  /// Puts all frames that are there into the table.
  virtual void drain(SpyTable& table) = 0;
  virtual std::string title() const = 0;
};

/// Follows a log like `tail -f`; a line counts once it is whole.
class LogSource final : public SpySource {
 public:
  explicit LogSource(const std::filesystem::path& path) : path_(find_bus_log(path)), in_(path_) {
    if (!in_) throw UserError(path_.string() + ": cannot read: " + std::strerror(errno));
  }

  void drain(SpyTable& table) override {
    in_.clear();
    std::string block(64 * 1024, '\0');
    while (in_.read(block.data(), std::streamsize(block.size())), in_.gcount() > 0) {
      rest_.append(block, 0, std::size_t(in_.gcount()));
      take_lines(table);
    }
  }

  std::string title() const override { return path_.string(); }

 private:
  void take_lines(SpyTable& table) {
    std::size_t start = 0;
    for (std::size_t end; (end = rest_.find('\n', start)) != std::string::npos; start = end + 1) {
      take_line(std::string_view(rest_).substr(start, end - start), table);
    }
    rest_.erase(0, start);
  }

  void take_line(std::string_view line, SpyTable& table) {
    try {
      const auto record = bridge::parse_candump_line(line, ++line_number_, path_.string());
      if (record) table.add(record->interface, record->frame, record->stamp_ns);
    } catch (const bridge::CandumpError& error) {
      throw UserError(error.what());
    }
  }

  std::filesystem::path path_;
  std::ifstream in_;
  std::string rest_;
  int line_number_ = 0;
};

class BusSource final : public SpySource {
 public:
  explicit BusSource(const std::string& interfaces) : title_(interfaces) {
    for (std::size_t start = 0; start <= interfaces.size();) {
      const std::size_t end = std::min(interfaces.find(',', start), interfaces.size());
      names_.push_back(interfaces.substr(start, end - start));
      hal::SocketCanSettings settings;
      settings.interface = names_.back();
      buses_.push_back(std::make_unique<hal::SocketCanBus>(settings));
      start = end + 1;
    }
  }

  void drain(SpyTable& table) override {
    hal::CanFrame frame;
    for (std::size_t i = 0; i < buses_.size(); ++i) {
      while (buses_[i]->receive(frame)) table.add(names_[i], frame, frame.stamp_ns);
    }
  }

  std::string title() const override {
    std::uint64_t lost = 0;
    for (const auto& bus : buses_) lost += bus->status().dropped;
    return title_ + (lost > 0 ? ", " + std::to_string(lost) + " frames lost here" : "");
  }

 private:
  std::string title_;
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<hal::SocketCanBus>> buses_;
};

class LcmSource final : public SpySource {
 public:
  explicit LcmSource(const std::string& url)
      : listener_(url), title_(url.empty() ? "LCM" : "LCM at " + url) {}

  void drain(SpyTable& table) override {
    listener_.drain([&table](const bridge::LcmEvent& event) { table.add(event); });
  }

  std::string title() const override { return title_; }

 private:
  bridge::LcmListener listener_;
  std::string title_;
};

std::unique_ptr<SpySource> open_source(const SpyRequest& request) {
  if (request.lcm) return std::make_unique<LcmSource>(*request.lcm);
  if (!request.bus.empty()) return std::make_unique<BusSource>(request.bus);
  return std::make_unique<LogSource>(request.recording);
}

/// Keys one by one, another screen; everything back at the end.
class Terminal {
 public:
  Terminal() {
    tcgetattr(STDIN_FILENO, &before_);
    termios raw = before_;
    raw.c_lflag &= ~tcflag_t(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    put("\x1b[?1049h\x1b[?25l");  // the alternate screen, no cursor
  }
  ~Terminal() {
    put("\x1b[?25h\x1b[?1049l");
    tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  void show(const std::string& text) const {
    std::string screen = "\x1b[H";
    for (const char c : text) {
      if (c == '\n') screen += "\x1b[K\r";  // clears what an earlier, longer line left
      screen += c;
    }
    put(screen + "\x1b[J");
  }

  winsize size() const {
    winsize size{};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0) size = {24, 80, 0, 0};
    return size;
  }

  /// Waits for input. @return what was typed, empty after the time
  std::string keys(int timeout_ms) const {
    pollfd in{STDIN_FILENO, POLLIN, 0};
    if (::poll(&in, 1, timeout_ms) <= 0) return "";
    char typed[32];
    const ssize_t count = read(STDIN_FILENO, typed, sizeof typed);
    return count > 0 ? std::string(typed, std::size_t(count)) : "";
  }

 private:
  static void put(const std::string& text) {
    std::size_t done = 0;
    while (done < text.size()) {
      const ssize_t written = ::write(STDOUT_FILENO, text.data() + done, text.size() - done);
      if (written < 0 && errno != EINTR && errno != EAGAIN) return;
      if (written > 0) done += std::size_t(written);
    }
  }

  termios before_{};
};

/// @return false when q was typed
bool obey(const std::string& keys, int& selected, int messages) {
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i] == 'q') return false;
    const bool up = keys.compare(i, 3, "\x1b[A") == 0, down = keys.compare(i, 3, "\x1b[B") == 0;
    if (up || down) i += 2;
    if (up || keys[i] == 'k') selected = std::max(0, selected - 1);
    if (down || keys[i] == 'j') selected = std::min(std::max(0, messages - 1), selected + 1);
  }
  return true;
}

std::string heading(const SpySource& source, const SpyTable& table) {
  return source.title() + ": " + std::to_string(table.frames()) + " messages";
}

}  // namespace

void spy(const SpyRequest& request) {
  const std::unique_ptr<SpySource> source = open_source(request);
  const bool live = !request.bus.empty() || request.lcm;
  SpyTable table;
  StopRequest stop;
  if (request.once || isatty(STDOUT_FILENO) == 0 || isatty(STDIN_FILENO) == 0) {
    // What is live has nothing to show at once: a second of it.
    for (int i = 0; i < (live ? 10 : 1) && !stop.requested(); ++i) {
      if (live) ::poll(nullptr, 0, 100);
      source->drain(table);
    }
    std::cout << table.render(heading(*source, table), 0, 0, 0);
    return;
  }
  const Terminal terminal;
  constexpr int kRedraw_ms = 100;
  int selected = 0;
  while (!stop.requested()) {
    source->drain(table);
    const winsize size = terminal.size();
    // The last line stays free: a line break in it would scroll.
    terminal.show(table.render(heading(*source, table) + "   (up/down or j/k: choose, q: quit)",
                               selected, size.ws_col, size.ws_row - 1));
    if (!obey(terminal.keys(kRedraw_ms), selected, table.messages())) return;
  }
}

}  // namespace hoof::tools
