// The other robot as a robot's map shows it: an obstacle where it stood, on floor that its own map knows to
// be free. That contradicts the right pose as a moved box would, but both robots know where they have been.
//
// A small thing of one map, alone on the floor, all of which lies where under a pose the other map's robot
// has been is taken for that robot, and what contradicts there is excused. Walls are not: they are longer
// than a robot. Nothing is where robots are the lesser part of what contradicts, and nothing speaks for a
// pose. Metres; counts as in pose_score.h.
#pragma once

#include <array>
#include <vector>

#include "cornerstone/registration/pose_score.h"

namespace cornerstone {

class RobotBodies {
 public:
  // The maps must outlive this. robot_radius_m: of the larger robot. Maps whose ways are not known excuse
  // nothing.
  RobotBodies(const EvidencePair& maps, double robot_radius_m);

  // A score less what the robots alone contradict.
  PoseScore excused(const PoseScore& score, const Pose2& reference_from_current) const;

 private:
  // What one robot saw and where the other one was, each in its own map.
  struct Side {
    const EvidenceGrid& walked;       // of the other robot's map
    std::vector<EdgeSamples> things;  // small ones, of this map
    EdgeIndex way;                    // of the other robot
  };
  double contradictedBy(const Side& side, const Pose2& walked_from_seen) const;

  double reach_m_;  // of a robot's edges from its way
  std::array<Side, 2> sides_;
};

}  // namespace cornerstone
