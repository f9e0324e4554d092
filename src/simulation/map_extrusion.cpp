#include "map_extrusion.h"

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

std::string joined(const std::string& directory, const std::string& file) {
  return !file.empty() && file.front() == '/' ? file : directory + "/" + file;
}

std::string readText(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// Occupied cells, row 0 at the smallest y.
cv::Mat1b occupiedCells(const std::string& image_path, bool negate, double occupied_threshold) {
  const cv::Mat image = cv::imread(image_path, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw InputError(image_path + ": cannot be read as an image");
  const double limit = 255 * (1 - occupied_threshold);
  cv::Mat1b occupied = negate ? cv::Mat1b(image > 255 - limit) : cv::Mat1b(image < limit);
  cv::flip(occupied, occupied, 0);
  return occupied;
}

// The largest run of equal rows below a run of columns: few blocks instead of one a cell.
cv::Rect takeBlock(cv::Mat1b& cells, int row, int col) {
  cv::Rect block(col, row, 1, 1);
  while (block.br().x < cells.cols && cells(row, block.br().x)) ++block.width;
  while (block.br().y < cells.rows &&
         cv::countNonZero(cells(cv::Rect(col, block.br().y, block.width, 1))) == block.width)
    ++block.height;
  cells(block).setTo(0);
  return block;
}

}  // namespace

std::vector<Solid> extrudeMap(StrictMap& map, const std::string& directory, Material material) {
  const std::string yaml_path = joined(directory, map.text("file"));
  const double height_m = map.number("height_m");
  requirePositive(height_m, map.nameOf("height_m"));
  StrictMap meta = StrictMap::ofText(readText(yaml_path), yaml_path);
  const double resolution_m = meta.number("resolution");
  requirePositive(resolution_m, meta.nameOf("resolution"));
  const auto origin = meta.numbers("origin", 3);
  if (origin[2] != 0) throw InputError(meta.nameOf("origin") + ": a turned map cannot be extruded");
  const double threshold = meta.number("occupied_thresh");
  requireWithin(threshold, 0, 1, meta.nameOf("occupied_thresh"));
  const auto slash = yaml_path.find_last_of('/');
  const std::string image = joined(yaml_path.substr(0, slash), meta.text("image"));
  cv::Mat1b cells = occupiedCells(image, meta.number("negate") != 0, threshold);
  std::vector<Solid> solids;
  for (int row = 0; row < cells.rows; ++row) {
    for (int col = 0; col < cells.cols; ++col) {
      if (!cells(row, col)) continue;
      const cv::Rect block = takeBlock(cells, row, col);
      const double x0 = origin[0] + block.x * resolution_m, x1 = x0 + block.width * resolution_m;
      const double y0 = origin[1] + block.y * resolution_m, y1 = y0 + block.height * resolution_m;
      solids.push_back({{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}}, 0, height_m, material, false});
    }
  }
  return solids;
}

}  // namespace cornerstone
