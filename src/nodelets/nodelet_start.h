// How every nodelet starts: a bad configuration stops the start with its name, and nothing half-started stays
// behind.
#pragma once

#include <nodelet/nodelet.h>
#include <ros/console.h>

#include <functional>
#include <string>

namespace cornerstone {

// Runs `start`; on any exception it says what is wrong and throws on, so that the nodelet manager unloads the
// nodelet and the load request fails.
inline void startOrRefuse(const std::string& name, const std::function<void()>& start) {
  try {
    start();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(name << ": refused to start: " << error.what());
    throw;
  }
}

}  // namespace cornerstone
