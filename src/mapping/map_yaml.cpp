#include "map_yaml.h"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <sstream>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

class MapFields {
 public:
  explicit MapFields(const std::string& path) : path_(path) {
    if (!std::filesystem::is_regular_file(path)) throw InputError(path + ": no such file");
    try {
      node_ = YAML::LoadFile(path);
    } catch (const YAML::Exception& error) {
      throw InputError(path + ": not YAML: " + error.what());
    }
    if (!node_.IsMap()) throw InputError(path + ": not a map file: expected image, resolution, origin");
  }
  bool has(const std::string& field) const { return node_[field].IsDefined(); }
  std::string nameOf(const std::string& field) const { return path_ + ": field '" + field + "'"; }
  template <typename T>
  T get(const std::string& field, const char* type) const {
    if (!has(field)) throw InputError(nameOf(field) + " is missing");
    T value{};
    if (!node_[field].IsScalar() || !YAML::convert<T>::decode(node_[field], value))
      throw InputError(nameOf(field) + " is not " + type);
    return value;
  }
  double number(const std::string& field, double low, double high) const {
    const auto value = get<double>(field, "a number");
    requireWithin(value, low, high, nameOf(field));
    return value;
  }
  Eigen::Vector3d triple(const std::string& field) const {
    if (!has(field)) throw InputError(nameOf(field) + " is missing");
    std::vector<double> values;
    if (!node_[field].IsSequence() || !YAML::convert<std::vector<double>>::decode(node_[field], values) ||
        values.size() != 3)
      throw InputError(nameOf(field) + " is not a list of three numbers");
    for (const double value : values) requireWithin(value, -1e6, 1e6, nameOf(field));
    return {values[0], values[1], values[2]};
  }

 private:
  std::string path_;
  YAML::Node node_;
};

bool readNegate(const MapFields& fields) {
  const auto text = fields.get<std::string>("negate", "0 or 1");
  if (text == "0" || text == "false") return false;
  if (text == "1" || text == "true") return true;
  throw InputError(fields.nameOf("negate") + " is '" + text + "', it must be 0 or 1");
}

MapMode readMode(const MapFields& fields) {
  if (!fields.has("mode")) return MapMode::kTrinary;
  const auto text = fields.get<std::string>("mode", "trinary, scale or raw");
  if (text == "trinary") return MapMode::kTrinary;
  if (text == "scale") return MapMode::kScale;
  if (text == "raw") return MapMode::kRaw;
  throw InputError(fields.nameOf("mode") + " is '" + text + "', it must be trinary, scale or raw");
}

}  // namespace

MapYaml readMapYaml(const std::string& yaml_path) {
  const MapFields fields(yaml_path);
  MapYaml yaml;
  const std::filesystem::path image = fields.get<std::string>("image", "a file name");
  if (image.empty()) throw InputError(fields.nameOf("image") + " is empty");
  yaml.image_path =
      (image.is_absolute() ? image : std::filesystem::path(yaml_path).parent_path() / image).string();
  yaml.geometry.resolution_m = fields.number("resolution", 1e-3, 10);
  const Eigen::Vector3d origin = fields.triple("origin");
  if (std::abs(origin.z()) > 1e-9)
    throw InputError(fields.nameOf("origin") + " has a yaw that is not 0: turned grids are not supported");
  yaml.geometry.origin_x_m = origin.x();
  yaml.geometry.origin_y_m = origin.y();
  yaml.negate = readNegate(fields);
  yaml.occupied_thresh = fields.number("occupied_thresh", 0, 1);
  yaml.free_thresh = fields.number("free_thresh", 0, 1);
  if (yaml.free_thresh >= yaml.occupied_thresh)
    throw InputError(fields.nameOf("free_thresh") + " is not below occupied_thresh");
  yaml.mode = readMode(fields);
  return yaml;
}

std::string mapYamlText(const std::string& image_name, const GridGeometry& geometry) {
  std::ostringstream text;
  text << std::setprecision(std::numeric_limits<double>::max_digits10);
  text << "image: " << YAML::Node(image_name) << "\n";
  text << "mode: scale\n";
  text << "resolution: " << geometry.resolution_m << "\n";
  text << "origin: [" << geometry.origin_x_m << ", " << geometry.origin_y_m << ", 0]\n";
  // With these thresholds mode scale keeps each probability; never-seen cells are transparent.
  text << "negate: 0\noccupied_thresh: 1\nfree_thresh: 0\n";
  return text.str();
}

}  // namespace cornerstone
