#include "cornerstone/stereo/rig_check.h"

#include <gtest/gtest.h>

#include "synthetic_views.h"

namespace cornerstone {
namespace {

StereoImages wall() {
  cv::RNG random(3);
  const Texture texture({160, 120}, 1.2, 40, random);
  return viewsOf(texture, {8, 0.01}, {}, random);
}

// What is said after so many sets that look alike.
std::string saidAfter(int sets, const StereoImages& images, const TrinocularRig& rig) {
  const Disparity answer = StereoMatcher({}).match(images, rig);
  RigCheck check({});
  for (int i = 0; i < sets; ++i) check.look(images, answer);
  return check.complaint();
}

TEST(RigCheck, NothingIsHeldAgainstARigThatFits) {
  const StereoImages images = wall();
  EXPECT_EQ(saidAfter(300, images, rigOf(images)), "");
  const StereoImages pair{images.reference, images.right, {}};
  EXPECT_EQ(saidAfter(300, pair, rigOf(pair)), "");
}

TEST(RigCheck, SwappedCamerasAreNamedOnceItLasts) {
  const StereoImages images = wall(), swapped{images.right, images.reference, {}};
  EXPECT_EQ(saidAfter(9, swapped, rigOf(swapped)), "");
  EXPECT_NE(saidAfter(10, swapped, rigOf(swapped)).find("hardly a pixel matches"), std::string::npos);
}

TEST(RigCheck, AThirdCameraThatContradictsIsNamedOnceItLasts) {
  const StereoImages images = wall();
  TrinocularRig rig = rigOf(images);
  for (const cv::Point2d shift : {cv::Point2d(0, 2), cv::Point2d(0, -1), cv::Point2d(-2, 0)}) {
    rig.top_shift = shift;
    EXPECT_EQ(saidAfter(99, images, rig).find("contradicts"), std::string::npos) << shift;
    EXPECT_NE(saidAfter(100, images, rig), "") << shift;
  }
}

TEST(RigCheck, ItIsForgottenWhenTheyFitAgain) {
  const StereoImages images = wall(), swapped{images.right, images.reference, {}};
  RigCheck check({});
  const Disparity wrong = matched(swapped), right = matched(images);
  for (int i = 0; i < 20; ++i) check.look(swapped, wrong);
  ASSERT_NE(check.complaint(), "");
  check.look(images, right);
  EXPECT_EQ(check.complaint(), "");
}

}  // namespace
}  // namespace cornerstone
