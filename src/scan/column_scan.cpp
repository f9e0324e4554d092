#include "cornerstone/scan/column_scan.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include "column_surface.h"
#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr double kIntervalSigmas = 2;  // of Beam::near_m and far_m

struct CameraPose {
  Eigen::Matrix3d rotation;
  Eigen::Vector2d position_m;  // in the base frame
  double height_m = 0;
  double yaw_rad = 0;
};

struct ScanInput {
  const InverseDepthImage& image;
  const CameraPose& camera;
  const ScanParams& params;
};

using LevelPixels = std::vector<std::vector<ColumnPixel>>;  // a list for each level

// The lowest and the highest point that any level holds.
std::pair<double, double> heightsOf(const std::vector<Level>& levels) {
  std::pair<double, double> heights_m{levels.front().z_min_m, levels.front().z_max_m};
  for (const Level& level : levels)
    heights_m = {std::min(heights_m.first, level.z_min_m), std::max(heights_m.second, level.z_max_m)};
  return heights_m;
}

// Rays of an image column in the base frame: they change evenly from row to row.
struct SpatialRays {
  Eigen::Vector3d first, step;
};

SpatialRays raysOf(const InverseDepthImage& image, const CameraPose& camera, int u) {
  const double x = (u - image.centre_x_px) / image.focal_px;
  const Eigen::Vector3d down = camera.rotation.col(1) / image.focal_px;
  return {camera.rotation * Eigen::Vector3d(x, 0, 1) - image.centre_y_px * down, down};
}

// All points of one image column, each in the levels it lies in.
void collectColumn(const ScanInput& input, int u, const SpatialRays& rays, LevelPixels& by_level) {
  const auto& [image, camera, params] = input;
  for (auto& pixels : by_level) pixels.clear();
  const auto [lowest, highest] = heightsOf(params.levels);
  const double first_z = rays.first.z(), step_z = rays.step.z();
  for (int v = 0; v < image.inverse_depth.rows; ++v) {
    const double inverse_depth = image.inverse_depth(v, u);
    if (!(inverse_depth > 0)) continue;
    const double depth_m = 1 / inverse_depth, ray_z = first_z + v * step_z;
    const double height_m = camera.height_m + ray_z * depth_m;
    if (height_m < lowest || height_m > highest) continue;  // floor and ceiling, before more is worked out
    const Eigen::Vector2d ray = rays.first.head<2>() + v * rays.step.head<2>();
    const double sigma = image.sigma(v, u), planar = ray.norm(), range_m = planar * depth_m;
    if (planar < 1e-3 || range_m < params.min_range_m) continue;
    const Eigen::Vector2d point_m = camera.position_m + depth_m * ray;
    if (point_m.squaredNorm() < params.body_radius_m * params.body_radius_m) continue;
    const double by_depth_m = ray_z * sigma * depth_m * depth_m, by_tilt_m = params.tilt_sigma_rad * range_m;
    const double margin_m = params.height_sigmas * std::sqrt(by_depth_m * by_depth_m + by_tilt_m * by_tilt_m);
    const double q = inverse_depth / planar, sigma_q = sigma / planar;
    for (std::size_t i = 0; i < params.levels.size(); ++i)
      if (height_m - margin_m >= params.levels[i].z_min_m && height_m + margin_m <= params.levels[i].z_max_m)
        by_level[i].push_back({q, sigma_q, 1 / (sigma_q * sigma_q), static_cast<double>(v)});
  }
}

double bearingOf(const Eigen::Vector2d& direction, const CameraPose& camera) {
  return wrapAngle(std::atan2(direction.y(), direction.x()) - camera.yaw_rad);
}

Beam emptyBeam(const InverseDepthImage& image, const CameraPose& camera, int u) {
  const auto edge = [&](double column) {
    const Eigen::Vector3d ray =
        camera.rotation * Eigen::Vector3d((column - image.centre_x_px) / image.focal_px, 0, 1);
    return bearingOf(ray.head<2>(), camera);
  };
  Beam beam;
  beam.bearing_rad = edge(u);
  beam.width_rad = std::abs(wrapAngle(edge(u - 0.5) - edge(u + 0.5)));
  return beam;
}

