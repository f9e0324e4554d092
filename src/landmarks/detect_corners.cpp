#include "cornerstone/landmarks/detect_corners.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "cornerstone/landmarks/corner_candidates.h"
#include "cornerstone/landmarks/corner_fit.h"
#include "cornerstone/landmarks/crop.h"
#include "cornerstone/landmarks/surface_corners.h"

namespace cornerstone {
namespace {

constexpr int kAlignment =
    64;  // cells: candidates are looked for in squares, and cells are looked at in words

}  // namespace

std::vector<CornerLandmark> suppressNear(std::vector<CornerLandmark> corners, double radius_m) {
  std::stable_sort(corners.begin(), corners.end(),
                   [](const CornerLandmark& a, const CornerLandmark& b) { return a.rms_m < b.rms_m; });
  std::vector<CornerLandmark> kept;
  for (const CornerLandmark& corner : corners) {
    const bool suppressed = std::any_of(kept.begin(), kept.end(), [&](const CornerLandmark& better) {
      return better.kind == corner.kind &&
             (better.pose.translation() - corner.pose.translation()).norm() < radius_m;
    });
    if (!suppressed) kept.push_back(corner);
  }
  return kept;
}

void describe(ParamVisitor& visitor, LandmarkParams& params) {
  visitor.group("edges", [&] { describe(visitor, params.edges); });
  visitor.field("arm_length_m", params.arm_length_m);
  visitor.field("model_spacing_m", params.model_spacing_m);
  visitor.field("dilation_m", params.dilation_m);
  visitor.field("candidate_spacing_m", params.candidate_spacing_m);
  visitor.field("max_iterations", params.max_iterations);
  visitor.field("stabiliser", params.stabiliser);
  visitor.field("max_rms_cells", params.max_rms_cells);
  visitor.field("suppression_m", params.suppression_m);
  visitor.field("polish_reach_m", params.polish_reach_m);
  visitor.field("min_support", params.min_support);
}

Landmarks detectLandmarks(const GridMap& map, const LandmarkParams& params) {
  Landmarks landmarks;
  landmarks.states = cellStates(map, params.edges);
  const cv::Rect known = landmarks.states.empty() ? cv::Rect() : cv::boundingRect(landmarks.states);
  if (known.empty()) return landmarks;
  const cv::Rect cells = aligned(known, kAlignment);
  const GridMap part = cropped(map, cells);
  landmarks.edges = findEdges(part, landmarks.states(cells), params.edges);
  if (landmarks.edges.empty()) return landmarks;
  const DistanceField field(landmarks.edges, part.geometry);
  const EdgeIndex index(landmarks.edges, 0.5 * params.arm_length_m);
  CornerFitter fitter(field, index, part.geometry, params);
  std::vector<CornerLandmark> corners;
  for (const Pose2& candidate : findCornerCandidates(field, part.geometry, params)) {
    const std::vector<CornerLandmark> fitted = fitter.fit(candidate);
    corners.insert(corners.end(), fitted.begin(), fitted.end());
  }
  landmarks.corners = suppressNear(std::move(corners), params.suppression_m);
  if (part.surface.empty()) return landmarks;
  const SurfaceCorners on_surface(part.surface, params.arm_length_m);
  for (CornerLandmark& corner : landmarks.corners) corner = on_surface.settled(corner);
  return landmarks;
}

}  // namespace cornerstone
