#include "cornerstone/ros/frame_names.h"

#include "cornerstone/base/errors.h"

namespace cornerstone {

void describe(ParamVisitor& visitor, FrameNames& frames) {
  visitor.field("map", frames.map);
  visitor.field("odom", frames.odom);
  visitor.field("base", frames.base);
}

FrameNames completed(FrameNames frames, const std::string& robot) {
  if (robot.empty()) throw InputError("parameter 'robot' is empty");
  if (frames.map.empty()) frames.map = robot + "/map";
  if (frames.odom.empty()) frames.odom = robot + "/odom";
  if (frames.base.empty()) frames.base = robot + "/base_link";
  return frames;
}

}  // namespace cornerstone
