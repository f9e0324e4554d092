#include "tools/calibration_files.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <iomanip>
#include <opencv2/core/utils/filesystem.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr double kEnlarged = 50;
constexpr int kGap_px = 10;

bool isImage(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  const std::vector<std::string> known{".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".bmp", ".tif", ".tiff"};
  return std::find(known.begin(), known.end(), ending) != known.end();
}

template <typename Matrix>
void writeMatrix(YAML::Emitter& out, const std::string& name, const Matrix& matrix) {
  out << YAML::Key << name << YAML::Value << YAML::BeginMap << YAML::Key << "rows" << YAML::Value
      << matrix.rows() << YAML::Key << "cols" << YAML::Value << matrix.cols() << YAML::Key << "data"
      << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) out << static_cast<double>(matrix(row, col));
  out << YAML::EndSeq << YAML::EndMap;
}

void drawErrors(const PairReport& pair, bool vertical, cv::Mat3b& canvas) {
  for (std::size_t i = 0; i < pair.at_px.size(); ++i) {
    const cv::Point2f at = pair.at_px[i];
    const auto error = static_cast<float>(kEnlarged * pair.errors_px[i]);
    const cv::Point2f end = at + (vertical ? cv::Point2f(error, 0) : cv::Point2f(0, error));
    cv::line(canvas, at, end, {40, 40, 220}, 1, cv::LINE_AA);
    cv::circle(canvas, at, 1, {90, 90, 90}, cv::FILLED);
  }
  std::ostringstream text;
  text << pair.name << ": rms " << std::setprecision(2) << pair.epipolar_rms_px << " px, x" << kEnlarged;
  cv::putText(canvas, text.str(), {8, 18}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {0, 0, 0}, 1, cv::LINE_AA);
}

}  // namespace

std::vector<std::string> imagesAt(const std::string& where) {
  namespace fs = std::filesystem;
  const fs::path path(where);
  const bool is_folder = fs::is_directory(path);
  const fs::path folder = is_folder ? path : path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder)) throw InputError(where + ": no such folder");
  std::vector<cv::String> found;
  cv::utils::fs::glob(folder.string(), is_folder ? "*" : path.filename().string(), found);
  std::vector<std::string> images;
  std::copy_if(found.begin(), found.end(), std::back_inserter(images), isImage);
  std::sort(images.begin(), images.end());
  if (images.empty()) throw InputError(where + ": no images");
  return images;
}

std::string cameraInfoYaml(const CameraCalibration& camera) {
  YAML::Emitter out;
  out.SetDoublePrecision(12);
  out << YAML::BeginMap << YAML::Key << "image_width" << YAML::Value << camera.image_size_px.width
      << YAML::Key << "image_height" << YAML::Value << camera.image_size_px.height << YAML::Key
      << "camera_name" << YAML::Value << camera.name;
  writeMatrix(out, "camera_matrix", camera.intrinsics_px);
  out << YAML::Key << "distortion_model" << YAML::Value << "plumb_bob";
  writeMatrix(out, "distortion_coefficients",
              Eigen::Map<const Eigen::RowVectorXd>(camera.distortion.data(),
                                                   static_cast<Eigen::Index>(camera.distortion.size())));
  writeMatrix(out, "rectification_matrix", camera.rectification);
  writeMatrix(out, "projection_matrix", camera.projection_px);
  out << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

cv::Mat3b epipolarPicture(const RigCalibration& rig) {
  const cv::Size size = rig.cameras[0].image_size_px;
  const int count = static_cast<int>(rig.pairs.size());
  cv::Mat3b picture(size.height, count * (size.width + kGap_px) - kGap_px, cv::Vec3b(120, 120, 120));
  for (int i = 0; i < count; ++i) {
    cv::Mat3b canvas = picture(cv::Rect({i * (size.width + kGap_px), 0}, size));
    canvas.setTo(cv::Vec3b(255, 255, 255));
    const auto& projection = rig.cameras[static_cast<std::size_t>(i + 1)].projection_px;
    drawErrors(rig.pairs[static_cast<std::size_t>(i)], projection(1, 3) != 0, canvas);
  }
  return picture;
}

}  // namespace cornerstone
