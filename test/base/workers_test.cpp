#include "cornerstone/base/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <set>

namespace cornerstone {
namespace {

TEST(Workers, EveryPartIsDoneOnceByAThreadOfItsOwn) {
  for (const int count : {1, 2, 3}) {
    Workers workers(count);
    ASSERT_EQ(workers.count(), count);
    for (const int size : {0, 1, 2, 3, 10, 101}) {
      std::vector<int> done(static_cast<std::size_t>(size), 0);
      for (int turn = 1; turn <= 50; ++turn) {
        workers.share(size, [&](int begin, int end) {
          for (int i = begin; i < end; ++i) ++done[static_cast<std::size_t>(i)];
        });
        ASSERT_EQ(done, std::vector<int>(done.size(), turn)) << count << ' ' << size;
      }
    }
    std::vector<std::thread::id> threads(static_cast<std::size_t>(count));
    workers.run([&](int worker) { threads[static_cast<std::size_t>(worker)] = std::this_thread::get_id(); });
    EXPECT_EQ(threads.front(), std::this_thread::get_id());
    EXPECT_EQ(std::set<std::thread::id>(threads.begin(), threads.end()).size(), threads.size());
  }
}

// Work that waits for the other worker ends only if the two run at the same time.
TEST(Workers, RunAtTheSameTime) {
  Workers workers(2);
  std::atomic<int> arrived{0};
  workers.run([&](int) {
    ++arrived;
    while (arrived < 2) std::this_thread::yield();
  });
  EXPECT_EQ(arrived, 2);
}

}  // namespace
}  // namespace cornerstone
