// Draws the map anew with the poses of a solved graph, a few looks at a time beside the running map, so that
// no scan waits for it. Frames that are added meanwhile are drawn, too, moved as the last one solved.
#pragma once

#include <optional>

#include "cornerstone/mapping/frame_graph.h"
#include "cornerstone/mapping/local_map.h"

namespace cornerstone {

class MapRedraw {
 public:
  MapRedraw(LocalMap blank, GraphSolution solution);
  // Draws at most `looks` of those that are left.
  void goOn(const std::vector<KeyFrame>& frames, int looks);
  bool finished(const std::vector<KeyFrame>& frames) const;
  const GraphSolution& solution() const { return solution_; }
  LocalMap takeMap() { return std::move(map_); }

 private:
  void drawNext(const std::vector<KeyFrame>& frames);

  LocalMap map_;
  GraphSolution solution_;
  std::size_t frame_ = 0, look_ = 0;  // to draw next
  std::optional<Pose2> last_;         // map_from_base of the look before
};

}  // namespace cornerstone
