#include "cornerstone/mapping/map_files.h"

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "cornerstone/base/errors.h"
#include "cornerstone/mapping/evidence.h"
#include "map_yaml.h"

namespace cornerstone {
namespace {

constexpr double kMaxCells = 1e8;  // 250,000 m2 at 5 cm

void requireSize(int cols, int rows, const std::string& path) {
  if (cols <= 0 || rows <= 0) throw InputError(path + ": the map has no cells");
  if (1.0 * cols * rows > kMaxCells)
    throw InputError(path + ": " + std::to_string(cols) + " x " + std::to_string(rows) +
                     " cells are too many");
}

struct MapPixels {
  cv::Mat1b grey;
  cv::Mat1b opaque;  // 0: never seen
};

MapPixels readPixels(const std::string& path, const std::string& field) {
  if (!std::filesystem::is_regular_file(path)) throw InputError(field + ": no such file " + path);
  cv::Mat image;
  try {
    image = cv::imread(path, cv::IMREAD_UNCHANGED | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception& error) {
    throw InputError(field + ": cannot read " + path + ": " + error.msg);
  }
  if (image.empty()) throw InputError(field + ": " + path + " is not an image or is truncated");
  requireSize(image.cols, image.rows, path);
  if (image.depth() == CV_16U) image.convertTo(image, CV_8U, 1.0 / 257);
  if (image.depth() != CV_8U) throw InputError(field + ": " + path + " has neither 8 nor 16 bits a channel");
  MapPixels pixels;
  pixels.opaque = cv::Mat1b(image.size(), 255);
  if (image.channels() == 4) cv::extractChannel(image, pixels.opaque, 3);
  if (image.channels() == 1) {
    pixels.grey = image;
  } else {  // map_server takes the plain mean of the colours
    cv::transform(image, pixels.grey,
                  image.channels() == 4 ? cv::Mat(cv::Matx14f(1 / 3.F, 1 / 3.F, 1 / 3.F, 0))
                                        : cv::Mat(cv::Matx13f(1 / 3.F, 1 / 3.F, 1 / 3.F)));
  }
  return pixels;
}

float probabilityOf(int grey, const MapYaml& yaml) {
  if (yaml.mode == MapMode::kRaw) {
    const int percent = yaml.negate ? 255 - grey : grey;
    return percent <= 100 ? static_cast<float>(percent) / 100 : kUnseen;
  }
  const double occupied = (yaml.negate ? grey : 255 - grey) / 255.0;
  if (occupied > yaml.occupied_thresh) return 1;
  if (occupied < yaml.free_thresh) return 0;
  if (yaml.mode == MapMode::kTrinary) return kUnseen;
  return static_cast<float>((occupied - yaml.free_thresh) / (yaml.occupied_thresh - yaml.free_thresh));
}

GridMap loadServerMap(const std::string& path) {
  const MapYaml yaml = readMapYaml(path);
  const MapPixels pixels = readPixels(yaml.image_path, path + ": field 'image'");
  GridMap map{yaml.geometry, cv::Mat1f(pixels.grey.size())};
  map.geometry.cols = pixels.grey.cols;
  map.geometry.rows = pixels.grey.rows;
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col) {
      const int image_row = map.geometry.imageRow(row);
      const bool seen = pixels.opaque(image_row, col) == 255;
      map.occupied(row, col) = seen ? probabilityOf(pixels.grey(image_row, col), yaml) : kUnseen;
    }
  return map;
}

GridMap loadMrptMap(const std::string& path) {
  mrpt::maps::COccupancyGridMap2D grid;
  try {
    mrpt::io::CFileGZInputStream file;
    if (!file.open(path)) throw InputError(path + ": no such file or not readable");
    auto archive = mrpt::serialization::archiveFrom(file);
    archive >> grid;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception&) {
    throw InputError(path + ": not an MRPT grid map or truncated");
  }
  const int cols = static_cast<int>(grid.getSizeX()), rows = static_cast<int>(grid.getSizeY());
  requireSize(cols, rows, path);
  // MRPT keeps them as floats: 0.05 is 0.0500000007 there.
  const double resolution_m = std::round(static_cast<double>(grid.getResolution()) * 1e6) * 1e-6;
  requirePositive(resolution_m, path + ": resolution");
  const auto onCell = [&](float value) {
    return std::round(static_cast<double>(value) / resolution_m) * resolution_m;
  };
  GridMap map{{resolution_m, onCell(grid.getXMin()), onCell(grid.getYMin()), cols, rows},
              cv::Mat1f(rows, cols)};
  for (int row = 0; row < rows; ++row)
    for (int col = 0; col < cols; ++col) {
      const auto cell = grid.getRow(row)[col];
      map.occupied(row, col) = cell == 0 ? kUnseen : 1 - mrpt::maps::COccupancyGridMap2D::l2p(cell);
    }
  return map;
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

// A reader never meets half a file: it is written beside its place and moved there.
void writeWhole(const std::filesystem::path& path, const std::function<bool(const std::string&)>& write) {
  std::filesystem::path beside = path;
  beside += ".part" + std::to_string(::getpid());
  std::error_code failed;
  if (!write(beside.string())) {
    std::filesystem::remove(beside, failed);
    throw InputError(path.string() + ": cannot be written");
  }
  std::filesystem::rename(beside, path, failed);
  if (!failed) return;
  const std::string reason = failed.message();
  std::filesystem::remove(beside, failed);
  throw InputError(path.string() + ": cannot be written: " + reason);
}

void writeBytes(const std::filesystem::path& path, const char* bytes, std::size_t size) {
  writeWhole(path, [&](const std::string& beside) {
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    file.write(bytes, static_cast<std::streamsize>(size));
    file.close();
    return !file.fail();
  });
}

void saveServerMap(const GridMap& map, const std::string& yaml_path) {
  cv::Mat4b image(map.occupied.size());
  for (int row = 0; row < map.geometry.rows; ++row)
    for (int col = 0; col < map.geometry.cols; ++col) {
      const float p = map.occupied(row, col);
      const auto grey = cv::saturate_cast<uchar>(255 * (1 - p));
      image(map.geometry.imageRow(row), col) = cv::Vec4b(grey, grey, grey, p == kUnseen ? 0 : 255);
    }
  std::filesystem::path image_path = yaml_path;
  image_path.replace_extension(".png");
  std::vector<uchar> png;
  cv::imencode(".png", image, png);
  writeBytes(image_path, reinterpret_cast<const char*>(png.data()), png.size());
  const std::string text = mapYamlText(image_path.filename().string(), map.geometry);
  writeBytes(yaml_path, text.data(), text.size());
}

using MrptGrid = mrpt::maps::COccupancyGridMap2D;

// MRPT's log-odds of free, held off 0 for cells that were seen. (MRPT's own p2l is a table of 255 entries:
// what it wrote would not come back.)
MrptGrid::cellType mrptCellOf(float occupied) {
  if (occupied == kUnseen) return 0;
  constexpr double kSure = 1e-4;  // as sure as a cell can say
  const double p = std::clamp(static_cast<double>(occupied), kSure, 1 - kSure);
  const EvidenceCell cell = EvidenceScale::cellOf(std::log(p / (1 - p)));
  if (cell != 0) return cell;
  return static_cast<EvidenceCell>(occupied > kUnseen ? -1 : 1);
}

void saveMrptMap(const GridMap& map, const std::string& path) {
  const GridGeometry& from = map.geometry;
  const auto resolution_m = static_cast<float>(from.resolution_m);
  const auto edge = [&](double origin_m, int cells) {
    return static_cast<float>((std::round(origin_m / from.resolution_m) + cells) * from.resolution_m);
  };
  MrptGrid grid(edge(from.origin_x_m, 0), edge(from.origin_x_m, from.cols), edge(from.origin_y_m, 0),
                edge(from.origin_y_m, from.rows), resolution_m);
  if (static_cast<int>(grid.getSizeX()) != from.cols || static_cast<int>(grid.getSizeY()) != from.rows)
    throw std::logic_error("saveMap: MRPT made a grid of another size");
  for (int row = 0; row < from.rows; ++row)
    std::transform(map.occupied[row], map.occupied[row] + from.cols, grid.getRow(row), mrptCellOf);
  const auto writeTo = [&](auto& file, const std::string& beside) {
    if (!file.open(beside)) return false;
    auto archive = mrpt::serialization::archiveFrom(file);
    archive << grid;
    file.close();
    return true;
  };
  writeWhole(path, [&](const std::string& beside) {
    mrpt::io::CFileGZOutputStream packed;
    mrpt::io::CFileOutputStream plain;
    try {
      return endsWith(path, ".gz") ? writeTo(packed, beside) : writeTo(plain, beside);
    } catch (const std::exception&) {
      return false;
    }
  });
}

bool isMrptPath(const std::string& path) {
  return endsWith(path, ".gridmap") || endsWith(path, ".gridmap.gz");
}

}  // namespace

GridMap loadMap(const std::string& path) {
  return isMrptPath(path) ? loadMrptMap(path) : loadServerMap(path);
}

void saveMap(const GridMap& map, const std::string& path) {
  if (!endsWith(path, ".yaml") && !isMrptPath(path))
    throw InputError(path + ": the name of a map must end in .yaml, .gridmap or .gridmap.gz");
  if (map.occupied.rows != map.geometry.rows || map.occupied.cols != map.geometry.cols)
    throw std::logic_error("saveMap: geometry and cells differ in size");
  if (map.occupied.empty()) throw InputError(path + ": the map to be saved is empty");
  isMrptPath(path) ? saveMrptMap(map, path) : saveServerMap(map, path);
}

namespace {

std::string levelPath(const std::string& path, const std::vector<std::string>& names, std::size_t level) {
  const std::string whole = endsWith(path, ".yaml") || isMrptPath(path) ? path : path + ".yaml";
  if (level == 0) return whole;
  const std::string ending = endsWith(whole, ".gz") ? ".gridmap.gz"
                             : isMrptPath(whole)    ? ".gridmap"
                                                    : ".yaml";
  return whole.substr(0, whole.size() - ending.size()) + "_" + names.at(level) + ending;
}

}  // namespace

void saveLevels(const std::vector<GridMap>& levels, const std::string& path,
                const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < levels.size(); ++i)
    if (i == 0 || !levels[i].occupied.empty()) saveMap(levels[i], levelPath(path, names, i));
}

std::vector<GridMap> loadLevels(const std::string& path, const std::vector<std::string>& names) {
  std::vector<GridMap> levels;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string file = levelPath(path, names, i);
    levels.push_back(i == 0 || std::filesystem::exists(file) ? loadMap(file) : GridMap{});
  }
  return levels;
}

}  // namespace cornerstone
