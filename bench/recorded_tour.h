// Tours of some 60 m through the shipped worlds at up to 2 m/s, once rendered and matched, so that many
// mappers can be fed with the same looks. World frame; odometry starts at the origin.
//
// Odometry: 3% of the distance and 2 degrees a metre, steady (their signs by the seed), and noise of 1 cm and
// 0.5 degrees per root of a metre.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cornerstone/scan/range_scan.h"
#include "peers.h"
#include "tour.h"

namespace cornerstone::bench {

struct TourSetup {
  std::string world;  // of worlds/, without its ending
  int width_px = 160;
  int seed = 1;
  CameraFaultParams faults{2.0, 0.05, 0.1, 0};  // as in the stereo benchmark
};

struct TourLook {
  RangeScan scan;
  std::vector<double> peer_ranges_m;  // StereoBM, nearest pixel of each column
  Pose2 world_from_base;
  Pose2 odom_from_base;
  double chain_ms = 0;       // stereo and scan
  double peer_chain_ms = 0;  // the same of the peer
};

struct RecordedTour {
  World world;
  CameraView camera;
  std::vector<TourLook> looks;
  double way_m = 0;
  Pose2 worldFromOdom() const {
    return looks.front().world_from_base * looks.front().odom_from_base.inverse();
  }
};

const std::vector<std::string>& tourWorlds();
RecordedTour recordTour(const TourSetup& setup);

}  // namespace cornerstone::bench
