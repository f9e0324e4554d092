// All robots of a world, stepped together: scripted routes or commands in; images, odometry and true poses
// out. The same world, parameters and seed give the same bytes. Use it in one thread (it owns the renderer).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cornerstone/simulation/camera_rig.h"
#include "cornerstone/simulation/renderer.h"
#include "cornerstone/simulation/route_driver.h"
#include "cornerstone/simulation/true_surfaces.h"
#include "cornerstone/simulation/vehicle.h"

namespace cornerstone {

struct SimulationParams {
  int seed = 1;                     // of every fault, and with the world's own seed of its textures
  int steps_per_second = 50;        // of the motion
  int steps_per_frame = 5;          // motion steps between two image triples: 10 Hz
  int supersampling = 3;            // see Renderer
  bool follow_routes = true;        // false: robots obey command()
  bool robots_visible = true;       // robots see one another
  std::vector<std::string> robots;  // of the world's robots; empty: all
  RigParams rig;
  CameraFaultParams cameras;
  VehicleParams vehicle;
  OdometryParams odometry;
};
void describe(ParamVisitor& visitor, SimulationParams& params);

// What one robot's sensors deliver at one time, and the truth.
struct RobotFrame {
  std::string robot;
  double time_s = 0;                           // since the start
  std::array<cv::Mat1b, kCameraCount> images;  // empty: this triple was dropped
  Pose2 odom_from_base;
  Pose2 world_from_base;
  Twist2 twist;
  int collisions = 0;
  bool route_done = false;
};

class Simulation {
 public:
  // Throws InputError: parameters, unknown robots, a robot that starts in a wall, no off-screen OpenGL.
  Simulation(const World& world, const SimulationParams& params);
  ~Simulation();

  // One step of the motion; afterwards frameDue() tells whether cameras fire now.
  void step();
  bool frameDue() const { return steps_ % params_.steps_per_frame == 0; }
  std::vector<RobotFrame> frames(bool with_images = true);

  void command(const std::string& robot, const Twist2& twist);
  // Scripted robots wait at their starts while held.
  void holdRoutes(bool held) { held_ = held; }
  double time_s() const { return double(steps_) / params_.steps_per_second; }
  double step_s() const { return 1.0 / params_.steps_per_second; }
  bool routesDone() const;
  const SimulationParams& params() const { return params_; }
  std::vector<std::string> robotNames() const;

 private:
  struct Robot;
  void checkCollision(Robot& robot, const Pose2& before);
  bool collides(const Robot& robot) const;
  void placeBodies();

  SimulationParams params_;
  World world_;
  TrueSurfaces obstacles_;
  std::vector<Robot> robots_;
  std::unique_ptr<Renderer> renderer_;
  long steps_ = 0;
  bool held_ = false;
};

// The body of a robot or mover as others see it: an upright prism around its own origin.
Solid robotBody(const VehicleParams& vehicle);

}  // namespace cornerstone