void answer(const ColumnSurface& surface, const CameraPose& camera, Beam& beam) {
  const double near_q = surface.q + kIntervalSigmas * surface.sigma_q;
  const double far_q = surface.q - kIntervalSigmas * surface.sigma_q;
  if (far_q <= 0) return;  // not told from infinity
  beam.hit = true;
  beam.bearing_rad = bearingOf(surface.direction, camera);
  beam.range_m = 1 / surface.q;
  beam.sigma_m = surface.sigma_q / (surface.q * surface.q);
  beam.near_m = 1 / near_q;
  beam.far_m = 1 / far_q;
  const double caution_q = surface.caution_q > surface.q ? surface.caution_q * near_q / surface.q : near_q;
  beam.clear_m = std::min(beam.near_m, 1 / caution_q);
}

// A surface seen by a single column between others that see elsewhere is a mismatch as a rule.
void dropLonely(std::vector<Beam>& beams) {
  const std::vector<Beam> all = beams;
  const auto agree = [](const Beam& a, const Beam& b) {
    constexpr double kSlopeRatio = 0.1;  // a slanted wall's ranges differ from column to column
    return a.hit && b.hit &&
           std::abs(a.range_m - b.range_m) <= 3 * std::hypot(a.sigma_m, b.sigma_m) + kSlopeRatio * a.range_m;
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool supported = false;
    for (std::size_t j = i < 2 ? 0 : i - 2; j < std::min(all.size(), i + 3); ++j)
      supported = supported || (j != i && agree(all[i], all[j]));
    if (all[i].hit && !supported) {
      beams[i] = Beam{};
      beams[i].bearing_rad = all[i].bearing_rad;
      beams[i].width_rad = all[i].width_rad;
    }
  }
}

}  // namespace

void describe(ParamVisitor& visitor, Level& level) {
  visitor.field("name", level.name);
  visitor.field("z_min_m", level.z_min_m);
  visitor.field("z_max_m", level.z_max_m);
}

namespace {

void requireValid(const std::vector<Level>& levels) {
  if (levels.empty()) throw InputError("levels: at least one is needed, the one to drive by");
  std::set<std::string> names;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::string where = "levels[" + std::to_string(i) + "]/", &name = levels[i].name;
    if (name.empty() ||
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") != std::string::npos ||
        std::islower(static_cast<unsigned char>(name[0])) == 0)
      throw InputError(where + "name is '" + name +
                       "', it must be of small letters, digits and _, a letter first");
    if (!names.insert(name).second) throw InputError(where + "name '" + name + "' is there twice");
    requireWithin(levels[i].z_min_m, -100, 100, where + "z_min_m");
    requireWithin(levels[i].z_max_m, -100, 100, where + "z_max_m");
    requirePositive(levels[i].z_max_m - levels[i].z_min_m, where + "z_max_m above z_min_m");
  }
}

}  // namespace

void describe(ParamVisitor& visitor, ScanParams& params) {
  visitor.list("levels", params.levels);
  visitor.field("min_support_px", params.min_support_px);
  visitor.field("min_caution_px", params.min_caution_px);
  visitor.field("agree_sigmas", params.agree_sigmas);
  visitor.field("height_sigmas", params.height_sigmas);
  visitor.degrees("tilt_sigma_deg", params.tilt_sigma_rad);
  visitor.field("correlated_px", params.correlated_px);
  visitor.field("common_sigma_px", params.common_sigma_px);
  visitor.field("calibration_sigma_px", params.calibration_sigma_px);
  visitor.field("min_range_m", params.min_range_m);
  visitor.field("body_radius_m", params.body_radius_m);
}

