"""tools/firmware/report.py over small images, each with one thing wrong. Usage: report_test.py ROOT"""

import os
import subprocess
import sys
import tempfile
import unittest

ROOT = os.path.abspath(sys.argv.pop(1))
FLAGS = ("-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -O2 -ffreestanding "
         "-fno-exceptions -fno-rtti -fcallgraph-info=su -nostdlib -nostartfiles "
         "-Wl,-Ttext=0x08010000 -Wl,-Tdata=0x20001000 -Wl,--section-start=.ram=0x20000000 "
         "-Wl,-e,hoof_reset").split()

# What every image has. `deep` uses that many bytes of stack.
FRAME = """
extern "C" void hoof_start();
extern "C" [[gnu::naked]] void hoof_reset() { asm("b hoof_start"); }
extern "C" void hoof_fault() {}
extern "C" void hoof_record_fault() {}
extern "C" void hoof_tick();
volatile int sink;
template <int bytes> [[gnu::noinline]] void deep() {
  volatile char room[bytes];
  room[sink] = 1;
  sink = room[0];
}
#ifndef OWN_TICK
extern "C" void hoof_tick() {}
#endif
using Handler = void (*)();
extern const Handler kVectorTable[];
[[gnu::used]] const Handler kVectorTable[] = {nullptr, hoof_reset, hoof_fault, hoof_tick};
"""


