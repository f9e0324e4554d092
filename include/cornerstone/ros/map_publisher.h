// Publishes a mapper's grid: map (whole, latched: when its size changed and for new subscribers), map_updates
// (the rectangle that changed), map_metadata, and map_tiles for other robots (those that changed; all of them
// to a new subscriber and after a reset).
#pragma once

#include <ros/node_handle.h>

#include <string>

#include "cornerstone/MapTiles.h"
#include "cornerstone/mapping/mapper.h"

namespace cornerstone {

class MapPublisher {
 public:
  MapPublisher(ros::NodeHandle& node, const std::string& robot, const std::string& map_frame);
  // What changed since the last call; nothing when nothing did.
  void publish(const Mapper& mapper);

 private:
  void announceEmpty(const Mapper& mapper, const std_msgs::Header& header);
  void publishMap(const OccupancyGrid& grid, const std::vector<TileIndex>& changed,
                  const std_msgs::Header& header);
  MapTiles tilesOf(const Mapper& mapper, const std::vector<TileIndex>& tiles,
                   const std_msgs::Header& header) const;

  std::uint32_t epochOf(const Mapper& mapper) const { return epoch_base_ + mapper.epoch(); }

  std::uint32_t
      epoch_base_;  // the start's wall time in seconds: a restarted mapper is never taken for the old one
  std::string robot_;
  std::string map_frame_;
  ros::Publisher map_;
  ros::Publisher updates_;
  ros::Publisher metadata_;
  ros::Publisher tiles_;
  GridGeometry published_geometry_;
  std::uint64_t published_version_ = 0;
  std::uint32_t published_epoch_ = 0;
  unsigned map_subscribers_ = 0;
  unsigned tile_subscribers_ = 0;
};

}  // namespace cornerstone
