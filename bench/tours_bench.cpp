// Long tours with poor odometry: where the robot thinks it is at the end, and what its map is worth.
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "bench.h"
#include "cornerstone/mapping/mapper.h"
#include "map_truth.h"
#include "recorded_tour.h"

namespace cornerstone::bench {
namespace {

struct TourResult {
  double end_error_m = 0;
  MapWorth by_start, by_way;  // where the map is placed in the world
  double frame_ms = 0;
};

// A robot's way, as it truly was and as it was mapped.
struct Way {
  std::vector<Eigen::Vector2d> true_m, mapped_m;
};

// world_from_map by which the way as mapped lies on the true one, by least squares.
Pose2 fitOfWay(const Way& way) {
  const auto count = static_cast<Eigen::Index>(way.true_m.size());
  const Eigen::Map<const Eigen::MatrixXd> truth(way.true_m.front().data(), 2, count),
      mapped(way.mapped_m.front().data(), 2, count);
  const Eigen::MatrixXd motion = Eigen::umeyama(mapped, truth, false);
  return {motion(0, 2), motion(1, 2), std::atan2(motion(1, 0), motion(0, 0))};
}

// The default priors are those of measured wheels; these name the drift that is simulated.
MapperParams toldOfTheDrift() {
  MapperParams params;
  params.odometry.scale_ratio = 0.03;
  params.odometry.yaw_drift_rad_per_m = 0.03;
  return params;
}

TourResult ours(const RecordedTour& tour, const MapTruth& truth) {
  Mapper mapper(toldOfTheDrift());
  std::vector<double> frame_ms;
  Way way;
  for (const TourLook& look : tour.looks) {
    frame_ms.push_back(look.chain_ms + elapsed_ms([&] { mapper.update(look.scan, look.odom_from_base); }));
    if (mapper.graph().frames().size() > way.true_m.size())
      way.true_m.push_back(look.world_from_base.translation());
  }
  for (const KeyFrame& frame : mapper.graph().frames())
    way.mapped_m.push_back(frame.map_from_base.translation());
  const Pose2 world_from_map = tour.worldFromOdom();
  const Pose2 end = world_from_map * mapper.pose().map_from_base;
  const GridMap map = mapper.map();
  return {(end.translation() - tour.looks.back().world_from_base.translation()).norm(),
          truth.worthOf(map, world_from_map), truth.worthOf(map, fitOfWay(way)), median(frame_ms)};
}

TourResult theirs(const RecordedTour& tour, const MapTruth& truth) {
  mrpt::maps::COccupancyGridMap2D map = emptyMrptMap();
  std::vector<double> frame_ms;
  Way way;
  for (const TourLook& look : tour.looks) {
    frame_ms.push_back(look.peer_chain_ms + elapsed_ms([&] {
                         insertRanges(look.peer_ranges_m, tour.camera, look.odom_from_base, map);
                       }));
    way.true_m.push_back(look.world_from_base.translation());
    way.mapped_m.push_back(look.odom_from_base.translation());
  }
  const Pose2 world_from_map = tour.worldFromOdom();
  const Pose2 end = world_from_map * tour.looks.back().odom_from_base;
  return {(end.translation() - tour.looks.back().world_from_base.translation()).norm(),
          truth.worthOf(fromMrpt(map), world_from_map), truth.worthOf(fromMrpt(map), fitOfWay(way)),
          median(frame_ms)};
}

// Median and worst of the seeds.
std::string spread(std::vector<double> values, bool largest_is_worst,
                   const std::function<std::string(double)>& written) {
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  const double worst = largest_is_worst ? *most : *least;
  return written(median(values)) + " (" + written(worst) + ")";
}

void print(const TourSetup& setup, const std::string& chain, const std::vector<TourResult>& results) {
  const auto all = [&](const std::function<double(const TourResult&)>& one) {
    std::vector<double> values;
    std::transform(results.begin(), results.end(), std::back_inserter(values), one);
    return values;
  };
  const auto metres = [](double value) { return text(value, 3); };
  const auto share = [](double value) { return percent(value); };
  const auto fine_share = [](double value) { return percent(value, 2); };
  printRow({setup.world, std::to_string(setup.width_px) + "x" + std::to_string(setup.width_px * 3 / 4), chain,
            spread(all([](const TourResult& r) { return r.end_error_m; }), true, metres),
            spread(all([](const TourResult& r) { return r.by_start.precision; }), false, share),
            spread(all([](const TourResult& r) { return r.by_start.recall; }), false, share),
            spread(all([](const TourResult& r) { return r.by_start.phantom_share; }), true, fine_share),
            spread(all([](const TourResult& r) { return r.by_way.precision; }), false, share),
            spread(all([](const TourResult& r) { return r.by_way.recall; }), false, share),
            spread(all([](const TourResult& r) { return r.by_way.phantom_share; }), true, fine_share),
            spread(all([](const TourResult& r) { return r.by_way.sharpness_m; }), true, metres),
            text(median(all([](const TourResult& r) { return r.frame_ms; })))});
}

void compare(TourSetup setup, int seeds) {
  std::vector<TourResult> our_results, their_results;
  for (setup.seed = 1; setup.seed <= seeds; ++setup.seed) {
    const RecordedTour tour = recordTour(setup);
    std::vector<Pose2> poses;
    for (const TourLook& look : tour.looks) poses.push_back(look.world_from_base);
    const MapTruth truth(tour.world, poses);
    our_results.push_back(ours(tour, truth));
    their_results.push_back(theirs(tour, truth));
  }
  print(setup, "cornerstone", our_results);
  print(setup, "StereoBM, nearest pixel, MRPT insertion, odometry as it is", their_results);
}

}  // namespace

void toursPart(int seeds) {
  std::printf(
      "\n## Tours with poor odometry\n\nTours of some 60 m at up to 2 m/s and 10 Hz through three worlds, "
      "%d seed(s) each. Odometry drifts by 3%% of the distance and 2 degrees a metre, steadily, and by noise "
      "of 1 cm and 0.5 degrees per root of a metre; cameras are spoiled as in the stereo part. The mapper is "
      "told that drift (`odometry/scale_ratio` 0.03, `yaw_drift_rad_per_m` 0.03): its defaults, 0.005 and "
      "0.015, are those of measured wheels, with which demonstrations fare better. A map is placed in "
      "the world by its start alone, so that one look's heading counts over the whole building, and by the "
      "rigid motion that lays the robot's way as mapped on the true one: this is what the map itself is "
      "worth. Median of the seeds, in brackets the worst. Phantom: occupied of the cells "
      "told about that are truly free (more than 0.10 m from all that is solid); sharpness: median distance "
      "of occupied cells from true surfaces, within 3 m of the way. Aimed at: end error 0.15 m (0.10 at "
      "320x240), precision 98%%, recall 90%%, phantoms 0.05%%, sharpness 0.03 m.\n",
      seeds);
  printHead({"world", "image", "chain", "end error m", "by the start: precision", "recall", "phantom",
             "by the way: precision", "recall", "phantom", "sharpness m", "ms a frame"});
  for (const std::string& world : tourWorlds())
    for (const int width_px : {160, 320}) {
      TourSetup setup;
      setup.world = world;
      setup.width_px = width_px;
      compare(setup, seeds);
    }
}

}  // namespace cornerstone::bench
