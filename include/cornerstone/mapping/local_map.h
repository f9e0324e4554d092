// One of the mapper's local maps: a grid for each height level, drawn together in one frame.
//
// The mapper draws in one local map, the current one; the pose it tracks, its key frames and their graph are
// of that map's frame. There is one for now, whose frame is the map's (map_from_local is identity): a second
// one, opened, linked and met again, needs nothing else here, for what is published is composed from the
// list.
#pragma once

#include <vector>

#include "cornerstone/mapping/occupancy_grid.h"

namespace cornerstone {

class LocalMap {
 public:
  // Throws InputError naming a parameter out of range. levels: at least 1.
  LocalMap(const GridParams& params, std::size_t levels);
  // Every level of the look into its grid. A look may have fewer levels (lasers), none is made up; InputError
  // when it has more, and nothing changes.
  void insert(const RangeScan& scan, const Pose2& local_from_base, const LookMotion& motion = kFirstLook);
  void clear();
  // Replaces one level's grid; InputError when the map does not fit it (OccupancyGrid::load).
  void load(std::size_t level, const GridMap& map) { grids_.at(level).load(map); }
  // Becomes another drawing of the same looks.
  void becomeRedrawn(LocalMap&& redrawn);

  std::size_t levelCount() const { return grids_.size(); }
  const OccupancyGrid& grid(std::size_t level = 0) const { return grids_.at(level); }  // 0: to drive by
  const Pose2& mapFromLocal() const { return map_from_local_; }
  void place(const Pose2& map_from_local) { map_from_local_ = map_from_local; }

 private:
  std::vector<OccupancyGrid> grids_;
  Pose2 map_from_local_;
};

// One level of all local maps in the map's frame: each cell is that of the local map that knows most of it,
// the surface is that of all. A
// local map that is not turned against the map and lies by whole cells is copied exactly.
GridMap composed(const std::vector<LocalMap>& maps, std::size_t level = 0);

}  // namespace cornerstone
