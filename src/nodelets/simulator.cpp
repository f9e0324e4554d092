// A world, its robots and their cameras. Gives /clock, and for every robot {reference,right,top}/{image_rect,
// camera_info}, odom, ground_truth, collisions; tf odom -> base_link; world (latched), real_time_factor,
// simulation_done (latched). Takes <robot>/cmd_vel when routes are not followed.
#include <geometry_msgs/Twist.h>
#include <rosgraph_msgs/Clock.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float32.h>
#include <std_msgs/String.h>
#include <tf2_ros/transform_broadcaster.h>
#include <pluginlib/class_list_macros.hpp>

#include <atomic>
#include <chrono>
#include <future>
#include <map>
#include <mutex>
#include <thread>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/params.h"
#include "cornerstone/ros/simulation_messages.h"
#include "nodelets/factories.h"
#include "nodelets/nodelet_start.h"

namespace cornerstone {
namespace {

using Clock = std::chrono::steady_clock;

// The simulation may catch up after a hiccup of this length; what is longer is lost, never run through in a
// rush.
constexpr std::chrono::milliseconds kCatchUp{100};
constexpr double kReportPeriod_s = 1.0;

double secondsBetween(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

struct CameraPublishers {
  ros::Publisher image, info;
};

struct RobotPublishers {
  std::array<CameraPublishers, kCameraCount> cameras;
  ros::Publisher odometry, ground_truth, collisions;
  ros::Subscriber command;
};

}  // namespace

class SimulatorNodelet : public nodelet::Nodelet {
 public:
  ~SimulatorNodelet() override {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  void onInit() override {
    startOrRefuse(getName(), [this] { start(); });
  }

  void start() {
    params_ = loadParams<SimulatorParams>(getPrivateNodeHandle());
    requirePositive(params_.rate_factor, "parameter 'rate_factor'");
    requirePositive(params_.start_s, "parameter 'start_s'");
    requireWithin(params_.start_delay_s, 0, 3600, "parameter 'start_delay_s'");
    // The renderer lives and dies in the thread that uses it; its refusals must still stop the start here.
    std::promise<void> started;
    auto refused = started.get_future();
    thread_ = std::thread([this, &started] { run(started); });
    try {
      refused.get();
    } catch (...) {
      thread_.join();
      throw;
    }
  }

  void run(std::promise<void>& started) {
    std::unique_ptr<Simulation> simulation;
    try {
      const World world = loadWorld(params_.world);
      simulation = std::make_unique<Simulation>(world, params_.simulation);
      advertise(*simulation, world);
    } catch (...) {
      started.set_exception(std::current_exception());
      return;
    }
    started.set_value();
    try {
      loop(*simulation);
    } catch (const std::exception& error) {
      NODELET_FATAL_STREAM("the simulation has stopped: " << error.what());
    }
  }

  void advertise(const Simulation& simulation, const World& world) {
    ros::NodeHandle& node = getNodeHandle();
    clock_publisher_ = node.advertise<rosgraph_msgs::Clock>("/clock", 10);
    world_publisher_ = node.advertise<std_msgs::String>("world", 1, true);
    factor_publisher_ = node.advertise<std_msgs::Float32>("real_time_factor", 10);
    done_publisher_ = node.advertise<std_msgs::Bool>("simulation_done", 1, true);
    for (const std::string& name : simulation.robotNames()) advertiseRobot(node, name);
    std_msgs::String text;
    text.data = world.yaml_text;
    world_publisher_.publish(text);
    calibrations_ = calibrationsOf(params_.simulation.rig);
  }

  void advertiseRobot(ros::NodeHandle& node, const std::string& name) {
    RobotPublishers& robot = robots_[name];
    for (std::size_t i = 0; i < kCameraCount; ++i) {
      const std::string camera = name + "/" + kCameraNames[i];
      robot.cameras[i].image = node.advertise<sensor_msgs::Image>(camera + "/image_rect", 5);
      robot.cameras[i].info = node.advertise<sensor_msgs::CameraInfo>(camera + "/camera_info", 5);
    }
    robot.odometry = node.advertise<nav_msgs::Odometry>(name + "/odom", 50);
    robot.ground_truth = node.advertise<nav_msgs::Odometry>(name + "/ground_truth", 50);
    robot.collisions = node.advertise<std_msgs::UInt32>(name + "/collisions", 1, true);
    robot.command = node.subscribe<geometry_msgs::Twist>(
        name + "/cmd_vel", 1,
        [this, name](const geometry_msgs::TwistConstPtr& twist) { takeCommand(name, *twist); });
  }

  void takeCommand(const std::string& robot, const geometry_msgs::Twist& twist) {
    if (!std::isfinite(twist.linear.x) || !std::isfinite(twist.angular.z)) {
      NODELET_ERROR_STREAM_THROTTLE(10, robot << "/cmd_vel: not finite, dropped");
      return;
    }
    const std::lock_guard<std::mutex> lock(commands_mutex_);
    commands_[robot] = {twist.linear.x, twist.angular.z};
  }

  void loop(Simulation& simulation) {
    publish(simulation);
    Clock::time_point due = Clock::now(), window_start = due;
    const auto step = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(simulation.step_s() / params_.rate_factor));
    double window_start_s = 0;
    while (!stop_ && ros::ok()) {
      due = std::max(due + step, Clock::now() - std::chrono::duration_cast<Clock::duration>(kCatchUp));
      std::this_thread::sleep_until(due);
      simulation.holdRoutes(!ready(simulation));
      passCommands(simulation);
      simulation.step();
      publish(simulation);
      const auto now = Clock::now();
      if (secondsBetween(window_start, now) < kReportPeriod_s) continue;
      std_msgs::Float32 factor;
      factor.data = float((simulation.time_s() - window_start_s) / secondsBetween(window_start, now));
      factor_publisher_.publish(factor);
      window_start = now;
      window_start_s = simulation.time_s();
    }
  }

