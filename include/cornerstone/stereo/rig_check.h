// Whether the images fit the rig that their calibrations tell of. What does not fit gives no error of its
// own: it gives few answers, or wrong ones.
#pragma once

#include <string>

#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone {

class RigCheck {
 public:
  explicit RigCheck(const StereoParams& params) : pair_(params) {}

  // After each match. Two things are held against the rig, each only when it lasts:
  // - hardly a pixel with texture has an answer: cameras swapped, another rig's calibrations, images of
  //   different instants;
  // - every so many sets with three cameras, the first two are matched alone: where both answer they must
  //   agree, or the baselines contradict each other.
  void look(const StereoImages& images, const Disparity& answer);
  // Empty: nothing is held against it.
  std::string complaint() const;

 private:
  void compareWithPair(const StereoImages& images, const Disparity& answer);

  StereoMatcher pair_;
  Disparity of_pair_;
  int sets_ = 0;           // since the first two cameras were matched alone
  int poor_ = 0;           // sets on end with hardly an answer
  int contradicting_ = 0;  // comparisons on end
};

}  // namespace cornerstone
