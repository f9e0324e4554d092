#include "cornerstone/ros/transforms.h"

#include <tf2_eigen/tf2_eigen.h>

#include <cmath>

namespace cornerstone {
namespace {

Eigen::Isometry3d toIsometry(const Pose2& a_from_b) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation() << a_from_b.x_m, a_from_b.y_m, 0;
  motion.linear() = Eigen::AngleAxisd(a_from_b.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return motion;
}

}  // namespace

geometry_msgs::Transform toTransform(const Pose2& a_from_b) {
  return tf2::eigenToTransform(toIsometry(a_from_b)).transform;
}

geometry_msgs::Pose toPose(const Pose2& a_from_b) { return tf2::toMsg(toIsometry(a_from_b)); }

geometry_msgs::TransformStamped toStamped(const Pose2& parent_from_child, const std::string& parent,
                                          const std::string& child, const ros::Time& stamp) {
  geometry_msgs::TransformStamped stamped;
  stamped.header.frame_id = parent;
  stamped.header.stamp = stamp;
  stamped.child_frame_id = child;
  stamped.transform = toTransform(parent_from_child);
  return stamped;
}

Pose2 planarPart(const Eigen::Isometry3d& a_from_b) {
  return {a_from_b.translation().x(), a_from_b.translation().y(),
          std::atan2(a_from_b.linear()(1, 0), a_from_b.linear()(0, 0))};
}

Eigen::Isometry3d tiltOf(const Eigen::Isometry3d& a_from_b) {
  Eigen::Isometry3d tilt = Eigen::Isometry3d::Identity();
  tilt.linear() =
      Eigen::AngleAxisd(-planarPart(a_from_b).yaw_rad, Eigen::Vector3d::UnitZ()) * a_from_b.linear();
  return tilt;
}

boost::array<double, 9> toRowMajor(const Eigen::Matrix3d& matrix) {
  boost::array<double, 9> values;
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data()) = matrix;
  return values;
}

Eigen::Matrix3d fromRowMajor(const boost::array<double, 9>& values) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}

std::optional<Eigen::Isometry3d> lookUp(const tf2::BufferCore& buffer, const std::string& target,
                                        const std::string& source, const ros::Time& stamp) {
  try {
    const Eigen::Isometry3d motion = tf2::transformToEigen(buffer.lookupTransform(target, source, stamp));
    if (!motion.matrix().allFinite()) return {};
    return motion;
  } catch (const tf2::TransformException&) {
    return {};
  }
}

}  // namespace cornerstone
