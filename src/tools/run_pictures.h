// Pictures of a recorded run, as the paper's figures.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/registration/register_maps.h"
#include "tools/run_recording.h"

namespace cornerstone {

// Figure 2, a to e, of one frame of a robot: grey image, disparity, largest disparity of each column, depth
// of each column, and the view from above. InputError when the bag holds no such frame.
cv::Mat3b pictureOfOneFrame(const std::string& bag, const std::string& robot, double time_s);

// The last map of a robot over the outlines of the true world (thin, red); empty where there is no map or no
// world.
cv::Mat3b pictureOfMapAndTruth(const RunRecording& run, const std::string& robot);

}  // namespace cornerstone
