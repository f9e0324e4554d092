// Buildings that are like themselves under a motion other than rest, drawn for tests and benchmarks, and what
// two robots see of them that share a part. The motion lays one robot's map on the other's at a wrong pose.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "drawn_maps.h"

namespace cornerstone {

enum class Likeness {
  kHalfTurn,  // an office that is its own half turn: every room is unlike the others but one
  kRow,       // like rooms in a row
  kRing,      // a ring of corridors with like rooms on its four sides
  kWings      // two like wings, each of rooms unlike one another
};

struct SelfSimilar {
  Likeness likeness = Likeness::kHalfTurn;
  int furniture = 0;  // pieces that stand where no motion of the building lays one
  unsigned seed = 1;
};

struct SelfSimilarBuilding {
  DrawnWorld world;
  double length_m = 0;                 // along x, from 0 on
  std::vector<Eigen::Vector2d> stops;  // where a robot looks around
};

namespace self_similar {

using Uniform = std::uniform_real_distribution<double>;

constexpr double kWall_m = 0.2, kCorridor_m = 2, kDoor_m = 0.9;

inline void addStops(SelfSimilarBuilding& building, const DrawnBox& corridor) {
  for (double x = corridor.low_x_m + 0.75; x < corridor.high_x_m; x += 1.5)
    for (double y = corridor.low_y_m + 0.75; y < corridor.high_y_m; y += 1.5)
      building.stops.emplace_back(x, y);
}

// A room with its door towards a corridor that ends at y, above it (up = 1) or below it (-1).
struct Room {
  double low_x_m, width_m, depth_m, table_m;  // table: 0 none, else its width, in the far corner
};
inline void addRoom(SelfSimilarBuilding& building, const Room& room, double y, int up) {
  const auto box = [&](double x0, double x1, double from, double to) {
    return up > 0 ? DrawnBox{x0, y + from, x1, y + to} : DrawnBox{x0, y - to, x1, y - from};
  };
  const double right = room.low_x_m + room.width_m - kWall_m, far = kWall_m + room.depth_m;
  building.world.rooms.push_back(box(room.low_x_m, right, kWall_m, far));
  building.world.rooms.push_back(box(room.low_x_m + 0.5, room.low_x_m + 0.5 + kDoor_m, 0, kWall_m));
  if (room.table_m > 0) building.world.solids.push_back(box(right - room.table_m, right, far - 0.8, far));
  building.stops.emplace_back(room.low_x_m + 0.95, y + up * 1.2);
  building.stops.emplace_back(0.5 * (room.low_x_m + right), y + up * 0.5 * far);
}

// Everything once more, turned by half about a point.
inline void addHalfTurn(SelfSimilarBuilding& building, const Eigen::Vector2d& about) {
  const auto turned = [&](const DrawnBox& b) {
    return DrawnBox{2 * about.x() - b.high_x_m, 2 * about.y() - b.high_y_m, 2 * about.x() - b.low_x_m,
                    2 * about.y() - b.low_y_m};
  };
  for (std::vector<DrawnBox>* boxes : {&building.world.rooms, &building.world.solids})
    for (std::size_t i = 0, count = boxes->size(); i < count; ++i) boxes->push_back(turned((*boxes)[i]));
  for (std::size_t i = 0, count = building.stops.size(); i < count; ++i)
    building.stops.emplace_back(2 * about - building.stops[i]);
}

inline void addShifted(SelfSimilarBuilding& building, double by_m) {
  for (std::vector<DrawnBox>* boxes : {&building.world.rooms, &building.world.solids})
    for (std::size_t i = 0, count = boxes->size(); i < count; ++i) {
      const DrawnBox b = (*boxes)[i];
      boxes->push_back({b.low_x_m + by_m, b.low_y_m, b.high_x_m + by_m, b.high_y_m});
    }
  for (std::size_t i = 0, count = building.stops.size(); i < count; ++i)
    building.stops.emplace_back(building.stops[i] + Eigen::Vector2d(by_m, 0));
}

// Rooms of any width, as many as fit into a length.
inline void addUnlikeRooms(SelfSimilarBuilding& building, double length_m, double y, int up,
                           std::mt19937& random) {
  Uniform width(3, 6), depth(3, 5), table(-1, 2);
  for (double x = 0; x < length_m;) {
    double next = x + width(random);
    if (next > length_m - 3) next = length_m;
    addRoom(building, {x, next - x, depth(random), table(random)}, y, up);
    x = next;
  }
}

inline SelfSimilarBuilding halfTurnOffice(std::mt19937& random) {
  SelfSimilarBuilding building;
  building.length_m = Uniform(24, 36)(random);
  addUnlikeRooms(building, building.length_m, kCorridor_m, 1, random);
  addHalfTurn(building, {building.length_m / 2, kCorridor_m / 2});
  building.world.rooms.push_back({0, 0, building.length_m, kCorridor_m});
  addStops(building, building.world.rooms.back());
  return building;
}

inline SelfSimilarBuilding rowOfRooms(std::mt19937& random) {
  SelfSimilarBuilding building;
  const double width_m = Uniform(3.5, 5)(random), depth_m = Uniform(3.5, 5)(random);
  const double table_m = Uniform(0.5, 2)(random);
  const int rooms = 8;
  building.length_m = rooms * width_m;
  for (int i = 0; i < rooms; ++i) addRoom(building, {i * width_m, width_m, depth_m, table_m}, kCorridor_m, 1);
  building.world.rooms.push_back({0, 0, building.length_m, kCorridor_m});
  addStops(building, building.world.rooms.back());
  return building;
}

inline SelfSimilarBuilding ring(std::mt19937& random) {
  SelfSimilarBuilding building;
  const double width_m = Uniform(3.5, 5)(random), depth_m = Uniform(3, 4.5)(random);
  const double side_m = 4 * width_m, middle_m = 0.5 * side_m;
  for (int i = 0; i < 4; ++i) addRoom(building, {i * width_m, width_m, depth_m, 1}, middle_m, 1);
  addHalfTurn(building, {middle_m, 0});
  const std::size_t count = building.world.rooms.size(), solids = building.world.solids.size();
  const auto quarter = [&](const DrawnBox& b) {  // about the ring's middle
    return DrawnBox{middle_m - b.high_y_m, b.low_x_m - middle_m, middle_m - b.low_y_m, b.high_x_m - middle_m};
  };
  for (std::size_t i = 0; i < count; ++i) building.world.rooms.push_back(quarter(building.world.rooms[i]));
  for (std::size_t i = 0; i < solids; ++i) building.world.solids.push_back(quarter(building.world.solids[i]));
  for (std::size_t i = 0, stops = building.stops.size(); i < stops; ++i)
    building.stops.emplace_back(middle_m - building.stops[i].y(), building.stops[i].x() - middle_m);
  for (const DrawnBox& corridor :
       {DrawnBox{0, middle_m - kCorridor_m, side_m, middle_m},
        DrawnBox{0, -middle_m, side_m, kCorridor_m - middle_m}, DrawnBox{0, -middle_m, kCorridor_m, middle_m},
        DrawnBox{side_m - kCorridor_m, -middle_m, side_m, middle_m}}) {
    building.world.rooms.push_back(corridor);
    addStops(building, corridor);
  }
  building.length_m = side_m;
  return building;
}

inline SelfSimilarBuilding wings(std::mt19937& random) {
  SelfSimilarBuilding building;
  const double wing_m = Uniform(11, 16)(random), link_m = Uniform(4, 8)(random);
  addUnlikeRooms(building, wing_m, kCorridor_m, 1, random);
  addUnlikeRooms(building, wing_m, 0, -1, random);
  addShifted(building, wing_m + link_m);
  building.length_m = 2 * wing_m + link_m;
  building.world.rooms.push_back({0, 0, building.length_m, kCorridor_m});
  addStops(building, building.world.rooms.back());
  return building;
}

}  // namespace self_similar

inline SelfSimilarBuilding drawnBuilding(const SelfSimilar& what) {
  std::mt19937 random(what.seed);
  SelfSimilarBuilding building = what.likeness == Likeness::kHalfTurn ? self_similar::halfTurnOffice(random)
                                 : what.likeness == Likeness::kRow    ? self_similar::rowOfRooms(random)
                                 : what.likeness == Likeness::kRing   ? self_similar::ring(random)
                                                                      : self_similar::wings(random);
  const std::vector<DrawnBox> rooms = building.world.rooms;
  self_similar::Uniform share(0, 1), size(0.4, 1.2);
  for (int placed = 0; placed < what.furniture;) {
    const DrawnBox& room = rooms[random() % rooms.size()];
    const double width = size(random), depth = size(random);
    const double free_x = room.high_x_m - room.low_x_m - width, free_y = room.high_y_m - room.low_y_m - depth;
    const double x = room.low_x_m + share(random) * free_x, y = room.low_y_m + share(random) * free_y;
    if (free_x < 1 || free_y < 1) continue;  // a door
    building.world.solids.push_back({x, y, x + width, y + depth});
    ++placed;
  }
  return building;
}

// How a robot looks around at its stops.
struct LookAround {
  int looks = 1;  // headings at a stop, at random
  double opening_rad = 2 * M_PI;
  double range_m = 15;
};
inline LookAround laserLook() { return {}; }
inline LookAround narrowLook() { return {3, 60 * M_PI / 180, 5}; }

// What of a drawn map is seen from stops, given in the map's frame: rays end at the first wall.
inline GridMap seenFrom(const GridMap& map, const std::vector<Eigen::Vector2d>& stops, const LookAround& look,
                        unsigned seed) {
  GridMap seen = map;
  seen.occupied = cv::Mat1f(map.occupied.size(), kUnseen);
  std::mt19937 random(seed);
  self_similar::Uniform heading(-M_PI, M_PI);
  const double step = 0.5 * map.geometry.resolution_m;
  for (const Eigen::Vector2d& stop : stops)
    for (int i = 0; i < look.looks; ++i) {
      const double first = heading(random);
      for (double turn = 0; turn < look.opening_rad; turn += map.geometry.resolution_m / look.range_m) {
        const Eigen::Vector2d way(std::cos(first + turn), std::sin(first + turn));
        for (double along = 0; along < look.range_m; along += step) {
          const Cell cell = map.geometry.cellAt(stop + along * way);
          if (!map.geometry.contains(cell)) break;
          const float probability = map.occupied(cell.row, cell.col);
          if (probability == kUnseen) break;
          seen.occupied(cell.row, cell.col) = probability;
          if (probability > 0.5f) break;
        }
      }
    }
  return seen;
}

struct SharedViews {
  GridMap reference, current;
  Pose2 reference_from_current;
};

// Two robots' maps of a building, one of each end, of which they share a part: `share` of its length.
inline SharedViews viewsOf(const SelfSimilarBuilding& building, double share, const LookAround& look,
                           unsigned seed) {
  std::mt19937 random(seed);
  self_similar::Uniform turn(-M_PI, M_PI);
  const auto view = [&](const DrawnBox& part) {
    const Pose2 world_from_map{turn(random), turn(random), turn(random)};
    const GridMap whole = draw(building.world, {world_from_map, part, 0.02, static_cast<unsigned>(random())});
    std::vector<Eigen::Vector2d> stops;
    for (const Eigen::Vector2d& stop : building.stops)
      if (part.contains(stop) && building.world.isFree(stop))
        stops.push_back(world_from_map.inverse() * stop);
    return std::pair(seenFrom(whole, stops, look, static_cast<unsigned>(random())), world_from_map);
  };
  const double end_m = 0.5 * (1 + share) * building.length_m, start_m = 0.5 * (1 - share) * building.length_m;
  const auto [reference, there] = view({-1e3, -1e3, end_m, 1e3});
  const auto [current, here] = view({start_m, -1e3, 1e3, 1e3});
  return {reference, current, there.inverse() * here};
}

}  // namespace cornerstone
