// Long tours with poor odometry: where the robot thinks it is at the end, and what its map is worth.
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
  MapWorth worth;
  double frame_ms = 0;
};

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
  for (const TourLook& look : tour.looks)
    frame_ms.push_back(look.chain_ms + elapsed_ms([&] { mapper.update(look.scan, look.odom_from_base); }));
  const Pose2 world_from_map = tour.worldFromOdom();
  const Pose2 end = world_from_map * mapper.pose().map_from_base;
  return {(end.translation() - tour.looks.back().world_from_base.translation()).norm(),
          truth.worthOf(mapper.map(), world_from_map), median(frame_ms)};
}

TourResult theirs(const RecordedTour& tour, const MapTruth& truth) {
  mrpt::maps::COccupancyGridMap2D map = emptyMrptMap();
  std::vector<double> frame_ms;
  for (const TourLook& look : tour.looks)
    frame_ms.push_back(look.peer_chain_ms + elapsed_ms([&] {
                         insertRanges(look.peer_ranges_m, tour.camera, look.odom_from_base, map);
                       }));
  const Pose2 world_from_map = tour.worldFromOdom();
  const Pose2 end = world_from_map * tour.looks.back().odom_from_base;
  return {(end.translation() - tour.looks.back().world_from_base.translation()).norm(),
          truth.worthOf(fromMrpt(map), world_from_map), median(frame_ms)};
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
            spread(all([](const TourResult& r) { return r.worth.precision; }), false, share),
            spread(all([](const TourResult& r) { return r.worth.recall; }), false, share),
            spread(all([](const TourResult& r) { return r.worth.phantom_share; }), true, fine_share),
            spread(all([](const TourResult& r) { return r.worth.sharpness_m; }), true, metres),
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
      "0.015, are those of measured wheels, with which demonstrations fare better. Maps are placed in the "
      "world by the start alone. Median of the seeds, in brackets the worst. Phantom: occupied of the cells "
      "told about that are truly free (more than 0.10 m from all that is solid); sharpness: median distance "
      "of occupied cells from true surfaces, within 3 m of the way. Aimed at: end error 0.15 m (0.10 at "
      "320x240), precision 98%%, recall 90%%, phantoms 0.05%%, sharpness 0.03 m.\n",
      seeds);
  printHead({"world", "image", "chain", "end error m", "precision", "recall", "phantom", "sharpness m",
             "ms a frame"});
  for (const std::string& world : tourWorlds())
    for (const int width_px : {160, 320}) {
      TourSetup setup;
      setup.world = world;
      setup.width_px = width_px;
      compare(setup, seeds);
    }
}

}  // namespace cornerstone::bench
