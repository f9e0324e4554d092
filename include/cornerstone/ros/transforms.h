// Poses between tf, messages and the core. A look-up that fails or is not finite is an empty answer, never
// identity.
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <boost/array.hpp>
#include <optional>
#include <string>

#include "cornerstone/base/pose2.h"

namespace cornerstone {

geometry_msgs::Transform toTransform(const Pose2& a_from_b);
geometry_msgs::Pose toPose(const Pose2& a_from_b);
geometry_msgs::TransformStamped toStamped(const Pose2& parent_from_child, const std::string& parent,
                                          const std::string& child, const ros::Time& stamp);

// The planar part of a motion: position and heading of b's x axis in a.
Pose2 planarPart(const Eigen::Isometry3d& a_from_b);

// What planarPart leaves of a motion's turn: pitch and roll of b, without any shift. Position and height are
// left out: odometry's height drifts.
Eigen::Isometry3d tiltOf(const Eigen::Isometry3d& a_from_b);

boost::array<double, 9> toRowMajor(const Eigen::Matrix3d& matrix);
Eigen::Matrix3d fromRowMajor(const boost::array<double, 9>& values);

// target_from_source at an instant; ros::Time(0): the newest known. Does not wait.
std::optional<Eigen::Isometry3d> lookUp(const tf2::BufferCore& buffer, const std::string& target,
                                        const std::string& source, const ros::Time& stamp);

}  // namespace cornerstone
