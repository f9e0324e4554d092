// Draws the map anew with the poses of a solved graph, a few looks at a time beside the running map, so that
// no scan waits for it. Frames that are added meanwhile are drawn, too, moved as the last one solved.
#pragma once

#include <optional>

#include "cornerstone/mapping/frame_graph.h"
#include "cornerstone/mapping/occupancy_grid.h"

namespace cornerstone {

class MapRedraw {
 public:
  MapRedraw(const GridParams& params, GraphSolution solution);
  // Draws at most `looks` of those that are left.
  void goOn(const std::vector<KeyFrame>& frames, int looks);
  bool finished(const std::vector<KeyFrame>& frames) const;
  const GraphSolution& solution() const { return solution_; }
  OccupancyGrid takeGrid() { return std::move(grid_); }

 private:
  void drawNext(const std::vector<KeyFrame>& frames);

  OccupancyGrid grid_;
  GraphSolution solution_;
  std::size_t frame_ = 0, look_ = 0;  // to draw next
  std::optional<Pose2> last_;         // map_from_base of the look before
};

}  // namespace cornerstone
