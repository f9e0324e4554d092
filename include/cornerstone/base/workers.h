// Threads that stay: they wait for work, so that nothing is started or allocated image by image.
// OpenCV's cv::parallel_for_ allocates in every call, and its number of threads is one for the whole process.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace cornerstone {

class Workers {
 public:
  explicit Workers(int count);  // the thread that calls run() is one of them
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  int count() const { return static_cast<int>(threads_.size()) + 1; }

  // Calls work(k) for every worker k = 0 .. count() - 1 at the same time, and returns when all are done. Work
  // that throws ends the program. One caller at a time.
  template <typename Work>
  void run(const Work& work) {
    runAll({[](const void* held, int worker) { (*static_cast<const Work*>(held))(worker); }, &work});
  }

  // The same for 0 .. size - 1 in neighbouring parts of about one size: work(begin, end), or
  // work(begin, end, worker). Parts may be empty.
  template <typename Work>
  void share(int size, const Work& work) {
    run([&](int worker) {
      const int begin = partBegin(size, worker), end = partBegin(size, worker + 1);
      if (begin == end) return;
      if constexpr (std::is_invocable_v<const Work&, int, int, int>)
        work(begin, end, worker);
      else
        work(begin, end);
    });
  }
  int partBegin(int size, int worker) const {
    return static_cast<int>(static_cast<std::int64_t>(size) * worker / count());
  }

 private:
  struct Task {
    void (*call)(const void* held, int worker) = nullptr;
    const void* held = nullptr;
  };
  void runAll(const Task& task) noexcept;
  void serve(int worker) noexcept;

  std::mutex mutex_;
  std::condition_variable begun_, done_;
  Task task_;
  std::atomic<std::uint64_t> turn_{0};  // counts tasks; the last one, without a task, is the end
  std::atomic<int> busy_{0};            // workers that have not done the present one
  bool stopping_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace cornerstone
