#include "cornerstone/ros/grid_messages.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr float kTileSteps = 254;
constexpr std::uint8_t kTileUnseen = 127;  // 254 * 0.5: a seen cell of that very value moves one step aside

std::int8_t toPercent(float occupied) {
  return occupied == kUnseen ? std::int8_t{-1} : static_cast<std::int8_t>(std::lround(100 * occupied));
}

float fromPercent(std::int8_t percent) {
  if (percent < 0) return kUnseen;
  // 50 percent was seen, if undecided: the smallest step aside keeps it apart from what was never seen.
  return percent == 50 ? 0.501f : std::min(1.f, static_cast<float>(percent) / 100);
}

std::uint8_t toTileValue(float occupied) {
  const auto value = static_cast<std::uint8_t>(std::lround(kTileSteps * occupied));
  if (value != kTileUnseen || occupied == kUnseen) return value;
  return occupied > kUnseen ? kTileUnseen + 1 : kTileUnseen - 1;
}

}  // namespace

nav_msgs::OccupancyGrid toOccupancyGrid(const GridMap& map, const std_msgs::Header& header) {
  nav_msgs::OccupancyGrid grid;
  grid.header = header;
  grid.info.map_load_time = header.stamp;
  grid.info.resolution = static_cast<float>(map.geometry.resolution_m);
  grid.info.width = static_cast<unsigned>(map.geometry.cols);
  grid.info.height = static_cast<unsigned>(map.geometry.rows);
  grid.info.origin.position.x = map.geometry.origin_x_m;
  grid.info.origin.position.y = map.geometry.origin_y_m;
  grid.info.origin.orientation.w = 1;
  grid.data.reserve(map.occupied.total());
  for (const float occupied : map.occupied) grid.data.push_back(toPercent(occupied));
  return grid;
}

map_msgs::OccupancyGridUpdate toUpdate(const GridMap& map, const cv::Rect& cells,
                                       const std_msgs::Header& header) {
  map_msgs::OccupancyGridUpdate update;
  update.header = header;
  update.x = cells.x;
  update.y = cells.y;
  update.width = static_cast<unsigned>(cells.width);
  update.height = static_cast<unsigned>(cells.height);
  for (const float occupied : cv::Mat1f(map.occupied(cells))) update.data.push_back(toPercent(occupied));
  return update;
}

GridMap fromOccupancyGrid(const nav_msgs::OccupancyGrid& message) {
  requirePositive(message.info.resolution, "map: resolution");
  requireFinite(message.info.origin.position.x, "map: origin.position.x");
  requireFinite(message.info.origin.position.y, "map: origin.position.y");
  const std::size_t cells = static_cast<std::size_t>(message.info.width) * message.info.height;
  if (message.data.size() != cells) throw InputError("map: width x height is not the number of cells");
  if (std::abs(message.info.origin.orientation.z) > 1e-6) throw InputError("map: origin is turned");
  GridMap map;
  map.geometry = {message.info.resolution, message.info.origin.position.x, message.info.origin.position.y,
                  static_cast<int>(message.info.width), static_cast<int>(message.info.height)};
  map.occupied.create(map.geometry.rows, map.geometry.cols);
  std::transform(message.data.begin(), message.data.end(), map.occupied.begin(), fromPercent);
  return map;
}

void applyUpdate(const map_msgs::OccupancyGridUpdate& update, GridMap& map) {
  const cv::Rect cells(update.x, update.y, static_cast<int>(update.width), static_cast<int>(update.height));
  if ((cells & cv::Rect(0, 0, map.geometry.cols, map.geometry.rows)) != cells ||
      update.data.size() != static_cast<std::size_t>(cells.area()))
    throw InputError("map_updates: the rectangle lies outside the map or does not fit its data");
  cv::Mat1f part = map.occupied(cells);
  std::transform(update.data.begin(), update.data.end(), part.begin(), fromPercent);
}

MapTile toTile(const GridMap& tile, Cell first) {
  MapTile message;
  message.col = first.col;
  message.row = first.row;
  message.size = static_cast<std::uint16_t>(tile.occupied.cols);
  cv::Mat1b values(tile.occupied.size());
  std::transform(tile.occupied.begin(), tile.occupied.end(), values.begin(), toTileValue);
  cv::imencode(".png", values, message.png);
  for (const SurfacePoint& point : tile.surface) {
    MapSurfacePoint& told = message.surface.emplace_back();
    told.x = point.x_m;
    told.y = point.y_m;
    told.weight = point.weight;
  }
  return message;
}

cv::Mat1f cellsOf(const MapTile& tile) {
  const cv::Mat1b values = tile.png.empty() ? cv::Mat1b() : cv::imdecode(tile.png, cv::IMREAD_GRAYSCALE);
  if (tile.size == 0 || values.rows != tile.size || values.cols != tile.size)
    throw InputError("map_tiles: a tile's png is not a picture of size x size");
  cv::Mat1f occupied(values.size());
  std::transform(values.begin(), values.end(), occupied.begin(), [](std::uint8_t value) {
    return value == kTileUnseen ? kUnseen : std::min(1.f, static_cast<float>(value) / kTileSteps);
  });
  return occupied;
}

std::vector<SurfacePoint> surfaceOf(const MapTile& tile) {
  if (tile.surface.size() > static_cast<std::size_t>(tile.size) * tile.size)
    throw InputError("map_tiles: a tile's surface has more points than cells");
  std::vector<SurfacePoint> surface;
  surface.reserve(tile.surface.size());
  for (const MapSurfacePoint& point : tile.surface) {
    if (!std::isfinite(point.x) || !std::isfinite(point.y) || !std::isfinite(point.weight) ||
        point.weight <= 0)
      throw InputError("map_tiles: a tile's surface is not finite or has no weight");
    surface.push_back({point.x, point.y, point.weight});
  }
  return surface;
}

}  // namespace cornerstone
