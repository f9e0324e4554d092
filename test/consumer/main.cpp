#include <cornerstone/MapRegistration.h>
#include <cornerstone/base/pose2.h>
#include <cornerstone/registration/register_maps.h>
#include <cornerstone/ros/grid_messages.h>

#include <cstdio>

int main() {
  const cornerstone::GridMap empty;
  const cornerstone::Landmarks none;
  const bool found = cornerstone::registerMaps({empty, none}, {empty, none}, {}, {}).registration.has_value();
  const cornerstone::Pose2 pose = cornerstone::Pose2{1, 2, 0} * cornerstone::Pose2{3, 0, 0};
  const cornerstone::MapRegistration message;
  std::printf("%g %g %d %d\n", pose.x_m, pose.y_m, int(found), int(message.state));
  return 0;
}
