#include "cornerstone/mapping/map_redraw.h"

#include <cmath>
#include <limits>
#include <utility>

namespace cornerstone {

MapRedraw::MapRedraw(LocalMap blank, GraphSolution solution)
    : map_(std::move(blank)), solution_(std::move(solution)) {}

// The last frame still gathers looks: the running map has them, and they are drawn when the robot has left.
bool MapRedraw::finished(const std::vector<KeyFrame>& frames) const {
  return frame_ >= frames.size() || (frame_ + 1 == frames.size() && look_ >= frames.back().looks.size());
}

void MapRedraw::goOn(const std::vector<KeyFrame>& frames, int looks) {
  for (int i = 0; i < looks && !finished(frames); ++i) drawNext(frames);
}

void MapRedraw::drawNext(const std::vector<KeyFrame>& frames) {
  const KeyFrame& frame = frames[frame_];
  const bool solved = frame_ < solution_.map_from_base.size();
  const Pose2 map_from_frame =
      solved ? solution_.map_from_base[frame_] : correctionOf(solution_, frames) * frame.map_from_base;
  if (look_ < frame.looks.size()) {
    const KeptLook& look = frame.looks[look_];
    const Pose2 map_from_base = map_from_frame * look.frame_from_base;
    const LookMotion motion = last_ ? motionBetween(*last_, map_from_base) : kFirstLook;
    map_.insert(corrected(*look.scan, solution_.calibration), map_from_base, motion);
    last_ = map_from_base;
    ++look_;
  }
  if (look_ >= frame.looks.size() && frame_ + 1 < frames.size()) {
    ++frame_;
    look_ = 0;
  }
}

namespace {

bool movesTheMap(const GraphProblem& before, const GraphSolution& now, const RedrawLimit& limit) {
  const Eigen::Vector2d change(now.calibration.offset_per_m - before.calibration.offset_per_m,
                               now.calibration.slope_per_m - before.calibration.slope_per_m);
  if (change.norm() * limit.at_m * limit.at_m > limit.shift_m) return true;
  for (std::size_t i = 0; i < now.map_from_base.size(); ++i) {
    const Pose2 moved = before.map_from_base[i].inverse() * now.map_from_base[i];
    if (moved.translation().norm() + limit.at_m * std::abs(moved.yaw_rad) > limit.shift_m) return true;
  }
  return false;
}

// What drawing needs of the frames; the scans are shared.
std::vector<KeyFrame> allButTheLast(const std::vector<KeyFrame>& frames) {
  std::vector<KeyFrame> copies(frames.size() - 1);
  for (std::size_t i = 0; i < copies.size(); ++i) {
    copies[i].map_from_base = frames[i].map_from_base;
    copies[i].looks = frames[i].looks;
  }
  return copies;
}

}  // namespace

std::future<std::optional<MapRedraw>> startRedraw(FrameGraph& graph, const LocalMap& blank,
                                                  const RedrawTask& task) {
  return std::async(std::launch::async,
                    [problem = graph.beginSolution(), frames = allButTheLast(graph.frames()), blank,
                     task]() -> std::optional<MapRedraw> {
                      std::optional<GraphSolution> solution;
                      if (task.loop) solution = closeLoop(problem, *task.loop, task.max_strain_sigmas);
                      if (!solution) solution = solve(problem);
                      if (!solution || !movesTheMap(problem, *solution, task.limit)) return std::nullopt;
                      MapRedraw redraw(blank, std::move(*solution));
                      redraw.goOn(frames, std::numeric_limits<int>::max());
                      return redraw;
                    });
}

}  // namespace cornerstone
