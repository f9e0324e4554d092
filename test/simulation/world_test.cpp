#include "cornerstone/simulation/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

World parse(const std::string& inside) {
  return parseWorld("{name: w, seed: 1, extent_m: [0, 0, 9, 9], ceiling_m: 3, " + inside + "}", "w.yaml",
                    ".");
}

std::string refusalOf(const std::string& inside) {
  try {
    parse(inside);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(World, RefusalsNameFileAndKey) {
  EXPECT_EQ(refusalOf("robots: []"), "");
  EXPECT_EQ(refusalOf("wals: []"), "w.yaml: 'robots' is missing");
  EXPECT_EQ(refusalOf("robots: [], wals: []"), "w.yaml: unknown key 'wals'");
  EXPECT_EQ(refusalOf("robots: [], walls: [{points_m: [[0, 0], [1, x]]}]"),
            "w.yaml/walls[0]: 'points_m' is not a list of numbers");
  EXPECT_EQ(refusalOf("robots: [], walls: [{points_m: [[0, 0], [1, 0]], height_m: -1}]"),
            "w.yaml/walls[0]: 'height_m' is -1, it must be greater than 0");
  EXPECT_EQ(
      refusalOf(
          "robots: [{name: a, start_m_m_deg: [0, 0, 0], speed_m_s: 1, turn_rate_deg_s: 9, route: [{}]}]"),
      "w.yaml/robots[0]/route[0]: a route step has one of 'to_m', 'turn_deg', 'wait_s'");
  EXPECT_EQ(refusalOf("robots: [], boxes: [{at_m: [1, 1], yaw_deg: 0, size_m: [1, 1, 1], material: cheese}]"),
            "w.yaml/boxes[0]: 'material': unknown material 'cheese'");
  EXPECT_THROW(parseWorld("{", "w.yaml", "."), InputError);
  EXPECT_THROW(parseWorld("7", "w.yaml", "."), InputError);
  EXPECT_THROW(loadWorld("/nowhere/w.yaml"), InputError);
}

TEST(World, AWallIsMitredAtItsCorner) {
  const auto solids =
      solidsOf(parse("robots: [], walls: [{points_m: [[0, 0], [2, 0], [2, 2]], height_m: 2, thickness_m: "
                     "0.2, material: paint}]"));
  ASSERT_EQ(solids.size(), 2U);
  // Outside and inside of the corner, 0.1 m from both centre lines.
  EXPECT_NEAR((solids[0].polygon_m[1] - Eigen::Vector2d(2.1, -0.1)).norm(), 0, 1e-9);
  EXPECT_NEAR((solids[0].polygon_m[2] - Eigen::Vector2d(1.9, 0.1)).norm(), 0, 1e-9);
  EXPECT_NEAR((solids[1].polygon_m[0] - Eigen::Vector2d(2.1, -0.1)).norm(), 0, 1e-9);
}

TEST(World, ADoorCutsItsWallAndLeavesALintel) {
  const auto solids = solidsOf(parse(
      "robots: [], walls: [{points_m: [[0, 0], [4, 0]], height_m: 2.5, thickness_m: 0.2, material: paint}], "
      "doors: [{at_m: [2, 0], yaw_deg: 0, width_m: 1, height_m: 2, open_deg: 90}]"));
  // Left of the door, lintel, right of it; then two jambs, the frame's head and the leaf.
  ASSERT_EQ(solids.size(), 7U);
  EXPECT_NEAR(solids[0].polygon_m[1].x(), 1.5, 1e-9);
  EXPECT_NEAR(solids[1].z_min_m, 2.0, 1e-9);
  EXPECT_NEAR(solids[2].polygon_m[0].x(), 2.5, 1e-9);
  // The open leaf hangs at the left jamb and points along +y.
  double farthest_m = 0;
  for (const auto& corner : solids[6].polygon_m) farthest_m = std::max(farthest_m, corner.y());
  EXPECT_NEAR(farthest_m, 0.87, 1e-9);
}

TEST(World, AMoverRunsItsPathAgainAndAgain) {
  const World world = parse(
      "robots: [], movers: [{name: m, size_m: [1, 1, 1], material: fabric, "
      "path_s_m_m: [[0, 0, 0], [2, 4, 0], [4, 0, 0]]}]");
  EXPECT_NEAR(worldFromMover(world.movers[0], 1).x_m, 2, 1e-9);
  EXPECT_NEAR(std::abs(worldFromMover(world.movers[0], 3).yaw_rad), M_PI, 1e-9);
  EXPECT_NEAR(worldFromMover(world.movers[0], 5).x_m, 2, 1e-9);
}

TEST(World, ShippedWorldsLoad) {
  for (const char* name : {"office", "corridor_crossing", "other_building"}) {
    const World world = loadWorld(std::string(CORNERSTONE_SOURCE_DIR) + "/worlds/" + name + ".yaml");
    EXPECT_EQ(world.name, name);
    EXPECT_EQ(world.robots.size(), 2U);
  }
}

}  // namespace
}  // namespace cornerstone
