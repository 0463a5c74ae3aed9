#include "sim/dem/thread_team.h"

#include <algorithm>

namespace hoof::sim {

ThreadTeam::ThreadTeam(int size) : size_(std::max(1, size)) {
  // Waiting by spinning costs nothing while every member has a core of its own; with more members
  // than cores it would keep the one that works off its core.
  const int cores = int(std::thread::hardware_concurrency());
  spins_ = size_ <= cores ? 4000 : 0;
  for (int member = 1; member < size_; ++member) {
    threads_.emplace_back([this, member] { work(member); });
  }
}

ThreadTeam::~ThreadTeam() {
  quit_ = true;
  round_.fetch_add(1);
  round_.notify_all();
  for (std::thread& t : threads_) t.join();
}

void ThreadTeam::await(const std::atomic<std::uint32_t>& value, std::uint32_t old_value) const {
  for (int i = 0; i < spins_; ++i) {
    if (value.load(std::memory_order_acquire) != old_value) return;
    __builtin_ia32_pause();
  }
  value.wait(old_value, std::memory_order_acquire);
}

void ThreadTeam::run(const std::function<void(int)>& job) {
  if (size_ == 1) {
    job(0);
    return;
  }
  job_ = &job;
  pending_.store(std::uint32_t(size_ - 1), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  job(0);
  for (std::uint32_t left = pending_.load(std::memory_order_acquire); left != 0;
       left = pending_.load(std::memory_order_acquire)) {
    await(pending_, left);
  }
}

void ThreadTeam::work(int member) {
  std::uint32_t seen = 0;
  for (;;) {
    await(round_, seen);
    ++seen;
    if (quit_) return;
    (*job_)(member);
    pending_.fetch_sub(1, std::memory_order_acq_rel);
    pending_.notify_one();
  }
}

}  // namespace hoof::sim
