// Drives a scripted route: turn on the spot towards a point, drive there and brake, turn by an angle, wait.
// It steers on the true pose (it is the scenario, not the robot's own skill). Speeds within the route's and
// the vehicle's limits.
#pragma once

#include "cornerstone/simulation/vehicle.h"
#include "cornerstone/simulation/world.h"

namespace cornerstone {

class RouteDriver {
 public:
  RouteDriver(const ScenarioRobot& robot, const VehicleParams& vehicle);
  Twist2 drive(const Pose2& world_from_base, const Twist2& twist, double time_s);
  bool done() const { return step_ >= robot_.route.size(); }

 private:
  Twist2 driveTo(const Eigen::Vector2d& to_m, const Pose2& world_from_base);
  Twist2 turn(double turn_rad, const Pose2& world_from_base, const Twist2& twist);
  double turnRateFor(double remaining_rad) const;
  void next();

  ScenarioRobot robot_;
  VehicleParams vehicle_;
  std::size_t step_ = 0;
  bool aligned_ = false;  // driveTo: heading found, on the way
  bool started_ = false;  // turn, wait: the two below are valid
  double last_yaw_rad_ = 0;
  double turned_rad_ = 0;
  double wait_until_s_ = 0;
};

}  // namespace cornerstone
