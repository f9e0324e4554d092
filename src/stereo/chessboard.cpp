#include "cornerstone/stereo/chessboard.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

// Half the edge of the window that corners are refined in, of the distance to the nearest other corner: more
// would take in its edges.
constexpr double kRefineShare = 0.4;
constexpr int kLargestRefine_px = 8;

double smallestDistance(const std::vector<cv::Point2f>& corners, int row_length) {
  double smallest = 1e9;
  for (std::size_t i = 1; i < corners.size(); ++i)
    if (i % static_cast<std::size_t>(row_length) != 0)
      smallest = std::min(smallest, cv::norm(corners[i] - corners[i - 1]));
  for (auto i = static_cast<std::size_t>(row_length); i < corners.size(); ++i)
    smallest = std::min(smallest, cv::norm(corners[i] - corners[i - static_cast<std::size_t>(row_length)]));
  return smallest;
}

}  // namespace

void requireUsable(const Chessboard& board) {
  requireWithin(board.inner_corners.width, 3, 100, "board: inner corners along a row");
  requireWithin(board.inner_corners.height, 3, 100, "board: inner corners along a column");
  requirePositive(board.square_m, "square: edge in m");
}

std::vector<cv::Point3f> cornersOnBoard(const Chessboard& board) {
  std::vector<cv::Point3f> corners;
  for (int row = 0; row < board.inner_corners.height; ++row)
    for (int col = 0; col < board.inner_corners.width; ++col)
      corners.emplace_back(static_cast<float>(col * board.square_m), static_cast<float>(row * board.square_m),
                           0.F);
  return corners;
}

std::vector<cv::Point2f> findCorners(const cv::Mat1b& image, const Chessboard& board) {
  std::vector<cv::Point2f> corners;
  const int flags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
  if (!cv::findChessboardCorners(image, board.inner_corners, corners, flags)) return {};
  const double room_px = kRefineShare * smallestDistance(corners, board.inner_corners.width);
  const int half_px = std::clamp(static_cast<int>(room_px), 2, kLargestRefine_px);
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-3);
  cv::cornerSubPix(image, corners, {half_px, half_px}, {-1, -1}, until);
  return corners;
}

}  // namespace cornerstone
