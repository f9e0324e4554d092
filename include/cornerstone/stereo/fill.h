// cv::Mat::setTo takes memory in every call.
#pragma once

#include <algorithm>
#include <opencv2/core.hpp>

namespace cornerstone {

template <typename Value>
void fillAll(cv::Mat_<Value>& plane, Value value) {
  for (int row = 0; row < plane.rows; ++row) std::fill_n(plane[row], plane.cols, value);
}

}  // namespace cornerstone
