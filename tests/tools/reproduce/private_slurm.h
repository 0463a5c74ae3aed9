// A Slurm of one node of its own, as whoever runs the tests: no munge, no service, ports of its
// own.
#pragma once

#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "tests/tools/run/scratch_folder.h"
#include "tools/run/output_file.h"

namespace hoof::tests {

class PrivateSlurm {
 public:
  static bool installed() {
    setenv("PATH", (std::string(getenv("PATH")) + ":/usr/sbin").c_str(), 1);
    for (const char* program : {"slurmctld", "slurmd", "sbatch", "squeue", "scancel"}) {
      if (run(std::string("command -v ") + program) != 0) return false;
    }
    return true;
  }

  PrivateSlurm() {
    for (const char* part : {"state", "spool", "log"}) {
      std::filesystem::create_directory(folder_.path() / part);
    }
    setenv("SLURM_CONF", (folder_.path() / "slurm.conf").c_str(), 1);
    start_controller(true);
    if (run("slurmd -f " + (folder_.path() / "slurm.conf").string()) != 0) fail("slurmd");
    until_idle();
  }

  ~PrivateSlurm() {
    run("scancel --user=\"$(id -un)\"");
    for (const char* name : {"ctld.pid", "slurmd.pid"}) {
      if (const pid_t id = read_id(name); id > 0) kill(id, SIGTERM);
    }
    for (const char* name : {"ctld.pid", "slurmd.pid"}) {
      const pid_t id = read_id(name);
      for (int i = 0; id > 0 && i < 500 && alive(id); ++i) pause_ms(10);
    }
    unsetenv("SLURM_CONF");
  }

  void kill_controller() const {
    const pid_t id = read_id("ctld.pid");
    if (id <= 0) throw std::runtime_error("slurmctld has no pid");
    kill(id, SIGKILL);
    while (alive(id)) pause_ms(5);
  }

  /// @param clean forgets what it knew. It then gives other numbers than before: a job that still
  /// runs on the node under a number given again would drain the node, which is for people to mend.
  void start_controller(bool clean) {
    tools::write_file(folder_.path() / "slurm.conf",
                      settings() + "FirstJobId=" + std::to_string(first_job_) + "\n");
    first_job_ += 1000;
    // Where the one before is killed its port may stay taken for a moment.
    for (int i = 0; i < 50; ++i) {
      if (run(std::string("slurmctld ") + (clean ? "-c " : "") + "-i") == 0 && answers()) return;
      pause_ms(200);
    }
    fail("slurmctld");
  }

  /// Until the queue of everybody is empty.
  void until_empty() const {
    for (int i = 0; i < 1200; ++i) {
      if (run("test -z \"$(squeue --noheader)\"") == 0) return;
      pause_ms(50);
    }
    fail("the queue");
  }

  static int run(const std::string& command) {
    return std::system(("(" + command + ") >/dev/null 2>&1").c_str());
  }
  static void pause_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

 private:
  static std::string said(const std::string& command) {
    const ScratchFolder scratch;
    const auto file = scratch.path() / "said";
    if (std::system((command + " >" + file.string()).c_str()) != 0) return "";
    std::string text = tools::read_file(file);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text;
  }

  std::string settings() const {
    const std::string dir = folder_.path().string(), host = said("hostname -s"),
                      user = said("id -un");
    const int port = 20000 + 2 * int(getpid() % 10000);  // two of each; tests run side by side
    return "ClusterName=hoof\nSlurmctldHost=" + host + "(127.0.0.1)\nSlurmUser=" + user +
           "\nSlurmdUser=" + user +
           "\nAuthType=auth/none\nCredType=cred/none\nDependencyParameters=kill_invalid_depend\n"
           "SlurmctldPort=" +
           std::to_string(port) + "\nSlurmdPort=" + std::to_string(port + 1) +
           "\nStateSaveLocation=" + dir + "/state\nSlurmdSpoolDir=" + dir +
           "/spool\nSlurmctldPidFile=" + dir + "/ctld.pid\nSlurmdPidFile=" + dir +
           "/slurmd.pid\nSlurmctldLogFile=" + dir + "/log/ctld.log\nSlurmdLogFile=" + dir +
           "/log/slurmd.log\nProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n"
           "JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n"
           "SelectType=select/cons_tres\nSelectTypeParameters=CR_CPU\nSchedulerType=sched/"
           "backfill\n"
           "SchedulerParameters=sched_interval=1,batch_sched_delay=0,bf_interval=1\n"
           "ReturnToService=2\nMailProg=/bin/true\nMpiDefault=none\nKillWait=2\nNodeName=" +
           host +
           " NodeAddr=127.0.0.1 CPUs=2 RealMemory=1000 State=UNKNOWN\nPartitionName=main "
           "Nodes=" +
           host + " Default=YES MaxTime=INFINITE State=UP\n";
  }

  bool answers() const {
    for (int i = 0; i < 50; ++i) {
      if (run("scontrol ping | grep -q 'is UP'") == 0) return true;
      pause_ms(100);
    }
    return false;
  }

  void until_idle() const {
    for (int i = 0; i < 200; ++i) {
      if (run("sinfo --noheader --format=%T | grep -q idle") == 0) return;
      pause_ms(100);
    }
    fail("the node");
  }

  /// Not one that is dead and whom nobody has buried: it was orphaned, and process 1 of a container
  /// need not do it.
  static bool alive(pid_t id) {
    std::ifstream file("/proc/" + std::to_string(id) + "/stat");
    std::string number, name, state;
    return bool(file >> number >> name >> state) && state != "Z";
  }

  pid_t read_id(const char* name) const {
    std::ifstream file(folder_.path() / name);
    pid_t id = 0;
    file >> id;
    return file ? id : 0;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(what + " does not come up; logs in " +
                             (folder_.path() / "log").string());
  }

  ScratchFolder folder_;
  int first_job_ = 1;
};

}  // namespace hoof::tests
