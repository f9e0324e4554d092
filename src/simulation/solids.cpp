// World -> upright prisms: walls with mitred corners, cut where doors stand; door frames and leaves; boxes;
// posters.
#include <algorithm>
#include <cmath>

#include "cornerstone/simulation/world.h"

namespace cornerstone {
namespace {

constexpr double kFrameWidth_m = 0.06;       // of a door frame's face: what carpenters build
constexpr double kFrameProtrusion_m = 0.02;  // beyond the wall on either side
constexpr double kLeafThickness_m = 0.04;
constexpr double kPosterThickness_m = 0.01;  // enough for the depth buffer, too little to matter in a map

Eigen::Vector2d direction(double yaw_rad) { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }
Eigen::Vector2d leftOf(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

// A rectangle around a centre, x along yaw.
std::vector<Eigen::Vector2d> rectangle(const Eigen::Vector2d& centre_m, double yaw_rad, double length_m,
                                       double width_m) {
  const Eigen::Vector2d along = direction(yaw_rad) * length_m / 2;
  const Eigen::Vector2d across = leftOf(direction(yaw_rad)) * width_m / 2;
  return {centre_m - along - across, centre_m + along - across, centre_m + along + across,
          centre_m - along + across};
}

// The part of the mitre that the wall's left side gets at a vertex, from the directions before and after it.
Eigen::Vector2d mitre(const Eigen::Vector2d& before, const Eigen::Vector2d& after, double half_thickness_m) {
  const Eigen::Vector2d sum = leftOf(before) + leftOf(after);
  // Sharper than about 30 degrees a mitre would run far out: cut it there.
  const double scale = std::max(sum.squaredNorm(), 0.25);
  return sum * (2 * half_thickness_m / scale);
}

struct Interval {
  double from_m, to_m, height_m;
};

// Door openings on a straight piece of wall, in order along it.
std::vector<Interval> openingsOn(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m,
                                 double thickness_m, const std::vector<Door>& doors) {
  const double length_m = (to_m - from_m).norm();
  const Eigen::Vector2d along = (to_m - from_m) / length_m;
  std::vector<Interval> openings;
  for (const Door& door : doors) {
    const Eigen::Vector2d offset_m = door.at_m - from_m;
    const double at_m = offset_m.dot(along);
    const bool on_line = std::abs(offset_m.dot(leftOf(along))) < thickness_m / 2;
    const bool parallel = std::abs(direction(door.yaw_rad).dot(along)) > 0.99;
    if (on_line && parallel && at_m > 0 && at_m < length_m)
      openings.push_back({at_m - door.width_m / 2, at_m + door.width_m / 2, door.height_m});
  }
  std::sort(openings.begin(), openings.end(),
            [](const auto& a, const auto& b) { return a.from_m < b.from_m; });
  return openings;
}

struct WallPiece {
  Eigen::Vector2d from_m, to_m;            // on the centre line
  std::vector<Eigen::Vector2d> outline_m;  // mitred: right from, right to, left to, left from
};

void addWallPiece(const Wall& wall, const WallPiece& piece, const std::vector<Door>& doors,
                  std::vector<Solid>& solids) {
  const auto& [from_m, to_m, outline_m] = piece;
  const Eigen::Vector2d along = (to_m - from_m).normalized();
  const Eigen::Vector2d half = leftOf(along) * wall.thickness_m / 2;
  Eigen::Vector2d right_m = outline_m[0], left_m = outline_m[3];
  for (const Interval& opening : openingsOn(from_m, to_m, wall.thickness_m, doors)) {
    const Eigen::Vector2d begin_m = from_m + along * opening.from_m, end_m = from_m + along * opening.to_m;
    solids.push_back(
        {{right_m, begin_m - half, begin_m + half, left_m}, 0, wall.height_m, wall.material, false});
    right_m = end_m - half;
    left_m = end_m + half;
    if (opening.height_m < wall.height_m)
      solids.push_back({{begin_m - half, right_m, left_m, begin_m + half},
                        opening.height_m,
                        wall.height_m,
                        wall.material,
                        false});
  }
  solids.push_back({{right_m, outline_m[1], outline_m[2], left_m}, 0, wall.height_m, wall.material, false});
}

void addWall(const Wall& wall, const std::vector<Door>& doors, std::vector<Solid>& solids) {
  std::vector<Eigen::Vector2d> points_m = wall.points_m;
  if (wall.closed) points_m.push_back(points_m.front());
  const std::size_t pieces = points_m.size() - 1;
  std::vector<Eigen::Vector2d> along;
  for (std::size_t i = 0; i < pieces; ++i) along.push_back((points_m[i + 1] - points_m[i]).normalized());
  const auto leftOffset = [&](std::size_t vertex) {
    const bool first = vertex == 0, last = vertex == pieces;
    const auto& before = first ? (wall.closed ? along.back() : along.front()) : along[vertex - 1];
    const auto& after = last ? (wall.closed ? along.front() : along.back()) : along[vertex];
    return mitre(before, after, wall.thickness_m / 2);
  };
  for (std::size_t i = 0; i < pieces; ++i) {
    const Eigen::Vector2d from_left = leftOffset(i), to_left = leftOffset(i + 1);
    const std::vector<Eigen::Vector2d> outline_m{points_m[i] - from_left, points_m[i + 1] - to_left,
                                                 points_m[i + 1] + to_left, points_m[i] + from_left};
    addWallPiece(wall, {points_m[i], points_m[i + 1], outline_m}, doors, solids);
  }
}

double thicknessAt(const Door& door, const std::vector<Wall>& walls) {
  for (const Wall& wall : walls) {
    for (std::size_t i = 1; i < wall.points_m.size(); ++i) {
      if (!openingsOn(wall.points_m[i - 1], wall.points_m[i], wall.thickness_m, {door}).empty())
        return wall.thickness_m;
    }
    if (wall.closed &&
        !openingsOn(wall.points_m.back(), wall.points_m.front(), wall.thickness_m, {door}).empty())
      return wall.thickness_m;
  }
  return kLeafThickness_m;
}

void addDoor(const Door& door, double wall_thickness_m, std::vector<Solid>& solids) {
  const Eigen::Vector2d along = direction(door.yaw_rad);
  const double depth_m = wall_thickness_m + 2 * kFrameProtrusion_m;
  const double jamb_m = door.width_m / 2 - kFrameWidth_m / 2;
  for (const double side : {-1.0, 1.0})
    solids.push_back({rectangle(door.at_m + along * side * jamb_m, door.yaw_rad, kFrameWidth_m, depth_m), 0,
                      door.height_m, Material::kMetal, false});
  solids.push_back({rectangle(door.at_m, door.yaw_rad, door.width_m - 2 * kFrameWidth_m, depth_m),
                    door.height_m - kFrameWidth_m, door.height_m, Material::kMetal, false});
  const double leaf_m = door.width_m - 2 * kFrameWidth_m - 0.01;
  const double leaf_yaw = door.yaw_rad + door.open_rad;
  const Eigen::Vector2d hinge_m = door.at_m - along * leaf_m / 2;
  solids.push_back({rectangle(hinge_m + direction(leaf_yaw) * leaf_m / 2, leaf_yaw, leaf_m, kLeafThickness_m),
                    0.01, door.height_m - kFrameWidth_m - 0.01, Material::kWood, true});
}

Solid posterSolid(const Poster& poster) {
  const Eigen::Vector2d centre_m = poster.at_m + direction(poster.facing_rad) * kPosterThickness_m / 2;
  return {rectangle(centre_m, poster.facing_rad, kPosterThickness_m, poster.width_m),
          poster.centre_z_m - poster.height_m / 2, poster.centre_z_m + poster.height_m / 2, Material::kPoster,
          true};
}

}  // namespace

Solid boxSolid(const Box& box) {
  return {rectangle(box.at_m, box.yaw_rad, box.size_m.x(), box.size_m.y()), box.z_m, box.z_m + box.size_m.z(),
          box.material, false};
}

std::vector<Solid> solidsOf(const World& world) {
  std::vector<Solid> solids = world.map_solids;
  for (const Wall& wall : world.walls) addWall(wall, world.doors, solids);
  for (const Door& door : world.doors) addDoor(door, thicknessAt(door, world.walls), solids);
  for (const Box& box : world.boxes) solids.push_back(boxSolid(box));
  for (const Poster& poster : world.posters) solids.push_back(posterSolid(poster));
  return solids;
}

Pose2 worldFromMover(const Mover& mover, double time_s) {
  const double start_s = mover.path.front().time_s, end_s = mover.path.back().time_s;
  const double within_s = start_s + std::fmod(std::max(time_s - start_s, 0.0), end_s - start_s);
  std::size_t next = 1;
  while (next + 1 < mover.path.size() && mover.path[next].time_s <= within_s) ++next;
  const TimedPoint &from = mover.path[next - 1], &to = mover.path[next];
  const double share = (within_s - from.time_s) / (to.time_s - from.time_s);
  const Eigen::Vector2d step_m = to.at_m - from.at_m;
  const Eigen::Vector2d at_m = from.at_m + step_m * share;
  return {at_m.x(), at_m.y(), step_m.norm() > 0 ? std::atan2(step_m.y(), step_m.x()) : 0};
}

}  // namespace cornerstone
