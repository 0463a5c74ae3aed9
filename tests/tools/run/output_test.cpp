#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/column_unit.h"
#include "tools/run/csv_writer.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"
#include "tools/run/result_json.h"
#include "tools/run/sha256.h"

using namespace hoof::tools;
using hoof::tests::ScratchFolder;

TEST_CASE("a full disk is an error that names the path and the reason") {
  // /dev/full takes the open and refuses the bytes, as a full disk does.
  OutputFile file("/dev/full");
  file.write("x");
  CHECK_THROWS_WITH(file.close(), "/dev/full: cannot write: No space left on device");
  CHECK_THROWS_AS(write_file("/dev/full", std::string(1 << 20, 'x')), UserError);

  CsvWriter csv("/dev/full", {"time_s"});
  csv.row({1.0});
  CHECK_THROWS_AS(csv.close(), UserError);
}

TEST_CASE("files that cannot be opened or read are named") {
  const ScratchFolder scratch;
  CHECK_THROWS_WITH(OutputFile(scratch.path() / "no" / "file"),
                    Catch::Contains("no/file: cannot open: No such file or directory"));
  CHECK_THROWS_WITH(read_file(scratch.path() / "absent"), Catch::Contains("cannot read"));
  CHECK_THROWS_WITH(read_file(scratch.path()), Catch::Contains("Is a directory"));
}

TEST_CASE("numbers are written shortest and read back exactly") {
  CHECK(format_number(0.1) == "0.1");
  CHECK(format_number(-0.0) == "-0");
  CHECK(format_number(40.0) == "40");
  CHECK(format_number(1e-7) == "1e-07");
  CHECK(format_number(-1.0 / 3.0) == "-0.3333333333333333");
  CHECK(format_number(std::nan("")) == "nan");

  const auto seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937_64 random(seed);
  for (int i = 0; i < 10'000; ++i) {
    const std::uint64_t bits = random();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    CAPTURE(bits);
    REQUIRE(std::stod(std::abs(value) < 1e-300 ? "0" : format_number(value)) ==
            (std::abs(value) < 1e-300 ? 0.0 : value));  // stod throws for subnormal numbers
  }
}

TEST_CASE("a table has one header, columns with units, and rows of its width") {
  const ScratchFolder scratch;
  const auto path = scratch.path() / "samples.csv";
  CsvWriter csv(path, {"time_s", "phase_name", "frame_count"});
  csv.row({0.001, std::string_view("homing"), std::int64_t{12}});
  csv.row({0.5, std::string_view("running"), std::int64_t{-3}});
  CHECK_THROWS_AS(csv.row({1.0}), std::invalid_argument);
  CHECK_THROWS_AS(csv.row({1.0, std::string_view("a,b"), std::int64_t{1}}), std::invalid_argument);
  csv.close();
  CHECK(read_file(path) == "time_s,phase_name,frame_count\n0.001,homing,12\n0.5,running,-3\n");

  CHECK_THROWS_AS(CsvWriter(path, {"time"}), std::invalid_argument);
  CHECK_THROWS_AS(CsvWriter(path, {"fx_lb"}), std::invalid_argument);
}

TEST_CASE("the unit is the longest that the name ends in") {
  const auto symbol = [](const char* name) { return std::string(find_column_unit(name)->symbol); };
  CHECK(symbol("velocity_m_s") == "m/s");
  CHECK(symbol("time_s") == "s");
  CHECK(symbol("toe_torque_Nm") == "N m");
  CHECK(symbol("fx_N") == "N");
  CHECK(find_column_unit("depth") == nullptr);
  CHECK(find_column_unit("_m") == nullptr);
  CHECK(column_label("toe_torque_Nm") == "toe torque");
  CHECK(column_label("velocity_m_s") == "velocity");
  CHECK(column_label("grain_count") == "grain count");
  CHECK(column_label("frames") == "frames");
}

TEST_CASE("results keep their order, and a value that is not finite is refused by name") {
  const ScratchFolder scratch;
  const auto path = scratch.path() / "result.json";
  nlohmann::ordered_json result;
  result["zeta_m"] = 0.1;
  result["alpha"] = {{"hip_Nm", 3}};
  write_result_json(path, result);
  CHECK(read_file(path) == "{\n  \"zeta_m\": 0.1,\n  \"alpha\": {\n    \"hip_Nm\": 3\n  }\n}\n");

  result["alpha"]["hip_Nm"] = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(write_result_json(path, result), Catch::Contains("alpha.hip_Nm"));
  CHECK_THROWS_AS(write_result_json(path, result), CannotFinish);
}

TEST_CASE("SHA-256 of the examples of FIPS 180-2, appendix B") {
  CHECK(sha256_hex("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256_hex("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256_hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  const ScratchFolder scratch;
  write_file(scratch.path() / "abc", "abc");
  CHECK(sha256_hex_of_file(scratch.path() / "abc") == sha256_hex("abc"));
}
