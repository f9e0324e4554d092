#include "cornerstone/ros/tile_follower.h"

#include <cmath>
#include <utility>
#include <vector>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/grid_messages.h"

namespace cornerstone {

namespace {

std::vector<Eigen::Vector2d> wayOf(const MapTiles& message) {
  std::vector<Eigen::Vector2d> way_m;
  for (const geometry_msgs::Point32& place : message.way) {
    if (!std::isfinite(place.x) || !std::isfinite(place.y)) throw InputError("map_tiles: way is not finite");
    way_m.emplace_back(place.x, place.y);
  }
  return way_m;
}

}  // namespace

bool TileFollower::take(const MapTiles& message) {
  std::vector<Eigen::Vector2d> way_m = wayOf(message);
  const bool anew = epoch_ && message.map_epoch != *epoch_;
  if (message.tiles.empty()) {
    if (!message.complete) throw InputError("map_tiles: no tiles");
    tiles_.reset();
  } else {
    const bool fresh = !tiles_ || anew || message.complete;
    TileMap next = fresh ? TileMap(message.resolution, message.tiles.front().size) : *tiles_;
    if (message.resolution != next.resolution())
      throw InputError("map_tiles: resolution changed within one map_epoch");
    for (const MapTile& tile : message.tiles) next.put(tile.col, tile.row, cellsOf(tile), surfaceOf(tile));
    tiles_ = std::move(next);
  }
  epoch_ = message.map_epoch;
  version_ = message.version;
  way_m_ = std::move(way_m);
  return anew;
}

}  // namespace cornerstone
