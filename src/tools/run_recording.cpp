#include "tools/run_recording.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Float32.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt32.h>
#include <tf2_eigen/tf2_eigen.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <filesystem>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/grid_messages.h"
#include "cornerstone/ros/transforms.h"

namespace cornerstone {
namespace {

constexpr double kWholeRun_s = 24 * 3600;  // tf forgets older transforms than its buffer's length

// "/a/map" -> {"a", "map"}; topics outside a robot's namespace have no robot.
std::pair<std::string, std::string> robotAndName(const std::string& topic) {
  const std::size_t slash = topic.find('/', 1);
  if (slash == std::string::npos) return {"", topic.substr(1)};
  return {topic.substr(1, slash - 1), topic.substr(slash + 1)};
}

void takeTf(RunRecording& run, const tf2_msgs::TFMessage& message, bool is_static) {
  for (const auto& transform : message.transforms) run.tf->setTransform(transform, "bag", is_static);
}

void takeDiagnostics(RunRecording& run, const diagnostic_msgs::DiagnosticArray& message) {
  for (const auto& status : message.status) {
    // "b/mapper: mapper": the node's name, then the stage's
    const std::size_t colon = status.name.find(": ");
    if (colon == std::string::npos) continue;
    const std::string robot = robotAndName("/" + status.name.substr(0, colon)).first;
    if (robot.empty()) continue;
    StageCounts& counts = run.robots[robot].stages[status.name.substr(colon + 2)];
    for (const auto& value : status.values) {
      if (value.key == "processed") counts.processed = static_cast<unsigned>(std::stoul(value.value));
      if (value.key == "dropped") counts.dropped = static_cast<unsigned>(std::stoul(value.value));
    }
  }
}

void takeRobotMessage(RobotRecording& robot, const std::string& name,
                      const rosbag::MessageInstance& message) {
  if (const auto odometry = message.instantiate<nav_msgs::Odometry>(); odometry && name == "ground_truth") {
    Eigen::Isometry3d world_from_base;
    tf2::fromMsg(odometry->pose.pose, world_from_base);
    robot.truth.push_back({odometry->header.stamp.toSec(), planarPart(world_from_base)});
  } else if (const auto map = message.instantiate<nav_msgs::OccupancyGrid>(); map && name == "map") {
    robot.map = fromOccupancyGrid(*map);
  } else if (const auto update = message.instantiate<map_msgs::OccupancyGridUpdate>()) {
    applyUpdate(*update, robot.map);
  } else if (const auto corners = message.instantiate<CornerArray>()) {
    robot.landmarks = *corners;
  } else if (const auto count = message.instantiate<std_msgs::UInt32>(); count && name == "collisions") {
    robot.collisions = count->data;
  }
}

void takeMessage(RunRecording& run, const rosbag::MessageInstance& message) {
  const std::string& topic = message.getTopic();
  if (const auto tf = message.instantiate<tf2_msgs::TFMessage>())
    takeTf(run, *tf, topic == "/tf_static");
  else if (const auto diagnostics = message.instantiate<diagnostic_msgs::DiagnosticArray>())
    takeDiagnostics(run, *diagnostics);
  else if (const auto registration = message.instantiate<MapRegistration>())
    run.registrations.push_back(*registration);
  else if (const auto text = message.instantiate<std_msgs::String>(); text && topic == "/world")
    run.world_yaml = text->data;
  else if (const auto factor = message.instantiate<std_msgs::Float32>();
           factor && topic == "/real_time_factor")
    run.real_time_factors.push_back(factor->data);
  else if (const auto [robot, name] = robotAndName(topic); !robot.empty())
    takeRobotMessage(run.robots[robot], name, message);
}

}  // namespace

RunRecording readRun(const std::string& bag_or_folder) {
  RunRecording run;
  run.path = std::filesystem::is_directory(bag_or_folder) ? bag_or_folder + "/run.bag" : bag_or_folder;
  run.tf = std::make_shared<tf2::BufferCore>(ros::Duration(kWholeRun_s));
  try {
    rosbag::Bag bag(run.path);
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) takeMessage(run, message);
  } catch (const rosbag::BagException& error) {
    throw InputError(run.path + ": " + error.what());
  }
  const bool truth = std::any_of(run.robots.begin(), run.robots.end(),
                                 [](const auto& robot) { return !robot.second.truth.empty(); });
  if (!truth) throw InputError(run.path + ": no ground_truth of any robot");
  return run;
}

std::optional<Pose2> transformAt(const RunRecording& run, const std::string& target,
                                 const std::string& source, double time_s) {
  try {
    return planarPart(tf2::transformToEigen(run.tf->lookupTransform(target, source, ros::Time(time_s))));
  } catch (const tf2::TransformException&) {
    return {};
  }
}

}  // namespace cornerstone
