// After the first images a matcher allocates nothing more: neither from the heap nor images.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "stereo/synthetic_views.h"

namespace {

std::atomic<int> allocations{0};

void* counted(std::size_t bytes) {
  ++allocations;
  if (void* memory = std::malloc(bytes)) return memory;
  throw std::bad_alloc();
}

// Counts what OpenCV's images take, which comes past operator new.
class CountingAllocator : public cv::MatAllocator {
 public:
  using Flags = cv::AccessFlag;
  cv::UMatData* allocate(int dims, const int* sizes, int type, void* data, std::size_t* step, Flags flags,
                         cv::UMatUsageFlags usage) const override {
    ++allocations;
    return cv::Mat::getStdAllocator()->allocate(dims, sizes, type, data, step, flags, usage);
  }
  bool allocate(cv::UMatData* data, Flags flags, cv::UMatUsageFlags usage) const override {
    return cv::Mat::getStdAllocator()->allocate(data, flags, usage);
  }
  void deallocate(cv::UMatData* data) const override { cv::Mat::getStdAllocator()->deallocate(data); }
};

}  // namespace

void* operator new(std::size_t bytes) { return counted(bytes); }
void* operator new[](std::size_t bytes) { return counted(bytes); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace cornerstone {
namespace {

TEST(StereoMatcher, AllocatesNothingInTheSteadyState) {
  static CountingAllocator counting;
  cv::MatAllocator* usual = cv::Mat::getDefaultAllocator();
  cv::Mat::setDefaultAllocator(&counting);
  cv::RNG random(17);
  const Texture texture({160, 120}, 1, 30, random);
  for (const auto& [third, threads] : {std::pair{true, 1}, {false, 1}, {true, 2}}) {
    StereoImages images = viewsOf(texture, {7, 0}, {2, 1}, random);
    if (third)
      for (cv::Mat1b* image : {&images.reference, &images.right, &images.top}) {
        cv::resize(*image, *image, {640, 480});
        (*image)(cv::Rect(0, 0, 640, 240)).setTo(90);  // silent: the coarse level is asked
      }
    else
      images.top.release();
    StereoParams params;
    params.threads = threads;
    StereoMatcher matcher(params);
    Disparity disparity;
    for (int i = 0; i < 2; ++i) matcher.match(images, rigOf(images), disparity);
    const int before = allocations;
    matcher.match(images, rigOf(images), disparity);
    EXPECT_EQ(allocations - before, 0)
        << (third ? "three cameras, 640x480" : "two cameras, 160x120") << ", threads: " << threads;
  }
  cv::Mat::setDefaultAllocator(usual);
}

}  // namespace
}  // namespace cornerstone
