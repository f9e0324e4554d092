// Runs one nodelet as a node of its own.
#pragma once

#include <nodelet/nodelet.h>

#include <functional>
#include <memory>
#include <string>

namespace cornerstone {

// The whole main of a stand-alone node: 0 when ROS shuts it down, 2 when the nodelet refuses to start.
int runStandAlone(int argc, char** argv, const std::string& default_name,
                  const std::function<std::unique_ptr<nodelet::Nodelet>()>& make);

}  // namespace cornerstone
