#include "cornerstone/simulation/simulation.h"

#include <algorithm>
#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr double kFloorUnevenness_m = 0.03;  // lower things (door sills) are driven over

// Different generators for every use, from the one seed (splitmix64).
std::uint64_t seedFor(int seed, std::uint64_t use) {
  std::uint64_t mixed =
      std::uint64_t(seed) * 0x9E3779B97F4A7C15U + use * 0xBF58476D1CE4E5B9U + 0x94D049BB133111EBU;
  mixed = (mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9U;
  mixed = (mixed ^ (mixed >> 27)) * 0x94D049BB133111EBU;
  return mixed ^ (mixed >> 31);
}

Eigen::Isometry3d spatial(const Pose2& pose) {
  Eigen::Isometry3d isometry = Eigen::Isometry3d::Identity();
  isometry.linear() = Eigen::AngleAxisd(pose.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  isometry.translation() = Eigen::Vector3d(pose.x_m, pose.y_m, 0);
  return isometry;
}

Solid moverBody(const Mover& mover) {
  return boxSolid({Eigen::Vector2d::Zero(), 0, mover.size_m, 0, mover.material});
}

}  // namespace

Solid robotBody(const VehicleParams& vehicle) {
  Solid body{{}, 0.03, vehicle.height_m, Material::kRobot, false};
  constexpr int kSides = 8;
  for (int i = 0; i < kSides; ++i) {
    const double angle = (i + 0.5) * 2 * M_PI / kSides;
    body.polygon_m.emplace_back(vehicle.radius_m * std::cos(angle), vehicle.radius_m * std::sin(angle));
  }
  return body;
}

struct Simulation::Robot {
  Robot(const ScenarioRobot& scenario, const SimulationParams& params, std::uint64_t index)
      : name(scenario.name),
        vehicle(params.vehicle, scenario.world_from_start),
        driver(scenario, params.vehicle),
        odometry(params.odometry, seedFor(params.seed, 2 * index)),
        faults(params.cameras, focalLength(params.rig), seedFor(params.seed, 2 * index + 1)) {}

  std::string name;
  Vehicle vehicle;
  RouteDriver driver;
  Odometry odometry;
  CameraFaults faults;
  int collisions = 0;
  bool touching = false;
};

void describe(ParamVisitor& visitor, SimulationParams& params) {
  visitor.field("seed", params.seed);
  visitor.field("steps_per_second", params.steps_per_second);
  visitor.field("steps_per_frame", params.steps_per_frame);
  visitor.field("supersampling", params.supersampling);
  visitor.field("follow_routes", params.follow_routes);
  visitor.field("robots_visible", params.robots_visible);
  visitor.field("robots", params.robots);
  visitor.group("rig", [&] { describe(visitor, params.rig); });
  visitor.group("cameras", [&] { describe(visitor, params.cameras); });
  visitor.group("vehicle", [&] { describe(visitor, params.vehicle); });
  visitor.group("odometry", [&] { describe(visitor, params.odometry); });
}

Simulation::Simulation(const World& world, const SimulationParams& params)
    : params_(params),
      world_(world),
      obstacles_(solidsOf(world), {kFloorUnevenness_m, params.vehicle.height_m}) {
  requireWithin(params.steps_per_second, 1, 1000, "steps_per_second");
  requireWithin(params.steps_per_frame, 1, 1000, "steps_per_frame");
  requireWithin(params.supersampling, 1, 8, "supersampling");
  for (const std::string& name : params.robots) {
    const auto has_name = [&](const ScenarioRobot& robot) { return robot.name == name; };
    if (std::none_of(world.robots.begin(), world.robots.end(), has_name))
      throw InputError("robots: world '" + world.name + "' has no robot '" + name + "'");
  }
  // A robot's faults go by its place in the world file: the same whether or not others take part.
  for (std::size_t i = 0; i < world.robots.size(); ++i) {
    const auto& wanted = params.robots;
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), world.robots[i].name) == wanted.end())
      continue;
    robots_.emplace_back(world.robots[i], params, i);
    if (collides(robots_.back()))
      throw InputError("world '" + world.name + "': robot '" + world.robots[i].name +
                       "' starts in an obstacle");
  }
  if (robots_.empty()) throw InputError("world '" + world.name + "': 'robots' is empty");
  std::vector<MovingBody> bodies(robots_.size(), MovingBody{robotBody(params.vehicle)});
  for (const Mover& mover : world.movers) bodies.push_back({moverBody(mover)});
  const double centre_x = (params.rig.width_px - 1) / 2.0, centre_y = (params.rig.height_px - 1) / 2.0;
  const cv::Size size(params.rig.width_px, params.rig.height_px);
  world_.seed = seedFor(params.seed, world.seed);
  renderer_ = std::make_unique<Renderer>(
      world_, bodies, RendererSetup{size, focalLength(params.rig), centre_x, centre_y, params.supersampling});
}

