#include "firmware/app/fault_record.h"

#include <bit>

#include "firmware/app/crc32.h"

namespace hoof::firmware::app {
namespace {

using Word = hal::Nonvolatile::Word;

constexpr Word kMagic = 0x4846'4C54;  // "HFLT"

std::uint32_t crc(const FaultRecordWords& words) {
  return Crc32().add(std::span<const Word>(words).first(kFaultRecordWords - 1)).value();
}

/// Twenty fault bits and twelve limit bits share a word.
constexpr unsigned kLimitBits = 12;
constexpr Word kLimitMask = (1u << kLimitBits) - 1u;

constexpr Word pack(control::FaultBits faults, safety::LimitBits limits) {
  return faults << kLimitBits | (limits & kLimitMask);
}

class Writer {
 public:
  explicit Writer(FaultRecordWords& words) : words_(words) {}
  void put(Word word) { words_[next_++] = word; }
  void put(const control::PerJoint<float>& values) {
    for (const float value : values) put(std::bit_cast<Word>(value));
  }

 private:
  FaultRecordWords& words_;
  std::size_t next_ = 0;
};

class Reader {
 public:
  explicit Reader(const FaultRecordWords& words) : words_(words) {}
  Word take() { return words_[next_++]; }
  void take(control::PerJoint<float>& values) {
    for (float& value : values) value = std::bit_cast<float>(take());
  }

 private:
  const FaultRecordWords& words_;
  std::size_t next_ = 0;
};

}  // namespace

void encode(const FaultRecord& record, FaultRecordWords& words) {
  Writer out(words);
  out.put(kMagic);
  const auto time_ns = static_cast<std::uint64_t>(record.time_ns);
  out.put(static_cast<Word>(time_ns));
  out.put(static_cast<Word>(time_ns >> 32));
  out.put(record.tick);
  out.put(record.faults);
  out.put(static_cast<Word>(record.mode) << 8 | static_cast<Word>(record.trace_count));
  for (const TraceSample& sample : record.trace) {
    out.put(sample.tick);
    out.put(pack(sample.faults, sample.active_limits));
    out.put(static_cast<Word>(sample.mode));
    out.put(sample.position_rad);
    out.put(sample.velocity_rad_s);
    out.put(sample.torque_Nm);
  }
  out.put(crc(words));
}

std::optional<FaultRecord> decode(const FaultRecordWords& words) {
  if (words.front() != kMagic || words.back() != crc(words)) return std::nullopt;
  FaultRecord record;
  Reader in(words);
  in.take();  // the magic
  const std::uint64_t low = in.take();
  record.time_ns = static_cast<std::int64_t>(low | static_cast<std::uint64_t>(in.take()) << 32);
  record.tick = in.take();
  record.faults = in.take();
  const Word bits = in.take();
  record.mode = static_cast<control::Mode>(bits >> 8);
  record.trace_count = bits & 0xFF;
  if (record.trace_count > TraceRing::kTicks) return std::nullopt;
  for (TraceSample& sample : record.trace) {
    sample.tick = in.take();
    const Word sample_bits = in.take();
    sample.faults = sample_bits >> kLimitBits;
    sample.active_limits = static_cast<safety::LimitBits>(sample_bits & kLimitMask);
    sample.mode = static_cast<control::Mode>(in.take());
    in.take(sample.position_rad);
    in.take(sample.velocity_rad_s);
    in.take(sample.torque_Nm);
  }
  return record;
}

}  // namespace hoof::firmware::app
