// Occupancy grids between messages and the core.
#pragma once

#include <map_msgs/OccupancyGridUpdate.h>
#include <nav_msgs/OccupancyGrid.h>

#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/MapTile.h"
#include "cornerstone/mapping/grid_map.h"

namespace cornerstone {

// 0 to 100 is the probability in percent, -1 was never seen.
nav_msgs::OccupancyGrid toOccupancyGrid(const GridMap& map, const std_msgs::Header& header);
// The same values of one rectangle (in cells, inside the map).
map_msgs::OccupancyGridUpdate toUpdate(const GridMap& map, const cv::Rect& cells,
                                       const std_msgs::Header& header);

// And back. InputError naming the field: sizes that do not fit, a resolution that is not positive, a turned
// origin.
GridMap fromOccupancyGrid(const nav_msgs::OccupancyGrid& message);
void applyUpdate(const map_msgs::OccupancyGridUpdate& update, GridMap& map);

// Tiles: square pieces of a grid at whole multiples of their size, as PNG with 254 steps of probability.
// first: the tile's first cell, in cells from the map frame's origin.
MapTile toTile(const GridMap& tile, Cell first);
// InputError when the picture is not one of `size` x `size` cells.
cv::Mat1f cellsOf(const MapTile& tile);
// InputError when a point is not finite or has no weight, and when there are more than cells.
std::vector<SurfacePoint> surfaceOf(const MapTile& tile);

}  // namespace cornerstone