class ReportTest(unittest.TestCase):
    def report(self, source, *arguments):
        """Compiles and links the source with the frame; @return exit status and all output"""
        with tempfile.TemporaryDirectory() as folder:
            path = f"{folder}/image.cpp"
            with open(path, "w", encoding="utf-8") as file:
                file.write(source.replace("@frame", FRAME))
            subprocess.run(["arm-none-eabi-g++", *FLAGS, path, "-o", "image.elf", "-lgcc"],
                           check=True, cwd=folder)
            done = subprocess.run(
                [sys.executable, f"{ROOT}/tools/firmware/report.py", f"{folder}/image.elf",
                 "--build", folder, *arguments], capture_output=True, text=True, check=False)
            return done.returncode, done.stdout + done.stderr

    def refused(self, source, *expected):
        status, output = self.report(source)
        self.assertEqual(status, 1, output)
        for text in expected:
            self.assertIn(text, output)

    def test_a_good_image_passes(self):
        status, output = self.report("@frame\nvoid hoof_start() { deep<1000>(); }")
        self.assertEqual(status, 0, output)
        # 1000 bytes of room, two frames of exceptions, and what the compiler adds to them.
        total = int(output.split("total")[-1].split()[0].replace(",", ""))
        self.assertGreaterEqual(total, 1000 + 2 * 108)
        self.assertLess(total, 1000 + 2 * 108 + 64)

    def test_bounds_are_met_exactly_or_missed_by_one(self):
        source = "@frame\nvoid hoof_start() { deep<1000>(); }"
        _, output = self.report(source)
        total = output.split("total")[-1].split()[0].replace(",", "")
        self.assertEqual(self.report(source, "--stack", total)[0], 0)
        self.assertEqual(self.report(source, "--stack", str(int(total) - 1))[0], 1)

    def test_flash(self):
        self.refused("@frame\n[[gnu::used]] const char big[130 * 1024] = {1};\n"
                     "void hoof_start() {}", "flash: ", "bound 131,072")

    def test_data_counts_in_flash_and_in_ram(self):
        self.refused("@frame\n[[gnu::used]] char big[131 * 1024] = {1};\nvoid hoof_start() {}",
                     "flash: ", "RAM: ")

    def test_ram(self):
        self.refused("@frame\n[[gnu::used]] char big[65 * 1024];\nvoid hoof_start() {}",
                     "RAM: ", "bound 65,536")

    def test_code_in_ram_counts_as_ram(self):
        source = """@frame
            [[gnu::section(".ram"), gnu::noinline, gnu::long_call]] void in_ram() { sink = 9; }
            void hoof_start() { in_ram(); }"""
        _, output = self.report(source)
        total = output.split("RAM")[1].split("total")[1].split()[0]
        self.assertIn("  .ram ", output.split("RAM")[1])
        self.assertEqual(self.report(source, "--ram", total)[0], 0)
        self.assertEqual(self.report(source, "--ram", str(int(total) - 1))[0], 1)

    def test_stack_by_direct_calls(self):
        self.refused("@frame\nvoid hoof_start() { deep<4000>(); }", "stack: ", "bound 4,096")

    def test_stack_by_a_virtual_call(self):
        self.refused("""@frame
            struct Base { virtual void idle() {} virtual void work() = 0; };
            struct Deep : Base { void work() override { deep<5000>(); } };
            extern "C" void __cxa_pure_virtual() {}
            Deep object;
            Base* volatile chosen = &object;
            void hoof_start() { chosen->work(); }""", "stack: ", "bound 4,096")

    def test_a_virtual_call_reaches_its_own_place_of_the_tables_only(self):
        status, output = self.report("""@frame
            struct Base { virtual void idle() { sink = 1; } virtual void work() { deep<5000>(); } };
            Base object;
            Base* volatile chosen = &object;
            void hoof_start() { chosen->idle(); }""")
        self.assertEqual(status, 0, output)

    def test_stack_by_a_pointer_to_a_function(self):
        self.refused("@frame\nHandler volatile chosen = deep<5000>;\n"
                     "void hoof_start() { Handler call = chosen; call(); }", "stack: ")

    def test_stack_by_an_interrupt(self):
        self.refused("#define OWN_TICK\n@frame\nextern \"C\" void hoof_tick() { deep<2000>(); }\n"
                     "void hoof_start() { deep<2000>(); }", "stack: ", "bound 4,096")

    def test_stack_by_a_jump_in_place_of_the_last_call(self):
        self.refused("@frame\n[[gnu::noinline]] void jump() { sink = 2; deep<5000>(); }\n"
                     "void hoof_start() { jump(); }", "stack: ", "bound 4,096")

    def test_stack_of_the_fault_handler(self):
        source = FRAME.replace("hoof_record_fault() {}", "hoof_record_fault();")
        self.refused(source + "void hoof_start() {}\n"
                     "extern \"C\" void hoof_record_fault() { deep<600>(); }\n"
                     "[[gnu::used]] Handler keep = hoof_record_fault;",
                     "stack of the fault handler", "bound 512")

    def test_recursion(self):
        self.refused("""@frame
            void odd(int n);
            [[gnu::noinline]] void even(int n) { if (n > 0) odd(n - 1); sink = n; }
            [[gnu::noinline]] void odd(int n) { if (n > 0) even(n - 1); sink = n + 1; }
            void hoof_start() { even(sink); }""", "recursion: ")

    def test_a_switch_calls_nobody(self):
        cases = "".join(f"case {i}: deep<{8 * i + 8}>(); sink = sink * {i} + 3; break;\n"
                        for i in range(9)).replace("\n", "\nmore();\n")
        status, output = self.report(f"""@frame
            Handler volatile chosen = deep<5000>;
            [[gnu::noinline]] void more() {{ sink = sink + 1; }}
            void hoof_start() {{ switch (sink) {{ {cases} }} }}""")
        self.assertEqual(status, 0, output)
        self.assertIn("  0 calls through pointers", output)

    def test_a_frame_of_unknown_size(self):
        self.refused("""@frame
            [[gnu::noinline]] void any(int n) {
              volatile char* room = static_cast<char*>(__builtin_alloca(n));
              sink = room[n - 1];
            }
            void hoof_start() { any(sink); }""", "a frame without bound: any(int)")

    def test_code_in_ram_that_calls_flash(self):
        self.refused("""@frame
            [[gnu::noinline]] void in_flash() { sink = 3; }
            [[gnu::section(".ram"), gnu::noinline, gnu::long_call]] void in_ram() {
              void (*call)() = in_flash;
              call();
              sink = 4;
            }
            void hoof_start() { in_ram(); }""", "runs from RAM and calls in_flash() in flash")

    def test_software_doubles(self):
        self.refused("@frame\nvolatile double d;\nvoid hoof_start() { d = d * 2.5; }",
                     "software doubles in the image: ", "__aeabi_dmul")
        self.refused("@frame\nvolatile float f;\nvolatile int i;\n"
                     "void hoof_start() { i = static_cast<double>(f) > 0.1; }",
                     "software doubles in the image: ", "__aeabi_f2d")

    def test_heap_exceptions_libm_and_output(self):
        for name, what in {"malloc": "heap", "_Znwj": "heap", "_sbrk": "heap",
                           "__cxa_throw": "exceptions", "__gxx_personality_v0": "exceptions",
                           "_ZTI4Base": "run-time types", "sinf": "libm", "pow": "libm",
                           "__ieee754_rem_pio2f": "libm", "sqrtf": "libm",
                           "printf": "text output", "_svfprintf_r": "text output"}.items():
            with self.subTest(name):
                self.refused(f'@frame\nextern "C" [[gnu::noinline]] void {name}() {{ sink = 5; }}\n'
                             f"void hoof_start() {{ {name}(); sink = 6; }}",
                             f"{what} in the image: {name}")

    def test_names_that_only_look_forbidden_pass(self):
        status, output = self.report(
            '@frame\nextern "C" void define() { sink = 7; }\nextern "C" void __aeabi_fadd2() {}\n'
            "namespace deep_sin { [[gnu::noinline]] void f() { sink = 8; } }\n"
            "void hoof_start() { define(); deep_sin::f(); }")
        self.assertEqual(status, 0, output)

    def test_wrong_input(self):
        for path in ("/dev/null", f"{ROOT}/no-such.elf"):
            done = subprocess.run([sys.executable, f"{ROOT}/tools/firmware/report.py", path,
                                   "--build", "."], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(path, done.stderr)
            self.assertNotIn("Traceback", done.stderr)


if __name__ == "__main__":
    unittest.main()