Simulation::~Simulation() = default;

std::vector<std::string> Simulation::robotNames() const {
  std::vector<std::string> names;
  for (const Robot& robot : robots_) names.push_back(robot.name);
  return names;
}

void Simulation::step() {
  for (Robot& robot : robots_) {
    if (params_.follow_routes && !held_)
      robot.vehicle.command(
          robot.driver.drive(robot.vehicle.worldFromBase(), robot.vehicle.twist(), time_s()), time_s());
    const Pose2 before = robot.vehicle.worldFromBase();
    robot.vehicle.step(time_s(), step_s());
    checkCollision(robot, before);
    robot.odometry.move(before.inverse() * robot.vehicle.worldFromBase());
  }
  ++steps_;
}

// A robot that touches something stands still there; every new touch counts once.
void Simulation::checkCollision(Robot& robot, const Pose2& before) {
  const bool touching = collides(robot);
  if (touching && !robot.touching) ++robot.collisions;
  if (touching) {
    // It may still turn on the spot, and back out.
    robot.vehicle.moveTo({before.x_m, before.y_m, robot.vehicle.worldFromBase().yaw_rad});
  }
  robot.touching = touching;
}

bool Simulation::collides(const Robot& robot) const {
  const Eigen::Vector2d at_m = robot.vehicle.worldFromBase().translation();
  if (obstacles_.distanceTo(at_m) < params_.vehicle.radius_m) return true;
  for (const Robot& other : robots_) {
    if (&other == &robot) continue;
    if ((other.vehicle.worldFromBase().translation() - at_m).norm() < 2 * params_.vehicle.radius_m)
      return true;
  }
  for (const Mover& mover : world_.movers) {
    // The mover's box, in its own frame.
    const Eigen::Vector2d own_m = worldFromMover(mover, time_s()).inverse() * at_m;
    const Eigen::Vector2d half_m = mover.size_m.head<2>() / 2;
    const Eigen::Vector2d outside_m = (own_m.cwiseAbs() - half_m).cwiseMax(0);
    if (outside_m.norm() < params_.vehicle.radius_m) return true;
  }
  return false;
}

void Simulation::command(const std::string& robot, const Twist2& twist) {
  requireFinite(twist.v_m_s, robot + "/cmd_vel linear.x");
  requireFinite(twist.w_rad_s, robot + "/cmd_vel angular.z");
  for (Robot& candidate : robots_)
    if (candidate.name == robot) candidate.vehicle.command(twist, time_s());
}

bool Simulation::routesDone() const {
  return std::all_of(robots_.begin(), robots_.end(), [](const Robot& robot) { return robot.driver.done(); });
}

void Simulation::placeBodies() {
  for (std::size_t i = 0; i < robots_.size(); ++i) renderer_->place(i, robots_[i].vehicle.worldFromBase());
  for (std::size_t i = 0; i < world_.movers.size(); ++i)
    renderer_->place(robots_.size() + i, worldFromMover(world_.movers[i], time_s()));
}

std::vector<RobotFrame> Simulation::frames(bool with_images) {
  const auto base_from_cameras = baseFromCameras(params_.rig);
  std::vector<RobotFrame> frames;
  placeBodies();
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    Robot& robot = robots_[i];
    RobotFrame frame;
    frame.robot = robot.name;
    frame.time_s = time_s();
    frame.odom_from_base = robot.odometry.odomFromBase();
    frame.world_from_base = robot.vehicle.worldFromBase();
    frame.twist = robot.vehicle.twist();
    frame.collisions = robot.collisions;
    frame.route_done = robot.driver.done();
    if (with_images && !robot.faults.dropsNext()) {
      for (std::size_t k = 0; k < robots_.size(); ++k) renderer_->show(k, params_.robots_visible && k != i);
      for (std::size_t camera = 0; camera < kCameraCount; ++camera) {
        Eigen::Isometry3d world_from_camera = spatial(frame.world_from_base) * base_from_cameras[camera];
        world_from_camera.linear() = world_from_camera.linear() * robot.faults.misalignment(camera);
        frame.images[camera] = robot.faults.expose(renderer_->render(world_from_camera), camera);
      }
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace cornerstone
