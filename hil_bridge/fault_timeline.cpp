#include "hil_bridge/fault_timeline.h"

#include <cmath>
#include <stdexcept>

#include "firmware/protocol/codec.h"
#include "hil_bridge/fault_targets.h"
#include "hil_bridge/lock_step.h"
#include "hil_bridge/session.h"
#include "sim/config/config_error.h"

namespace hoof::bridge {
namespace {

// Ticks are whole milliseconds; half of one forgives the sums of floating point.
constexpr double kHalfTick_s = 0.5e-3;

// Of the drives (sim/config/drives/goat.toml); what a divider sees while nothing is wrong.
constexpr float kSupply_V = 48.0f;

/// Whether the fault says what the supply falls to: without it the early warning's line alone.
bool measured(const FaultSpec& fault) {
  return fault.kind == FaultKind::kBrownOut && fault.amount != 0;
}

std::unique_ptr<Flood> make_flood(const FaultSpec& fault, const FaultTarget& target) {
  auto flood = std::make_unique<Flood>();
  if (fault.kind == FaultKind::kEstop) {
    flood->bus = target.bus;
    flood->frame = encode(firmware::protocol::EmergencyStop{1, 0});
    flood->period_ns = 10'000'000;  // the dictionary's shortest
    return flood;
  }
  flood->bus = target.bus;
  flood->frame.id = std::uint32_t(fault.id);
  flood->frame.length = hal::CanFrame::kMaxClassicLength;
  if (fault.rate_Hz > 0) flood->period_ns = std::llround(1e9 / fault.rate_Hz);
  return flood;
}

}  // namespace

struct FaultTimeline::Item {
  FaultSpec fault;
  FaultTarget target;
  std::unique_ptr<FrameEffect> frames;
  std::unique_ptr<Flood> flood;
  std::unique_ptr<sim::DriveEffect> drive;
  std::optional<double> began_s;
  std::optional<double> ended_s;
  std::uint64_t ticks = 0;  // with the line pressed or low; restarts

