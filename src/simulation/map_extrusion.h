// Walls from a map_server map: every occupied cell becomes part of an upright block.
#pragma once

#include <string>
#include <vector>

#include "cornerstone/simulation/world.h"
#include "strict_yaml.h"

namespace cornerstone {

// Keys of `map`: file (a map_server YAML, relative to `directory`), height_m. Throws InputError.
std::vector<Solid> extrudeMap(StrictMap& map, const std::string& directory, Material material);

}  // namespace cornerstone
