// Pictures of maps, edges and corners, as in the paper's figures 4 to 10. Images have their first row at the
// largest y.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

// What lies where on a picture: a rectangle of a map's frame at so many pixels a metre.
struct Canvas {
  Eigen::Vector2d low_m;  // lower left corner
  double px_per_m = 40;
  cv::Mat3b image;

  // For everything that the maps show, each placed by canvas_from_map; at most max_px a side.
  static Canvas over(const std::vector<std::pair<const GridMap*, Pose2>>& maps, int max_px = 2000);
  cv::Point2d at(const Eigen::Vector2d& point_m) const;
};

const cv::Vec3b kReferenceColour{200, 60, 0};    // blue, OpenCV's order
const cv::Vec3b kCurrentColour{0, 60, 220};      // red
const cv::Vec3b kInsideFreeColour{0, 0, 230};    // red
const cv::Vec3b kInsideSolidColour{220, 90, 0};  // blue
const cv::Vec3b kMatchColour{0, 160, 0};         // green

// Free white, occupied dark, unknown grey, as the cells' probabilities say.
void drawMap(Canvas& canvas, const GridMap& map, const Pose2& canvas_from_map);
void drawEdges(Canvas& canvas, const std::vector<EdgePoint>& edges, const Pose2& canvas_from_map,
               const cv::Vec3b& colour);
// Both arms at arm_m; a dot at the apex.
void drawCorners(Canvas& canvas, const std::vector<CornerLandmark>& corners, const Pose2& canvas_from_map,
                 double arm_m);
void drawMatches(Canvas& canvas, const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& pairs_m);

// Throws InputError naming the file when it cannot be written.
void writePicture(const cv::Mat3b& image, const std::string& path);

// Map, edges and corners (figures 4, 6 and 8).
cv::Mat3b pictureOfLandmarks(const GridMap& map, const Landmarks& landmarks, double arm_m);
// Edges of both maps laid over each other by a pose, with the matched corners joined (figures 9 and 10).
struct Overlay {
  const GridMap& reference;
  const Landmarks& reference_landmarks;
  const GridMap& current;
  const Landmarks& current_landmarks;
  std::vector<std::pair<int, int>> matches;
};
cv::Mat3b pictureOfOverlay(const Overlay& overlay, const Pose2& reference_from_current);

}  // namespace cornerstone
