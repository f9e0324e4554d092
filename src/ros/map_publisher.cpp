#include "cornerstone/ros/map_publisher.h"

#include <nav_msgs/MapMetaData.h>

#include <vector>

#include "cornerstone/ros/grid_messages.h"

namespace cornerstone {
namespace {

bool sameExtent(const GridGeometry& a, const GridGeometry& b) {
  return a.cols == b.cols && a.rows == b.rows && a.origin_x_m == b.origin_x_m && a.origin_y_m == b.origin_y_m;
}

// The rectangle of cells of a map that the changed tiles cover.
cv::Rect changedCells(const OccupancyGrid& grid, const GridMap& map, const std::vector<TileIndex>& changed) {
  cv::Rect cells;
  for (const TileIndex& index : changed) {
    const GridGeometry tile = grid.tile(index).geometry;
    const Cell first = map.geometry.cellAt(tile.centreOf({0, 0}));
    const cv::Rect rectangle(first.col, first.row, tile.cols, tile.rows);
    cells = cells.empty() ? rectangle : cells | rectangle;
  }
  return cells & cv::Rect(0, 0, map.geometry.cols, map.geometry.rows);
}

}  // namespace

MapPublisher::MapPublisher(ros::NodeHandle& node, const std::string& robot, const std::string& map_frame)
    : epoch_base_(ros::WallTime::now().sec), robot_(robot), map_frame_(map_frame) {
  map_ = node.advertise<nav_msgs::OccupancyGrid>("map", 1, true);
  updates_ = node.advertise<map_msgs::OccupancyGridUpdate>("map_updates", 10);
  metadata_ = node.advertise<nav_msgs::MapMetaData>("map_metadata", 1, true);
  tiles_ = node.advertise<MapTiles>("map_tiles", 100);
}

void MapPublisher::publish(const Mapper& mapper) {
  const OccupancyGrid& grid = mapper.grid();
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = map_frame_;
  const bool anew = epochOf(mapper) != published_epoch_;
  const bool new_map_subscriber = map_.getNumSubscribers() > map_subscribers_;
  const bool new_tile_subscriber = tiles_.getNumSubscribers() > tile_subscribers_;
  map_subscribers_ = map_.getNumSubscribers();
  tile_subscribers_ = tiles_.getNumSubscribers();
  if (grid.empty()) {
    if (anew && published_epoch_ != 0) announceEmpty(mapper, header);
    return;
  }
  const auto changed = grid.changedTiles(anew ? 0 : published_version_);
  if (anew || new_map_subscriber) published_geometry_ = GridGeometry{};
  if (!changed.empty() || new_map_subscriber) publishMap(grid, changed, header);
  if (anew || new_tile_subscriber) {
    MapTiles all = tilesOf(mapper, grid.changedTiles(0), header);
    all.complete = true;
    tiles_.publish(all);
  } else if (!changed.empty()) {
    tiles_.publish(tilesOf(mapper, changed, header));
  }
  published_version_ = grid.version();
  published_epoch_ = epochOf(mapper);
}

// Others must not use the old map's frame until this robot sees something.
void MapPublisher::announceEmpty(const Mapper& mapper, const std_msgs::Header& header) {
  MapTiles nothing = tilesOf(mapper, {}, header);
  nothing.complete = true;
  tiles_.publish(nothing);
  published_epoch_ = epochOf(mapper);
  published_version_ = 0;
  published_geometry_ = GridGeometry{};
}

void MapPublisher::publishMap(const OccupancyGrid& grid, const std::vector<TileIndex>& changed,
                              const std_msgs::Header& header) {
  if (map_.getNumSubscribers() + updates_.getNumSubscribers() + metadata_.getNumSubscribers() == 0) return;
  const GridMap map = grid.snapshot();
  if (sameExtent(map.geometry, published_geometry_)) {
    updates_.publish(toUpdate(map, changedCells(grid, map, changed), header));
    return;
  }
  const nav_msgs::OccupancyGrid message = toOccupancyGrid(map, header);
  map_.publish(message);
  metadata_.publish(message.info);
  published_geometry_ = map.geometry;
}

MapTiles MapPublisher::tilesOf(const Mapper& mapper, const std::vector<TileIndex>& tiles,
                               const std_msgs::Header& header) const {
  MapTiles message;
  message.header = header;
  message.robot = robot_;
  message.map_epoch = epochOf(mapper);
  message.version = static_cast<std::uint32_t>(mapper.grid().version());
  message.resolution = mapper.grid().params().resolution_m;
  for (const TileIndex& index : tiles) {
    const Cell first = firstCellOf(index);
    message.tiles.push_back(toTile(mapper.grid().tile(index).occupied, first.col, first.row));
  }
  return message;
}

}  // namespace cornerstone
