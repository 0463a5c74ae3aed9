#include "tests/tools/emulator/tick_cost.h"

#include <stdexcept>

#include "tests/firmware/cost/cycle_rule.h"

namespace hoof::test {
namespace {

using tests::cost::kCycleRule;

constexpr std::uint32_t kFlash = 0x0800'0000, kFlashBytes = 1u << 20;
constexpr std::uint32_t kExceptionCycles = 12;
constexpr std::uint32_t kVectors = 98;  // 16 of the core, 82 of the STM32F405

bool contains(const std::string& name, const char* part) {
  return name.find(part) != std::string::npos;
}

/// By the mangled name: "N4hoof8firmware7control...". A template of one part on types of another
/// counts where it is defined, which comes first in the name.
std::size_t part_of(const std::string& name) {
  constexpr std::array<const char*, kParts - 2> kMarks = {"8firmware3app", "8firmware7control",
                                                          "8firmware10trajectory",
                                                          "8firmware6safety", "8firmware8protocol"};
  std::size_t best = std::string::npos, part = kParts - 1;
  for (std::size_t i = 0; i < kMarks.size(); ++i) {
    if (const std::size_t at = name.find(kMarks[i]); at < best) {
      best = at;
      part = i;
    }
  }
  if (best != std::string::npos) return part;
  return contains(name, "4hoof") ? kParts - 2 : kParts - 1;
}

struct StageFunction {
  const char* mark;  // in the mangled name
  Stage stage;
};
/// None of them is merged into its caller: they are called from other files, or from several
/// places. (A test sees to it that each stage is found.)
constexpr StageFunction kStageFunctions[] = {
    {"3app5Inbox5drainE", Stage::kReceive},
    {"7control14FootController4stepE", Stage::kControl},
    {"9GeneratorIfLi1EE4workEv", Stage::kPlan},
    {"9GeneratorIfLi2EE4workEv", Stage::kPlan},
    {"6safety10TorqueGate7inspectE", Stage::kGate},
    {"6safety10TorqueGate5checkE", Stage::kGate},
    {"3app11ControlLoop5writeE", Stage::kSend},
    {"3app11ControlLoop6recordE", Stage::kTelemetry},
    {"3app11ControlLoop5traceE", Stage::kTelemetry},
    {"3app15telemetry_frameE", Stage::kTelemetry},
    {"3app11ControlLoop21send_heartbeat_if_dueE", Stage::kTelemetry},
    {"3app11ControlLoop4tickE", Stage::kTick},
};

/// LDR and VLDR of a literal (Armv7-M, A7.7.44, A7.7.236).
std::optional<std::uint32_t> literal_address(std::uint32_t address, std::uint16_t first,
                                             std::uint16_t second) {
  const std::uint32_t base = (address + 4) & ~3u;
  if ((first & 0xF800) == 0x4800) return base + 4u * (first & 0xFFu);
  if ((first & 0xFF7F) == 0xF85F) {
    const std::uint32_t offset = second & 0xFFFu;
    return (first & 0x80) != 0 ? base + offset : base - offset;
  }
  if ((first & 0xFF3F) == 0xED1F && (second & 0x0E00) == 0x0A00) {
    const std::uint32_t offset = 4u * (second & 0xFFu);
    return (first & 0x80) != 0 ? base + offset : base - offset;
  }
  return {};
}

}  // namespace

TickCostCounter::TickCostCounter(tools::emulator::Board& board)
    : board_(board), places_(kFlashBytes / 2) {
  std::vector<std::uint32_t> vectors(kVectors);
  board_.cpu().read_memory(board.image().address_of("hoof_vectors").value(), vectors.data(),
                           4 * vectors.size());
  for (std::size_t i = 1; i < vectors.size(); ++i) handlers_.push_back(vectors[i] & ~1u);
  board_.cpu().observe([this](std::uint32_t address) { execute(address); });
}

TickCostCounter::Place TickCostCounter::examine(std::uint32_t address) {
  std::uint16_t words[2];
  board_.cpu().read_memory(address, words, sizeof words);
  Place place;
  place.timing = tests::cost::timing_of(words[0], words[1]);
  place.literal = literal_address(address, words[0], words[1]);
  place.part = kParts - 1;
  for (const std::uint32_t handler : handlers_) place.handler = place.handler || handler == address;
  const auto* function = board_.image().function_at(address);
  if (function == nullptr) return place;
  place.part = std::uint8_t(part_of(function->name));
  const bool entry = (function->address & ~1u) == address;
  for (const StageFunction& each : kStageFunctions) {
    if (entry && contains(function->name, each.mark)) place.stage = each.stage;
  }
  place.tick_begins = entry && contains(function->name, "11ControlLoop4tickE");
  place.plans = place.stage == Stage::kPlan;
  return place;
}

const TickCostCounter::Place& TickCostCounter::place_at(std::uint32_t address) {
  if (address < kFlash || address >= kFlash + kFlashBytes) {
    throw std::runtime_error("the image executes outside the flash, at " + std::to_string(address));
  }
  std::optional<Place>& place = places_[(address - kFlash) / 2];
  if (!place) place = examine(address);
  return *place;
}

void TickCostCounter::follow(std::uint32_t address, const Place& place, bool jumped) {
  // One that ended with a jump into another function ends where that one returns to the same place.
  while (!open_.empty() && address == open_.back().back &&
         board_.cpu().registers().sp >= open_.back().stack) {
    open_.pop_back();
  }
  if (place.handler && jumped) {
    // One handler after another without a return between: the same interruption.
    if (open_.empty() || open_.back().stage != Stage::kInterrupt) {
      open_.push_back({Stage::kInterrupt, expected_, board_.cpu().registers().sp + 1});
    }
  } else if (place.stage) {
    const auto now = board_.cpu().registers();
    open_.push_back({*place.stage, now.lr & ~1u, now.sp});
  }
}

void TickCostCounter::execute(std::uint32_t address) {
  const Place& place = place_at(address);
  if (!place.timing.known) {
    throw std::runtime_error("an instruction of unknown cost at " + board_.image().place(address));
  }
  if (place.tick_begins) {
    if (begun_) ticks_.push_back(now_);
    begun_ = true;
    now_ = {};
  }
  now_.plans = now_.plans || place.plans;
  const bool jumped = address != expected_;
  follow(address, place, jumped);
  std::uint32_t cycles = place.timing.cycles + (jumped ? kCycleRule.refill : 0);
  if (place.handler && jumped) cycles += 2 * kExceptionCycles;
  if ((place.timing.fp_reads & late_registers_) != 0) cycles += kCycleRule.fp_result_used_next;
  cycles += flash_.fetch(address);
  if (place.literal) cycles += flash_.load(*place.literal);
  flash_.spend(cycles);
  now_.cycles += cycles;
  ++now_.instructions;
  ++now_.part_instructions[place.part];
  const Stage stage = open_.empty() ? Stage::kPoll : open_.back().stage;
  ++now_.stage_instructions[std::size_t(stage)];
  expected_ = address + place.timing.bytes;
  late_registers_ = place.timing.fp_late_writes;
}

}  // namespace hoof::test
