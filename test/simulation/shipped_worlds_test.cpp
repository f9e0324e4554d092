// Every file of worlds/ loads, and its robots start where there is room.
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>

#include "cornerstone/simulation/true_surfaces.h"
#include "cornerstone/simulation/vehicle.h"

namespace cornerstone {
namespace {

constexpr double kFloorUnevenness_m = 0.03;

bool isInside(const Solid& solid, const Eigen::Vector2d& point_m) {
  std::vector<cv::Point2f> polygon;
  for (const Eigen::Vector2d& corner : solid.polygon_m)
    polygon.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
  const cv::Point2f point(static_cast<float>(point_m.x()), static_cast<float>(point_m.y()));
  return cv::pointPolygonTest(polygon, point, false) >= 0;
}

TEST(ShippedWorlds, RobotsStartInFreeSpaceAndApart) {
  const VehicleParams vehicle;
  int worlds = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(CORNERSTONE_SOURCE_DIR) + "/worlds")) {
    if (entry.path().extension() != ".yaml") continue;
    SCOPED_TRACE(entry.path().filename());
    ++worlds;
    const World world = loadWorld(entry.path());
    ASSERT_FALSE(world.robots.empty());
    const std::vector<Solid> solids = solidsOf(world);
    const TrueSurfaces obstacles(solids, {kFloorUnevenness_m, vehicle.height_m});
    for (const ScenarioRobot& robot : world.robots) {
      const Eigen::Vector2d at_m = robot.world_from_start.translation();
      EXPECT_GT(obstacles.distanceTo(at_m), vehicle.radius_m) << robot.name;
      for (const Solid& solid : solids) {
        if (solid.z_min_m < vehicle.height_m && solid.z_max_m > kFloorUnevenness_m) {
          EXPECT_FALSE(isInside(solid, at_m)) << robot.name;
        }
      }
      for (const ScenarioRobot& other : world.robots) {
        const double apart_m = (other.world_from_start.translation() - at_m).norm();
        EXPECT_TRUE(&other == &robot || apart_m > 2 * vehicle.radius_m) << robot.name;
      }
    }
  }
  EXPECT_GE(worlds, 3);
}

}  // namespace
}  // namespace cornerstone
