// A simulated building as its YAML file describes it: walls, doors, furniture, posters, moving objects, and
// the robots of the scenario with their routes. World frame: x, y on the floor, z up, metres; yaw
// counter-clockwise. solidsOf() turns all that stands still into upright prisms: the one geometry that the
// renderer draws, that the vehicle collides with and that the ground truth is taken from.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cornerstone/base/pose2.h"

namespace cornerstone {

enum class Material {
  kPlaster,
  kPaint,
  kConcrete,
  kWood,
  kMetal,
  kCabinet,
  kFabric,
  kBooks,
  kPoster,
  kCarpet,
  kCeiling,
  kRobot,
  kStripes
};

// An upright prism on a convex polygon (counter-clockwise).
struct Solid {
  std::vector<Eigen::Vector2d> polygon_m;
  double z_min_m = 0;
  double z_max_m = 0;
  Material material = Material::kPlaster;
  bool fit_texture =
      false;  // the texture fills a face (posters, door leaves); otherwise it has its natural size
};

struct Wall {
  std::vector<Eigen::Vector2d> points_m;  // centre line
  bool closed = false;
  double height_m = 0;
  double thickness_m = 0;
  Material material = Material::kPlaster;
};

// A door frame cut into the wall it stands on, with a leaf hung at its left end (seen along yaw).
struct Door {
  Eigen::Vector2d at_m;  // middle of the opening, on the wall's centre line
  double yaw_rad = 0;    // along the wall
  double width_m = 0;
  double height_m = 0;
  double open_rad = 0;  // 0: closed; positive: the leaf swings counter-clockwise
};

struct Box {
  Eigen::Vector2d at_m;
  double yaw_rad = 0;
  Eigen::Vector3d size_m;
  double z_m = 0;  // of its underside
  Material material = Material::kCabinet;
};

struct Poster {
  Eigen::Vector2d at_m;  // middle of its back, on a wall's surface
  double facing_rad = 0;
  double width_m = 0;
  double height_m = 0;
  double centre_z_m = 0;
};

struct TimedPoint {
  double time_s = 0;
  Eigen::Vector2d at_m;
};

// A box on a timed path, run through again and again; it looks along its way.
struct Mover {
  std::string name;
  Eigen::Vector3d size_m;
  Material material = Material::kFabric;
  std::vector<TimedPoint> path;
};

// One entry of a route: drive to a point, or turn on the spot, or wait.
struct RouteStep {
  std::optional<Eigen::Vector2d> to_m;
  std::optional<double> turn_rad;
  std::optional<double> wait_s;
};

struct ScenarioRobot {
  std::string name;
  Pose2 world_from_start;
  double speed_m_s = 0;
  double turn_rate_rad_s = 0;
  std::vector<RouteStep> route;
};

struct World {
  std::string name;
  std::uint64_t seed = 0;        // of the textures
  Eigen::Vector2d min_m, max_m;  // extent of floor and ceiling
  double ceiling_m = 0;
  std::vector<Wall> walls;
  std::vector<Door> doors;
  std::vector<Box> boxes;
  std::vector<Poster> posters;
  std::vector<Mover> movers;
  std::vector<Solid> map_solids;  // extruded from a map image
  std::vector<ScenarioRobot> robots;
  std::string yaml_text;  // as read: published, so that an evaluation can rebuild the world
};

// Both throw InputError naming file and key: unknown, missing, mistyped, out of range. Relative map file
// names are taken from `directory`.
World loadWorld(const std::string& yaml_path);
World parseWorld(const std::string& yaml_text, const std::string& where, const std::string& directory);

std::vector<Solid> solidsOf(const World& world);
Solid boxSolid(const Box& box);

// Where a mover is at a time.
Pose2 worldFromMover(const Mover& mover, double time_s);

}  // namespace cornerstone
