#include "cornerstone/mapping/map_redraw.h"

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
    map_.insert(corrected(look.scan, solution_.calibration), map_from_base, motion);
    last_ = map_from_base;
    ++look_;
  }
  if (look_ >= frame.looks.size() && frame_ + 1 < frames.size()) {
    ++frame_;
    look_ = 0;
  }
}

}  // namespace cornerstone
