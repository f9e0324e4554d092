// Corners, registrations and their rviz markers. The message is called Corner, the core's landmark
// CornerLandmark.
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <optional>
#include <vector>

#include "cornerstone/CornerArray.h"
#include "cornerstone/MapRegistration.h"
#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/registration/robot_links.h"

namespace cornerstone {

// now_s: on the clock of the corner's since_s.
Corner toMessage(const CornerLandmark& corner, double now_s);

// The state, pose, covariance and evidence; names, frames and epochs are the caller's to fill in.
MapRegistration toMessage(const SharedFrame& shared, double now_s);
// What another robot's message tells of its map; empty: it is not registered. InputError naming the field at
// fault.
std::optional<ToldRoute> fromMessage(const MapRegistration& message);

// Edges as points (namespace "edges") and each corner as its two arms (namespace "corners"), coloured by
// kind.
visualization_msgs::MarkerArray toMarkers(const Landmarks& landmarks, double arm_length_m,
                                          const std_msgs::Header& header);
// Lines between the matched corners of two maps, in the reference map's frame (namespace "matches").
visualization_msgs::MarkerArray toMatchMarkers(const MapRegistration& registration);

}  // namespace cornerstone
