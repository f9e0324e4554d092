// Maps on disk: map_server's form (YAML and image) and, to read only, MRPT's own (.gridmap, .gridmap.gz).
//
// Reading follows map_server: with occ = (255 - grey) / 255 (negate: grey / 255),
//   trinary: 1 above occupied_thresh, 0 below free_thresh, never seen between;
//   scale:   the same but linear from 0 to 1 between the thresholds; transparent pixels are never seen;
//   raw:     grey is the probability in percent, above 100 never seen.
// Writing uses mode scale with thresholds 0 and 1: probabilities come back within 1/510, never-seen cells
// exactly.
#pragma once

#include <string>

#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

// Throws InputError that names the file and the field: missing, truncated, not a map, sizes or thresholds out
// of range.
GridMap loadMap(const std::string& path);

// Writes <stem>.yaml and <stem>.png beside it, each complete or not at all. Throws InputError naming the
// file.
void saveMap(const GridMap& map, const std::string& yaml_path);

}  // namespace cornerstone
