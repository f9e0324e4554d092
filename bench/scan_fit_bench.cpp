// The fit of one scan to the map, beside MRPT's ICP: both from the same wrong poses, to what was seen before.
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/slam/CICP.h>

#include <cmath>
#include <random>
#include <set>

#include "bench.h"
#include "cornerstone/mapping/mapper.h"
#include "recorded_tour.h"

namespace cornerstone::bench {
namespace {

constexpr double kOff_m = 0.05, kOff_rad = 2 * M_PI / 180;  // of the start: standard deviations

mrpt::maps::CSimplePointsMap pointsOf(const RangeScan& scan) {
  mrpt::maps::CSimplePointsMap points;
  for (const Beam& beam : scan.beams) {
    if (!beam.hit || beam.range_m > GridParams{}.max_range_m) continue;
    const Eigen::Vector2d end_m =
        scan.base_from_sensor *
        (beam.range_m * Eigen::Vector2d(std::cos(beam.bearing_rad), std::sin(beam.bearing_rad)));
    points.insertPoint(static_cast<float>(end_m.x()), static_cast<float>(end_m.y()), 0);
  }
  return points;
}

// All ends at their true poses, one a cell.
class SeenPoints {
 public:
  void add(const mrpt::maps::CSimplePointsMap& points, const Pose2& world_from_base) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      float x_m = 0, y_m = 0;
      points.getPoint(i, x_m, y_m);
      const Eigen::Vector2d at_m =
          world_from_base * Eigen::Vector2d(static_cast<double>(x_m), static_cast<double>(y_m));
      const double cell_m = GridParams{}.resolution_m;
      const std::pair cell(std::lround(at_m.x() / cell_m), std::lround(at_m.y() / cell_m));
      if (cells_.insert(cell).second)
        map_.insertPoint(static_cast<float>(at_m.x()), static_cast<float>(at_m.y()), 0);
    }
  }
  const mrpt::maps::CSimplePointsMap& map() const { return map_; }

 private:
  std::set<std::pair<long, long>> cells_;
  mrpt::maps::CSimplePointsMap map_;
};

struct FitErrors {
  std::vector<double> m, deg, ms;
  void note(const Pose2& found, const Pose2& truth, double took_ms) {
    const Pose2 off = truth.inverse() * found;
    m.push_back(off.translation().norm());
    deg.push_back(std::abs(off.yaw_rad) * 180 / M_PI);
    ms.push_back(took_ms);
  }
  void print(const std::string& name) const {
    printRow({name, text(median(m), 3), text(median(deg), 2), text(median(ms), 2)});
  }
};

}  // namespace

void scanFitPart() {
  std::printf(
      "\n### One scan's fit\n\nEvery tenth look of the office tour (seed 1, 160x120), its pose off by %.2f m "
      "and 2 degrees (standard deviations), fitted to what was seen before it, drawn at true poses. Medians. "
      "CICP: default options but for thresholdDist 0.2 m, the gate of the fit; points thinned to one a cell "
      "of 0.05 m.\n",
      kOff_m);
  printHead({"method", "error m", "error deg", "ms"});
  TourSetup setup;
  setup.world = tourWorlds().front();
  const RecordedTour tour = recordTour(setup);
  MapperParams params;
  params.fit_scans = false;
  Mapper mapper(params);
  SeenPoints seen;
  mrpt::slam::CICP icp;
  icp.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  icp.options.thresholdDist = params.fit.gate_m;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  FitErrors start, ours, theirs;
  for (std::size_t i = 0; i < tour.looks.size(); ++i) {
    const TourLook& look = tour.looks[i];
    const mrpt::maps::CSimplePointsMap points = pointsOf(look.scan);
    if (i % 10 == 9) {
      const Pose2 from = look.world_from_base *
                         Pose2{kOff_m * normal(random), kOff_m * normal(random), kOff_rad * normal(random)};
      start.note(from, look.world_from_base, 0);
      const PoseEstimate prior{
          from, Eigen::Vector3d(kOff_m, kOff_m, kOff_rad).cwiseAbs2().asDiagonal().toDenseMatrix()};
      ScanFit fit;
      const double our_ms = elapsed_ms([&] {
        fit = fitScan(look.scan, mapper.grid(), {prior, 1}, params.fit);
      });
      ours.note(fit.pose.map_from_base, look.world_from_base, our_ms);
      mrpt::poses::CPose2D answer;
      const double their_ms = elapsed_ms([&] {
        answer = icp.Align(&seen.map(), &points, mrpt::poses::CPose2D(from.x_m, from.y_m, from.yaw_rad))
                     ->getMeanVal();
      });
      theirs.note({answer.x(), answer.y(), answer.phi()}, look.world_from_base, their_ms);
    }
    mapper.update(look.scan, look.world_from_base);
    seen.add(points, look.world_from_base);
  }
  start.print("where they start");
  ours.print("cornerstone");
  theirs.print("MRPT CICP");
}

}  // namespace cornerstone::bench
