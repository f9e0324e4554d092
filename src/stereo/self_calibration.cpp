#include "cornerstone/stereo/self_calibration.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

namespace cornerstone {
namespace {

// Of each turn before anything is known: calibrations by boards leave half of it. With half, 40 looks know
// the offset to 0.008 px instead of 0.007.
constexpr double kPrior_px = 0.2;
constexpr int kPeriod_sets = 5;  // with the corrections a seventh of a match at 160x120
// A map's first metres are drawn by what the first looks know: as long every set is looked at. The offset of
// eight tours is then known to 0.012 px after 50 sets and to 0.011 px after 100, without it to 0.019 and
// 0.013 px; as long as 40 sets 0.013 and 0.012, always 0.010 and 0.009.
constexpr int kYoung_sets = 100;
constexpr int kReach_px = 3;          // windows of 7 x 7
constexpr int kWindows = 300;         // in a grid over the image, elsewhere at each look
constexpr float kLargestStep_px = 1;  // of the disparities in a window
// What the surfaces' own shape does to a window: its evidence is never better than this.
constexpr double kWindowFloor_px = 0.05;
constexpr double kLeastVariance_grey2 = 1;  // of the differences: no camera is quieter after smoothing
constexpr double kCorrelated_px = 7;        // that share noise after smoothing
// Looks half a second apart see nearly the same and err alike: one of them counts as a fourth, and a tenth
// of a second apart as a tenth. With half of that errors are 0.8 of what they are believed to be, with 0.25
// 1.7 times.
constexpr double kLookShare = 0.25, kYoungLookShare = 0.1;
// Of what is known, from look to look: rigs warm up. It lasts 8 minutes at 10 Hz.
constexpr double kKept = 1 - 1.0 / 1000;
constexpr double kLargest_px = 1;  // beyond, images do not match any more

using Turning = Eigen::Matrix<double, 2, 3>;

// How far what is seen at an image point moves, in px, for each turn in px.
Turning movedByTurns(const TrinocularRig& rig, const cv::Point2d& at) {
  const double x = (at.x - rig.centre_x_px) / rig.focal_px, y = (at.y - rig.centre_y_px) / rig.focal_px;
  Turning moved;
  moved << x * y, -(1 + x * x), y, 1 + y * y, -x * y, -x;
  return moved;
}

Eigen::Vector2d vectorOf(const cv::Point2d& point) { return {point.x, point.y}; }

float sample(const cv::Mat1f& image, double x, double y) {
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const auto right = static_cast<float>(x - column), down = static_cast<float>(y - row);
  const float *above = image[row] + column, *below = image[row + 1] + column;
  return (1 - down) * ((1 - right) * above[0] + right * above[1]) +
         down * ((1 - right) * below[0] + right * below[1]);
}

// Far enough inside for the samples of a window around it, their gradients and the pixels between which they
// lie.
bool isInside(const cv::Mat1f& image, const cv::Point2d& shift, const Eigen::Vector2d& middle) {
  const double reach_u = kReach_px + kLargestStep_px * std::abs(shift.x) + 2,
               reach_v = kReach_px + kLargestStep_px * std::abs(shift.y) + 2;
  return middle.x() >= reach_u && middle.y() >= reach_v && middle.x() < image.cols - 1 - reach_u &&
         middle.y() < image.rows - 1 - reach_v;
}

bool isOneSurface(const Disparity& answer, cv::Point middle) {
  const float middle_px = answer.disparity_px(middle);
  for (int y = middle.y - kReach_px; y <= middle.y + kReach_px; ++y)
    for (int x = middle.x - kReach_px; x <= middle.x + kReach_px; ++x) {
      const float here_px = answer.disparity_px(y, x);
      if (!(here_px > 0) || std::abs(here_px - middle_px) > kLargestStep_px) return false;
    }
  return true;
}

using Floats = cv::v_float32;

Floats floatsOf(double value) { return cv::vx_setall_f32(static_cast<float>(value)); }

// What the turns of a camera move along its baseline: a polynomial over the image.
class AlongBaseline {
 public:
  AlongBaseline(const TrinocularRig& rig, const cv::Point2d& shift, const Eigen::Vector3d& turns_px)
      : shift_x_(floatsOf(shift.x)),
        shift_y_(floatsOf(shift.y)),
        weight_(floatsOf(shift.dot(shift))),
        centre_x_px_(floatsOf(rig.centre_x_px)),
        centre_y_px_(floatsOf(rig.centre_y_px)),
        per_px_(floatsOf(1 / rig.focal_px)),
        last_x_px_(floatsOf(rig.image_size_px.width - 1)),
        last_y_px_(floatsOf(rig.image_size_px.height - 1)),
        constant_(floatsOf(shift.y * turns_px.x() - shift.x * turns_px.y())),
        x_(floatsOf(-shift.y * turns_px.z())),
        y_(floatsOf(shift.x * turns_px.z())),
        xx_(floatsOf(-shift.x * turns_px.y())),
        yy_(floatsOf(shift.y * turns_px.x())),
        xy_(floatsOf(shift.x * turns_px.x() - shift.y * turns_px.y())) {}