  bool active() const { return began_s && !ended_s; }
  std::uint64_t changed() const {
    return ticks + (frames ? frames->changed() : 0) + (flood ? flood->sent : 0) +
           (drive ? drive->changed() : 0);
  }
};

FaultTimeline::FaultTimeline(const std::vector<FaultSpec>& faults, const Drives& drives)
    : drives_(drives) {
  for (const FaultSpec& fault : faults) add(fault);
}

FaultTimeline::~FaultTimeline() = default;

void FaultTimeline::add(const FaultSpec& fault) {
  auto item = std::make_unique<Item>();
  item->fault = fault;
  item->target = find_target(fault, drives_);
  if (item->target.frames) {
    item->frames = std::make_unique<FrameEffect>(
        FrameEffectSettings{*item->target.effect, *item->target.frames, fault.probability,
                            std::llround(fault.delay_s * 1e9), fault.count, fault.seed});
  }
  if (item->target.floods) item->flood = make_flood(fault, item->target);
  if (item->target.drive_effect) {
    item->drive =
        std::make_unique<sim::DriveEffect>(*item->target.drive_effect, fault.amount, fault.seed);
  }
  items_.push_back(std::move(item));
  connect(*items_.back());
}

/// To what there is already.
void FaultTimeline::connect(Item& item) {
  if (wires_ && item.frames) wires_->add(*item.frames);
  if (wires_ && item.flood) wires_->add(*item.flood);
  if (experiment_ && item.drive) {
    experiment_->plant().drive(*item.target.joint)->add_effect(*item.drive);
  }
}

Wires& FaultTimeline::wires(Wires& inner) {
  wires_ = std::make_unique<FaultyWires>(inner);
  for (const auto& item : items_) connect(*item);
  return *wires_;
}

void FaultTimeline::bind(LockStep& lock_step, sim::Experiment& experiment) {
  lock_step_ = &lock_step;
  experiment_ = &experiment;
  for (const auto& item : items_) {
    if (item->drive) experiment.plant().drive(*item->target.joint)->add_effect(*item->drive);
  }
  for (const auto& item : items_) {
    require_reach(*item);
    // A board whose supply is to be measured has a divider, and measures it from the start.
    if (measured(item->fault)) board().volts = kSupply_V;
  }
  begin_due(0, nullptr);
}

void FaultTimeline::require_reach(const Item& item) const {
  if (!needs_board(item.fault) || lock_step_->firmware().board() != nullptr) return;
  refuse_without_board(item.fault);
}

void FaultTimeline::update(const TickRecord& record) {
  const double now_s = double(lock_step_->now_ns()) * 1e-9;
  for (const auto& item : items_) {
    if (!item->active()) continue;
    const FaultKind kind = item->fault.kind;
    if (kind == FaultKind::kBrownOut || (kind == FaultKind::kEstop && !item->flood)) ++item->ticks;
    const auto& for_s = item->fault.for_s;
    if (for_s && now_s >= *item->began_s + *for_s - kHalfTick_s) end(*item, now_s);
  }
  begin_due(now_s, &record);
}

void FaultTimeline::begin_due(double now_s, const TickRecord* record) {
  for (const auto& item : items_) {
    if (item->began_s) continue;
    const auto& when = item->fault.when;
    const bool due =
        when ? record != nullptr && when->holds(*record) : now_s >= item->fault.at_s - kHalfTick_s;
    if (due) begin(*item, now_s);
  }
}

/// There, as require_reach() has seen to.
hal::SoftBoard& FaultTimeline::board() const {
  return *lock_step_->firmware().board();
}

void FaultTimeline::begin(Item& item, double now_s) {
  item.began_s = now_s;
  if (item.frames) item.frames->start();
  if (item.drive) item.drive->start();
  if (item.flood) item.flood->active = true;
  if (item.fault.kind == FaultKind::kNodeRestart) restart(item);
  if (item.fault.kind == FaultKind::kBrownOut) {
    if (measured(item.fault)) board().volts = float(item.fault.amount);
    board().low = !measured(item.fault);
  }
  if (item.fault.kind == FaultKind::kEstop && !item.flood) board().pressed = true;
}

void FaultTimeline::end(Item& item, double now_s) {
  item.ended_s = now_s;
  if (item.frames) item.frames->stop();
  if (item.drive) item.drive->stop();
  if (item.flood) item.flood->active = false;
  if (item.fault.kind == FaultKind::kNodeRestart && item.target.joint) restart(item);
  if (item.fault.kind == FaultKind::kBrownOut) {
    board().low = false;
    if (measured(item.fault)) board().volts = kSupply_V;
  }
  if (item.fault.kind == FaultKind::kEstop && !item.flood) board().pressed = false;
}

/// A drive counts from where it wakes up, so once more at the end. The firmware is new from the
/// start on and hears nothing until the end: that is its time to start up.
void FaultTimeline::restart(Item& item) {
  ++item.ticks;
  if (item.target.joint) {
    experiment_->plant().drive(*item.target.joint)->restart();
  } else {
    lock_step_->firmware().restart(item.fault.cause);
  }
}

bool FaultTimeline::any_active() const {
  for (const auto& item : items_) {
    if (item->active()) return true;
  }
  return false;
}

bool FaultTimeline::all_over() const {
  for (const auto& item : items_) {
    if (!item->ended_s) return false;
  }
  return true;
}

std::optional<double> FaultTimeline::first_s() const {
  std::optional<double> first;
  for (const auto& item : items_) {
    if (item->began_s && (!first || *item->began_s < *first)) first = item->began_s;
  }
  return first;
}

std::vector<FaultOutcome> FaultTimeline::outcomes() const {
  std::vector<FaultOutcome> outcomes;
  for (const auto& item : items_) {
    outcomes.push_back({item->fault.name(), kFaultKindNames[std::size_t(item->fault.kind)],
                        item->fault.target, item->began_s, item->ended_s, item->changed()});
  }
  return outcomes;
}

void FaultTimeline::require_changes() const {
  std::string idle;
  for (const auto& item : items_) {
    if (item->changed() > 0) continue;
    std::string why = " changed nothing";
    if (!item->began_s) {
      why = item->fault.when ? " never began: " + item->fault.when->text() + " never held"
                             : " never began: the run ended before";
    }
    idle +=
        (idle.empty() ? "" : "; ") + item->fault.origin.text() + ": " + item->fault.name() + why;
  }
  if (!idle.empty()) throw std::runtime_error(idle);
}

}  // namespace hoof::bridge
