#include "firmware/board/host/lock_step_foot.h"

#include <iostream>

#include "firmware/app/received_ids.h"

namespace hoof::firmware::board {
namespace {

/// Without a simulator the loop looks at its clock every millisecond.
constexpr std::int64_t kFreeSleep_ns = 500'000;
/// While time stands there is nothing to look at but the order to end.
constexpr std::int64_t kStandingSleep_ns = 50'000'000;

/// A leg is let down within two seconds of ticks; on a machine that does not come to a thousand
/// ticks a second the program does not outlive its user for that.
constexpr std::int64_t kLongestStop_ns = 3'000'000'000;

std::unique_ptr<hal::SocketCanBus> open(const std::string& interface) {
  hal::SocketCanSettings settings;
  settings.interface = interface;
  settings.batched = true;
  return std::make_unique<hal::SocketCanBus>(settings);
}

/// Of a frame on an interface that carries both buses: replies of the leg's drives are on bus 1,
/// all else, frames of nobody among it, counts as of bus 0.
bool is_on_bus0(const hal::CanFrame& frame) {
  if (frame.extended) return true;
  bool on[2] = {false, false};
  for (const std::size_t bus : {0, 1}) {
    app::for_each_received_id(bus, [&](std::uint32_t id) { on[bus] = on[bus] || id == frame.id; });
  }
  return on[0] || !on[1];
}

bool drives_off(control::Mode mode) {
  return mode == control::Mode::kOff || mode == control::Mode::kEmergencyOff ||
         mode == control::Mode::kFault;
}

}  // namespace

LockStepFoot::LockStepFoot(const Options& options, const app::Parameters& parameters,
                           app::Storage* storage)
    : patience_ns_(static_cast<std::int64_t>(options.patience_s * 1e9)), storage_(storage) {
  // No acceptance filters: frames of nobody are counted as by a foot in the simulator's process.
  socket0_ = open(options.bus0);
  if (options.bus1 != options.bus0) socket1_ = open(options.bus1);
  buses_[0] = std::make_unique<Connection>(*socket0_);
  buses_[1] = std::make_unique<Connection>(socket1_ ? *socket1_ : *socket0_);
  for (const auto& bus : buses_) bus->allow(hal::lock_step::kMostFree, false);
  start_loop(parameters);
}

void LockStepFoot::start_loop(const app::Parameters& parameters) {
  for (const auto& bus : buses_) bus->clear();
  const app::Parameters copy = parameters;  // may be those of the loop that ends here
  loop_.emplace(app::ControlLoop::Buses{buses_[0].get(), buses_[1].get()}, clock_, board_, copy,
                storage_);
}

void LockStepFoot::run(const std::atomic<bool>& interrupted) {
  while (!interrupted) {
    if (clock_.running()) {
      free_step();
      continue;
    }
    listen(kStandingSleep_ns);
    mind_silence();
  }
  if (!clock_.running()) send_now(hal::lock_step::end());
  clock_.run_on();
  loop_->request_stop();
  const std::int64_t give_up_ns = wall_.now_ns() + kLongestStop_ns;
  do {
    free_step();
  } while (!drives_off(loop_->mode()) && wall_.now_ns() < give_up_ns);
  for (const auto& bus : buses_) bus->allow(hal::lock_step::kMostFree, false);
  loop_->release_drives();
  flush();
}

/// Asks for the time only where nothing was heard, as lock-step has thousands of turns a second.
void LockStepFoot::mind_silence() {
  if (heard_) {
    heard_ = false;
    silent_since_ns_.reset();
  } else if (!silent_since_ns_) {
    silent_since_ns_ = wall_.now_ns();
  } else if (wall_.now_ns() - *silent_since_ns_ > patience_ns_) {
    run_on("the simulator is silent");
  }
}

/// Bus 1 first: what tells the simulator to look is on bus 0.
void LockStepFoot::flush() {
  if (socket1_) socket1_->flush();
  socket0_->flush();
}

void LockStepFoot::send_now(const hal::CanFrame& frame) {
  socket0_->send(frame);
  flush();
}

void LockStepFoot::free_step() {
  for (const auto& bus : buses_) bus->allow(hal::lock_step::kMostFree, false);
  listen(kFreeSleep_ns);
  if (!clock_.running()) return;
  loop_->poll();
  flush();
}

void LockStepFoot::listen(std::int64_t longest_ns) {
  if (!socket0_->wait(longest_ns)) {
    drain_bus1();
    return;
  }
  hal::CanFrame frame;
  while (socket0_->receive(frame)) take(frame);
}

void LockStepFoot::drain_bus1() {
  hal::CanFrame frame;
  while (socket1_ && socket1_->receive(frame)) buses_[1]->put(frame);
}

void LockStepFoot::take(const hal::CanFrame& frame) {
  if (!hal::lock_step::is_any(frame)) {
    const bool bus0 = socket1_ != nullptr || is_on_bus0(frame);
    buses_[bus0 ? 0 : 1]->put(frame);
    return;
  }
  heard_ = true;
  if (hal::lock_step::is_begin(frame)) {
    begin();
  } else if (hal::lock_step::is_end(frame)) {
    run_on("");
  } else if (const auto go = hal::lock_step::decode_go(frame); go && !clock_.running()) {
    step(*go);
  }
}

void LockStepFoot::begin() {
  drain_bus1();
  clock_.stand_at(0);
  start_loop(loop_->parameters());
  answer(0);
}

void LockStepFoot::step(const hal::lock_step::Go& go) {
  drain_bus1();
  if (go.time_ns < clock_.now_ns()) return;  // of another life
  clock_.stand_at(go.time_ns);
  for (std::size_t bus = 0; bus < buses_.size(); ++bus) {
    buses_[bus]->allow(go.free[bus], go.bus_off[bus]);
  }
  loop_->poll();
  if (go.answer) answer(go.time_ns);
}

void LockStepFoot::answer(std::int64_t time_ns) {
  send_now(encode(hal::lock_step::done(time_ns, loop_->next_due_ns())));
}

void LockStepFoot::run_on(const char* why) {
  if (clock_.running()) return;
  if (*why != '\0') {
    std::cerr << "hoof-firmware: " << why << "; time goes on by this machine's clock\n";
  }
  clock_.run_on();
}

}  // namespace hoof::firmware::board
