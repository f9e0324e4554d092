// From a disparity image to one range per image column (paper, section 2.1 and Fig. 2): the nearest surface
// within a height band that enough pixels of the column agree on, averaged over those pixels. Several bands,
// called levels, are read in one pass over the image: the first is what the robot drives by, a near-ceiling
// one sees the corners of rooms over the furniture (the paper's future work).
//
// A pixel (u, v) with inverse depth 1/Z looks along r = R ((u - cx) / f, (v - cy) / f, 1) in the base frame;
// its inverse planar range is q = (1/Z) / |r_xy|, in which stereo noise is even: sigma_q = sigma_d / (f B
// |r_xy|). A vertical wall has one q for the whole column whatever the camera's pitch. Fails silently (empty
// beam) where nothing is matched; a column whose only matches lie behind a bare near object is answered
// wrongly: stereo cannot know.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "cornerstone/base/params.h"
#include "cornerstone/scan/range_scan.h"
#include "cornerstone/stereo/disparity.h"

namespace cornerstone {

struct Level {
  std::string name;    // of its topic, map/<name>: small letters, digits and _, a letter first
  double z_min_m = 0;  // above the floor
  double z_max_m = 0;
};
void describe(ParamVisitor& visitor, Level& level);

struct ScanParams {
  // The first is the one to drive by: lower points are floor, higher ones do not hinder the robot.
  std::vector<Level> levels{{"obstacles", 0.15, 1.50}};
  // Pixels of a column that must agree before they are an obstacle; a mismatch rarely fills more of a column.
  int min_support_px = 6;
  // Fewer pixels than an obstacle needs but at least these end the free space before them: caution, no
  // obstacle.
  int min_caution_px = 3;
  double agree_sigmas = 2.5;  // pixels this near to each other, in their own sigmas, show one surface
  double height_sigmas = 3;   // a point counts as inside a level when it is so by this many sigmas
  // Of the floor against the robot: what is left of pitch and roll that the poses do not tell. It keeps a far
  // floor out of the map when the robot brakes.
  double tilt_sigma_rad = 0.3 * M_PI / 180;
  // Pixels that share one matching error, an edge of the matcher's window: averaging n pixels counts as n /
  // this.
  double correlated_px = 9;
  // Error of all disparities of a frame together (calibration, pixel locking), which no averaging removes.
  double common_sigma_px = 0.1;
  // Of it, what a rig gets wrong in every look alike (scan_calibration.h): for rigs that calibrate themselves
  // (stereo/self_calibration.h) a hundredth of a pixel or two, else 0.05 to 0.1. The mapper looks for no
  // more.
  double calibration_sigma_px = 0.01;
  double min_range_m = 0.2;  // from the camera; nearer answers are mismatches
  // Points within this radius of the base's origin are the robot's own body (bumper, mast, payload).
  double body_radius_m = 0.2;
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
