#include "nodelets/stand_alone.h"

#include <ros/ros.h>

namespace cornerstone {

int runStandAlone(int argc, char** argv, const std::string& default_name,
                  const std::function<std::unique_ptr<nodelet::Nodelet>()>& make) {
  ros::init(argc, argv, default_name);
  const ros::NodeHandle keeps_ros_running;
  const std::unique_ptr<nodelet::Nodelet> nodelet = make();
  try {
    nodelet->init(ros::this_node::getName(), ros::names::getRemappings(),
                  ros::V_string(argv + 1, argv + argc));
  } catch (const std::exception&) {
    return 2;  // the nodelet has said why
  }
  ros::spin();
  return 0;
}

}  // namespace cornerstone
