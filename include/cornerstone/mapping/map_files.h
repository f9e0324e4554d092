// Maps on disk: map_server's form (.yaml and image) and MRPT's own (.gridmap, .gridmap.gz: a serialised
// COccupancyGridMap2D).
//
// Reading follows map_server: with occ = (255 - grey) / 255 (negate: grey / 255),
//   trinary: 1 above occupied_thresh, 0 below free_thresh, never seen between;
//   scale:   the same but linear from 0 to 1 between the thresholds; transparent pixels are never seen;
//   raw:     grey is the probability in percent, above 100 never seen.
// Writing uses mode scale with thresholds 0 and 1: probabilities come back within 1/510, never-seen cells
// exactly. MRPT's form holds log-odds in steps of 1/16: probabilities come back within 0.016, never-seen
// cells exactly, and what was read from it once comes back exactly. Its origin lies on a whole cell.
#pragma once

#include <string>
#include <vector>

#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

// Throws InputError that names the file and the field: missing, truncated, not a map, sizes or thresholds out
// of range.
GridMap loadMap(const std::string& path);

// By its ending writes <stem>.yaml and <stem>.png beside it, or MRPT's form; each file complete or not at
// all. Throws InputError naming the file.
void saveMap(const GridMap& map, const std::string& path);

// The levels of one map, a file each: the first at `path` (.yaml is added where no form's ending stands),
// further ones beside it as <stem>_<name><ending>. An empty level but the first is not written.
void saveLevels(const std::vector<GridMap>& levels, const std::string& path,
                const std::vector<std::string>& names);
// Levels but the first whose file is not there are empty maps.
std::vector<GridMap> loadLevels(const std::string& path, const std::vector<std::string>& names);

}  // namespace cornerstone
