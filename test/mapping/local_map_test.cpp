#include "cornerstone/mapping/local_map.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"
#include "cornerstone/mapping/mapper.h"
#include "support/room_scan.h"

namespace cornerstone {
namespace {

constexpr float kOccupied = 0.65F, kFree = 0.196F;

float at(const GridMap& map, double x_m, double y_m) {
  const Cell cell = map.geometry.cellAt({x_m, y_m});
  return map.geometry.contains(cell) ? map.occupied(cell.row, cell.col) : kUnseen;
}

test::Room boxRoom() {
  test::Room room;
  room.addRectangle(0, 0, 6, 4);
  return room;
}

// The driving level sees a cupboard before the wall, the ceiling level only the wall.
RangeScan lookOfTwoLevels(const Pose2& pose) {
  test::Room furnished = boxRoom();
  furnished.addRectangle(3.525, 1.5, 4.5, 2.5);
  RangeScan scan = test::scanOf(furnished, pose);
  scan.further_levels = {test::scanOf(boxRoom(), pose).beams};
  return scan;
}

TEST(LocalMap, EachLevelHasAGridOfItsOwn) {
  LocalMap local({}, 2);
  for (int i = 0; i < 4; ++i) local.insert(lookOfTwoLevels({1, 2, 0}), {1, 2, 0});
  EXPECT_GT(at(local.grid(0).snapshot(), 3.52, 2.02), kOccupied);
  EXPECT_LT(at(local.grid(1).snapshot(), 3.52, 2.02), kFree);
  const GridMap ceiling = local.grid(1).snapshot();
  EXPECT_GT(std::max(at(ceiling, 3.02, -0.02), at(ceiling, 3.02, 0.02)), kOccupied);
  local.insert(levelOf(lookOfTwoLevels({1, 2, 0}), 0), {1, 2, 0});  // a laser's look: one level
  RangeScan three = lookOfTwoLevels({1, 2, 0});
  three.further_levels.push_back(three.beams);
  EXPECT_THROW(local.insert(three, {1, 2, 0}), InputError);
  local.clear();
  EXPECT_TRUE(local.grid(0).empty() && local.grid(1).empty());
}

TEST(LocalMap, TheMapIsComposedOfAllLocalMaps) {
  const test::Room room = boxRoom();
  std::vector<LocalMap> maps(1, LocalMap({}, 1));
  for (int i = 0; i < 4; ++i) maps[0].insert(test::scanOf(room, {1, 2, 0}), {1, 2, 0});
  const GridMap alone = maps[0].grid().snapshot();
  EXPECT_EQ(cv::norm(composed(maps).occupied, alone.occupied, cv::NORM_INF), 0);
  // A second one, turned by 90 degrees and moved by whole cells, that looks at the wall x = 0 behind the
  // first.
  const Pose2 map_from_second{3, 2, M_PI / 2}, map_from_base{2, 2, M_PI};
  maps.emplace_back(GridParams{}, 1);
  maps[1].place(map_from_second);
  for (int i = 0; i < 4; ++i)
    maps[1].insert(test::scanOf(room, map_from_base), map_from_second.inverse() * map_from_base);
  const GridMap both = composed(maps);
  for (const Eigen::Vector2d& wall_m :
       {Eigen::Vector2d(0, 2.22), Eigen::Vector2d(3.52, 0), Eigen::Vector2d(3.52, 4)}) {
    float most = 0;
    for (const double dx : {-0.03, 0.03})
      for (const double dy : {-0.03, 0.03}) most = std::max(most, at(both, wall_m.x() + dx, wall_m.y() + dy));
    EXPECT_GT(most, kOccupied) << wall_m.transpose();
  }
  EXPECT_EQ(both.surface.size(), alone.surface.size() + maps[1].grid().snapshot().surface.size());
  for (const SurfacePoint& point : both.surface) {
    const Eigen::Vector2d at_m = point.position_m();
    EXPECT_LT(room.distanceTo(at_m), 0.05) << at_m.transpose();
  }
  EXPECT_LT(at(both, 1, 2.22), kFree);
  EXPECT_LT(at(both, 3, 2.22), kFree);
  EXPECT_EQ(at(both, 7, 2), kUnseen);
}

// All levels are drawn anew with the graph's poses, and a reset empties them all.
TEST(LocalMap, LevelsSurviveTheRedraw) {
  MapperParams params;
  params.graph.redraw_shift_m = 0;  // every solution draws the map anew
  Mapper mapper(params, 2);
  const Pose2 first{1, 2, 0};
  for (int i = 0; i < 90; ++i) {
    const Pose2 pose{1 + 0.01 * i, 2, 0.06 * i};
    mapper.update(lookOfTwoLevels(pose), first.inverse() * pose);
  }
  ASSERT_GE(mapper.redraws(), 1);
  EXPECT_GT(std::max(at(mapper.map(0), 2.48, 0.02), at(mapper.map(0), 2.53, 0.02)), kOccupied);
  EXPECT_LT(at(mapper.map(1), 2.53, 0.02), kFree);
  EXPECT_GT(std::max(at(mapper.map(1), 0.52, 1.98), at(mapper.map(1), 0.52, 2.02)), kOccupied);
  const auto epoch = mapper.epoch();
  const std::vector<GridMap> saved{mapper.map(0), mapper.map(1)};
  mapper.reset();
  EXPECT_GT(mapper.epoch(), epoch);
  EXPECT_TRUE(mapper.grid(0).empty() && mapper.grid(1).empty());
  mapper.load(saved, {});
  EXPECT_LT(cv::norm(mapper.map(1).occupied, saved[1].occupied, cv::NORM_INF), 1e-6);
  EXPECT_THROW(mapper.load({saved[0], saved[1], saved[1]}, {}), InputError);
}

}  // namespace
}  // namespace cornerstone
