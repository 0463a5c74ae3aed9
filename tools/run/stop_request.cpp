#include "tools/run/stop_request.h"

#include <csignal>

namespace hoof::tools {
namespace {

volatile std::sig_atomic_t requested_signal = 0;

extern "C" void remember_signal(int signal_number) {
  requested_signal = signal_number;
}

void set_handler(int signal_number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  // SA_RESETHAND: the second signal meets the default handler and ends the program at once.
  // No SA_RESTART: a blocking read returns EINTR, so that its loop comes round to requested().
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigemptyset(&action.sa_mask);
  sigaction(signal_number, &action, nullptr);
}

}  // namespace

StopRequest::StopRequest() {
  requested_signal = 0;
  set_handler(SIGINT, remember_signal);
  set_handler(SIGTERM, remember_signal);
  set_handler(SIGUSR1, remember_signal);
}

StopRequest::~StopRequest() {
  set_handler(SIGINT, SIG_DFL);
  set_handler(SIGTERM, SIG_DFL);
  set_handler(SIGUSR1, SIG_DFL);
}

bool StopRequest::requested() const {
  return requested_signal != 0;
}

int StopRequest::exit_status() const {
  return requested() ? 128 + requested_signal : 0;
}

}  // namespace hoof::tools
