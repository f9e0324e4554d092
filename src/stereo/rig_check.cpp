#include "cornerstone/stereo/rig_check.h"

#include <cmath>
#include <optional>

namespace cornerstone {
namespace {

// Of the pixels with texture. Rigs that fit: at least 0.83 on views of two rendered buildings, 0.58 on a
// photograph with 4 grey levels of noise; swapped cameras: at most 0.19, medians below 0.05. Half of it and
// double still tell the two apart.
constexpr double kLeastMatched = 0.2;
constexpr int kPoorSets = 10;  // a second at 10 Hz: a hand before a camera does not last

// Of the first two cameras' answers, those that all three agree with within 1 px. Rigs that fit: 0.94 and
// more, 0.86 between walls of stripes (which mislead two cameras) or with 8 grey levels of noise. A third
// baseline that is 1.3 times too long, turned over or in another direction: medians of at most 0.8, less with
// noise.
constexpr double kLeastAgreeing = 0.84;
constexpr float kAgree_px = 1;
constexpr int kLeastPixels_share = 50;  // at least a 50th of the image, or there is nothing to compare
constexpr int kPeriod_sets = 20;        // costs a twentieth of a match
constexpr int kContradictingLooks = 5;  // 10 s at 10 Hz

}  // namespace

void RigCheck::look(const StereoImages& images, const Disparity& answer) {
  const std::optional<double> share = matchedShare(answer);
  if (share) poor_ = *share < kLeastMatched ? poor_ + 1 : 0;
  if (images.top.empty()) contradicting_ = 0;
  if (images.top.empty() || ++sets_ < kPeriod_sets) return;
  sets_ = 0;
  compareWithPair(images, answer);
}

void RigCheck::compareWithPair(const StereoImages& images, const Disparity& answer) {
  TrinocularRig pair = answer.rig;
  pair.top_shift.reset();
  pair_.match({images.reference, images.right, {}}, pair, of_pair_);
  int answers = 0, agreeing = 0;
  for (int y = 0; y < answer.disparity_px.rows; ++y)
    for (int x = 0; x < answer.disparity_px.cols; ++x) {
      if (!(of_pair_.disparity_px(y, x) > 0)) continue;
      ++answers;
      agreeing += answer.disparity_px(y, x) > 0 &&
                  std::abs(answer.disparity_px(y, x) - of_pair_.disparity_px(y, x)) <= kAgree_px;
    }
  if (answers * kLeastPixels_share < static_cast<int>(answer.disparity_px.total())) return;
  contradicting_ = agreeing < kLeastAgreeing * answers ? contradicting_ + 1 : 0;
}

std::string RigCheck::complaint() const {
  if (poor_ >= kPoorSets)
    return "hardly a pixel matches: cameras swapped, calibrations of another rig, or images of different "
           "instants";
  if (contradicting_ >= kContradictingLooks)
    return "the third camera contradicts the first two: its calibration is not that of its images, or not of "
           "this rig";
  return {};
}

}  // namespace cornerstone