  struct Share {
    Floats moved, weight;  // moved / weight: px of disparity
  };
  // Nothing where the camera does not see the pixel.
  Share of(const Floats& x_px, const Floats& y_px, const Floats& disparities_px) const {
    const Floats u = x_px + disparities_px * shift_x_, v = y_px + disparities_px * shift_y_;
    const Floats x = (u - centre_x_px_) * per_px_, y = (v - centre_y_px_) * per_px_;
    const Floats moved = constant_ + x * (x_ + xx_ * x + xy_ * y) + y * (y_ + yy_ * y);
    const Floats zero = cv::vx_setzero_f32();
    const Floats seen = (u >= zero) & (v >= zero) & (u <= last_x_px_) & (v <= last_y_px_);
    return {moved & seen, weight_ & seen};
  }

 private:
  Floats shift_x_, shift_y_, weight_, centre_x_px_, centre_y_px_, per_px_, last_x_px_, last_y_px_;
  Floats constant_, x_, y_, xx_, yy_, xy_;
};

// Takes out of a vector's disparities what the turns have put in; where there is no answer they stay 0.
void correctVector(const AlongBaseline& right, const AlongBaseline& third, const cv::Point2f& first_px,
                   float* disparities_px) {
  static const std::array<float, 16> kCounting{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const Floats before = cv::vx_load(disparities_px), zero = cv::vx_setzero_f32();
  const Floats x = cv::vx_setall_f32(first_px.x) + cv::vx_load(kCounting.data()),
               y = cv::vx_setall_f32(first_px.y);
  const auto by_right = right.of(x, y, before), by_third = third.of(x, y, before);
  const Floats weight = by_right.weight + by_third.weight;
  const Floats off = (by_right.moved + by_third.moved) / cv::v_select(weight > zero, weight, floatsOf(1));
  cv::v_store(disparities_px, (before - off) & (before > zero));
}

}  // namespace

// A displacement (du, dv) of each view: the quadratic that the brightness differences make of it, and what it
// is made of.
struct SelfCalibration::Window {
  Eigen::Matrix4d squares = Eigen::Matrix4d::Zero();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  Eigen::Vector4d by_disparity = Eigen::Vector4d::Zero();
  Eigen::Matrix<double, 4, 6> by_turns = Eigen::Matrix<double, 4, 6>::Zero();
};

SelfCalibration::SelfCalibration() : information_(Information::Identity() / (kPrior_px * kPrior_px)) {}

SelfCalibration::Turns SelfCalibration::sigmas_px() const {
  return information_.inverse().diagonal().cwiseSqrt();
}

void SelfCalibration::smooth(const StereoImages& images, const TrinocularRig& rig) {
  const std::array<const cv::Mat1b*, 3> all{&images.reference, &images.right, &images.top};
  std::array<double, 3> contrasts{};
  view_count_ = images.top.empty() || !rig.top_shift ? 1 : 2;
  for (std::size_t i = 0; i <= view_count_; ++i) {
    all[i]->convertTo(grey_, CV_32F);
    // Noise goes, and with it what is too fine for samples between pixels.
    cv::GaussianBlur(grey_, smoothed_[i], {5, 5}, 1.0);
    cv::Scalar mean, deviation;
    cv::meanStdDev(smoothed_[i], mean, deviation);
    contrasts[i] = std::max(deviation[0], 1.0);
  }
  views_[0] = {&smoothed_[1], rig.right_shift, contrasts[0] / contrasts[1]};
  if (view_count_ == 2) views_[1] = {&smoothed_[2], *rig.top_shift, contrasts[0] / contrasts[2]};
}

void SelfCalibration::sumDifferences(const Disparity& answer, cv::Point middle, Window& window) const {
  for (std::size_t i = 0; i < view_count_; ++i) {
    const View& view = views_[i];
    const auto first = static_cast<Eigen::Index>(2 * i), turn = static_cast<Eigen::Index>(3 * i);
    const cv::Point2d at = cv::Point2d(middle) + answer.disparity_px(middle) * view.shift;
    const Turning by_turns = movedByTurns(answer.rig, at);
    const Eigen::Vector2d moved_px = by_turns * turns_px_.segment<3>(turn);
    if (!isInside(*view.image, view.shift, vectorOf(at) + moved_px)) continue;

    constexpr int kEdge_px = 2 * kReach_px + 1, kPixels = kEdge_px * kEdge_px;
    std::array<Eigen::Vector3d, kPixels> pixels;  // gradient and difference
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    std::size_t count = 0;
    for (int y = middle.y - kReach_px; y <= middle.y + kReach_px; ++y)
      for (int x = middle.x - kReach_px; x <= middle.x + kReach_px; ++x) {
        const double d_px = answer.disparity_px(y, x);
        const double u = x + d_px * view.shift.x + moved_px.x(), v = y + d_px * view.shift.y + moved_px.y();
        const auto brightness = [&](double du, double dv) {
          return view.gain * static_cast<double>(sample(*view.image, u + du, v + dv));
        };
        Eigen::Vector3d& pixel = pixels[count++];
        pixel << (brightness(1, 0) - brightness(-1, 0)) / 2, (brightness(0, 1) - brightness(0, -1)) / 2,
            static_cast<double>(smoothed_[0](y, x)) - brightness(0, 0);
        sum += pixel;
      }
    const double offset = sum.z() / kPixels;  // of this camera's brightness
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    for (Eigen::Vector3d& pixel : pixels) {
      pixel.z() -= offset;
      products += pixel * pixel.transpose();
    }
    const double variance = kCorrelated_px * std::max(kLeastVariance_grey2, products(2, 2) / kPixels);
    const Eigen::Matrix2d squares = products.topLeftCorner<2, 2>() / variance;
    const Eigen::Matrix2d temper =
        (Eigen::Matrix2d::Identity() + kWindowFloor_px * kWindowFloor_px * squares).inverse();
    window.squares.block<2, 2>(first, first) = temper * squares;
    window.gradient.segment<2>(first) = temper * products.topRightCorner<2, 1>() / variance;
    window.by_disparity.segment<2>(first) = vectorOf(view.shift);
    window.by_turns.block<2, 3>(first, turn) = by_turns;
  }
}

// With the disparity's error eliminated.
void SelfCalibration::addWindow(const Disparity& answer, cv::Point middle, Evidence& evidence) const {
  if (!isOneSurface(answer, middle)) return;
  Window window;
  sumDifferences(answer, middle, window);
  const Eigen::Vector4d by_disparity = window.squares * window.by_disparity;
  const double of_disparity = window.by_disparity.dot(by_disparity);
  constexpr double kNothing = 1e-3;  // no disparity of the window can be told better than to 30 px
  if (of_disparity < kNothing) return;
  const Eigen::Matrix4d squares = window.squares - by_disparity * by_disparity.transpose() / of_disparity;
  const Eigen::Vector4d gradient =
      window.gradient - by_disparity * (window.by_disparity.dot(window.gradient) / of_disparity);
  evidence.squares += window.by_turns.transpose() * squares * window.by_turns;
  evidence.gradient += window.by_turns.transpose() * gradient;
}

// Seen again from the same place, windows err as they did: how much of a pixel the view has moved since the
// last look, by the squares of brightness differences, at most 1.
double SelfCalibration::novelty() {
  const cv::Mat1f& now = smoothed_[0];
  const cv::Rect inner({0, 0}, now.size() - cv::Size(1, 1));
  const auto sumOfSquares = [&](const cv::Mat1f& a, const cv::Mat1f& b) {
    return cv::norm(a, b, cv::NORM_L2SQR);
  };
  const double by_a_pixel = sumOfSquares(now(inner), now(inner + cv::Point(1, 0))) +
                            sumOfSquares(now(inner), now(inner + cv::Point(0, 1)));
  const bool known = last_seen_.size() == now.size();
  const double moved = known ? sumOfSquares(now, last_seen_) : by_a_pixel;
  now.copyTo(last_seen_);
  return by_a_pixel > 0 ? std::min(1.0, moved / by_a_pixel) : 0;
}

void SelfCalibration::look(const StereoImages& images, const Disparity& answer, double full_share) {
  smooth(images, answer.rig);
  const double share = full_share * novelty();
  const cv::Size size = answer.disparity_px.size();
  const int step = std::max(2 * kReach_px + 1, static_cast<int>(std::sqrt(size.area() / kWindows)));
  constexpr int kAcross = 5, kDown = 3;  // from look to look, so that every place has its turn
  const int first_x = kReach_px + looks_ * kAcross % step, first_y = kReach_px + looks_ * kDown % step;
  looks_ = (looks_ + 1) % step;
  Evidence evidence;
  for (int y = first_y; y < size.height - kReach_px; y += step)
    for (int x = first_x; x < size.width - kReach_px; x += step) addWindow(answer, {x, y}, evidence);

  const Information prior = Information::Identity() / (kPrior_px * kPrior_px);
  information_ = prior + kKept * (information_ - prior) + share * evidence.squares;
  turns_px_ += information_.ldlt().solve(share * evidence.gradient);
  turns_px_ = turns_px_.cwiseMax(-kLargest_px).cwiseMin(kLargest_px);
}

bool SelfCalibration::isAtLimit() const { return turns_px_.cwiseAbs().maxCoeff() >= kLargest_px; }

// Cameras that see a pixel have been asked for its disparity together: it is off by their mean.
void SelfCalibration::correct(const StereoImages& images, Disparity& answer) {
  const bool young = sets_ < kYoung_sets;
  if (young || sets_ % kPeriod_sets == 0) look(images, answer, young ? kYoungLookShare : kLookShare);
  ++sets_;
  if (turns_px_.isZero(0)) return;
  const TrinocularRig& rig = answer.rig;
  const AlongBaseline right(rig, rig.right_shift, turns_px_.head<3>()),
      third(rig, rig.top_shift.value_or(cv::Point2d(0, 0)), turns_px_.tail<3>());  // no baseline, no say
  constexpr int kLanes = Floats::nlanes;
  const int width = answer.disparity_px.cols, rest = width % kLanes;
  for (int y = 0; y < answer.disparity_px.rows; ++y) {
    float* disparities_px = answer.disparity_px[y];
    for (int x = 0; x < width - rest; x += kLanes)
      correctVector(right, third, cv::Point(x, y), disparities_px + x);
    if (rest > 0) {
      std::array<float, kLanes> last{};
      std::copy_n(disparities_px + width - rest, rest, last.begin());
      correctVector(right, third, cv::Point(width - rest, y), last.data());
      std::copy_n(last.begin(), rest, disparities_px + width - rest);
    }
    const std::uint8_t* rejections = answer.rejection[y];
    for (int x = 0; x < width; ++x)
      if (rejections[x] == 0 && !(disparities_px[x] > 0)) reject(answer, {x, y}, Rejection::kRange);
  }
}

}  // namespace cornerstone
