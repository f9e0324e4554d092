#include "cornerstone/stereo/gap_fill.h"

#include <gtest/gtest.h>

#include "stereo/synthetic_views.h"

namespace cornerstone {
namespace {

constexpr auto kUniqueness = static_cast<std::uint8_t>(Rejection::kUniqueness);
constexpr GapParams kParams{6, 1.F};
const cv::Size kSize(60, 40);

// Two images, and an answer for every pixel until it is rejected.
class GapFillTest : public testing::Test {
 protected:
  void look(const cv::Mat1b& reference, const cv::Mat1b& right) {
    reference_.compute(reference, workers_);
    right_.compute(right, workers_);
    input_.reference = &reference_;
    input_.views[0].prepare(right_, {-1, 0}, 16);
    input_.view_count = 1;
    winners_.disparity_px.create(kSize);
    disparity_.disparity_px.create(kSize);
    disparity_.sigma_px = cv::Mat1f(kSize, 0.1F);
    disparity_.rejection = cv::Mat1b(kSize, std::uint8_t{0});
    answer(cv::Rect({0, 0}, kSize), 5);
  }
  void answer(const cv::Rect& where, int disparity_px) {
    disparity_.disparity_px(where).setTo(disparity_px);
    winners_.disparity_px(where).setTo(disparity_px);
  }
  void rejectAll(const cv::Rect& where, Rejection why = Rejection::kUniqueness) {
    for (int y = where.y; y < where.br().y; ++y)
      for (int x = where.x; x < where.br().x; ++x) reject(disparity_, {x, y}, why);
  }
  void fill() { gap_fill_.fill({winners_, input_, workers_}, kParams, disparity_); }

  Workers workers_{1};
  GradientFeatures reference_, right_;
  SweepInput input_;
  Winners winners_;
  Disparity disparity_;
  GapFill gap_fill_;
};

TEST_F(GapFillTest, GivesAGapWhatLiesBetween) {
  const cv::Mat1b even(kSize, std::uint8_t{90});
  look(even, even);
  answer({30, 0, 30, 40}, 6);
  rejectAll({28, 0, 4, 40});
  fill();
  EXPECT_EQ(cv::countNonZero(disparity_.rejection), 0);
  EXPECT_NEAR(disparity_.disparity_px(20, 28), 5.2, 1e-5);
  EXPECT_NEAR(disparity_.disparity_px(20, 31), 5.8, 1e-5);
  EXPECT_FLOAT_EQ(disparity_.sigma_px(20, 30), 0.1F);
}

TEST_F(GapFillTest, TheShorterOfARowAndAColumnDecides) {
  const cv::Mat1b even(kSize, std::uint8_t{90});
  look(even, even);
  answer({10, 18, 5, 1}, 7);
  answer({10, 20, 5, 1}, 7);  // above and below a gap one pixel high and five long
  rejectAll({10, 19, 5, 1});
  fill();
  EXPECT_FLOAT_EQ(disparity_.disparity_px(19, 12), 7);
}

TEST_F(GapFillTest, LeavesDepthStepsLongGapsBordersAndWhatIsNearerThanTheSearch) {
  const cv::Mat1b even(kSize, std::uint8_t{90});
  look(even, even);
  answer({30, 0, 30, 40}, 7);
  rejectAll({29, 0, 2, 40});  // a depth step
  rejectAll({8, 8, 7, 7});    // one pixel too large
  rejectAll({0, 30, 2, 10});  // a corner
  rejectAll({40, 5, 2, 2}, Rejection::kOutside);
  rejectAll({50, 5, 2, 2}, Rejection::kRange);
  const cv::Mat1b before = disparity_.rejection.clone();
  fill();
  EXPECT_EQ(cv::countNonZero(disparity_.rejection != before), 0);
}

TEST_F(GapFillTest, LeavesWhatTheImagesContradict) {
  cv::RNG random(3);
  cv::Mat1b reference(kSize), right(kSize, std::uint8_t{90});
  random.fill(reference, cv::RNG::UNIFORM, 0, 255);
  reference(cv::Rect(7, 0, 53, 40)).copyTo(right(cv::Rect(5, 0, 53, 40)));  // a farther wall: 2 px
  look(reference, right);
  answer({20, 10, 4, 20}, 2);  // seen between two posts
  rejectAll({20, 10, 4, 20});
  fill();
  EXPECT_EQ(cv::countNonZero(disparity_.rejection == kUniqueness), 80);
}

}  // namespace
}  // namespace cornerstone
