#include "cornerstone/stereo/rig_calibration.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <sstream>

#include "cornerstone/base/errors.h"
#include "rig_rectification.h"

namespace cornerstone {
namespace {

using Corners = std::vector<cv::Point2f>;

// k3 is left at 0: chessboards seldom reach the image's corners, where alone it could be told.
constexpr int kLensFlags = cv::CALIB_FIX_K3;
const cv::TermCriteria kUntil(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-9);

struct Lens {
  cv::Size image_size_px;
  cv::Mat1d intrinsics, distortion;
  double rms_px = 0;
};

void requireEnough(std::size_t sets, const std::string& what) {
  const int needed = CalibrationParams().smallest_sets;
  if (sets < static_cast<std::size_t>(needed))
    throw InputError(what + ": only " + std::to_string(sets) + " boards found, at least " +
                     std::to_string(needed) + " are needed");
}

Lens lensOf(const CameraViews& camera, cv::Size size, const Chessboard& board) {
  std::vector<Corners> seen;
  for (const Corners& corners : camera.corners)
    if (!corners.empty()) seen.push_back(corners);
  requireEnough(seen.size(), camera.name);
  const std::vector<std::vector<cv::Point3f>> boards(seen.size(), cornersOnBoard(board));
  Lens lens;
  lens.image_size_px = size;
  cv::Mat intrinsics, distortion;
  std::vector<cv::Mat> rotations, positions;
  lens.rms_px = cv::calibrateCamera(boards, seen, size, intrinsics, distortion, rotations, positions,
                                    kLensFlags, kUntil);
  lens.intrinsics = intrinsics;
  lens.distortion = distortion.reshape(1, 1);
  return lens;
}

// Cameras side by side see the board the same way round; a board that looks the same turned may have been
// counted from its other end.
Corners turnedLike(const Corners& reference, Corners corners) {
  const cv::Point2f along = reference.back() - reference.front(), other = corners.back() - corners.front();
  if (along.dot(other) < 0) std::reverse(corners.begin(), corners.end());
  return corners;
}

struct Shared {  // corners of the boards that two cameras have seen
  std::vector<Corners> reference, other;
};

Shared sharedBoards(const CameraViews& reference, const CameraViews& other) {
  Shared shared;
  for (std::size_t i = 0; i < reference.corners.size(); ++i) {
    if (reference.corners[i].empty() || other.corners[i].empty()) continue;
    shared.reference.push_back(reference.corners[i]);
    shared.other.push_back(turnedLike(reference.corners[i], other.corners[i]));
  }
  requireEnough(shared.reference.size(), reference.name + " and " + other.name + " together");
  return shared;
}

// Corners as the rectified camera sees them.
Corners rectified(const std::vector<Corners>& boards, const CameraCalibration& camera) {
  Corners all, out;
  for (const Corners& corners : boards) all.insert(all.end(), corners.begin(), corners.end());
  cv::Mat1d intrinsics, rotation, projection;
  cv::eigen2cv(camera.intrinsics_px, intrinsics);
  cv::eigen2cv(camera.rectification, rotation);
  const Eigen::Matrix3d left = camera.projection_px.leftCols<3>();
  cv::eigen2cv(left, projection);
  cv::undistortPoints(all, out, intrinsics, camera.distortion, rotation, projection);
  return out;
}

void measureEpipolar(const Shared& shared, const CameraCalibration& reference, const CameraCalibration& other,
                     PairReport& report) {
  const bool vertical = std::abs(other.projection_px(1, 3)) > std::abs(other.projection_px(0, 3));
  report.at_px = rectified(shared.reference, reference);
  const Corners there = rectified(shared.other, other);
  double squares = 0;
  for (std::size_t i = 0; i < there.size(); ++i) {
    const cv::Point2f apart = there[i] - report.at_px[i];
    report.errors_px.push_back(vertical ? apart.x : apart.y);
    squares += report.errors_px.back() * report.errors_px.back();
  }
  report.epipolar_rms_px = std::sqrt(squares / static_cast<double>(there.size()));
}

CameraCalibration calibrationOf(const std::string& name, const Lens& lens) {
  CameraCalibration camera;
  camera.name = name;
  camera.image_size_px = lens.image_size_px;
  cv::cv2eigen(lens.intrinsics, camera.intrinsics_px);
  camera.distortion.assign(lens.distortion.begin(), lens.distortion.end());
  return camera;
}

void requireAlike(const std::vector<CameraViews>& cameras) {
  if (cameras.size() < 2 || cameras.size() > 3) throw InputError("a rig has two or three cameras");
  for (const CameraViews& camera : cameras)
    if (camera.corners.size() != cameras[0].corners.size())
      throw InputError(camera.name + ": " + std::to_string(camera.corners.size()) + " images, but " +
                       std::to_string(cameras[0].corners.size()) + " of " + cameras[0].name);
}

// Both lenses and the mounting from all boards that both have seen: what one image leaves open, the other's
// tells.
void refineTogether(const Shared& shared, Lens& reference, Lens& other, const Chessboard& board) {
  const std::vector<std::vector<cv::Point3f>> boards(shared.reference.size(), cornersOnBoard(board));
  cv::Mat rotation, position, essential, fundamental;
  cv::stereoCalibrate(boards, shared.reference, shared.other, reference.intrinsics, reference.distortion,
                      other.intrinsics, other.distortion, reference.image_size_px, rotation, position,
                      essential, fundamental, kLensFlags | cv::CALIB_USE_INTRINSIC_GUESS, kUntil);
}

struct Mounting {
  Eigen::Isometry3d reference_from_other = Eigen::Isometry3d::Identity();
  double rms_px = 0;
};

// The second camera's pose from all boards that both have seen, lenses as they were solved.
Mounting mountingOf(const Shared& shared, Lens& reference, Lens& other, const Chessboard& board) {
  const std::vector<std::vector<cv::Point3f>> boards(shared.reference.size(), cornersOnBoard(board));
  cv::Mat1d rotation, position;
  cv::Mat essential, fundamental;
  Mounting mounting;
  mounting.rms_px = cv::stereoCalibrate(
      boards, shared.reference, shared.other, reference.intrinsics, reference.distortion, other.intrinsics,
      other.distortion, {}, rotation, position, essential, fundamental, cv::CALIB_FIX_INTRINSIC, kUntil);
  Eigen::Matrix3d other_from_reference;
  Eigen::Vector3d reference_in_other_m;
  cv::cv2eigen(rotation, other_from_reference);
  cv::cv2eigen(position, reference_in_other_m);
  mounting.reference_from_other.linear() = other_from_reference.transpose();
  mounting.reference_from_other.translation() = -other_from_reference.transpose() * reference_in_other_m;
  return mounting;
}

std::string textOf(double value) {
  std::ostringstream text;
  text << std::setprecision(3) << value;
  return text.str();
}

}  // namespace

std::optional<RigCalibration> calibrateRig(const std::vector<CameraViews>& cameras, cv::Size image_size_px,
                                           const Chessboard& board, std::string& why) {
  requireUsable(board);
  requireAlike(cameras);
  const CalibrationParams limits;
  RigCalibration rig;
  std::vector<Lens> lenses;
  for (const CameraViews& camera : cameras) {
    lenses.push_back(lensOf(camera, image_size_px, board));
    rig.rms_px.push_back(lenses.back().rms_px);
  }
  std::vector<Shared> shared;
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    shared.push_back(sharedBoards(cameras[0], cameras[i]));
    refineTogether(shared.back(), lenses[0], lenses[i], board);
  }
  for (std::size_t i = 0; i < cameras.size(); ++i)
    rig.cameras.push_back(calibrationOf(cameras[i].name, lenses[i]));
  std::vector<Eigen::Isometry3d> reference_from_camera{Eigen::Isometry3d::Identity()};
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    const Mounting mounting = mountingOf(shared[i - 1], lenses[0], lenses[i], board);
    reference_from_camera.push_back(mounting.reference_from_other);
    PairReport report;
    report.name = cameras[i].name;
    report.sets = static_cast<int>(shared[i - 1].reference.size());
    report.rms_px = mounting.rms_px;
    report.baseline_m = mounting.reference_from_other.translation().norm();
    rig.pairs.push_back(report);
    if (!(mounting.rms_px <= limits.largest_rms_px)) {
      why = cameras[0].name + " and " + cameras[i].name + ": corners are " + textOf(mounting.rms_px) +
            " px from where the solution puts them, more than " + textOf(limits.largest_rms_px);
      return std::nullopt;
    }
  }
  const auto orientation = commonOrientation(reference_from_camera);
  if (!orientation) why = cameras[1].name + " does not stand beside " + cameras[0].name;
  if (orientation && orientation->skew_rad > limits.largest_skew_rad)
    why = cameras[2].name + " stands neither across nor along the baseline: off by " +
          textOf(orientation->skew_rad) + " rad";
  if (!why.empty()) return std::nullopt;
  rectifyRig(reference_from_camera, *orientation, rig.cameras);
  for (std::size_t i = 1; i < cameras.size(); ++i)
    measureEpipolar(shared[i - 1], rig.cameras[0], rig.cameras[i], rig.pairs[i - 1]);
  return rig;
}

}  // namespace cornerstone
