// The frames of one robot (REP 105). An empty name means the default that hangs on the robot's name.
#pragma once

#include <string>

#include "cornerstone/base/params.h"

namespace cornerstone {

struct FrameNames {
  std::string map;   // empty: <robot>/map
  std::string odom;  // empty: <robot>/odom
  std::string base;  // empty: <robot>/base_link
};
void describe(ParamVisitor& visitor, FrameNames& frames);

// The names with the defaults filled in; InputError when `robot` is empty.
FrameNames completed(FrameNames frames, const std::string& robot);

}  // namespace cornerstone
