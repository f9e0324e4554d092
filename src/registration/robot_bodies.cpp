#include "cornerstone/registration/robot_bodies.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace cornerstone {
namespace {

// Beyond the robot's radius: two cells of the map, and what a map bends by in the view of one robot.
constexpr double kPlay_m = 0.2;
// Of what contradicts, at least so much must be robots, or none is excused. At right poses they were half of
// it and more; at wrong ones, where one of them hides some small thing by chance, a tenth.
constexpr double kLeastShare = 1.0 / 3;

EdgeIndex indexOf(const std::vector<Eigen::Vector2d>& way_m, double bucket_m) {
  std::vector<EdgePoint> points;
  points.reserve(way_m.size());
  for (const Eigen::Vector2d& at : way_m) points.push_back({at, Eigen::Vector2d::Zero()});
  return EdgeIndex(points, bucket_m);
}

// Edges that hang together, square by square, and are no wider than a robot.
std::vector<EdgeSamples> smallThings(const MapEvidence& map, double max_size_m) {
  const SquareCounts& squares = map.fine.counts();
  cv::Mat1b occupied(squares.rows, squares.cols, static_cast<unsigned char>(0));
  std::vector<cv::Point> square_of;
  for (const EdgePoint& edge : map.edges) {
    const Eigen::Vector2f at =
        (edge.position_m.cast<float>() - squares.origin_m) * map.fine.squaresPerMetre();
    square_of.emplace_back(std::clamp(static_cast<int>(at.x()), 0, squares.cols - 1),
                           std::clamp(static_cast<int>(at.y()), 0, squares.rows - 1));
    occupied(square_of.back()) = 1;
  }
  cv::Mat1i labels;
  cv::Mat1i boxes;
  cv::Mat1d middles;
  const int count = cv::connectedComponentsWithStats(occupied, labels, boxes, middles);
  std::vector<EdgeSamples> things(static_cast<std::size_t>(count));
  for (std::size_t i = 0; i < map.samples.size(); ++i)
    things[static_cast<std::size_t>(labels(square_of[i]))].add(map.samples.position_m(i),
                                                               map.samples.direction_256[i]);
  const auto isLarge = [&](int label) {
    return std::hypot(boxes(label, cv::CC_STAT_WIDTH), boxes(label, cv::CC_STAT_HEIGHT)) * squares.square_m >
           max_size_m;
  };
  std::vector<EdgeSamples> small;
  for (int label = 1; label < count; ++label)  // 0: no edge
    if (!isLarge(label)) small.push_back(std::move(things[static_cast<std::size_t>(label)]));
  return small;
}

}  // namespace

RobotBodies::RobotBodies(const EvidencePair& maps, double robot_radius_m)
    : reach_m_(robot_radius_m + kPlay_m),
      sides_{Side{maps.reference.fine, {}, indexOf(maps.reference.way_m, reach_m_)},
             Side{maps.current.fine, {}, indexOf(maps.current.way_m, reach_m_)}} {
  const double size_m = 2 * reach_m_;
  if (!maps.reference.way_m.empty()) sides_[0].things = smallThings(maps.current, size_m);
  if (!maps.current.way_m.empty()) sides_[1].things = smallThings(maps.reference, size_m);
}

double RobotBodies::contradictedBy(const Side& side, const Pose2& walked_from_seen) const {
  const Eigen::Matrix2f rotation = walked_from_seen.rotation().cast<float>();
  const Eigen::Vector2f shift = walked_from_seen.translation().cast<float>();
  const auto isOnWay = [&](const Eigen::Vector2f& seen_m) {
    const Eigen::Vector2d at = (rotation * seen_m + shift).cast<double>();
    bool near = false;
    side.way.forEachNear(at, reach_m_, [&](const EdgePoint& place) {
      near = near || (place.position_m - at).squaredNorm() <= reach_m_ * reach_m_;
    });
    return near;
  };
  double contradicted = 0;
  for (const EdgeSamples& thing : side.things) {
    bool is_robot = true;
    for (std::size_t i = 0; i < thing.size() && is_robot; ++i) is_robot = isOnWay(thing.position_m(i));
    if (is_robot) contradicted += scoreSamples(side.walked, thing, walked_from_seen, thing.size()).contradict;
  }
  return contradicted;
}

PoseScore RobotBodies::excused(const PoseScore& score, const Pose2& reference_from_current) const {
  const double robots = 0.5 * (contradictedBy(sides_[0], reference_from_current) +
                               contradictedBy(sides_[1], reference_from_current.inverse()));
  if (robots < kLeastShare * score.contradict) return score;
  return {score.agree, std::max(score.contradict - robots, 0.0)};
}

}  // namespace cornerstone
