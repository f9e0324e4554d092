// From a disparity image to one range per image column (paper, section 2.1 and Fig. 2): the nearest surface
// within a height band that enough pixels of the column agree on, averaged over those pixels.
//
// A pixel (u, v) with inverse depth 1/Z looks along r = R ((u - cx) / f, (v - cy) / f, 1) in the base frame;
// its inverse planar range is q = (1/Z) / |r_xy|, in which stereo noise is even: sigma_q = sigma_d / (f B
// |r_xy|). A vertical wall has one q for the whole column whatever the camera's pitch. Fails silently (empty
// beam) where nothing is matched; a column whose only matches lie behind a bare near object is answered
// wrongly: stereo cannot know.
#pragma once

#include <Eigen/Geometry>

#include "cornerstone/base/params.h"
#include "cornerstone/scan/range_scan.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

struct ScanParams {
  double z_min_m = 0.15;  // above the floor: lower points are floor
  double z_max_m = 1.50;  // higher points do not hinder the robot
  // Pixels of a column that must agree before they are an obstacle; a mismatch rarely fills more of a column.
  int min_support_px = 6;
  // Fewer pixels than an obstacle needs but at least these end the free space before them: caution, no
  // obstacle.
  int min_caution_px = 3;
  double agree_sigmas = 2.5;  // pixels this near to each other, in their own sigmas, show one surface
  double height_sigmas = 3;   // a point counts as inside the band when it is so by this many sigmas
  // Pixels that share one matching error, an edge of the matcher's window: averaging n pixels counts as n /
  // this.
  double correlated_px = 9;
  // Error of all disparities of a frame together (calibration, pixel locking), which no averaging removes.
  double common_sigma_px = 0.1;
  double min_range_m = 0.2;  // nearer answers are the robot's own body or mismatches
};
void describe(ParamVisitor& visitor, ScanParams& params);
void requireValid(const ScanParams& params);  // throws InputError naming the parameter

// base_from_camera: pose of the reference camera's optical frame (z forward, x right, y down) in the base
// frame (x forward, z up, origin on the floor). The scan's sensor frame lies at the camera, heading along its
// optical axis.
RangeScan scanFromDisparity(const Disparity& disparity, const Eigen::Isometry3d& base_from_camera,
                            const ScanParams& params);

// What both stereo and depth cameras come down to; 1/m, even noise.
struct InverseDepthImage {
  cv::Mat1f inverse_depth;  // 1/Z in 1/m; 0: no answer
  cv::Mat1f sigma;          // standard deviation in 1/m
  double common_sigma = 0;  // error of the whole image together, 1/m
  double focal_px = 0;
  double centre_x_px = 0;
  double centre_y_px = 0;
};
RangeScan scanFromInverseDepth(const InverseDepthImage& image, const Eigen::Isometry3d& base_from_camera,
                               const ScanParams& params);

}  // namespace cornerstone
