#include "cornerstone/stereo/self_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "stereo/synthetic_views.h"

namespace cornerstone {
namespace {

constexpr double kFocal_px = 80;
const cv::Point2d kCentre_px(79.5, 59.5);

// Where a camera that is turned by so much sees what it should see at a pixel, the other way round.
cv::Point2d levelOf(int col, int row, const Eigen::Vector3d& turns_px) {
  const Eigen::Vector3d seen((col - kCentre_px.x) / kFocal_px, (row - kCentre_px.y) / kFocal_px, 1);
  const Eigen::Vector3d level = seen + (turns_px / kFocal_px).cross(seen);
  return kCentre_px + kFocal_px / level.z() * cv::Point2d(level.x(), level.y());
}

struct Rig {
  Eigen::Vector3d right_px = Eigen::Vector3d::Zero(), third_px = Eigen::Vector3d::Zero();
  bool has_third = true;
  double contrast = 30;
};

TrinocularRig centred(TrinocularRig rig) {
  rig.focal_px = kFocal_px;
  rig.centre_x_px = kCentre_px.x;
  rig.centre_y_px = kCentre_px.y;
  return rig;
}

// As viewsOf, of 160 x 120 px, by turned cameras.
StereoImages turnedViewsOf(const Texture& texture, const Surface& wall, const Rig& rig, cv::RNG& random) {
  cv::Mat1f reference(120, 160), right(120, 160), top(120, 160);
  for (int y = 0; y < reference.rows; ++y)
    for (int x = 0; x < reference.cols; ++x) {
      reference(y, x) = texture.at(x, y);
      const cv::Point2d by_right = levelOf(x, y, rig.right_px), by_top = levelOf(x, y, rig.third_px);
      right(y, x) = texture.at((by_right.x + wall.at_left_px) / (1 - wall.slope), by_right.y);
      top(y, x) = texture.at(by_top.x, by_top.y - (wall.at_left_px + wall.slope * by_top.x));
    }
  return {photographed(reference, 1, 1, random), photographed(right, 1, 1.05, random),
          rig.has_third ? photographed(top, 1, 0.95, random) : cv::Mat1b()};
}

// Walls that pass by, at other distances and slants each time.
SelfCalibration afterSets(int sets, const Rig& rig) {
  cv::RNG random(5);
  SelfCalibration calibration;
  StereoMatcher matcher({});
  for (int i = 0; i < sets; ++i) {
    const Texture texture({160, 120}, 1.5, rig.contrast, random);
    const StereoImages images =
        turnedViewsOf(texture, {random.uniform(3.0, 9.0), random.uniform(-0.02, 0.02)}, rig, random);
    Disparity answer = matcher.match(images, centred(rigOf(images)));
    calibration.correct(images, answer);
  }
  return calibration;
}

constexpr int kSets = 100;

TEST(SelfCalibration, FindsHowTheCamerasAreTurned) {
  const Rig rig{{0.06, 0.10, -0.08}, {-0.09, 0.05, 0.07}};
  const SelfCalibration calibration = afterSets(kSets, rig);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(calibration.turns_px()(i), rig.right_px(i), 0.006) << "right, axis " << i;
    EXPECT_NEAR(calibration.turns_px()(3 + i), rig.third_px(i), 0.006) << "third, axis " << i;
  }
  EXPECT_LT(calibration.sigmas_px().maxCoeff(), 0.01);
  EXPECT_FALSE(calibration.isAtLimit());
}

TEST(SelfCalibration, LeavesARigAloneThatIsAsCalibrated) {
  const SelfCalibration calibration = afterSets(kSets, {});
  EXPECT_LT(calibration.turns_px().cwiseAbs().maxCoeff(), 0.004) << calibration.turns_px().transpose();
}

// However long it stands: windows that are seen again err as they did.
TEST(SelfCalibration, LearnsFromAViewOnce) {
  cv::RNG random(5);
  const Texture texture({160, 120}, 1.5, 30, random);
  SelfCalibration calibration;
  StereoMatcher matcher({});
  SelfCalibration::Turns first;
  for (int i = 0; i < 300; ++i) {
    const StereoImages images = turnedViewsOf(texture, {5.3, 0.01}, {}, random);
    Disparity answer = matcher.match(images, centred(rigOf(images)));
    calibration.correct(images, answer);
    if (i == 0) first = calibration.sigmas_px();
  }
  for (int i = 0; i < 6; ++i) EXPECT_GT(calibration.sigmas_px()(i), 0.5 * first(i)) << "turn " << i;
}

// Across its baseline a camera at the side shows all three of its turns.
TEST(SelfCalibration, TwoCamerasAreEnough) {
  Rig rig{{0.05, 0.10, -0.05}, {}};
  rig.has_third = false;
  const SelfCalibration calibration = afterSets(kSets, rig);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(calibration.turns_px()(i), rig.right_px(i), 0.012) << "axis " << i;
  EXPECT_TRUE(calibration.turns_px().tail<3>().isZero(0));  // of a camera that is not there
}

TEST(SelfCalibration, LearnsNothingFromBareWalls) {
  Rig rig{{0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}};
  rig.contrast = 0;
  const SelfCalibration calibration = afterSets(20, rig);
  EXPECT_LT(calibration.turns_px().cwiseAbs().maxCoeff(), 0.02);
  EXPECT_GT(calibration.sigmas_px().minCoeff(), 0.08);
}

struct Seen {
  StereoImages images;
  Disparity answer;
};

// A wall 6 px away, not yet corrected.
Seen wallSeenBy(const Rig& rig) {
  cv::RNG random(9);
  const Texture texture({160, 120}, 1.5, 30, random);
  Seen seen{turnedViewsOf(texture, {6, 0}, rig, random), {}};
  seen.answer = StereoMatcher({}).match(seen.images, centred(rigOf(seen.images)));
  return seen;
}

TEST(SelfCalibration, TakesTheOffsetOutOfTheAnswers) {
  const Rig rig{{0, 0.2, 0}, {0.2, 0, 0}};
  SelfCalibration calibration = afterSets(kSets, rig);
  Seen wall = wallSeenBy(rig);
  const auto offset = [&] { return cv::mean(wall.answer.disparity_px, wall.answer.rejection == 0)[0] - 6; };
  EXPECT_GT(offset(), 0.2);
  calibration.correct(wall.images, wall.answer);
  EXPECT_NEAR(offset(), 0, 0.02);
}

// Also where a row is no whole number of the processor's vectors.
TEST(SelfCalibration, CorrectsImagesOfAnyWidth) {
  const Rig rig{{0, 0.2, 0}, {0.2, 0, 0}};
  const SelfCalibration learned = afterSets(kSets, rig);
  for (const int width : {158, 157, 3}) {
    Seen whole = wallSeenBy(rig), narrow = whole;
    const cv::Rect part(0, 0, width, 120);
    for (cv::Mat1b* image : {&narrow.images.reference, &narrow.images.right, &narrow.images.top})
      *image = (*image)(part).clone();
    narrow.answer.disparity_px = narrow.answer.disparity_px(part).clone();
    narrow.answer.rejection = narrow.answer.rejection(part).clone();
    narrow.answer.rig.image_size_px = part.size();
    SelfCalibration(learned).correct(whole.images, whole.answer);
    SelfCalibration(learned).correct(narrow.images, narrow.answer);
    EXPECT_LT(cv::norm(whole.answer.disparity_px(part), narrow.answer.disparity_px, cv::NORM_INF), 0.005);
  }
}

// What is as far as infinity once it is corrected has no answer, rather than one below zero.
TEST(SelfCalibration, NoAnswerIsEverBelowZero) {
  const Rig rig{{0, 0.6, 0}, {0.6, 0, 0}};
  SelfCalibration calibration = afterSets(kSets, rig);
  Seen wall = wallSeenBy(rig);
  wall.answer.disparity_px.setTo(0.3, wall.answer.disparity_px > 0);
  calibration.correct(wall.images, wall.answer);
  EXPECT_EQ(cv::countNonZero(wall.answer.disparity_px > 0), 0);
  EXPECT_EQ(cv::countNonZero(wall.answer.rejection == 0), 0);
}

}  // namespace
}  // namespace cornerstone
