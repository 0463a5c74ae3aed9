#include "tools/reproduce/slurm_queue.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <sstream>

#include "tools/run/errors.h"

extern char** environ;

namespace hoof::tools {
namespace {

struct Said {
  int status = 0;
  std::string text;  // both streams
};

/// @throws CannotFinish where there is no such program
Said call(std::vector<std::string> words) {
  std::array<int, 2> pipe_ends{};
  if (pipe2(pipe_ends.data(), O_CLOEXEC) != 0) throw CannotFinish("cannot make a pipe");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDERR_FILENO);
  pid_t child = 0;
  const int failure =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(pipe_ends[1]);
  Said said;
  if (failure == 0) {
    std::array<char, 4096> part{};
    ssize_t got = 0;
    while ((got = read(pipe_ends[0], part.data(), part.size())) > 0 ||
           (got < 0 && errno == EINTR)) {
      if (got > 0) said.text.append(part.data(), std::size_t(got));
    }
    while (waitpid(child, &said.status, 0) < 0 && errno == EINTR) {
    }
  }
  close(pipe_ends[0]);
  if (failure != 0) {
    throw CannotFinish("--engine slurm: cannot run " + words[0] + ": " + std::strerror(failure));
  }
  return said;
}

std::string one_line(std::string text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  for (char& c : text) c = c == '\n' ? ' ' : c;
  return text;
}

Said call_well(const std::vector<std::string>& words) {
  Said said = call(words);
  if (said.status != 0) {
    throw CannotFinish("--engine slurm: " + words[0] + " failed: " + one_line(said.text));
  }
  return said;
}

}  // namespace

std::vector<QueuedTask> parse_squeue(const std::string& text) {
  std::vector<QueuedTask> tasks;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    QueuedTask task;
    if (!std::getline(fields, task.job, '|') || !std::getline(fields, task.name, '|') ||
        !std::getline(fields, task.state, '|')) {
      continue;  // a warning among the lines
    }
    std::getline(fields, task.reason);
    const std::size_t at = task.job.find('_');
    if (at == std::string::npos) continue;
    try {
      task.index = std::stoi(task.job.substr(at + 1));
    } catch (const std::exception&) {
      continue;
    }
    tasks.push_back(task);
  }
  return tasks;
}

std::vector<QueuedTask> queued_tasks(const std::vector<std::string>& names) {
  if (names.empty()) return {};
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ",") + name;
  return parse_squeue(
      call_well({"squeue", "--noheader", "--array", "--name=" + all, "--format=%i|%j|%T|%r"}).text);
}

std::string submit(const std::filesystem::path& script, const std::vector<std::string>& options) {
  std::vector<std::string> words = {"sbatch", "--parsable"};
  words.insert(words.end(), options.begin(), options.end());
  words.push_back(script.string());
  const std::string said = one_line(call_well(words).text);
  // "12" or "12;cluster", after warnings of the site if there are any.
  const std::string last = said.substr(said.find_last_of(' ') + 1);
  return last.substr(0, last.find(';'));
}

void cancel(const std::string& job) {
  call({"scancel", job});
}

}  // namespace hoof::tools
