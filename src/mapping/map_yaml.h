// The YAML half of a map_server map.
#pragma once

#include <string>

#include "cornerstone/base/grid_geometry.h"

namespace cornerstone {

enum class MapMode { kTrinary, kScale, kRaw };

struct MapYaml {
  std::string image_path;  // absolute, or relative to the working directory as the YAML's own path is
  GridGeometry geometry;   // cols and rows 0: the image tells
  bool negate = false;
  double occupied_thresh = 0.65;
  double free_thresh = 0.196;
  MapMode mode = MapMode::kTrinary;
};

MapYaml readMapYaml(const std::string& yaml_path);  // throws InputError naming file and field
std::string mapYamlText(const std::string& image_name, const GridGeometry& geometry);

}  // namespace cornerstone
