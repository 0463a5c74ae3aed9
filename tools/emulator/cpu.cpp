#include "tools/emulator/cpu.h"

#include <unicorn/unicorn.h>

#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <set>
#include <utility>
#include <vector>

#include "tools/emulator/system_control.h"
#include "tools/emulator/unicorn_stores.h"

namespace hoof::tools::emulator {
namespace {

// QEMU's EXCP_PREFETCH_ABORT and EXCP_EXCEPTION_EXIT, as Unicorn tells them
constexpr std::uint32_t kPrefetchAbort = 3, kExceptionExit = 8;

void require(uc_err error, const char* what) {
  if (error == UC_ERR_OK) return;
  throw EmulatorError(std::string("unicorn, ") + what + ": " + uc_strerror(error));
}

}  // namespace

struct Cpu::Machine final : DataPages {
  struct Window {
    Machine& machine;
    RegisterSpace& space;
    std::uint32_t base;
  };

  /// Plain memory. It is read and written where it lies: by way of Unicorn each access would search
  /// the translated code for what it invalidates.
  struct Memory {
    static constexpr std::size_t kPage = 4096;
    struct Free {
      void operator()(std::uint8_t* bytes) const {
        ::operator delete[](bytes, std::align_val_t{kPage});
      }
    };

    std::uint32_t base;
    std::uint32_t size;
    std::unique_ptr<std::uint8_t[], Free> bytes;
    bool writable;
    std::set<std::uint32_t> executable = {};  // of memory that can be written: pages, by address
  };

  struct Flash {
    RegisterSpace& writes;
    std::uint32_t base;
    std::span<std::uint8_t> bytes;
  };

  uc_engine* engine = nullptr;
  std::vector<Memory> memories;
  std::vector<std::unique_ptr<Window>> windows;
  std::vector<Flash> flashes;
  std::exception_ptr error;
  Fault fault;
  bool at_checkpoint = false;
  std::set<std::uint64_t> checkpoints;  // where it stops
  std::uint64_t left_checkpoint = 0;    // where run() began: stopped there before
  std::function<bool()> interrupt_waits;
  bool requested = false;
  bool stuck = false;
  std::uint32_t interrupt = 0;
  std::uint64_t blocks = 0;  // since run() began
  Observer observer;
  uc_hook observing = 0;

  ~Machine() { uc_close(engine); }

  void stop() { uc_emu_stop(engine); }

  /// Null where not all of it is memory.
  std::uint8_t* memory_at(std::uint32_t address, std::size_t size) {
    const auto within = [&](std::uint32_t base, std::size_t bytes) {
      return address >= base && address - base <= bytes && size <= bytes - (address - base);
    };
    for (const Memory& m : memories) {
      if (within(m.base, m.size)) return m.bytes.get() + (address - m.base);
    }
    for (const Flash& f : flashes) {
      if (within(f.base, f.bytes.size())) return f.bytes.data() + (address - f.base);
    }
    return nullptr;
  }

  /// Stores are fast only where no code may be, so memory that can be written becomes executable
  /// page by page, once the core goes there.
  /// @return false where that is not the reason of the fault
  bool make_executable(std::uint32_t address) {
    for (Memory& m : memories) {
      if (address - m.base >= m.size || !m.writable) continue;
      const std::uint32_t page = address & ~std::uint32_t{Memory::kPage - 1};
      if (!m.executable.insert(page).second) return false;
      require(uc_mem_unmap(engine, m.base, m.size), "unmap memory");
      map(m);
      return true;
    }
    return false;
  }

  bool plain_data(std::uint32_t address) const override {
    const std::uint32_t page = address & ~std::uint32_t{Memory::kPage - 1};
    for (const Memory& m : memories) {
      if (address - m.base < m.size) return m.writable && !m.executable.contains(page);
    }
    return false;
  }

  /// In pieces of equal rights.
  void map(const Memory& m) {
    const auto rights_at = [&](std::uint32_t page) {
      return std::uint32_t(m.executable.contains(page) ? UC_PROT_ALL
                                                       : UC_PROT_READ | UC_PROT_WRITE);
    };
    const std::uint32_t end = m.base + m.size;
    for (std::uint32_t from = m.base, to = from; from < end; from = to) {
      const std::uint32_t rights = rights_at(from);
      while (to < end && rights_at(to) == rights) to += Memory::kPage;
      require(uc_mem_map_ptr(engine, from, to - from, rights, m.bytes.get() + (from - m.base)),
              "map memory");
    }
  }

