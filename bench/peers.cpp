#include "peers.h"

#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/poses/CPosePDFSOG.h>
#include <mrpt/slam/CGridMapAligner.h>

#include <algorithm>
#include <cmath>
#include <list>
#include <opencv2/features2d.hpp>
#include <vector>

namespace cornerstone::bench {

cv::Ptr<cv::StereoMatcher> makeStereoBM(int max_disparity_px) {
  auto matcher = cv::StereoBM::create(max_disparity_px, 9);
  matcher->setTextureThreshold(10);
  matcher->setUniquenessRatio(10);
  matcher->setDisp12MaxDiff(1);
  matcher->setSpeckleWindowSize(100);
  matcher->setSpeckleRange(16);
  return matcher;
}

cv::Ptr<cv::StereoMatcher> makeStereoSGBM(int max_disparity_px) {
  return cv::StereoSGBM::create(0, max_disparity_px, 5, 8 * 25, 32 * 25, 1, 0, 10, 100, 2);
}

cv::Mat1f matchOpenCV(cv::StereoMatcher& matcher, const cv::Mat1b& reference, const cv::Mat1b& right) {
  const int pad = matcher.getNumDisparities();
  cv::Mat padded_reference, padded_right, fixed_point;
  cv::copyMakeBorder(reference, padded_reference, 0, 0, pad, 0, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(right, padded_right, 0, 0, pad, 0, cv::BORDER_REPLICATE);
  matcher.compute(padded_reference, padded_right, fixed_point);
  cv::Mat1f disparity_px;
  fixed_point.colRange(pad, fixed_point.cols).convertTo(disparity_px, CV_32F, 1.0 / 16);
  disparity_px.setTo(0, disparity_px <= 0);
  return disparity_px;
}

std::vector<double> nearestRanges(const cv::Mat1f& disparity_px, const CameraView& view) {
  const Level band = ScanParams().levels.front();
  std::vector<double> ranges_m(static_cast<std::size_t>(disparity_px.cols), 0);
  for (int col = 0; col < disparity_px.cols; ++col)
    for (int row = 0; row < disparity_px.rows; ++row) {
      const double disparity = disparity_px(row, col);
      if (disparity <= 0) continue;
      const double z = view.rig.rangeOf(disparity);
      const Eigen::Vector3d in_camera((col - view.rig.centre_x_px) * z / view.rig.focal_px,
                                      (row - view.rig.centre_y_px) * z / view.rig.focal_px, z);
      const double height_m = (view.base_from_camera * in_camera).z();
      if (height_m < band.z_min_m || height_m > band.z_max_m) continue;
      double& range_m = ranges_m[static_cast<std::size_t>(col)];
      const double planar_m = std::hypot(in_camera.x(), z);
      if (range_m == 0 || planar_m < range_m) range_m = planar_m;
    }
  return ranges_m;
}

void insertRanges(const std::vector<double>& ranges_m, const CameraView& view, const Pose2& map_from_base,
                  mrpt::maps::COccupancyGridMap2D& map) {
  const double half_rad = std::atan(view.rig.centre_x_px / view.rig.focal_px);
  mrpt::obs::CObservation2DRangeScan scan;
  scan.aperture = static_cast<float>(2 * half_rad);
  scan.rightToLeft = true;
  scan.maxRange = 100;
  const Eigen::Vector3d at_m = view.base_from_camera.translation();
  scan.sensorPose = mrpt::poses::CPose3D(at_m.x(), at_m.y(), 0, 0, 0, 0);
  scan.resizeScan(ranges_m.size());
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    const double bearing_rad =
        -half_rad + 2 * half_rad * static_cast<double>(i) / static_cast<double>(ranges_m.size() - 1);
    const double col = view.rig.centre_x_px - view.rig.focal_px * std::tan(bearing_rad);
    const double range_m = ranges_m[static_cast<std::size_t>(std::lround(col))];
    scan.setScanRange(i, static_cast<float>(range_m));
    scan.setScanRangeValidity(i, range_m > 0);
  }
  map.insertObservation(
      scan, mrpt::poses::CPose3D(map_from_base.x_m, map_from_base.y_m, 0, map_from_base.yaw_rad, 0, 0));
}

mrpt::maps::COccupancyGridMap2D emptyMrptMap() {
  const GridParams ours;
  mrpt::maps::COccupancyGridMap2D map(0, 1, 0, 1, static_cast<float>(ours.resolution_m));
  map.insertionOptions.considerInvalidRangesAsFreeSpace = false;
  map.insertionOptions.maxDistanceInsertion = static_cast<float>(ours.max_range_m);
  return map;
}

GridMap fromMrpt(const mrpt::maps::COccupancyGridMap2D& map) {
  GridMap result;
  result.geometry = {map.getResolution(), map.getXMin(), map.getYMin(), static_cast<int>(map.getSizeX()),
                     static_cast<int>(map.getSizeY())};
  result.occupied = cv::Mat1f(result.geometry.rows, result.geometry.cols, kUnseen);
  for (int row = 0; row < result.geometry.rows; ++row)
    for (int col = 0; col < result.geometry.cols; ++col) {
      const float free = map.getCell(col, row);
      if (std::abs(free - 0.5F) > 0.01F) result.occupied(row, col) = 1 - free;
    }
  return result;
}

mrpt::maps::COccupancyGridMap2D toMrpt(const GridMap& map) {
  const GridGeometry& g = map.geometry;
  mrpt::maps::COccupancyGridMap2D result(
      static_cast<float>(g.origin_x_m), static_cast<float>(g.origin_x_m + g.cols * g.resolution_m),
      static_cast<float>(g.origin_y_m), static_cast<float>(g.origin_y_m + g.rows * g.resolution_m),
      static_cast<float>(g.resolution_m));
  for (int row = 0; row < g.rows; ++row)
    for (int col = 0; col < g.cols; ++col) result.setCell(col, row, 1 - map.occupied(row, col));
  return result;
}

namespace {

mrpt::maps::CMultiMetricMap withPoints(const GridMap& map, bool with_points) {
  mrpt::maps::CMultiMetricMap result;
  result.maps.push_back(std::make_shared<mrpt::maps::COccupancyGridMap2D>(toMrpt(map)));
  if (!with_points) return result;
  const auto points = std::make_shared<mrpt::maps::CSimplePointsMap>();
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col) {
      if (map.occupied(row, col) <= 0.65F) continue;
      const Eigen::Vector2f at_m = map.geometry.centreOf({col, row}).cast<float>();
      points->insertPoint(at_m.x(), at_m.y(), 0);
    }
  result.maps.push_back(points);
  return result;
}

}  // namespace

