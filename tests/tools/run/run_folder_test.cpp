#include "tools/run/run_folder.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/errors.h"
#include "tools/run/output_file.h"

using namespace hoof::tools;
using hoof::tests::ScratchFolder;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

RunFolderOptions at(const fs::path& out, bool force = false) {
  return {"sinkage", out, force};
}

void write_run(RunFolder& run, const std::string& settings) {
  write_file(run.file("settings.toml"), settings);
}

}  // namespace

TEST_CASE("a run stands at its final path only once it is committed") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "deep" / "er" / "run";
  RunFolder run(at(out));
  write_run(run, "a = 1\n");
  CHECK_FALSE(fs::exists(out));
  CHECK(run.working_path().filename().string().front() == '.');

  CHECK(run.commit() == out);
  CHECK(read_file(out / "settings.toml") == "a = 1\n");
  CHECK(names_in(out.parent_path()) == std::vector<std::string>{"run"});
}

TEST_CASE("a run that fails leaves nothing behind") {
  const ScratchFolder scratch;
  {
    RunFolder run(at(scratch.path() / "run"));
    write_run(run, "a = 1\n");
  }
  CHECK(names_in(scratch.path()).empty());
}

TEST_CASE("an earlier run is kept unless --force is given") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  {
    RunFolder first(at(out));
    write_run(first, "first = 1\n");
    first.commit();
  }
  CHECK_THROWS_AS(RunFolder(at(out)), UserError);
  CHECK_THROWS_AS(RunFolder(at(out.string() + "/")), UserError);
  CHECK(read_file(out / "settings.toml") == "first = 1\n");

  RunFolder second(at(out, true));
  write_run(second, "second = 2\n");
  CHECK(read_file(out / "settings.toml") == "first = 1\n");
  second.commit();
  CHECK(read_file(out / "settings.toml") == "second = 2\n");
  CHECK(names_in(scratch.path()) == std::vector<std::string>{"run"});
}

TEST_CASE("force does not replace what is no run folder") {
  const ScratchFolder scratch;
  fs::create_directory(scratch.path() / "thesis");
  write_file(scratch.path() / "thesis" / "chapter1.tex", "years of work");
  CHECK_THROWS_WITH(RunFolder(at(scratch.path() / "thesis", true)),
                    Catch::Contains("is not a run folder"));
  write_file(scratch.path() / "file", "also precious");
  CHECK_THROWS_AS(RunFolder(at(scratch.path() / "file", true)), UserError);
  CHECK(fs::exists(scratch.path() / "thesis" / "chapter1.tex"));

  fs::create_directory(scratch.path() / "empty");
  CHECK_NOTHROW(RunFolder(at(scratch.path() / "empty", true)));
}

TEST_CASE("a folder that appears during a run is not overwritten, and the run is not lost") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  RunFolder run(at(out));
  write_run(run, "a = 1\n");
  fs::create_directory(out);
  write_file(out / "settings.toml", "other = 1\n");
  CHECK_THROWS_AS(run.commit(), UserError);
  CHECK(read_file(out / "settings.toml") == "other = 1\n");
  CHECK(read_file(scratch.path() / "run-new" / "settings.toml") == "a = 1\n");
}

TEST_CASE("default folders are numbered, also when two runs end at the same time") {
  const ScratchFolder scratch;
  RunFolderOptions options{"traction", "", false, scratch.path() / "runs"};
  RunFolder first(options);
  write_run(first, "first = 1\n");
  {
    // The same process cannot start a second run of the same name at the same time; another
    // process that took the name in the meantime looks like this.
    fs::create_directory(scratch.path() / "runs" / "x");
    fs::rename(scratch.path() / "runs" / "x",
               scratch.path() / "runs" /
                   first.working_path().filename().string().substr(
                       1, first.working_path().filename().string().find(".partial") - 1));
  }
  const fs::path path = first.commit();
  CHECK_THAT(path.filename().string(), Catch::Matches("traction-[0-9]{4}-[0-9]{2}-[0-9]{2}-2"));
  CHECK(read_file(path / "settings.toml") == "first = 1\n");
}

TEST_CASE("an interrupted run is kept under a name that says so") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  for (const std::string expected : {"run-interrupted", "run-interrupted-2"}) {
    RunFolder run(at(out));
    write_run(run, "a = 1\n");
    CHECK(run.keep_as("interrupted").filename() == expected);
  }
  CHECK(names_in(scratch.path()) ==
        std::vector<std::string>{"run-interrupted", "run-interrupted-2"});
}

TEST_CASE("a folder that cannot be made is named with the reason") {
  const ScratchFolder scratch;
  write_file(scratch.path() / "file", "");
  CHECK_THROWS_WITH(RunFolder(at(scratch.path() / "file" / "run")),
                    Catch::Contains("file") && Catch::Contains("Not a directory"));
}

TEST_CASE("what a killed run of the same name left is removed, what a living one writes is not") {
  const ScratchFolder scratch;
  const fs::path out = scratch.path() / "run";
  // Process ids that no process has: above the kernel's limit of 2^22.
  const fs::path killed = scratch.path() / ".run.partial-99999999",
                 other = scratch.path() / ".run-2.partial-99999999",
                 living = scratch.path() / ".run.partial-99999998";
  for (const fs::path& folder : {killed, other, living}) {
    fs::create_directory(folder);
    write_file(folder / "samples.csv", "half");
  }
  const FolderLock alive(living);
  REQUIRE(alive.held());
  RunFolder run(at(out));
  CHECK(run.removed() == std::vector<fs::path>{killed});
  CHECK_FALSE(fs::exists(killed));
  CHECK(fs::exists(living / "samples.csv"));
  CHECK(fs::exists(other / "samples.csv"));
  // This one's own is locked under whatever name.
  CHECK(FolderLock(run.working_path()).taken());
  write_run(run, "a = 1\n");
  CHECK(FolderLock(run.commit()).taken());
}

TEST_CASE("a default name is not given anew while its run can be resumed") {
  const ScratchFolder scratch;
  const RunFolderOptions options{"sinkage", "", false, scratch.path() / "runs"};
  fs::path first;
  {
    const RunFolder run(options);
    first = run.final_path();
  }
  CHECK_THAT(first.filename().string(), Catch::EndsWith("-1"));
  fs::create_directory(resume_path(first));
  CHECK_THAT(RunFolder(options).final_path().filename().string(), Catch::EndsWith("-2"));
}

TEST_CASE("a lock is let go of with its owner, and where there is no folder there is none") {
  const ScratchFolder scratch;
  {
    const FolderLock first(scratch.path());
    CHECK(first.held());
    const FolderLock second(scratch.path());
    CHECK(second.taken());
    CHECK_FALSE(second.held());
  }
  CHECK(FolderLock(scratch.path()).held());
  const FolderLock nothing(scratch.path() / "nothing");
  CHECK_FALSE(nothing.held());
  CHECK_FALSE(nothing.taken());
}
