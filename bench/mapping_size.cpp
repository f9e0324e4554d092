// What an update costs, and a map holds, as the map grows: a building of equal square rooms, the robot in one
// of them.
#include <malloc.h>

#include <cmath>
#include <memory>

#include "bench.h"
#include "cornerstone/mapping/mapper.h"

namespace cornerstone::bench {
namespace {

constexpr double kRoom_m = 10;

// Rooms x rooms of kRoom_m, known to the last cell: walls one cell thick.
GridMap building(int rooms) {
  const double resolution_m = GridParams{}.resolution_m;
  const int room_cells = static_cast<int>(std::lround(kRoom_m / resolution_m)), cells = rooms * room_cells;
  GridMap map{{resolution_m, 0, 0, cells, cells}, cv::Mat1f(cells, cells, 0.02F)};
  for (int line = 0; line < cells; line += room_cells) {
    map.occupied.row(line).setTo(0.98F);
    map.occupied.col(line).setTo(0.98F);
  }
  return map;
}

// 160 columns over 90 degrees, as stereo sees the walls of the room that the pose lies in.
RangeScan lookFrom(const Pose2& pose) {
  RangeScan scan;
  const double wall_m = GridParams{}.resolution_m / 2;  // the middle of its cell
  for (int i = -80; i < 80; ++i) {
    Beam beam;
    beam.bearing_rad = std::atan((i + 0.5) / 80);
    beam.width_rad = 1.0 / 80;
    beam.range_m = 1e9;
    const double heading_rad = pose.yaw_rad + beam.bearing_rad;
    const auto toWall = [&](double at_m, double along) {
      const double inside_m = at_m - kRoom_m * std::floor(at_m / kRoom_m) - wall_m;
      if (std::abs(along) > 1e-9)
        beam.range_m = std::min(beam.range_m, ((along > 0 ? kRoom_m : 0) - inside_m) / along);
    };
    toWall(pose.x_m, std::cos(heading_rad));
    toWall(pose.y_m, std::sin(heading_rad));
    beam.hit = true;
    beam.sigma_m = 0.005 + 0.008 * beam.range_m * beam.range_m;
    beam.near_m = beam.clear_m = std::max(0.1, beam.range_m - 2 * beam.sigma_m);
    beam.far_m = beam.range_m + 2 * beam.sigma_m;
    scan.beams.push_back(beam);
  }
  return scan;
}

struct Grown {
  double area_m2 = 0, memory_mb = 0;
  std::unique_ptr<Mapper> mapper;
  Pose2 start;
  std::vector<double> update_ms{}, changed_ms{}, whole_ms{};
};

Grown grow(int rooms) {
  Grown grown;
  grown.area_m2 = rooms * kRoom_m * rooms * kRoom_m;
  const double middle_m = (rooms / 2 + 0.5) * kRoom_m;
  grown.start = {middle_m, middle_m, 0};
  grown.mapper = std::make_unique<Mapper>(MapperParams{});
  const auto bytes = [] { return static_cast<double>(mallinfo2().uordblks + mallinfo2().hblkhd); };
  const double before = bytes();
  {
    const GridMap map = building(rooms);
    grown.mapper->load({map}, grown.start);
  }
  grown.memory_mb = (bytes() - before) / 1e6;
  return grown;
}

// A robot on a circle of 2 m, 0.1 m a look.
void look(Grown& grown, int i) {
  const Pose2 moved = Pose2{0, 0, 0.05 * i} * Pose2{2, 0, M_PI / 2};
  const Pose2 odom_from_base = (Pose2{0, 0, 0} * Pose2{2, 0, M_PI / 2}).inverse() * moved;
  const Pose2 map_from_base = grown.start * odom_from_base;
  const RangeScan scan = lookFrom(map_from_base);
  const OccupancyGrid& grid = grown.mapper->grid();
  const std::uint64_t version = grid.version();
  grown.update_ms.push_back(elapsed_ms([&] { grown.mapper->update(scan, odom_from_base); }));
  grown.changed_ms.push_back(elapsed_ms([&] {
    for (const TileIndex& tile : grid.changedTiles(version)) grid.tile(tile);
  }));
  if (i % 20 == 0) grown.whole_ms.push_back(elapsed_ms([&] { grid.snapshot(); }));
}

}  // namespace

void mappingSizePart() {
  std::puts(
      "\n## The size of the map\n\nRooms of 10 m x 10 m, all of them known, cells of 0.05 m; the robot "
      "drives a "
      "circle in the middle one: 160 columns, walls 3 to 7 m away. Medians of 100 updates (scan fit and "
      "insertion), taken in turn. "
      "Changed: reading the tiles that one update touched, what map_updates and map_tiles cost. Whole: the "
      "full map, read "
      "only when its size changed or somebody new subscribes. Memory: of the grid after it was loaded; walls "
      "that looks "
      "sharpen add 12 bytes a cell in their tiles.");
  printHead(
      {"map, m2", "update, ms", "of the smallest", "changed, ms", "whole, ms", "memory, MB", "bytes a m2"});
  std::vector<Grown> sizes;
  for (const int rooms : {2, 5, 10, 20}) sizes.push_back(grow(rooms));
  for (int i = 0; i < 100; ++i)
    for (Grown& size : sizes) look(size, i);
  for (const Grown& size : sizes)
    printRow({text(size.area_m2, 0), text(median(size.update_ms)),
              text(median(size.update_ms) / median(sizes.front().update_ms)), text(median(size.changed_ms)),
              text(median(size.whole_ms)), text(size.memory_mb, 1),
              text(1e6 * size.memory_mb / size.area_m2, 0)});
}

}  // namespace cornerstone::bench
