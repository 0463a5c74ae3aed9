#include "tools/emulator/unicorn_stores.h"

#include <dlfcn.h>
#include <unicorn/unicorn.h>

namespace hoof::tools::emulator {
namespace {

thread_local const DataPages* pages_of_thread = nullptr;

template <typename Function>
Function* in_library(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

FastStores::FastStores(const DataPages& pages) : before_(pages_of_thread) {
  pages_of_thread = &pages;
}

FastStores::~FastStores() {
  pages_of_thread = before_;
}

}  // namespace hoof::tools::emulator

#if UC_API_MAJOR == 2 && UC_API_MINOR == 0 && UC_API_PATCH == 1
// Signatures: qemu/include/exec/exec-all.h of that version, for ARM: addresses of the core have 32
// bits, MemTxAttrs is one word.
extern "C" void tlb_set_page_with_attrs_arm(void* cpu, std::uint32_t address, std::uint64_t behind,
                                            std::uint32_t attributes, int rights, int index,
                                            std::uint32_t bytes) {
  using namespace hoof::tools::emulator;
  using Set = void(void*, std::uint32_t, std::uint64_t, std::uint32_t, int, int, std::uint32_t);
  static Set* const set = in_library<Set>("tlb_set_page_with_attrs_arm");
  static auto* const set_dirty = in_library<void(void*, std::uint32_t)>("tlb_set_dirty_arm");
  set(cpu, address, behind, attributes, rights, index, bytes);
  if (pages_of_thread == nullptr || set_dirty == nullptr) return;
  if (pages_of_thread->plain_data(address)) set_dirty(cpu, address);
}
#endif