void requireValid(const ScanParams& params) {
  requireValid(params.levels);
  requireWithin(params.min_support_px, 1, 1000, "min_support_px");
  requireWithin(params.min_caution_px, 1, params.min_support_px, "min_caution_px");
  requireWithin(params.agree_sigmas, 0.5, 10, "agree_sigmas");
  requireWithin(params.height_sigmas, 0, 10, "height_sigmas");
  requireWithin(params.tilt_sigma_rad, 0, 0.2, "tilt_sigma_deg");
  requireWithin(params.correlated_px, 1, 100, "correlated_px");
  requireWithin(params.common_sigma_px, 0, 2, "common_sigma_px");
  requireWithin(params.calibration_sigma_px, 0, 2, "calibration_sigma_px");
  requirePositive(params.min_range_m, "min_range_m");
  requireWithin(params.body_radius_m, 0, 10, "body_radius_m");
}

RangeScan scanFromInverseDepth(const InverseDepthImage& image, const Eigen::Isometry3d& base_from_camera,
                               const ScanParams& params) {
  requireValid(params);
  requirePositive(image.focal_px, "focal length of the depth camera");
  if (!base_from_camera.matrix().allFinite()) throw InputError("base_from_camera is not finite");
  const Eigen::Vector3d axis = base_from_camera.linear().col(2);
  if (axis.head<2>().norm() < 0.1) throw InputError("base_from_camera: the camera looks straight up or down");
  const CameraPose camera{base_from_camera.linear(), base_from_camera.translation().head<2>(),
                          base_from_camera.translation().z(), std::atan2(axis.y(), axis.x())};

  RangeScan scan;
  scan.base_from_sensor = {camera.position_m.x(), camera.position_m.y(), camera.yaw_rad};
  scan.correlated_beams = params.correlated_px;
  LevelPixels pixels(params.levels.size());
  std::vector<std::vector<Beam>> beams(params.levels.size());
  for (int u = image.inverse_depth.cols - 1; u >= 0; --u) {
    const SpatialRays rays = raysOf(image, camera, u);
    collectColumn({image, camera, params}, u, rays, pixels);
    const Beam empty = emptyBeam(image, camera, u);
    for (std::size_t i = 0; i < beams.size(); ++i) {
      beams[i].push_back(empty);
      const auto surface =
          nearestSurface(pixels[i], {rays.first.head<2>(), rays.step.head<2>()}, image.common_sigma, params);
      if (surface) answer(*surface, camera, beams[i].back());
    }
  }
  for (auto& level : beams) {
    std::stable_sort(level.begin(), level.end(),
                     [](const Beam& a, const Beam& b) { return a.bearing_rad < b.bearing_rad; });
    dropLonely(level);
  }
  scan.beams = std::move(beams.front());
  scan.further_levels.assign(std::make_move_iterator(beams.begin() + 1),
                             std::make_move_iterator(beams.end()));
  return scan;
}

RangeScan scanFromDisparity(const Disparity& disparity, const Eigen::Isometry3d& base_from_camera,
                            const ScanParams& params) {
  const TrinocularRig& rig = disparity.rig;
  requirePositive(rig.baseline_m, "baseline of the stereo rig");
  requirePositive(rig.focal_px, "focal length of the stereo rig");
  if (disparity.disparity_px.size() != disparity.sigma_px.size())
    throw InputError("disparity: disparity_px and sigma_px differ in size");
  const double per_px = 1 / (rig.focal_px * rig.baseline_m);  // 1/Z = d / (f B)
  InverseDepthImage image;
  image.inverse_depth = disparity.disparity_px * per_px;
  image.sigma = disparity.sigma_px * per_px;
  image.common_sigma = params.common_sigma_px * per_px;
  image.focal_px = rig.focal_px;
  image.centre_x_px = rig.centre_x_px;
  image.centre_y_px = rig.centre_y_px;
  RangeScan scan = scanFromInverseDepth(image, base_from_camera, params);
  scan.calibration_sigma_per_m = params.calibration_sigma_px * per_px;
  return scan;
}

}  // namespace cornerstone
