// Reads a world's YAML through a strict map reader: every key is asked for by name, and none may be left
// over.
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "cornerstone/base/errors.h"
#include "cornerstone/simulation/world.h"
#include "map_extrusion.h"
#include "strict_yaml.h"

namespace cornerstone {
namespace {

double lengthOf(StrictMap& map, const std::string& key) {
  const double value = map.number(key);
  requirePositive(value, map.nameOf(key));
  return value;
}

double radians(double degrees) { return degrees * M_PI / 180; }

Material materialOf(StrictMap& map, const std::string& key) {
  static const std::map<std::string, Material> names{
      {"plaster", Material::kPlaster}, {"paint", Material::kPaint},     {"concrete", Material::kConcrete},
      {"wood", Material::kWood},       {"metal", Material::kMetal},     {"cabinet", Material::kCabinet},
      {"fabric", Material::kFabric},   {"books", Material::kBooks},     {"poster", Material::kPoster},
      {"carpet", Material::kCarpet},   {"ceiling", Material::kCeiling}, {"robot", Material::kRobot},
      {"stripes", Material::kStripes}};
  const std::string name = map.text(key);
  const auto found = names.find(name);
  if (found == names.end()) throw InputError(map.nameOf(key) + ": unknown material '" + name + "'");
  return found->second;
}

Eigen::Vector2d pointOf(StrictMap& map, const std::string& key) {
  const auto numbers = map.numbers(key, 2);
  return {numbers[0], numbers[1]};
}

Eigen::Vector3d sizeOf(StrictMap& map, const std::string& key) {
  const auto numbers = map.numbers(key, 3);
  for (const double number : numbers) requirePositive(number, map.nameOf(key));
  return {numbers[0], numbers[1], numbers[2]};
}

Wall readWall(StrictMap& map) {
  Wall wall;
  for (const auto& row : map.rows("points_m", 2)) wall.points_m.emplace_back(row[0], row[1]);
  if (wall.points_m.size() < 2) throw InputError(map.nameOf("points_m") + ": a wall needs two points");
  for (std::size_t i = 1; i < wall.points_m.size(); ++i)
    requirePositive((wall.points_m[i] - wall.points_m[i - 1]).norm(),
                    map.nameOf("points_m") + ": distance of neighbours");
  if (map.has("closed")) wall.closed = map.flag("closed");
  wall.height_m = lengthOf(map, "height_m");
  wall.thickness_m = lengthOf(map, "thickness_m");
  wall.material = materialOf(map, "material");
  return wall;
}

Door readDoor(StrictMap& map) {
  Door door;
  door.at_m = pointOf(map, "at_m");
  door.yaw_rad = radians(map.number("yaw_deg"));
  door.width_m = lengthOf(map, "width_m");
  door.height_m = lengthOf(map, "height_m");
  door.open_rad = radians(map.number("open_deg"));
  return door;
}

Box readBox(StrictMap& map) {
  Box box;
  box.at_m = pointOf(map, "at_m");
  box.yaw_rad = radians(map.number("yaw_deg"));
  box.size_m = sizeOf(map, "size_m");
  if (map.has("z_m")) box.z_m = map.number("z_m");
  requireWithin(box.z_m, 0, 100, map.nameOf("z_m"));
  box.material = materialOf(map, "material");
  return box;
}

Poster readPoster(StrictMap& map) {
  Poster poster;
  poster.at_m = pointOf(map, "at_m");
  poster.facing_rad = radians(map.number("facing_deg"));
  const auto size = map.numbers("size_m", 2);
  poster.width_m = size[0];
  poster.height_m = size[1];
  requirePositive(size[0], map.nameOf("size_m"));
  requirePositive(size[1], map.nameOf("size_m"));
  poster.centre_z_m = lengthOf(map, "centre_z_m");
  return poster;
}

Mover readMover(StrictMap& map) {
  Mover mover;
  mover.name = map.text("name");
  mover.size_m = sizeOf(map, "size_m");
  mover.material = materialOf(map, "material");
  for (const auto& row : map.rows("path_s_m_m", 3)) mover.path.push_back({row[0], {row[1], row[2]}});
  if (mover.path.size() < 2) throw InputError(map.nameOf("path_s_m_m") + ": a path needs two points");
  for (std::size_t i = 1; i < mover.path.size(); ++i)
    requirePositive(mover.path[i].time_s - mover.path[i - 1].time_s,
                    map.nameOf("path_s_m_m") + ": time step");
  return mover;
}

RouteStep readStep(StrictMap& map) {
  RouteStep step;
  if (map.has("to_m")) step.to_m = pointOf(map, "to_m");
  if (map.has("turn_deg")) step.turn_rad = radians(map.number("turn_deg"));
  if (map.has("wait_s")) step.wait_s = lengthOf(map, "wait_s");
  if (int{step.to_m.has_value()} + int{step.turn_rad.has_value()} + int{step.wait_s.has_value()} != 1)
    throw InputError(map.nameOf("") + ": a route step has one of 'to_m', 'turn_deg', 'wait_s'");
  return step;
}

ScenarioRobot readRobot(StrictMap& map) {
  ScenarioRobot robot;
  robot.name = map.text("name");
  if (robot.name.empty()) throw InputError(map.nameOf("name") + " is empty");
  const auto start = map.numbers("start_m_m_deg", 3);
  robot.world_from_start = {start[0], start[1], wrapAngle(radians(start[2]))};
  robot.speed_m_s = lengthOf(map, "speed_m_s");
  robot.turn_rate_rad_s = radians(lengthOf(map, "turn_rate_deg_s"));
  map.each("route", [&](StrictMap& step) { robot.route.push_back(readStep(step)); });
  return robot;
}

// Whoever rebuilds the world from its published text does not know the folder that the map's name hangs on.
std::string withAbsoluteMapFile(const std::string& yaml_text, const std::string& directory) {
  YAML::Node world = YAML::Load(yaml_text);
  const auto file = world["map"]["file"].as<std::string>();
  world["map"]["file"] = std::filesystem::absolute(std::filesystem::path(directory) / file).string();
  return YAML::Dump(world);
}

}  // namespace

World parseWorld(const std::string& yaml_text, const std::string& where, const std::string& directory) {
  World world;
  world.yaml_text = yaml_text;
  StrictMap map = StrictMap::ofText(yaml_text, where);
  world.name = map.text("name");
  const double seed = map.number("seed");
  requireWithin(seed, 0, 1e15, map.nameOf("seed"));
  world.seed = static_cast<std::uint64_t>(seed);
  const auto extent = map.numbers("extent_m", 4);
  world.min_m = {extent[0], extent[1]};
  world.max_m = {extent[2], extent[3]};
  requirePositive(extent[2] - extent[0], map.nameOf("extent_m") + ": x extent");
  requirePositive(extent[3] - extent[1], map.nameOf("extent_m") + ": y extent");
  world.ceiling_m = lengthOf(map, "ceiling_m");
  if (map.has("walls")) map.each("walls", [&](StrictMap& m) { world.walls.push_back(readWall(m)); });
  if (map.has("doors")) map.each("doors", [&](StrictMap& m) { world.doors.push_back(readDoor(m)); });
  if (map.has("boxes")) map.each("boxes", [&](StrictMap& m) { world.boxes.push_back(readBox(m)); });
  if (map.has("posters")) map.each("posters", [&](StrictMap& m) { world.posters.push_back(readPoster(m)); });
  if (map.has("movers")) map.each("movers", [&](StrictMap& m) { world.movers.push_back(readMover(m)); });
  if (map.has("map")) {
    StrictMap inner = map.inner("map");
    world.map_solids = extrudeMap(inner, directory, materialOf(inner, "material"));
    inner.requireAllRead();
    world.yaml_text = withAbsoluteMapFile(yaml_text, directory);
  }
  std::set<std::string> names;
  map.each("robots", [&](StrictMap& m) {
    world.robots.push_back(readRobot(m));
    if (!names.insert(world.robots.back().name).second) throw InputError(m.nameOf("name") + ": given twice");
  });
  map.requireAllRead();
  return world;
}

World loadWorld(const std::string& yaml_path) {
  std::ifstream file(yaml_path);
  if (!file) throw InputError(yaml_path + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  const auto slash = yaml_path.find_last_of('/');
  return parseWorld(text.str(), yaml_path, slash == std::string::npos ? "." : yaml_path.substr(0, slash));
}

}  // namespace cornerstone
