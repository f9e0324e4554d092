#include "cornerstone/ros/tile_follower.h"

#include <utility>
#include <vector>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/grid_messages.h"

namespace cornerstone {

bool TileFollower::take(const MapTiles& message) {
  const bool anew = epoch_ && message.map_epoch != *epoch_;
  if (message.tiles.empty()) {
    if (!message.complete) throw InputError("map_tiles: no tiles");
    tiles_.reset();
  } else {
    const bool fresh = !tiles_ || anew || message.complete;
    TileMap next = fresh ? TileMap(message.resolution, message.tiles.front().size) : *tiles_;
    if (message.resolution != next.resolution())
      throw InputError("map_tiles: resolution changed within one map_epoch");
    for (const MapTile& tile : message.tiles) next.put(tile.col, tile.row, fromTile(tile));
    tiles_ = std::move(next);
  }
  epoch_ = message.map_epoch;
  version_ = message.version;
  return anew;
}

}  // namespace cornerstone
