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

/// Faults, mode and one more byte share a word.
constexpr Word pack(control::FaultBits faults, control::Mode mode, std::uint8_t last) {
  return static_cast<Word>(faults) << 16 | static_cast<Word>(mode) << 8 | last;
}
constexpr control::FaultBits packed_faults(Word word) {
  return static_cast<control::FaultBits>(word >> 16);
}
constexpr control::Mode packed_mode(Word word) {
  return static_cast<control::Mode>(word >> 8 & 0xFF);
}
constexpr std::uint8_t packed_last(Word word) {
  return static_cast<std::uint8_t>(word);
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
  out.put(pack(record.faults, record.mode, static_cast<std::uint8_t>(record.trace_count)));
  for (const TraceSample& sample : record.trace) {
    out.put(sample.tick);
    out.put(pack(sample.faults, sample.mode, sample.active_limits));
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
  const Word bits = in.take();
  record.faults = packed_faults(bits);
  record.mode = packed_mode(bits);
  record.trace_count = packed_last(bits);
  if (record.trace_count > TraceRing::kTicks) return std::nullopt;
  for (TraceSample& sample : record.trace) {
    sample.tick = in.take();
    const Word sample_bits = in.take();
    sample.faults = packed_faults(sample_bits);
    sample.mode = packed_mode(sample_bits);
    sample.active_limits = packed_last(sample_bits);
    in.take(sample.position_rad);
    in.take(sample.velocity_rad_s);
    in.take(sample.torque_Nm);
  }
  return record;
}

}  // namespace hoof::firmware::app
