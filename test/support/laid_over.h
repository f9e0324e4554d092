// One parameter file over another, as roslaunch loads them.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>

namespace cornerstone::test {

// Puts what `over` has in the place of what `whole` has; false: a key that `whole` does not know.
inline bool laidOver(YAML::Node whole, const YAML::Node& over) {
  for (const auto& member : over) {
    const auto name = member.first.as<std::string>();
    if (!whole[name]) return false;
    if (!member.second.IsMap())
      whole[name] = member.second;
    else if (!laidOver(whole[name], member.second))
      return false;
  }
  return true;
}

}  // namespace cornerstone::test
