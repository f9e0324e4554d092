#include "cornerstone/scan/column_scan.h"

#include <algorithm>
#include <cmath>

#include "column_surface.h"
#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr double kIntervalSigmas = 2;  // of Beam::near_m and far_m

struct CameraPose {
  Eigen::Matrix3d rotation;
  double height_m = 0;
  double yaw_rad = 0;
};

struct ScanInput {
  const InverseDepthImage& image;
  const CameraPose& camera;
  const ScanParams& params;
};

// All points of one image column that lie in the height band.
void collectColumn(const ScanInput& input, int u, std::vector<ColumnPixel>& pixels) {
  const auto& [image, camera, params] = input;
  pixels.clear();
  const double x = (u - image.centre_x_px) / image.focal_px;
  for (int v = 0; v < image.inverse_depth.rows; ++v) {
    const double inverse_depth = image.inverse_depth(v, u);
    if (!(inverse_depth > 0)) continue;
    const double sigma = image.sigma(v, u);
    const Eigen::Vector3d ray =
        camera.rotation * Eigen::Vector3d(x, (v - image.centre_y_px) / image.focal_px, 1);
    const double height_m = camera.height_m + ray.z() / inverse_depth;
    const double margin_m =
        params.height_sigmas * std::abs(ray.z()) * sigma / (inverse_depth * inverse_depth);
    if (height_m - margin_m < params.z_min_m || height_m + margin_m > params.z_max_m) continue;
    const double planar = ray.head<2>().norm();
    if (planar < 1e-3 || inverse_depth * params.min_range_m > planar) continue;
    pixels.push_back({inverse_depth / planar, sigma / planar, ray.head<2>()});
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

void describe(ParamVisitor& visitor, ScanParams& params) {
  visitor.field("z_min_m", params.z_min_m);
  visitor.field("z_max_m", params.z_max_m);
  visitor.field("min_support_px", params.min_support_px);
  visitor.field("min_caution_px", params.min_caution_px);
  visitor.field("agree_sigmas", params.agree_sigmas);
  visitor.field("height_sigmas", params.height_sigmas);
  visitor.field("correlated_px", params.correlated_px);
  visitor.field("common_sigma_px", params.common_sigma_px);
  visitor.field("min_range_m", params.min_range_m);
}

void requireValid(const ScanParams& params) {
  requireFinite(params.z_min_m, "z_min_m");
  requirePositive(params.z_max_m - params.z_min_m, "z_max_m above z_min_m");
  requireWithin(params.min_support_px, 1, 1000, "min_support_px");
  requireWithin(params.min_caution_px, 1, params.min_support_px, "min_caution_px");
  requireWithin(params.agree_sigmas, 0.5, 10, "agree_sigmas");
  requireWithin(params.height_sigmas, 0, 10, "height_sigmas");
  requireWithin(params.correlated_px, 1, 100, "correlated_px");
  requireWithin(params.common_sigma_px, 0, 2, "common_sigma_px");
  requirePositive(params.min_range_m, "min_range_m");
}

RangeScan scanFromInverseDepth(const InverseDepthImage& image, const Eigen::Isometry3d& base_from_camera,
                               const ScanParams& params) {
  requireValid(params);
  requirePositive(image.focal_px, "focal length of the depth camera");
  if (!base_from_camera.matrix().allFinite()) throw InputError("base_from_camera is not finite");
  const Eigen::Vector3d axis = base_from_camera.linear().col(2);
  if (axis.head<2>().norm() < 0.1) throw InputError("base_from_camera: the camera looks straight up or down");
  CameraPose camera{base_from_camera.linear(), base_from_camera.translation().z(),
                    std::atan2(axis.y(), axis.x())};

  RangeScan scan;
  scan.base_from_sensor = {base_from_camera.translation().x(), base_from_camera.translation().y(),
                           camera.yaw_rad};
  scan.correlated_beams = params.correlated_px;
  std::vector<ColumnPixel> pixels;
  for (int u = image.inverse_depth.cols - 1; u >= 0; --u) {
    collectColumn({image, camera, params}, u, pixels);
    Beam beam = emptyBeam(image, camera, u);
    const auto surface = nearestSurface(pixels, image.common_sigma, params);
    if (surface) answer(*surface, camera, beam);
    scan.beams.push_back(beam);
  }
  std::stable_sort(scan.beams.begin(), scan.beams.end(),
                   [](const Beam& a, const Beam& b) { return a.bearing_rad < b.bearing_rad; });
  dropLonely(scan.beams);
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
  scan.calibration_sigma_per_m = image.common_sigma;
  return scan;
}

}  // namespace cornerstone