  bool ready(const Simulation& simulation) {
    if (ready_) return true;
    if (simulation.time_s() < params_.start_delay_s) return false;
    for (const auto& [name, robot] : robots_)
      if (params_.wait_for_subscribers && robot.cameras[0].image.getNumSubscribers() == 0) return false;
    return ready_ = true;
  }

  void passCommands(Simulation& simulation) {
    const std::lock_guard<std::mutex> lock(commands_mutex_);
    for (const auto& [robot, twist] : commands_) simulation.command(robot, twist);
    commands_.clear();
  }

  void publish(Simulation& simulation) {
    const ros::Time stamp = stampOf(params_, simulation.time_s());
    rosgraph_msgs::Clock clock;
    clock.clock = stamp;
    clock_publisher_.publish(clock);
    std::vector<geometry_msgs::TransformStamped> transforms;
    const auto frames = simulation.frames(simulation.frameDue());
    for (const RobotFrame& frame : frames) transforms.push_back(publishMotion(frame, stamp));
    broadcaster_.sendTransform(transforms);
    for (const RobotFrame& frame : frames) publishCameras(frame, stamp);
    if (params_.simulation.follow_routes && simulation.routesDone() && !done_published_) {
      std_msgs::Bool done;
      done.data = true;
      done_publisher_.publish(done);
      done_published_ = true;
    }
  }

  geometry_msgs::TransformStamped publishMotion(const RobotFrame& frame, const ros::Time& stamp) {
    RobotPublishers& robot = robots_.at(frame.robot);
    const MotionMessages messages = motionMessages(frame, stamp);
    robot.odometry.publish(messages.odometry);
    robot.ground_truth.publish(messages.ground_truth);
    if (collisions_.count(frame.robot) == 0 || collisions_[frame.robot] != frame.collisions) {
      collisions_[frame.robot] = frame.collisions;
      std_msgs::UInt32 count;
      count.data = unsigned(frame.collisions);
      robot.collisions.publish(count);
    }
    return messages.odom_from_base;
  }

  void publishCameras(const RobotFrame& frame, const ros::Time& stamp) {
    RobotPublishers& robot = robots_.at(frame.robot);
    const auto cameras = cameraMessages(frame, calibrations_, stamp);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      robot.cameras[i].info.publish(cameras[i].info);
      robot.cameras[i].image.publish(cameras[i].image);
    }
  }

  SimulatorParams params_;
  std::array<CameraCalibration, kCameraCount> calibrations_;
  std::map<std::string, RobotPublishers> robots_;
  std::map<std::string, int> collisions_;  // as published
  ros::Publisher clock_publisher_, world_publisher_, factor_publisher_, done_publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::mutex commands_mutex_;
  std::map<std::string, Twist2> commands_;
  bool ready_ = false;
  bool done_published_ = false;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

std::unique_ptr<nodelet::Nodelet> makeSimulator() { return std::make_unique<SimulatorNodelet>(); }

}  // namespace cornerstone

PLUGINLIB_EXPORT_CLASS(cornerstone::SimulatorNodelet, nodelet::Nodelet)