  /// Exceptions must not pass through the emulator's code.
  template <typename Call>
  std::uint32_t guarded(Call&& call) {
    if (error) return 0;
    try {
      return call();
    } catch (...) {
      error = std::current_exception();
      stop();
      return 0;
    }
  }

  static std::uint64_t on_read(uc_engine*, std::uint64_t offset, unsigned bytes, void* data) {
    const Window& w = *static_cast<Window*>(data);
    return w.machine.guarded([&] { return w.space.read(w.base + std::uint32_t(offset), bytes); });
  }
  static void on_write(uc_engine*, std::uint64_t offset, unsigned bytes, std::uint64_t value,
                       void* data) {
    const Window& w = *static_cast<Window*>(data);
    w.machine.guarded([&] {
      w.space.write(w.base + std::uint32_t(offset), bytes, std::uint32_t(value));
      return 0u;
    });
  }
  static void on_interrupt(uc_engine*, std::uint32_t number, void* data) {
    auto* m = static_cast<Machine*>(data);
    m->interrupt = number;
    m->stop();
  }
  /// @return whether the access is dealt with: Unicorn then drops it, as the memory is read-only
  static bool on_invalid(uc_engine*, uc_mem_type type, std::uint64_t at, int bytes,
                         std::int64_t value, void* data) {
    auto* m = static_cast<Machine*>(data);
    const auto address = std::uint32_t(at);
    for (const Flash& flash : m->flashes) {
      if (type != UC_MEM_WRITE_PROT || address - flash.base >= flash.bytes.size()) {
        continue;
      }
      m->guarded([&] {
        flash.writes.write(address, unsigned(bytes), std::uint32_t(value));
        return 0u;
      });
      return true;
    }
    m->fault.address = address;
    return false;
  }
  static void on_checkpoint(uc_engine*, std::uint64_t address, std::uint32_t, void* data) {
    auto* m = static_cast<Machine*>(data);
    const bool just_left = std::exchange(m->left_checkpoint, 0) == address;
    if (just_left || !m->interrupt_waits()) return;
    m->at_checkpoint = true;
    m->stop();
  }
  static void on_block(uc_engine*, std::uint64_t, std::uint32_t, void* data) {
    auto* m = static_cast<Machine*>(data);
    if (++m->blocks < kMostBlocks) return;
    m->stuck = true;
    m->stop();
  }
  static void on_code(uc_engine*, std::uint64_t address, std::uint32_t, void* data) {
    auto* m = static_cast<Machine*>(data);
    m->guarded([&] {
      m->observer(std::uint32_t(address));
      return 0u;
    });
  }

