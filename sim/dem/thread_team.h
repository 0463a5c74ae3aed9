// A fixed team of threads that does one job after another. The caller is member 0.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace hoof::sim {

class ThreadTeam {
 public:
  explicit ThreadTeam(int size);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return size_; }

  /// Runs job(member) once on every member and returns when all are done. The job must not throw.
  void run(const std::function<void(int)>& job);

 private:
  void work(int member);
  void await(const std::atomic<std::uint32_t>& value, std::uint32_t old_value) const;

  int size_;
  int spins_;
  const std::function<void(int)>* job_ = nullptr;
  std::atomic<std::uint32_t> round_{0};
  std::atomic<std::uint32_t> pending_{0};
  std::atomic<bool> quit_{false};
  std::vector<std::thread> threads_;
};

}  // namespace hoof::sim
