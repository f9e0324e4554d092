#include "recorded_tour.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "bench.h"
#include "cornerstone/base/errors.h"
#include "cornerstone/stereo/self_calibration.h"

namespace cornerstone::bench {
namespace {

constexpr double kSpeed_m_s = 2, kTurnRate_rad_s = 1.5;
constexpr int kStepsPerFrame = 5;  // of 50 a second: 10 Hz

using Route = std::vector<Eigen::Vector2d>;

const std::map<std::string, Route>& routes() {
  static const std::map<std::string, Route> kRoutes{
      {"office",
       {{10, 7.4},
        {10, 3.2},
        {10, 12.2},
        {12.6, 12.3},
        {13, 10},
        {13, 7.4},
        {17.5, 7.4},
        {6.8, 7.4},
        {6.8, 9.9},
        {6.8, 7.4},
        {1.8, 7.4},
        {10, 7.4},
        {10, 5}}},
      {"corridor_crossing",
       {{4, 0},
        {0.2, 0},
        {0.2, 4.5},
        {0, -4},
        {0, 0},
        {-4.5, 0},
        {4, 0},
        {0.4, 0},
        {0.4, 4.5},
        {0, -4},
        {0, 0.2},
        {-4.5, 0.2},
        {0, 0}}},
      {"other_building",
       {{4.6, 3.6}, {5.2, 5.8}, {6.8, 5.5}, {6.5, 3.4}, {6.3, 2.2}, {4.8, 2.2}, {2.2, 3.8},
        {4.8, 2.2}, {6.3, 2.2}, {6.5, 3.4}, {6.8, 5.5}, {5.2, 5.8}, {4.6, 3.6}, {2.2, 3.8},
        {4.6, 3.6}, {5.2, 5.8}, {6.8, 5.5}, {6.5, 3.4}, {6.3, 2.2}, {4.8, 2.2}, {2.2, 3.8},
        {4.8, 2.2}, {6.3, 2.2}, {6.5, 3.4}, {6.8, 5.5}, {5.2, 5.8}, {4.6, 3.6}, {2.2, 3.8}}}};
  return kRoutes;
}

World tourWorld(const std::string& name) {
  World world = shippedWorld(name + ".yaml");
  ScenarioRobot& robot = world.robots.front();
  robot.speed_m_s = kSpeed_m_s;
  robot.turn_rate_rad_s = kTurnRate_rad_s;
  robot.route.clear();
  for (const Eigen::Vector2d& to_m : routes().at(name)) {
    RouteStep step;
    step.to_m = to_m;
    robot.route.push_back(step);
  }
  return world;
}

class DriftingOdometry {
 public:
  explicit DriftingOdometry(int seed) : random_(static_cast<unsigned>(seed)) {
    std::bernoulli_distribution coin;
    scale_ = coin(random_) ? 1.03 : 0.97;
    drift_rad_per_m_ = (coin(random_) ? 2 : -2) * M_PI / 180;
  }
  Pose2 next(const Pose2& world_from_base) {
    if (started_) {
      const Pose2 step = last_.inverse() * world_from_base;
      const double way_m = step.translation().norm(), root = std::sqrt(way_m);
      const double stretch = scale_ + (way_m > 0 ? 0.01 * normal_(random_) / root : 0);
      const double turn_rad =
          step.yaw_rad + drift_rad_per_m_ * way_m + 0.5 * M_PI / 180 * root * normal_(random_);
      // Heading is lost along the way, not at its end.
      const Pose2 half_way{0, 0, 0.5 * (turn_rad - step.yaw_rad)};
      odom_from_base_ = odom_from_base_ * half_way * Pose2{step.x_m * stretch, step.y_m * stretch, 0} *
                        Pose2{0, 0, turn_rad - half_way.yaw_rad};
    }
    started_ = true;
    last_ = world_from_base;
    return odom_from_base_;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  double scale_ = 1, drift_rad_per_m_ = 0;
  bool started_ = false;
  Pose2 last_, odom_from_base_;
};

}  // namespace

const std::vector<std::string>& tourWorlds() {
  static const std::vector<std::string> kNames{"office", "corridor_crossing", "other_building"};
  return kNames;
}

RecordedTour recordTour(const TourSetup& setup) {
  RecordedTour tour;
  tour.world = tourWorld(setup.world);
  SimulationParams params;
  params.seed = setup.seed;
  params.robots = {tour.world.robots.front().name};
  params.steps_per_frame = kStepsPerFrame;
  params.rig = rigOf(setup.width_px);
  params.cameras = setup.faults;
  const StereoMounting mounting = mountingOf(params.rig);
  tour.camera = {mounting.rig, mounting.base_from_camera};
  StereoParams stereo;
  stereo.max_disparity_px = maxDisparityOf(setup.width_px);
  StereoMatcher matcher(stereo);
  SelfCalibration calibration;
  const auto peer = makeStereoBM(stereo.max_disparity_px);
  DriftingOdometry odometry(setup.seed);
  drive(tour.world, params, [&](const RobotFrame& frame) {
    TourLook look;
    look.world_from_base = frame.world_from_base;
    look.odom_from_base = odometry.next(frame.world_from_base);
    look.chain_ms = elapsed_ms([&] {
      const StereoImages images{frame.images[0], frame.images[1], frame.images[2]};
      Disparity disparity = matcher.match(images, mounting.rig);
      calibration.correct(images, disparity);
      look.scan = scanFromDisparity(disparity, mounting.base_from_camera, {});
    });
    look.peer_chain_ms = elapsed_ms([&] {
      look.peer_ranges_m = nearestRanges(matchOpenCV(*peer, frame.images[0], frame.images[1]), tour.camera);
    });
    if (!tour.looks.empty())
      tour.way_m +=
          (tour.looks.back().world_from_base.translation() - look.world_from_base.translation()).norm();
    tour.looks.push_back(std::move(look));
    if (frame.collisions > 0)
      throw std::logic_error("tour of " + setup.world + ": the robot touched something");
  });
  return tour;
}

}  // namespace cornerstone::bench
