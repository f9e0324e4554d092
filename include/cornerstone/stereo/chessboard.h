// Corners of a chessboard in the images of a calibration.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace cornerstone {

struct Chessboard {
  cv::Size inner_corners;  // along a row, along a column
  double square_m = 0;     // edge of a square
};
// Throws InputError on fewer than 3 corners a side or a square that is no positive length.
void requireUsable(const Chessboard& board);

// Where the corners lie on the board, row by row, z = 0.
std::vector<cv::Point3f> cornersOnBoard(const Chessboard& board);

// The corners in an image in the same order, to a fraction of a pixel; empty: no whole board in the image.
// Which end of the board comes first is arbitrary where it looks the same turned by half.
std::vector<cv::Point2f> findCorners(const cv::Mat1b& image, const Chessboard& board);

}  // namespace cornerstone
