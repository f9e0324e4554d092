// Draws the map anew with the poses of a solved graph, beside the running map. Most of it is done in a thread
// of its own (startRedraw), from copies: the mapper goes on meanwhile, and what it adds is drawn afterwards,
// some looks a scan, moved as the last frame solved.
#pragma once

#include <future>
#include <optional>

#include "cornerstone/mapping/local_map.h"
#include "cornerstone/mapping/loop_closure.h"

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

// What moves the map by less than this leaves it as it is.
struct RedrawLimit {
  double shift_m = 0;
  double at_m = 0;  // from the robot: what a turn moves
};

struct RedrawTask {
  std::optional<FoundLoop> loop;  // to be closed
  double max_strain_sigmas = 0;   // in doing so
  RedrawLimit limit;
};

// Solves and draws all frames but the last, which still gathers looks, into a copy of `blank`. None: no
// solution, or nothing moves.
std::future<std::optional<MapRedraw>> startRedraw(FrameGraph& graph, const LocalMap& blank,
                                                  const RedrawTask& task);

}  // namespace cornerstone
