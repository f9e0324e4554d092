#include "cornerstone/base/workers.h"

namespace cornerstone {
namespace {

// To fall asleep and be woken takes as long as many a task: before that, whoever waits gives its processor to
// others so many times, some tens of microseconds where nobody wants it.
constexpr int kYields = 100;

template <typename Condition>
bool comesSoon(const Condition& condition) {
  for (int i = 0; i < kYields; ++i) {
    if (condition()) return true;
    std::this_thread::yield();
  }
  return condition();
}

}  // namespace

Workers::Workers(int count) {
  for (int worker = 1; worker < count; ++worker) threads_.emplace_back([this, worker] { serve(worker); });
}

Workers::~Workers() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
    ++turn_;
  }
  begun_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Workers::runAll(const Task& task) noexcept {
  if (threads_.empty()) return task.call(task.held, 0);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    task_ = task;
    busy_ = static_cast<int>(threads_.size());
    ++turn_;
  }
  begun_.notify_all();
  task.call(task.held, 0);
  const auto allDone = [this] { return busy_ == 0; };
  if (comesSoon(allDone)) return;
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, allDone);
}

void Workers::serve(int worker) noexcept {
  for (std::uint64_t served = 0;; ++served) {
    const auto begun = [&] { return turn_ != served; };
    if (!comesSoon(begun)) {
      std::unique_lock<std::mutex> lock(mutex_);
      begun_.wait(lock, begun);
    }
    if (stopping_) return;
    task_.call(task_.held, worker);
    if (--busy_ > 0) continue;
    { const std::lock_guard<std::mutex> lock(mutex_); }  // the caller either waits already or sees it
    done_.notify_one();
  }
}

}  // namespace cornerstone
