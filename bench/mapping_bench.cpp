// From images to a map: time by stage, and what the map is worth beside MRPT's own insertion.
#include "bench.h"
#include "cornerstone/scan/column_scan.h"
#include "cornerstone/stereo/self_calibration.h"
#include "peers.h"
#include "tour.h"

namespace cornerstone::bench {
namespace {

// One robot's frames through three ways at once, all with maps in the world's frame.
class Comparison {
 public:
  explicit Comparison(int width_px)
      : mounting_(mountingOf(rigOf(width_px))),
        matcher_(stereoParams(width_px)),
        at_truth_(truthParams()),
        bm_(makeStereoBM(maxDisparityOf(width_px))) {}

  void look(const RobotFrame& frame) {
    if (poses_.empty()) world_from_odom_ = frame.world_from_base * frame.odom_from_base.inverse();
    poses_.push_back(frame.world_from_base);
    RangeScan scan;
    const StereoImages images{frame.images[0], frame.images[1], frame.images[2]};
    stereo_ms_.push_back(elapsed_ms([&] {
      matcher_.match(images, mounting_.rig, disparity_);
      calibration_.correct(images, disparity_);
    }));
    scan_ms_.push_back(
        elapsed_ms([&] { scan = scanFromDisparity(disparity_, mounting_.base_from_camera, {}); }));
    mapping_ms_.push_back(elapsed_ms([&] { driven_.update(scan, world_from_odom_ * frame.odom_from_base); }));
    total_ms_.push_back(stereo_ms_.back() + scan_ms_.back() + mapping_ms_.back());
    truth_mapping_ms_.push_back(elapsed_ms([&] { at_truth_.update(scan, frame.world_from_base); }));
    at_truth_ms_.push_back(stereo_ms_.back() + scan_ms_.back() + truth_mapping_ms_.back());
    cv::Mat1f answer;
    peer_stereo_ms_.push_back(
        elapsed_ms([&] { answer = matchOpenCV(*bm_, images.reference, images.right); }));
    const CameraView view{mounting_.rig, mounting_.base_from_camera};
    peer_mapping_ms_.push_back(
        elapsed_ms([&] { insertRanges(nearestRanges(answer, view), view, frame.world_from_base, mrpt_); }));
    peer_ms_.push_back(peer_stereo_ms_.back() + peer_mapping_ms_.back());
  }

  void print(const std::string& image, const World& world) const {
    const double peer_ms = median(peer_ms_);
    const auto row = [&](const std::string& way, const std::vector<std::vector<double>>& stages,
                         const std::vector<double>& all_ms, const GridMap& map) {
      const MapQuality quality = qualityOf(map, world, poses_);
      std::vector<std::string> cells{image, way};
      for (const auto& stage : stages) cells.push_back(stage.empty() ? "" : text(median(stage)));
      const double ms = median(all_ms);
      cells.insert(cells.end(),
                   {text(ms), text(ms / peer_ms), percent(quality.precision), percent(quality.recall)});
      printRow(cells);
    };
    row("cornerstone, drifting odometry, scans fitted", {stereo_ms_, scan_ms_, mapping_ms_}, total_ms_,
        driven_.grid().snapshot());
    row("cornerstone, true poses", {stereo_ms_, scan_ms_, truth_mapping_ms_}, at_truth_ms_,
        at_truth_.grid().snapshot());
    row("StereoBM, nearest pixel, MRPT insertion, true poses", {peer_stereo_ms_, {}, peer_mapping_ms_},
        peer_ms_, fromMrpt(mrpt_));
  }

 private:
  static StereoParams stereoParams(int width_px) {
    StereoParams params;
    params.max_disparity_px = maxDisparityOf(width_px);
    return params;
  }
  static MapperParams truthParams() {
    MapperParams params;
    params.fit_scans = false;
    return params;
  }

  StereoMounting mounting_;
  StereoMatcher matcher_;
  SelfCalibration calibration_;
  Mapper driven_{MapperParams{}}, at_truth_;
  cv::Ptr<cv::StereoMatcher> bm_;
  mrpt::maps::COccupancyGridMap2D mrpt_ = emptyMrptMap();
  Disparity disparity_;
  Pose2 world_from_odom_;
  std::vector<Pose2> poses_;
  std::vector<double> stereo_ms_, scan_ms_, mapping_ms_, total_ms_, truth_mapping_ms_, at_truth_ms_;
  std::vector<double> peer_stereo_ms_, peer_mapping_ms_, peer_ms_;
};

}  // namespace

void mappingPart() {
  std::puts(
      "\n## From images to a map\n\nRobot a of `worlds/office.yaml` on its whole route, 5 image triples a "
      "second, the "
      "simulator's default faults (1 grey level, gains 2%, 0.1 px). Medians of one frame in ms. Precision: "
      "occupied "
      "cells (above 0.65) within 0.10 m of a true surface; recall: surface seen within 3 m of the route that "
      "has an "
      "occupied cell within 0.10 m. Maps with drift are placed by the start alone. MRPT: insertObservation "
      "of a "
      "CObservation2DRangeScan with default options but for considerInvalidRangesAsFreeSpace (off: it would "
      "erase "
      "bare walls) and the range (8 m, as cornerstone's). Its scan is made and inserted in one time. Cells "
      "of 0.05 m.");
  printHead({"image", "chain", "stereo", "scan", "mapping", "whole frame", "time / StereoBM chain",
             "precision", "recall"});
  const World world = shippedWorld("office.yaml");
  for (const int width_px : {160, 320}) {
    SimulationParams params;
    params.robots = {"a"};
    params.steps_per_frame = params.steps_per_second / 5;
    params.rig = rigOf(width_px);
    Comparison comparison(width_px);
    drive(world, params, [&](const RobotFrame& frame) { comparison.look(frame); });
    comparison.print(std::to_string(params.rig.width_px) + "x" + std::to_string(params.rig.height_px), world);
  }
}

}  // namespace cornerstone::bench
