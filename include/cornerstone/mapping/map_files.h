// Maps in map_server's form (YAML and image).
#pragma once

#include <string>

#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

// Throws InputError that names the file and the field: missing, truncated, not a map, sizes or thresholds out
// of range.
GridMap loadMap(const std::string& yaml_path);

// Writes <stem>.yaml and <stem>.png beside it, each complete or not at all. Throws InputError naming the
// file.
void saveMap(const GridMap& map, const std::string& yaml_path);

}  // namespace cornerstone
