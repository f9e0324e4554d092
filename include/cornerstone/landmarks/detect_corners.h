// Corners of a grid map (paper, section 3): edges, candidates, least-squares fit, suppression of near
// doubles. Everything is in metres of the map's frame. A map without edges gives empty lists.
#pragma once

#include <vector>

#include "cornerstone/base/params.h"
#include "cornerstone/landmarks/corner.h"
#include "cornerstone/landmarks/edges.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

struct LandmarkParams {
  EdgeParams edges;
  double arm_length_m = 0.5;         // paper: 500 mm
  double model_spacing_m = 0.05;     // between model points: about a cell, finer repeats the same edges
  double dilation_m = 0.1;           // of edges for the candidates: a drawn line at 11 degrees stays inside
  double candidate_spacing_m = 0.2;  // one candidate per square and direction: well inside the fit's reach
  int max_iterations = 10;           // paper: 10, 3 are usual
  double stabiliser = 0.1;           // paper: W = 0.1 I in cells and degrees
  double max_rms_cells = 1.5;        // paper: "one of the few magic numbers"
  double suppression_m = 0.5;        // paper: a corner suppresses worse ones within 500 mm
  double polish_reach_m =
      0.1;  // edges this near an arm decide its line: half a thick wall, less than a door jamb
  double min_support = 0.7;  // share of each arm's length that edges must cover: leaves room for small gaps
};
void describe(ParamVisitor& visitor, LandmarkParams& params);

struct Landmarks {
  cv::Mat1b states;  // CellState of each of the map's cells
  std::vector<EdgePoint> edges;
  std::vector<CornerLandmark> corners;
};

// Best fit first: a corner suppresses those with a higher rms near it (paper, section 4.1); the two kinds are
// different landmarks.
std::vector<CornerLandmark> suppressNear(std::vector<CornerLandmark> corners, double radius_m);

Landmarks detectLandmarks(const GridMap& map, const LandmarkParams& params);

}  // namespace cornerstone
