// simulate_bag: a world's robots drive their routes, and all that the simulator nodelet would publish goes
// into a bag, faster than real time and the same bytes for the same seed. tf holds odom -> base_link only;
// /clock is made by `rosbag play --clock`.
#include <rosbag/bag.h>
#include <std_msgs/Bool.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <sstream>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/simulation_messages.h"
#include "tools/program.h"

namespace cornerstone {
namespace {

const char* kUsage =
    "simulate_bag WORLD.yaml --out X.bag [--seed N] [--duration S] [--robots a,b] [--params simulator.yaml]";
constexpr double kLongestRun_s = 3600;  // for routes that never end

// A latched topic: whoever starts late while the bag plays still gets the last message.
template <typename Message>
void writeLatched(rosbag::Bag& bag, const std::string& topic, const ros::Time& stamp,
                  const Message& message) {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["topic"] = topic;
  (*header)["type"] = ros::message_traits::datatype(message);
  (*header)["md5sum"] = ros::message_traits::md5sum(message);
  (*header)["message_definition"] = ros::message_traits::definition(message);
  (*header)["latching"] = "1";
  (*header)["callerid"] = "/simulator";
  bag.write(topic, stamp, message, header);
}

std::vector<std::string> namesOf(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream stream(list);
  for (std::string name; std::getline(stream, name, ',');) names.push_back(name);
  return names;
}

SimulatorParams paramsOf(const Arguments& arguments) {
  SimulatorParams params;
  if (arguments.has("params")) {
    const std::string path = arguments.text("params");
    try {
      params = readParams<SimulatorParams>(YAML::LoadFile(path), path);
    } catch (const YAML::Exception& error) {
      throw InputError(path + ": " + error.what());
    }
  }
  params.simulation.seed = arguments.wholeNumber("seed", params.simulation.seed);
  if (arguments.has("robots")) params.simulation.robots = namesOf(arguments.text("robots"));
  params.simulation.follow_routes = true;
  return params;
}

class BagWriter {
 public:
  BagWriter(const std::string& path, const SimulatorParams& params)
      : params_(params),
        calibrations_(calibrationsOf(params.simulation.rig)),
        bag_(path, rosbag::bagmode::Write) {}

  void writeWorld(const World& world) {
    std_msgs::String text;
    text.data = world.yaml_text;
    writeLatched(bag_, "/world", stampOf(params_, 0), text);
  }

  void write(const std::vector<RobotFrame>& frames) {
    tf2_msgs::TFMessage tf;
    for (const RobotFrame& frame : frames) {
      const ros::Time stamp = stampOf(params_, frame.time_s);
      const MotionMessages motion = motionMessages(frame, stamp);
      tf.transforms.push_back(motion.odom_from_base);
      bag_.write("/" + frame.robot + "/odom", stamp, motion.odometry);
      bag_.write("/" + frame.robot + "/ground_truth", stamp, motion.ground_truth);
      writeCollisions(frame, stamp);
    }
    if (!frames.empty()) bag_.write("/tf", stampOf(params_, frames.front().time_s), tf);
    for (const RobotFrame& frame : frames) writeCameras(frame);
  }

  void finish(double time_s) {
    std_msgs::Bool done;
    done.data = true;
    writeLatched(bag_, "/simulation_done", stampOf(params_, time_s), done);
    bag_.close();
  }

  const std::map<std::string, int>& imageCounts() const { return image_counts_; }
  const std::map<std::string, int>& collisions() const { return collisions_; }

 private:
  void writeCollisions(const RobotFrame& frame, const ros::Time& stamp) {
    if (collisions_.count(frame.robot) > 0 && collisions_[frame.robot] == frame.collisions) return;
    collisions_[frame.robot] = frame.collisions;
    std_msgs::UInt32 count;
    count.data = unsigned(frame.collisions);
    writeLatched(bag_, "/" + frame.robot + "/collisions", stamp, count);
  }

  void writeCameras(const RobotFrame& frame) {
    const ros::Time stamp = stampOf(params_, frame.time_s);
    const auto cameras = cameraMessages(frame, calibrations_, stamp);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const std::string topic = "/" + frame.robot + "/" + kCameraNames[i];
      bag_.write(topic + "/camera_info", stamp, cameras[i].info);
      bag_.write(topic + "/image_rect", stamp, *cameras[i].image);
    }
    if (!cameras.empty()) ++image_counts_[frame.robot];
  }

  SimulatorParams params_;
  std::array<CameraCalibration, kCameraCount> calibrations_;
  rosbag::Bag bag_;
  std::map<std::string, int> image_counts_, collisions_;
};

Outcome simulate(const Arguments& arguments) {
  const auto start = std::chrono::steady_clock::now();
  if (!arguments.has("out")) throw InputError(std::string("--out is missing; ") + kUsage);
  const double duration_s = arguments.number("duration", kLongestRun_s);
  requirePositive(duration_s, "--duration");
  const World world = loadWorld(arguments.positional(0));
  const SimulatorParams params = paramsOf(arguments);
  Simulation simulation(world, params.simulation);
  BagWriter writer(arguments.text("out"), params);
  writer.writeWorld(world);
  writer.write(simulation.frames());
  while (!simulation.routesDone() && simulation.time_s() < duration_s) {
    simulation.step();
    writer.write(simulation.frames(simulation.frameDue()));
  }
  writer.finish(simulation.time_s());
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  return {kExitDone,
          {{"frames", writer.imageCounts()},
           {"duration_s", simulation.time_s()},
           {"collisions", writer.collisions()},
           {"routes_done", simulation.routesDone()},
           {"elapsed_ms", elapsed.count()}}};
}

}  // namespace
}  // namespace cornerstone

int main(int argc, char** argv) {
  using namespace cornerstone;
  return runProgram("simulate_bag", [&] {
    const Arguments arguments(argc, argv, kUsage, 1, {"out", "seed", "duration", "robots", "params"});
    try {
      return simulate(arguments);
    } catch (const rosbag::BagException& error) {
      throw InputError(arguments.text("out") + ": " + error.what());
    }
  });
}