  template <typename Function>
  void hook(int type, Function* function, std::uint64_t begin = 1, std::uint64_t end = 0) {
    uc_hook handle;
    require(uc_hook_add(engine, &handle, type, reinterpret_cast<void*>(function), this, begin, end),
            "hook");
  }
};

Cpu::Cpu(std::function<bool()> interrupt_waits) : machine_(std::make_unique<Machine>()) {
  Machine& m = *machine_;
  m.interrupt_waits = std::move(interrupt_waits);
  require(uc_open(UC_ARCH_ARM, uc_mode(UC_MODE_THUMB | UC_MODE_MCLASS), &m.engine), "open");
  require(uc_ctl_set_cpu_model(m.engine, UC_CPU_ARM_CORTEX_M4), "choose a Cortex-M4");
  // A list of addresses to stop at, which stays empty: with the one that uc_emu_start() is given,
  // each start would search the translated code for it.
  require(uc_ctl_exits_enable(m.engine), "have no address to stop at");
  m.hook(UC_HOOK_INTR, Machine::on_interrupt);
  m.hook(UC_HOOK_MEM_INVALID, Machine::on_invalid);
  m.hook(UC_HOOK_BLOCK, Machine::on_block);
}

Cpu::~Cpu() = default;

void Cpu::map_memory(std::uint32_t base, std::uint32_t bytes, Access access) {
  Machine::Memory memory{base, bytes, {}, access == Access::kAll};
  memory.bytes.reset(new (std::align_val_t{Machine::Memory::kPage}) std::uint8_t[bytes]());
  if (memory.writable) {
    machine_->map(memory);
  } else {
    require(uc_mem_map_ptr(machine_->engine, base, bytes, UC_PROT_READ | UC_PROT_EXEC,
                           memory.bytes.get()),
            "map memory");
  }
  machine_->memories.push_back(std::move(memory));
}

void Cpu::map_registers(std::uint32_t base, std::uint32_t bytes, RegisterSpace& space) {
  Machine& m = *machine_;
  m.windows.push_back(std::make_unique<Machine::Window>(Machine::Window{m, space, base}));
  void* window = m.windows.back().get();
  require(uc_mmio_map(m.engine, base, bytes, Machine::on_read, window, Machine::on_write, window),
          "map registers");
}

void Cpu::map_flash(std::uint32_t base, std::span<std::uint8_t> memory, RegisterSpace& writes) {
  require(uc_mem_map_ptr(machine_->engine, base, memory.size(), UC_PROT_READ | UC_PROT_EXEC,
                         memory.data()),
          "map flash");
  // Of memory of the caller's Unicorn only notes the rights; this makes it drop the stores.
  require(uc_mem_protect(machine_->engine, base, memory.size(), UC_PROT_READ | UC_PROT_EXEC),
          "make flash read-only");
  machine_->flashes.push_back({writes, base, memory});
}

void Cpu::forget_code(std::uint32_t base, std::uint32_t bytes) {
  uc_ctl_remove_cache(machine_->engine, base, base + bytes);
}

/// CPSIE i and f, and MSR of PRIMASK, FAULTMASK, BASEPRI and CONTROL; data that look like one cost
/// a stop and nothing else.
void Cpu::watch_unmasking(std::uint32_t run_address, std::span<const std::uint8_t> code) {
  const auto half = [&](std::size_t i) { return std::uint32_t(code[i] | code[i + 1] << 8); };
  for (std::size_t i = 0; i + 4 <= code.size(); i += 2) {
    const bool cps = (half(i) & 0xFFFC) == 0xB660;
    const bool msr = (half(i) & 0xFFF0) == 0xF380 && (half(i + 2) & 0xFFFC) == 0x8810;
    if (!cps && !msr) continue;
    const std::uint64_t next = run_address + i + (cps ? 2 : 4);
    if (!machine_->checkpoints.insert(next).second) continue;
    machine_->hook(UC_HOOK_CODE, Machine::on_checkpoint, next, next);
  }
}

bool Cpu::write_memory(std::uint32_t address, const void* bytes, std::size_t size) {
  std::uint8_t* to = machine_->memory_at(address, size);
  if (to == nullptr) return false;
  std::memcpy(to, bytes, size);
  if (address < 0x1000'0000) uc_ctl_remove_cache(machine_->engine, address, address + size);
  return true;
}

bool Cpu::read_memory(std::uint32_t address, void* bytes, std::size_t size) {
  const std::uint8_t* from = machine_->memory_at(address, size);
  if (from == nullptr) return false;
  std::memcpy(bytes, from, size);
  return true;
}

namespace {

constexpr int kIds[] = {UC_ARM_REG_R0,   UC_ARM_REG_R1,     UC_ARM_REG_R2, UC_ARM_REG_R3,
                        UC_ARM_REG_R12,  UC_ARM_REG_SP,     UC_ARM_REG_LR, UC_ARM_REG_PC,
                        UC_ARM_REG_XPSR, UC_ARM_REG_CONTROL};
constexpr int kCount = int(std::size(kIds));

/// Calls get or set with pointers to the members in the order of kIds.
template <typename Registers, typename Call>
void with_pointers(Registers& r, Call&& call) {
  void* pointers[] = {&r.r0, &r.r1, &r.r2, &r.r3, &r.r12, &r.sp, &r.lr, &r.pc, &r.xpsr, &r.control};
  call(const_cast<int*>(kIds), pointers);
}

}  // namespace

CoreRegisters Cpu::registers() const {
  CoreRegisters r;
  with_pointers(r, [&](int* ids, void** to) {
    require(uc_reg_read_batch(machine_->engine, ids, to, kCount), "read registers");
  });
  return r;
}

void Cpu::set_registers(const CoreRegisters& registers) {
  CoreRegisters r = registers;
  r.pc |= 1;  // Thumb, or Unicorn leaves it
  // The exception number first: the stack pointer depends on it.
  require(uc_reg_write(machine_->engine, UC_ARM_REG_XPSR, &r.xpsr), "write XPSR");
  require(uc_reg_write(machine_->engine, UC_ARM_REG_CONTROL, &r.control), "write CONTROL");
  with_pointers(r, [&](int* ids, void** from) {
    require(uc_reg_write_batch(machine_->engine, ids, from, kCount - 2), "write registers");
  });
}

void Cpu::read_fp(std::span<std::uint32_t, 17> words) const {
  for (int i = 0; i < 16; ++i) uc_reg_read(machine_->engine, UC_ARM_REG_S0 + i, &words[i]);
  uc_reg_read(machine_->engine, UC_ARM_REG_FPSCR, &words[16]);
}

void Cpu::write_fp(std::span<const std::uint32_t, 17> words) {
  for (int i = 0; i < 16; ++i) uc_reg_write(machine_->engine, UC_ARM_REG_S0 + i, &words[i]);
  uc_reg_write(machine_->engine, UC_ARM_REG_FPSCR, &words[16]);
}

Cpu::MaskRegisters Cpu::masks() const {
  int ids[] = {UC_ARM_REG_PRIMASK, UC_ARM_REG_FAULTMASK, UC_ARM_REG_BASEPRI};
  MaskRegisters m;
  void* to[] = {&m.primask, &m.faultmask, &m.basepri};
  require(uc_reg_read_batch(machine_->engine, ids, to, 3), "read masks");
  return m;
}

void Cpu::set_masks(const MaskRegisters& masks) {
  uc_reg_write(machine_->engine, UC_ARM_REG_PRIMASK, &masks.primask);
  uc_reg_write(machine_->engine, UC_ARM_REG_FAULTMASK, &masks.faultmask);
  uc_reg_write(machine_->engine, UC_ARM_REG_BASEPRI, &masks.basepri);
}

Cpu::Stop Cpu::run() {
  Machine& m = *machine_;
  m.error = nullptr;
  m.at_checkpoint = m.requested = m.stuck = false;
  m.interrupt = 0;
  m.blocks = 0;
  m.fault = {};
  std::uint32_t pc = 0;
  uc_err error = UC_ERR_OK;
  const FastStores fast_stores(m);
  do {
    uc_reg_read(m.engine, UC_ARM_REG_PC, &pc);
    m.left_checkpoint = pc;
    error = uc_emu_start(m.engine, pc | 1, 0xFFFF'FFFF, 0, 0);
  } while (error == UC_ERR_FETCH_PROT && m.make_executable(m.fault.address));
  if (m.error) std::rethrow_exception(m.error);
  if (m.requested) return Stop::kRequested;
  if (m.stuck) return Stop::kStuck;
  if (m.interrupt == kExceptionExit) return Stop::kExceptionReturn;
  if (m.interrupt == kPrefetchAbort) {
    m.fault = {fault_status::kInstructionBus, pc};
    return Stop::kFault;
  }
  if (m.interrupt != 0) {
    throw EmulatorError("no model of QEMU's exception " + std::to_string(m.interrupt));
  }
  switch (error) {
    case UC_ERR_OK:
      return m.at_checkpoint ? Stop::kCheckpoint : Stop::kSleep;
    case UC_ERR_READ_UNMAPPED:
    case UC_ERR_WRITE_UNMAPPED:
    case UC_ERR_WRITE_PROT:
    case UC_ERR_READ_PROT:
      m.fault.status = fault_status::kPreciseData;
      return Stop::kFault;
    case UC_ERR_FETCH_UNMAPPED:
    case UC_ERR_FETCH_PROT:
      m.fault.status = fault_status::kInstructionBus;
      return Stop::kFault;
    case UC_ERR_INSN_INVALID:
    case UC_ERR_EXCEPTION:
      m.fault.status = fault_status::kUndefined;
      return Stop::kFault;
    default:
      throw EmulatorError(std::string("unicorn: ") + uc_strerror(error));
  }
}

const Cpu::Fault& Cpu::fault() const {
  return machine_->fault;
}

void Cpu::request_stop() {
  machine_->requested = true;
  machine_->stop();
}

std::uint64_t Cpu::blocks() const {
  return machine_->blocks;
}

void Cpu::observe(Observer observer) {
  Machine& m = *machine_;
  if (m.observing != 0) uc_hook_del(m.engine, m.observing);
  m.observing = 0;
  m.observer = std::move(observer);
  if (m.observer) {
    require(uc_hook_add(m.engine, &m.observing, UC_HOOK_CODE,
                        reinterpret_cast<void*>(Machine::on_code), &m, 1, 0),
            "hook instructions");
  }
  uc_ctl_remove_cache(m.engine, 0x0800'0000, 0x0810'0000);  // translated without the hook
}

}  // namespace hoof::tools::emulator
