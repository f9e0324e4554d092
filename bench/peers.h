// What users would take instead: OpenCV's matchers, MRPT's own insertion and its grid aligner.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <vector>

#include "cornerstone/mapping/occupancy_grid.h"
#include "cornerstone/scan/column_scan.h"
#include "cornerstone/stereo/trinocular_rig.h"

namespace cornerstone::bench {

// Block 9, texture 10, uniqueness 10, left-right check 1 px, speckles of 100 px within 16 / 16 px dropped.
cv::Ptr<cv::StereoMatcher> makeStereoBM(int max_disparity_px);
// Block 5, P1 8 x 25, P2 32 x 25, left-right check 1 px, uniqueness 10, speckles of 100 px within 2 px
// dropped.
cv::Ptr<cv::StereoMatcher> makeStereoSGBM(int max_disparity_px);
// In px, 0: no answer. Both images are padded at the left by the largest disparity (edge pixels repeated),
// which saves the left columns that these matchers leave out.
cv::Mat1f matchOpenCV(cv::StereoMatcher& matcher, const cv::Mat1b& reference, const cv::Mat1b& right);

struct CameraView {
  TrinocularRig rig;
  Eigen::Isometry3d base_from_camera;
};
// Planar range of each column's nearest pixel whose height lies within the band; 0: none. The rule of
// depthimage_to_laserscan.
std::vector<double> nearestRanges(const cv::Mat1f& disparity_px, const CameraView& view);
// Ranges of the columns, in even steps of bearing, inserted at the pose.
void insertRanges(const std::vector<double>& ranges_m, const CameraView& view, const Pose2& map_from_base,
                  mrpt::maps::COccupancyGridMap2D& map);
// MRPT's default insertion but for considerInvalidRangesAsFreeSpace (off: it would erase bare walls) and the
// range, which is cornerstone's.
mrpt::maps::COccupancyGridMap2D emptyMrptMap();

GridMap fromMrpt(const mrpt::maps::COccupancyGridMap2D& map);
mrpt::maps::COccupancyGridMap2D toMrpt(const GridMap& map);

// CGridMapAligner with a prior that says nothing; empty: no mode left.
enum class MrptAligner {
  kGrids,           // default options
  kGridsAndPoints,  // the occupied cells also as a point map, which its last step (ICP) needs
  kMoreFeatures,    // the same with three times the features and half the consensus
  kMoreFeaturesOnGrids
};
std::optional<Pose2> alignMrpt(const GridMap& reference, const GridMap& current, MrptAligner aligner);

// The map-merging recipe: AKAZE features of the maps as grey pictures, matched by ratio, a similarity by
// RANSAC. Empty: fewer than 12 inliers, or a scale that is none.
std::optional<Pose2> alignFeatures(const GridMap& reference, const GridMap& current);

}  // namespace cornerstone::bench
