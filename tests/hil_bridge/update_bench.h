// A foot with two slots of small images and a boot loader, on a simulated bus, with a supply that
// can fail: what runs is always the control loop of this build, whichever image it stands for.
#pragma once

#include <memory>
#include <optional>

#include "firmware/app/control_loop.h"
#include "firmware/protocol/codec.h"
#include "firmware/update/boot_choice.h"
#include "hal/in_process/in_process_bus.h"
#include "hal/in_process/ram_flash.h"
#include "hal/in_process/soft_board.h"
#include "hal/stepped_clock.h"
#include "hil_bridge/update_client.h"
#include "tests/firmware/update/signed_image.h"

namespace hoof::test {

inline constexpr std::size_t kBenchImageWords = 24;
inline constexpr std::size_t kBenchSlotWords =
    firmware::update::kHeaderWords + 64 + firmware::update::kMarkWords;

inline bridge::UpdateImage update_image(const ImageSpec& spec, const SigningKey& key) {
  const std::vector<Word> words = make_image(spec, key);
  bridge::UpdateImage image;
  std::copy_n(words.begin(), image.header.word.size(), image.header.word.begin());
  image.words.assign(words.begin() + firmware::update::kHeaderWords, words.end());
  return image;
}

/// The flash of a foot that runs version 7 in slot A.
struct Part {
  hal::RamFlash flash{{kBenchSlotWords, kBenchSlotWords}};
  SigningKey key;

  Part() {
    write_image(flash, 0, make_image({.version = 7, .words = kBenchImageWords}, key));
    firmware::update::ImageSlot(flash, 0).confirm();
  }
  firmware::update::ImageSlot slot(std::size_t number) { return {flash, number}; }
  std::optional<std::size_t> boot() {
    return firmware::update::BootChoice(flash, key.open, firmware::update::kFootBoard, [] {})
        .choose();
  }
};

class UpdateBench final : public hal::ImageSlots {
 public:
  explicit UpdateBench(Part& part) : part_(part) { power_on(); }

  bridge::ServiceClient client{desk_, clock_, [this] { step(); }, 2, 3'000'000'000};
  bridge::UpdateClient updates{
      client, {.word_period_ns = 0, .start_ns = 3'000'000'000, .healthy_ns = 6'000'000'000}};

  bool powered() const { return loop_ != nullptr; }
  std::size_t running() const override { return running_; }
  int starts() const { return starts_; }
  /// The new image: it is sick where this is set.
  void make_new_image_sick() { sick_ = true; }
  void crash_in_trial() { crashes_ = true; }
  /// Called for each frame between desk and foot; false loses it. May change it.
  std::function<bool(hal::CanFrame&)> meddle;

  void run_ms(int ms) {
    for (int i = 0; i < 2 * ms; ++i) step();
  }
  void power_on() {
    const auto chosen = part_.boot();
    loop_.reset();
    if (!chosen) return;
    running_ = *chosen;
    ++starts_;
    board_.cause = hal::ResetCause::kRequested;
    loop_ = std::make_unique<firmware::app::ControlLoop>(
        firmware::app::ControlLoop::Buses{&foot0_, &foot1_}, clock_, board_,
        firmware::app::Parameters{}, nullptr, this);
  }
  firmware::app::ControlLoop& loop() { return *loop_; }
  void step() {
    clock_.advance_to(clock_.now_ns() + 500'000);
    if (++steps_ % 2 == 0 && sync) master_.send(encode(firmware::protocol::Sync{++tick_}));
    bus0_.advance_to(clock_.now_ns());
    bus1_.advance_to(clock_.now_ns());
    if (!loop_) return;
    const bool in_trial = part_.slot(running_).attempts() > 0 && !part_.slot(running_).confirmed();
    board_.pressed = sick_ && in_trial;  // a fault that stays
    try {
      if (crashes_ && in_trial) restart_ = true;
      loop_->poll();
      if (std::exchange(restart_, false)) power_on();
    } catch (const hal::PowerCut&) {
      loop_.reset();
    }
  }

  bool sync = true;

 private:
  hal::Nonvolatile& flash() override { return part_.flash; }
  void restart() override { restart_ = true; }

  Part& part_;
  hal::SteppedClock clock_;
  hal::InProcessBus bus0_{{.name = "can0", .bit_rates = {}}};
  hal::InProcessBus bus1_{{.name = "can1", .bit_rates = {}}};

  /// The desk's connection, with someone in the wire.
  class MeddledBus final : public hal::CanBus {
   public:
    MeddledBus(hal::CanBus& inner, UpdateBench& bench) : inner_(inner), bench_(bench) {}
    hal::SendResult send(const hal::CanFrame& frame) override {
      hal::CanFrame copy = frame;
      if (bench_.meddle && !bench_.meddle(copy)) return hal::SendResult::kQueued;
      if (bench_.repeat_each) inner_.send(copy);
      return inner_.send(copy);
    }
    bool receive(hal::CanFrame& frame) override {
      while (inner_.receive(frame)) {
        if (!bench_.meddle || bench_.meddle(frame)) return true;
      }
      return false;
    }
    void withdraw(std::uint32_t id) override { inner_.withdraw(id); }
    hal::BusStatus status() const override { return inner_.status(); }

   private:
    hal::CanBus& inner_;
    UpdateBench& bench_;
  };

 public:
  bool repeat_each = false;

 private:
  MeddledBus desk_{bus0_.attach("desk"), *this};
  hal::CanBus& master_ = bus0_.attach("sync");
  hal::CanBus& foot0_ = bus0_.attach("foot");
  hal::CanBus& foot1_ = bus1_.attach("foot");
  hal::SoftBoard board_;
  std::unique_ptr<firmware::app::ControlLoop> loop_;
  std::size_t running_ = 0;
  int starts_ = 0;
  bool restart_ = false, sick_ = false, crashes_ = false;
  std::uint32_t steps_ = 0, tick_ = 0;
};

}  // namespace hoof::test
