// How the cameras are turned against their calibration: hundredths of a degree, from warmth, a knock or a
// calibration that was not quite right. Nothing in one disparity shows it, and 0.1 px of it is 4% of the
// range at 4 m (f B = 10 px m).
//
// A camera turned by w (right-handed, about the axes x right, y down, z forward of its own frame) sees what
// it should see at (X, Y, 1) moved by
//   du = f (-w_y (1 + X^2) + w_z Y + w_x X Y),   dv = f (w_x (1 + Y^2) - w_z X - w_y X Y)
// Along the baseline that is taken for disparity. Across it nothing may move, so that all three turns are
// seen, w_y of a camera at the side by its X Y alone: wide views tell. Where a third camera stands across,
// both must also tell the same disparity. Of windows with answers the brightness differences of reference and
// second camera are solved for (Lucas and Kanade, 1981), a disparity error of each window, common to all
// cameras, being left free; windows in which little differs weigh most.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "cornerstone/stereo/disparity.h"
#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone {

class SelfCalibration {
 public:
  using Turns = Eigen::Matrix<double, 6, 1>;  // f w of the right and of the third camera, px

  SelfCalibration();
  // After each match: looks at every so many sets, and takes out of the answers what the turns found so far
  // have put in.
  void correct(const StereoImages& images, Disparity& answer);

  const Turns& turns_px() const { return turns_px_; }
  Turns sigmas_px() const;  // standard deviations; before the first look what is believed of any rig
  // Turned by so much that the images hardly match: boards have to be shown again.
  bool isAtLimit() const;

 private:
  using Information = Eigen::Matrix<double, 6, 6>;
  struct Evidence {
    Information squares = Information::Zero();
    Turns gradient = Turns::Zero();
  };
  struct View {
    const cv::Mat1f* image;  // smoothed
    cv::Point2d shift;       // px of this view for a px of disparity
    double gain;             // makes it as bright as the reference
  };
  struct Window;

  void look(const StereoImages& images, const Disparity& answer, double full_share);
  double novelty();
  void smooth(const StereoImages& images, const TrinocularRig& rig);
  void addWindow(const Disparity& answer, cv::Point middle, Evidence& evidence) const;
  void sumDifferences(const Disparity& answer, cv::Point middle, Window& window) const;

  Information information_;
  Turns turns_px_ = Turns::Zero();
  std::array<cv::Mat1f, 3> smoothed_;
  cv::Mat1f grey_;  // kept for their memory
  std::array<View, 2> views_{};
  std::size_t view_count_ = 0;
  cv::Mat1f last_seen_;
  std::uint64_t sets_ = 0;  // since the start
  int looks_ = 0;           // where the next look's windows begin
};

}  // namespace cornerstone
