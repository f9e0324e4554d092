// Publishes a mapper's grids. Of each level: map/<level> (whole, latched: when its size changed and for new
// subscribers), map/<level>_updates (the rectangle that changed) and map/<level>_metadata; the first level is
// `map`, too. For other robots map_tiles of the first level and map_tiles/<level> of further ones (those that
// changed; all of them to a new subscriber and after a reset).
#pragma once

#include <ros/node_handle.h>

#include <memory>
#include <string>
#include <vector>

#include "cornerstone/MapTiles.h"
#include "cornerstone/mapping/mapper.h"

namespace cornerstone {

// What a grid looks like to those who follow it.
struct GridState {
  const OccupancyGrid& grid;
  std::uint32_t epoch = 0;
  std_msgs::Header header;
  const Mapper& mapper;  // the grid is one of its own
};

// One grid as nav_msgs/OccupancyGrid on a topic, with updates and metadata. Work and messages are of the size
// of what changed, not of the map.
class GridPublisher {
 public:
  GridPublisher(ros::NodeHandle& node, const std::string& topic);
  void publish(const GridState& state);

 private:
  void announceEmpty(const GridState& state);
  void publishWhole(const GridState& state);
  void publishUpdate(const GridState& state, const std::vector<TileIndex>& changed);

  bool new_subscriber_ = false;
  ros::Publisher map_, updates_, metadata_;
  GridGeometry published_geometry_;
  std::uint64_t published_version_ = 0;
  std::uint32_t published_epoch_ = 0;
};

class TilePublisher {
 public:
  TilePublisher(ros::NodeHandle& node, const std::string& topic, const std::string& robot);
  void publish(const GridState& state);

 private:
  void announceEmpty(const GridState& state);
  MapTiles messageOf(const GridState& state, const std::vector<TileIndex>& tiles) const;

  std::string robot_;
  bool new_subscriber_ = false;
  ros::Publisher tiles_;
  std::uint64_t published_version_ = 0;
  std::uint32_t published_epoch_ = 0;
};

struct MapPublisherSetup {
  std::string robot;
  std::string map_frame;
  std::vector<std::string> levels;  // their names; at least one
};

class MapPublisher {
 public:
  MapPublisher(ros::NodeHandle& node, const MapPublisherSetup& setup);
  // What changed since the last call; nothing when nothing did.
  void publish(const Mapper& mapper);

 private:
  struct Level {
    std::vector<std::unique_ptr<GridPublisher>> maps;
    std::unique_ptr<TilePublisher> tiles;
  };
  std::uint32_t
      epoch_base_;  // the start's wall time in seconds: a restarted mapper is never taken for the old one
  std::string map_frame_;
  std::vector<Level> levels_;
};

}  // namespace cornerstone