std::optional<Pose2> alignMrpt(const GridMap& reference, const GridMap& current, MrptAligner kind) {
  // The aligner keeps features by the address of a map: every map is kept, so that no address comes twice.
  static std::list<mrpt::maps::CMultiMetricMap> kept;
  const bool with_points = kind == MrptAligner::kGridsAndPoints || kind == MrptAligner::kMoreFeatures;
  const auto& m1 = kept.emplace_back(withPoints(reference, with_points));
  const auto& m2 = kept.emplace_back(withPoints(current, with_points));
  mrpt::math::CMatrixDouble33 covariance;
  covariance.setDiagonal(std::vector<double>{1e4, 1e4, 1e2});
  mrpt::slam::CGridMapAligner aligner;
  aligner.setMinLoggingLevel(mrpt::system::LVL_ERROR);
  if (kind == MrptAligner::kMoreFeatures || kind == MrptAligner::kMoreFeaturesOnGrids) {
    aligner.options.featsPerSquareMeter = 0.05F;
    aligner.options.ransac_minSetSizeRatio = 0.1F;
  }
  const auto answer = aligner.AlignPDF(&m1, &m2, mrpt::poses::CPosePDFGaussian({}, covariance));
  const auto modes = std::dynamic_pointer_cast<mrpt::poses::CPosePDFSOG>(answer);
  if (!modes || modes->empty()) return {};
  const auto best = std::max_element(modes->begin(), modes->end(),
                                     [](const auto& a, const auto& b) { return a.log_w < b.log_w; });
  return Pose2{best->mean.x(), best->mean.y(), best->mean.phi()};
}

namespace {

cv::Mat1b greyOf(const GridMap& map) {
  cv::Mat1b grey(map.occupied.size());
  map.occupied.convertTo(grey, CV_8U, -255, 255);
  return grey;
}

// Metres of a pixel of greyOf, whose rows grow with y.
Eigen::Vector2d metresOf(const GridMap& map, const Eigen::Vector2d& pixel) {
  return map.geometry.toMetres(pixel);
}

}  // namespace

std::optional<Pose2> alignFeatures(const GridMap& reference, const GridMap& current) {
  constexpr std::size_t kMinInliers = 12;
  constexpr float kRatio = 0.8F;
  const auto detector = cv::AKAZE::create();
  std::vector<cv::KeyPoint> there, here;
  cv::Mat described_there, described_here;
  detector->detectAndCompute(greyOf(reference), cv::noArray(), there, described_there);
  detector->detectAndCompute(greyOf(current), cv::noArray(), here, described_here);
  if (there.size() < 2 || here.size() < 2) return {};
  std::vector<std::vector<cv::DMatch>> matches;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(described_here, described_there, matches, 2);
  std::vector<cv::Point2f> from, to;
  for (const auto& best : matches) {
    if (best.size() < 2 || best[0].distance > kRatio * best[1].distance) continue;
    from.push_back(here[static_cast<std::size_t>(best[0].queryIdx)].pt);
    to.push_back(there[static_cast<std::size_t>(best[0].trainIdx)].pt);
  }
  if (from.size() < kMinInliers) return {};
  std::vector<unsigned char> inliers;
  const cv::Mat affine = cv::estimateAffinePartial2D(from, to, inliers, cv::RANSAC, 3);
  if (affine.empty() || std::count(inliers.begin(), inliers.end(), 1) < static_cast<long>(kMinInliers))
    return {};
  const double c = affine.at<double>(0, 0), s = affine.at<double>(1, 0), scale = std::hypot(c, s);
  if (scale < 0.9 || scale > 1.1) return {};
  const Pose2 turn{0, 0, std::atan2(s, c)};
  const Eigen::Vector2d pixel(affine.at<double>(0, 2),
                              affine.at<double>(1, 2));  // where the current's (0, 0) lies
  const Eigen::Vector2d shift = metresOf(reference, pixel) - turn * metresOf(current, {0, 0});
  return Pose2{shift.x(), shift.y(), turn.yaw_rad};
}

}  // namespace cornerstone::bench
