#include "views.h"

#include "tour.h"

namespace cornerstone::bench {
namespace {

const CameraFaultParams kFaults{2.0, 0.05, 0.1, 0};

}  // namespace

Tour tourOf(const TourName& name, int poses) {
  Tour tour;
  tour.world = shippedWorld(name.world);
  tour.world.seed += 100 * (name.seed - 1);
  tour.seed = name.seed;
  SimulationParams params;
  params.robots = {name.robot};
  std::vector<Pose2> route;
  Simulation simulation(tour.world, params);
  while (!simulation.routesDone()) {
    simulation.step();
    route.push_back(simulation.frames(false).front().world_from_base);
  }
  for (int i = 0; i < poses; ++i)
    tour.poses.push_back(route[route.size() * (2 * std::size_t(i) + 1) / (2 * std::size_t(poses))]);
  return tour;
}

std::vector<View> renderViews(const Tour& tour, const RigParams& rig) {
  const double focal_px = focalLength(rig);
  Renderer renderer(
      tour.world, {},
      {{rig.width_px, rig.height_px}, focal_px, (rig.width_px - 1) / 2.0, (rig.height_px - 1) / 2.0});
  CameraFaults faults(kFaults, focal_px, tour.seed);
  const auto base_from_cameras = baseFromCameras(rig);
  std::vector<View> views;
  for (const Pose2& pose : tour.poses) {
    std::array<cv::Mat1b, kCameraCount> images;
    for (std::size_t camera = 0; camera < kCameraCount; ++camera) {
      Eigen::Isometry3d at = spatial(pose) * base_from_cameras[camera];
      at.linear() = at.linear() * faults.misalignment(camera);
      images[camera] = faults.expose(renderer.render(at), camera);
    }
    views.push_back(
        {{images[0], images[1], images[2]}, renderer.renderDepth(spatial(pose) * base_from_cameras[0])});
  }
  return views;
}

}  // namespace cornerstone::bench
