// Where a robot comes back to after a long way: drift may have put it farther from where it was then than
// frames are held against each other (frame_match.h), and it would draw its walls a second time.
//
// The newest looks, together one wide look, are sought on a map of the old ones alone (relocalisation.h).
// Where they lie on it, at one place only, single frames of then and now are matched from there. The loop is
// believed if the whole way can be bent so that these matches fit, and if that asks no more of odometry and
// of all other matches than they may be wrong: rooms that look alike must not become one.
#pragma once

#include <optional>
#include <vector>

#include "cornerstone/mapping/frame_graph.h"
#include "cornerstone/mapping/relocalisation.h"

namespace cornerstone {

// For sensors that see half a turn or more, as the relocalisation that it rests on; off by default.
struct LoopParams {
  double reach_m = 0;  // of the search around the robot's pose; 0: none
  double reach_rad = 20 * M_PI / 180;
  // Of the way since the robot was there, or was last seen to stand where it has itself on that old map: it
  // is not sought farther off.
  double max_drift_ratio = 0.05;
  double min_way_m = 15;          // since then: what is nearer is tied by the frames between
  double look_way_m = 5;          // of the newest looks that are sought together
  double min_known_share = 0.5;   // of their ends: the map of then knows that much of what is seen now
  double max_strain_sigmas = 10;  // that closing the loop may put on all else that is known
};
void describe(ParamVisitor& visitor, LoopParams& params);
void requireValid(const LoopParams& params);  // throws InputError naming the parameter

struct IndexedFrame {
  std::size_t index;  // in the graph
  KeyFrame frame;
};

// Copies of the frames, so that the search can go on beside the mapper.
struct OpenLoop {
  std::vector<IndexedFrame> then;
  std::vector<IndexedFrame> now;  // the newest
  double way_m = 0;               // on which it has drifted
};
// None where the robot is at no old place. sure: the frame since which it may have drifted.
std::optional<OpenLoop> openLoop(const FrameGraph& graph, std::size_t sure, const LoopParams& params);

struct FoundLoop {
  std::vector<GraphMatch> matches;
  std::size_t then = 0, now = 0;  // two frames and how they lie, as the search has it
  Pose2 then_from_now;
};
struct LoopSearchParams {
  LoopParams loop;
  FrameGraphParams graph;
  RelocalisationParams place;
  ScanFitParams fit;
  GridParams grid;
  ScanCalibration calibration;
};
struct LoopSearch {
  std::size_t now = 0;             // the newest frame
  bool sure = false;               // it stands on the old map where it should
  std::optional<FoundLoop> found;  // it stands elsewhere
};
LoopSearch findLoop(const OpenLoop& loop, const LoopSearchParams& params);

// The way bent so that the loop closes, its matches in the solution's `loop`; none where that asks too much.
std::optional<GraphSolution> closeLoop(const GraphProblem& problem, const FoundLoop& loop,
                                       double max_strain_sigmas);

}  // namespace cornerstone
