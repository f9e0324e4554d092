// The nodelets by name, for the stand-alone nodes that link them directly (pluginlib finds a nodelet only
// through the environment's CMAKE_PREFIX_PATH, which is lost under systemd or ssh).
#pragma once

#include <nodelet/nodelet.h>

#include <memory>

namespace cornerstone {

std::unique_ptr<nodelet::Nodelet> makeTrinocularStereo();
std::unique_ptr<nodelet::Nodelet> makeOccupancyMapper();
std::unique_ptr<nodelet::Nodelet> makeRegistration();
std::unique_ptr<nodelet::Nodelet> makeSimulator();

}  // namespace cornerstone
