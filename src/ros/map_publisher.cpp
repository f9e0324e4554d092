#include "cornerstone/ros/map_publisher.h"

#include <nav_msgs/MapMetaData.h>

#include <algorithm>

#include "cornerstone/ros/grid_messages.h"

namespace cornerstone {
namespace {

bool sameExtent(const GridGeometry& a, const GridGeometry& b) {
  return a.cols == b.cols && a.rows == b.rows && a.origin_x_m == b.origin_x_m && a.origin_y_m == b.origin_y_m;
}

// Told of each new subscriber in the node's own callback queue: the same thread as publish().
template <typename Message>
ros::Publisher advertiseTelling(ros::NodeHandle& node, const std::string& topic, bool latch, bool& told) {
  return node.advertise<Message>(
      topic, latch ? 1 : 100, [&told](const ros::SingleSubscriberPublisher&) { told = true; },
      ros::SubscriberStatusCallback(), ros::VoidConstPtr(), latch);
}

}  // namespace

GridPublisher::GridPublisher(ros::NodeHandle& node, const std::string& topic) {
  map_ = advertiseTelling<nav_msgs::OccupancyGrid>(node, topic, true, new_subscriber_);
  updates_ = node.advertise<map_msgs::OccupancyGridUpdate>(topic + "_updates", 10);
  metadata_ = node.advertise<nav_msgs::MapMetaData>(topic + "_metadata", 1, true);
}

void GridPublisher::publish(const GridState& state) {
  if (state.grid.empty()) {
    announceEmpty(state);
    return;
  }
  if (map_.getNumSubscribers() + updates_.getNumSubscribers() + metadata_.getNumSubscribers() == 0) return;
  const bool whole = state.epoch != published_epoch_ || new_subscriber_ ||
                     !sameExtent(state.grid.geometry(), published_geometry_);
  if (whole) {
    publishWhole(state);
  } else {
    const auto changed = state.grid.changedTiles(published_version_);
    if (!changed.empty()) publishUpdate(state, changed);
  }
  new_subscriber_ = false;
  published_geometry_ = state.grid.geometry();
  published_version_ = state.grid.version();
  published_epoch_ = state.epoch;
}

// After a reset nobody shall drive by the old map until this robot sees something: it was never seen,
// wherever it was.
void GridPublisher::announceEmpty(const GridState& state) {
  if (published_epoch_ == 0 || published_epoch_ == state.epoch) return;
  if (published_geometry_.cols > 0) {
    const cv::Mat1f unseen(published_geometry_.rows, published_geometry_.cols, kUnseen);
    map_.publish(toOccupancyGrid({published_geometry_, unseen}, state.header));
  }
  published_epoch_ = state.epoch;
  published_version_ = 0;
  published_geometry_ = GridGeometry{};
}

void GridPublisher::publishWhole(const GridState& state) {
  const nav_msgs::OccupancyGrid message = toOccupancyGrid(state.grid.snapshot(), state.header);
  map_.publish(message);
  metadata_.publish(message.info);
}

void GridPublisher::publishUpdate(const GridState& state, const std::vector<TileIndex>& changed) {
  TileIndex low = changed.front(), high = low;
  for (const TileIndex& index : changed) {
    low = {std::min(low.col, index.col), std::min(low.row, index.row)};
    high = {std::max(high.col, index.col), std::max(high.row, index.row)};
  }
  const GridMap part = state.grid.tiles(low, high);
  auto update = toUpdate(part, {0, 0, part.geometry.cols, part.geometry.rows}, state.header);
  const Cell at = state.grid.geometry().cellAt(part.geometry.centreOf({0, 0}));
  update.x = at.col;
  update.y = at.row;
  updates_.publish(update);
}

TilePublisher::TilePublisher(ros::NodeHandle& node, const std::string& topic, const std::string& robot)
    : robot_(robot), tiles_(advertiseTelling<MapTiles>(node, topic, false, new_subscriber_)) {}

void TilePublisher::publish(const GridState& state) {
  if (state.grid.empty()) {
    announceEmpty(state);
    return;
  }
  const bool complete = state.epoch != published_epoch_ || new_subscriber_;
  const auto changed = state.grid.changedTiles(complete ? 0 : published_version_);
  if (!changed.empty() && tiles_.getNumSubscribers() > 0) {
    MapTiles message = messageOf(state, changed);
    message.complete = complete;
    tiles_.publish(message);
  }
  new_subscriber_ = false;
  published_version_ = state.grid.version();
  published_epoch_ = state.epoch;
}

// Others must not use the old map's frame until this robot sees something.
void TilePublisher::announceEmpty(const GridState& state) {
  if (published_epoch_ == 0 || published_epoch_ == state.epoch) return;
  MapTiles nothing = messageOf(state, {});
  nothing.complete = true;
  tiles_.publish(nothing);
  published_epoch_ = state.epoch;
  published_version_ = 0;
}

MapTiles TilePublisher::messageOf(const GridState& state, const std::vector<TileIndex>& tiles) const {
  MapTiles message;
  message.header = state.header;
  message.robot = robot_;
  message.map_epoch = state.epoch;
  message.version = static_cast<std::uint32_t>(state.grid.version());
  message.resolution = state.grid.params().resolution_m;
  for (const Eigen::Vector2d& place : state.mapper.way()) {
    geometry_msgs::Point32& told = message.way.emplace_back();
    told.x = static_cast<float>(place.x());
    told.y = static_cast<float>(place.y());
  }
  for (const TileIndex& index : tiles) {
    message.tiles.push_back(toTile(state.grid.tile(index), firstCellOf(index)));
  }
  return message;
}

MapPublisher::MapPublisher(ros::NodeHandle& node, const MapPublisherSetup& setup)
    : epoch_base_(ros::WallTime::now().sec), map_frame_(setup.map_frame) {
  for (const std::string& name : setup.levels) {
    const bool first = levels_.empty();
    Level& level = levels_.emplace_back();
    if (first) level.maps.push_back(std::make_unique<GridPublisher>(node, "map"));
    level.maps.push_back(std::make_unique<GridPublisher>(node, "map/" + name));
    level.tiles =
        std::make_unique<TilePublisher>(node, first ? "map_tiles" : "map_tiles/" + name, setup.robot);
  }
}

void MapPublisher::publish(const Mapper& mapper) {
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = map_frame_;
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const GridState state{mapper.grid(i), epoch_base_ + mapper.epoch(), header, mapper};
    for (const auto& map : levels_[i].maps) map->publish(state);
    levels_[i].tiles->publish(state);
  }
}

}  // namespace cornerstone
