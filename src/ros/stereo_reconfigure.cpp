#include "cornerstone/ros/stereo_reconfigure.h"

namespace cornerstone {

StereoParams changedBy(const StereoConfig& config, const StereoParams& params) {
  dynamic_reconfigure::Config message;
  config.__toMessage__(message);
  YAML::Node tree = writeParams(params);
  for (const auto& entry : message.bools) tree[entry.name] = static_cast<bool>(entry.value);
  for (const auto& entry : message.ints) tree[entry.name] = entry.value;
  for (const auto& entry : message.doubles) tree[entry.name] = entry.value;
  return readParams<StereoParams>(tree, "dynamic_reconfigure");
}

}  // namespace cornerstone
