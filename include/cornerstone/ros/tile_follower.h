// Another robot's map, or this robot's own, followed through its map_tiles.
#pragma once

#include <optional>
#include <vector>

#include "cornerstone/MapTiles.h"
#include "cornerstone/mapping/tile_map.h"

namespace cornerstone {

class TileFollower {
 public:
  // True: the robot's map began anew (another epoch), all older tiles are gone. A complete message without
  // tiles is an empty map. InputError naming the field at fault, and nothing changes.
  bool take(const MapTiles& message);
  bool empty() const { return !tiles_; }
  GridMap map() const { return tiles_ ? tiles_->assemble() : GridMap{}; }
  std::uint32_t epoch() const { return epoch_.value_or(0); }  // 0: nothing was heard yet
  std::uint32_t version() const { return version_; }          // of the newest tiles
  // Where the robot has been, m in its map's frame, as told with the newest tiles.
  const std::vector<Eigen::Vector2d>& way() const { return way_m_; }

 private:
  std::optional<TileMap> tiles_;
  std::optional<std::uint32_t> epoch_;
  std::uint32_t version_ = 0;
  std::vector<Eigen::Vector2d> way_m_;
};

}  // namespace cornerstone
