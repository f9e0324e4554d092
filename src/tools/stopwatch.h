// Times the stages of a program in milliseconds.
#pragma once

#include <chrono>

namespace cornerstone {

class Stopwatch {
 public:
  // Since the start or the last call.
  double lap_ms() {
    const auto now = Clock::now();
    const double lap = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return lap;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace cornerstone
