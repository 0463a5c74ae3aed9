# Compiler and flags of the board's image, the one place for them. Debian: gcc-arm-none-eabi,
# libstdc++-arm-none-eabi-newlib.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR cortex-m4)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)

get_filename_component(hoof_root ${CMAKE_CURRENT_LIST_DIR}/../../.. REALPATH)
string(JOIN " " CMAKE_CXX_FLAGS_INIT
  -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
  -ffreestanding -fno-exceptions -fno-rtti -fno-threadsafe-statics
  -ffunction-sections -fdata-sections
  # The image as one: a fifth fewer cycles a tick.
  -flto -fno-fat-lto-objects -flto-partition=one
  # No double by mistake: what the compiler sees here, and the image's symbols are looked through.
  -Wdouble-promotion -Werror=double-promotion
  # Each function's stack, for the bound over the whole image. (A function whose address stands in
  # code, as a guess at what a virtual call will mean, could be called from anywhere.)
  -fcallgraph-info=su -fno-devirtualize-speculatively
  # Lines for a crash record's addresses (addr2line); the same bytes wherever source and build lie.
  -g1 \"-ffile-prefix-map=${hoof_root}=.\" \"-ffile-prefix-map=${CMAKE_BINARY_DIR}=build\")

string(JOIN " " CMAKE_EXE_LINKER_FLAGS_INIT
  -nostdlib -nostartfiles -static -Wl,--gc-sections -Wl,--fatal-warnings -Wl,--build-id=none)
set(CMAKE_CXX_STANDARD_LIBRARIES "-lc -lgcc")
