#include "tools/drawing.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr double kMarginM = 0.5;
constexpr double kMaxPxPerM = 40;  // two pixels a cell of 0.05 m
const cv::Vec3b kUnknownGrey{205, 205, 205};

// The part of a map that was seen.
cv::Rect seenPart(const GridMap& map) {
  cv::Mat seen;
  cv::compare(map.occupied, kUnseen, seen, cv::CMP_NE);
  return cv::boundingRect(seen);
}

cv::Vec3b shade(float probability) {
  const auto grey = static_cast<unsigned char>(std::lround(255 - 175 * std::clamp(probability, 0.0f, 1.0f)));
  return probability == kUnseen ? kUnknownGrey : cv::Vec3b{grey, grey, grey};
}

cv::Point rounded(const cv::Point2d& point) {
  return {static_cast<int>(std::lround(point.x)), static_cast<int>(std::lround(point.y))};
}

}  // namespace

Canvas Canvas::over(const std::vector<std::pair<const GridMap*, Pose2>>& maps, int max_px) {
  Eigen::Vector2d low(0, 0), high(0, 0);
  bool first = true;
  for (const auto& [map, canvas_from_map] : maps) {
    const cv::Rect part = seenPart(*map);
    for (const int col : {part.x, part.x + part.width}) {
      for (const int row : {part.y, part.y + part.height}) {
        const Eigen::Vector2d corner =
            canvas_from_map * map->geometry.toMetres(Eigen::Vector2d(col - 0.5, row - 0.5));
        low = first ? corner : Eigen::Vector2d(low.cwiseMin(corner));
        high = first ? corner : Eigen::Vector2d(high.cwiseMax(corner));
        first = false;
      }
    }
  }
  low.array() -= kMarginM;
  high.array() += kMarginM;
  Canvas canvas;
  canvas.low_m = low;
  canvas.px_per_m = std::min(kMaxPxPerM, max_px / (high - low).maxCoeff());
  const Eigen::Vector2d size = (high - low) * canvas.px_per_m;
  canvas.image =
      cv::Mat3b(static_cast<int>(std::ceil(size.y())), static_cast<int>(std::ceil(size.x())), kUnknownGrey);
  return canvas;
}

cv::Point2d Canvas::at(const Eigen::Vector2d& point_m) const {
  return {(point_m.x() - low_m.x()) * px_per_m, image.rows - (point_m.y() - low_m.y()) * px_per_m};
}

void drawMap(Canvas& canvas, const GridMap& map, const Pose2& canvas_from_map) {
  const Pose2 map_from_canvas = canvas_from_map.inverse();
  for (int row = 0; row < canvas.image.rows; ++row) {
    for (int col = 0; col < canvas.image.cols; ++col) {
      const Eigen::Vector2d offset((col + 0.5) / canvas.px_per_m,
                                   (canvas.image.rows - row - 0.5) / canvas.px_per_m);
      const Cell cell = map.geometry.cellAt(map_from_canvas * Eigen::Vector2d(canvas.low_m + offset));
      if (map.geometry.contains(cell)) canvas.image(row, col) = shade(map.occupied(cell.row, cell.col));
    }
  }
}

void drawEdges(Canvas& canvas, const std::vector<EdgePoint>& edges, const Pose2& canvas_from_map,
               const cv::Vec3b& colour) {
  for (const EdgePoint& edge : edges)
    cv::circle(canvas.image, rounded(canvas.at(canvas_from_map * edge.position_m)), 1, colour, cv::FILLED);
}

void drawCorners(Canvas& canvas, const std::vector<CornerLandmark>& corners, const Pose2& canvas_from_map,
                 double arm_m) {
  for (const CornerLandmark& corner : corners) {
    const cv::Vec3b colour = corner.kind == CornerKind::kInsideFree ? kInsideFreeColour : kInsideSolidColour;
    const Pose2 pose = canvas_from_map * corner.pose;
    const cv::Point apex = rounded(canvas.at(pose.translation()));
    cv::line(canvas.image, apex, rounded(canvas.at(pose * Eigen::Vector2d(arm_m, 0))), colour, 2,
             cv::LINE_AA);
    cv::line(canvas.image, apex, rounded(canvas.at(pose * Eigen::Vector2d(0, arm_m))), colour, 2,
             cv::LINE_AA);
    cv::circle(canvas.image, apex, 3, colour, cv::FILLED, cv::LINE_AA);
  }
}

void drawMatches(Canvas& canvas, const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>& pairs_m) {
  for (const auto& [one, other] : pairs_m) {
    cv::line(canvas.image, rounded(canvas.at(one)), rounded(canvas.at(other)), kMatchColour, 1, cv::LINE_AA);
    cv::circle(canvas.image, rounded(canvas.at(one)), 7, kMatchColour, 2, cv::LINE_AA);
  }
}

void writePicture(const cv::Mat3b& image, const std::string& path) {
  bool written = false;
  try {
    written = cv::imwrite(path, image);
  } catch (const cv::Exception&) {
    written = false;  // an unknown file ending throws
  }
  if (!written) throw InputError(path + ": cannot write the picture");
}

cv::Mat3b pictureOfLandmarks(const GridMap& map, const Landmarks& landmarks, double arm_m) {
  Canvas canvas = Canvas::over({{&map, Pose2{}}});
  drawMap(canvas, map, {});
  drawEdges(canvas, landmarks.edges, {}, cv::Vec3b{90, 90, 90});
  drawCorners(canvas, landmarks.corners, {}, arm_m);
  return canvas.image;
}

cv::Mat3b pictureOfOverlay(const Overlay& overlay, const Pose2& reference_from_current) {
  Canvas canvas = Canvas::over({{&overlay.reference, Pose2{}}, {&overlay.current, reference_from_current}});
  canvas.image.setTo(cv::Scalar::all(255));
  drawEdges(canvas, overlay.reference_landmarks.edges, {}, kReferenceColour);
  drawEdges(canvas, overlay.current_landmarks.edges, reference_from_current, kCurrentColour);
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;
  for (const auto& [reference, current] : overlay.matches)
    pairs.emplace_back(
        overlay.reference_landmarks.corners.at(static_cast<std::size_t>(reference)).pose.translation(),
        reference_from_current *
            overlay.current_landmarks.corners.at(static_cast<std::size_t>(current)).pose.translation());
  drawMatches(canvas, pairs);
  return canvas.image;
}

}  // namespace cornerstone
