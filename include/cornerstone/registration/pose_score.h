// How well a pose of one map in another agrees with both: the current map's edges on the reference map and
// the other way round. An edge on an edge of the same direction agrees, an edge on surely free space
// contradicts, unknown says nothing. Counted in edges of the thinned maps, each about one square of wall.
#pragma once

#include <vector>

#include "cornerstone/base/pose2.h"
#include "cornerstone/landmarks/edge_index.h"
#include "cornerstone/registration/evidence_grid.h"
#include "cornerstone/registration/thin_edges.h"

namespace cornerstone {

struct MapEvidence {
  EvidenceGrid coarse;
  EvidenceGrid fine;
  std::vector<EdgePoint> edges;        // thinned, in an order without pattern
  EdgeSamples samples;                 // the same, for the grids
  Eigen::Vector2d middle_m;            // mean of the edges
  double cell_m;                       // of the map itself
  std::vector<double> directions;      // of the walls (proposals.h)
  EdgeIndex all_edges;                 // of the map, as found
  std::vector<Eigen::Vector2d> way_m;  // where the map's own robot has been; empty: not known
};

struct EvidencePair {
  const MapEvidence& reference;
  const MapEvidence& current;
};

struct PoseScore {
  double agree = 0;
  double contradict = 0;
  // Share of the edges that the other map can judge which agree.
  double agreement() const { return agree > 0 ? agree / (agree + contradict) : 0; }
};

enum class ScoreLevel { kCoarse, kFine };

// How closely a pose is looked at.
struct Look {
  ScoreLevel level;
  std::size_t max_samples;  // of each map; the counts are scaled up to all of them
};

// The edges of one map on the grid of another; the first max_samples stand for all.
PoseScore scoreSamples(const EvidenceGrid& grid, const EdgeSamples& samples, const Pose2& grid_from_samples,
                       std::size_t max_samples);

PoseScore scorePose(const EvidencePair& maps, const Pose2& reference_from_current, const Look& look);

}  // namespace cornerstone
