#include "cornerstone/stereo/subpixel.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>

namespace cornerstone {
namespace {

constexpr int kLanes = 4;
constexpr float kNoWinner_px = -1e4F;
// Offsets between cameras (exposure, vignetting) vary slowly: what is coarser than this is taken out of the
// image.
constexpr int kOffsetWindow_px = 15;
// The camera's own rounding to grey levels, 1/sqrt(12), after the smoothing below: no image is better than
// that.
constexpr float kLeastNoise = 0.15F;
// Smoothing makes neighbouring equations share noise; they count as this many fewer (measured on synthetic
// images).
constexpr float kSharedNoise = 1.7F;
// What the equations do not know: slant within the support, rectification. Added to every sigma.
constexpr float kModelSigma_px = 0.05F;

}  // namespace

void SubpixelRefiner::Sums::clear(cv::Size size) {
  for (cv::Mat1f* plane : {&pp, &pe, &ee, &count}) {
    plane->create(size);
    plane->setTo(0);
  }
}

void SubpixelRefiner::prepare(const cv::Mat1b& image, Plane& plane) {
  static const cv::Mat smoothing = (cv::Mat_<float>(1, 3) << 0.25F, 0.5F, 0.25F);
  // Derivative exact for cubics: a plain difference is 16% low at a period of 6 px.
  static const cv::Mat derivative = (cv::Mat_<float>(1, 5) << 1.F / 12, -8.F / 12, 0, 8.F / 12, -1.F / 12);
  static const cv::Mat identity = (cv::Mat_<float>(1, 1) << 1.F);
  cv::sepFilter2D(image, smooth_, CV_32F, smoothing, smoothing, {-1, -1}, 0, cv::BORDER_REFLECT);
  cv::blur(smooth_, mean_, {kOffsetWindow_px, kOffsetWindow_px}, {-1, -1}, cv::BORDER_REFLECT);
  cv::subtract(smooth_, mean_, plane.level);
  cv::sepFilter2D(plane.level, plane.gradient_x, CV_32F, derivative, identity, {-1, -1}, 0,
                  cv::BORDER_REFLECT);
  cv::sepFilter2D(plane.level, plane.gradient_y, CV_32F, identity, derivative, {-1, -1}, 0,
                  cv::BORDER_REFLECT);
}

void SubpixelRefiner::addEquations(const SubpixelView& view, const cv::Mat1s& winners_px) {
  prepare(*view.image, secondary_);
  const bool vertical = std::abs(view.shift.y) > std::abs(view.shift.x);
  const double shift = vertical ? view.shift.y : view.shift.x;
  const cv::Mat1f& reference_gradient = vertical ? reference_.gradient_y : reference_.gradient_x;
  const cv::Mat1f& secondary_gradient = vertical ? secondary_.gradient_y : secondary_.gradient_x;
  const auto gain =
      static_cast<float>(cv::norm(reference_.level) / std::max(cv::norm(secondary_.level), 1e-9));
  const int rows = reference_.level.rows, cols = reference_.level.cols;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < cols; ++x) {
      const int winner_px = winners_px(y, x);
      if (winner_px <= 0) continue;
      const auto along = static_cast<int>(std::lround(shift * winner_px));
      const int sx = vertical ? x : x + along, sy = vertical ? y + along : y;
      if (sx < 0 || sx >= cols || sy < 0 || sy >= rows) continue;
      const auto s = static_cast<float>(shift);
      const float ahead_px = static_cast<float>(along) / s - static_cast<float>(winner_px);
      const float p_reference = s * reference_gradient(y, x),
                  p_secondary = s * gain * secondary_gradient(sy, sx);
      const float p = 0.5F * (p_reference + p_secondary);
      const float e = reference_.level(y, x) - gain * secondary_.level(sy, sx) + p * ahead_px;
      pixel_.pp(y + radius_px_, x + radius_px_) += p_reference * p_secondary;
      pixel_.pe(y + radius_px_, x + radius_px_) += p * e;
      pixel_.ee(y + radius_px_, x + radius_px_) += e * e;
      pixel_.count(y + radius_px_, x + radius_px_) += 1;
    }
  }
}

// out = sum over in at -radius .. radius steps, of pixels whose winner is at most a pixel from the middle
// one's; their equations are moved to the middle one's winner.
void SubpixelRefiner::sumOverSupport(const Sums& in, cv::Point step, Sums& out) const {
  const cv::v_float32x4 largest_step = cv::v_setall_f32(1.5F);
  for (int y = radius_px_; y < winners_px_.rows - radius_px_; ++y) {
    for (int x = radius_px_; x + radius_px_ + kLanes <= winners_px_.cols; x += kLanes) {
      const cv::v_float32x4 middle = cv::v_load(&winners_px_(y, x));
      cv::v_float32x4 pp = cv::v_setzero_f32(), pe = pp, ee = pp, count = pp;
      for (int i = -radius_px_; i <= radius_px_; ++i) {
        const int ny = y + i * step.y, nx = x + i * step.x;
        const cv::v_float32x4 ahead = cv::v_load(&winners_px_(ny, nx)) - middle;
        const cv::v_float32x4 same = cv::v_abs(ahead) < largest_step;
        const cv::v_float32x4 n_pp = cv::v_load(&in.pp(ny, nx)) & same,
                              n_pe = cv::v_load(&in.pe(ny, nx)) & same;
        const cv::v_float32x4 moved = ahead * n_pp;
        pp += n_pp;
        pe += n_pe + moved;
        ee += (cv::v_load(&in.ee(ny, nx)) & same) + ahead * (n_pe + n_pe + moved);
        count += cv::v_load(&in.count(ny, nx)) & same;
      }
      cv::v_store(&out.pp(y, x), pp);
      cv::v_store(&out.pe(y, x), pe);
      cv::v_store(&out.ee(y, x), ee);
      cv::v_store(&out.count(y, x), count);
    }
  }
}

void SubpixelRefiner::solve(cv::Mat1f& disparity_px, cv::Mat1f& sigma_px) const {
  for (int y = 0; y < disparity_px.rows; ++y) {
    for (int x = 0; x < disparity_px.cols; ++x) {
      const cv::Point at(x + radius_px_, y + radius_px_);
      const float winner = winners_px_(at), pp = support_.pp(at), count = support_.count(at);
      disparity_px(y, x) = sigma_px(y, x) = 0;
      if (winner <= 0 || pp <= 0 || count < 2) continue;
      const float ahead = support_.pe(at) / pp;
      const float left_over = std::max(support_.ee(at) - ahead * support_.pe(at), 0.F) / (count - 1);
      const float noise = std::max(left_over, kLeastNoise * kLeastNoise);
      disparity_px(y, x) = winner + ahead;
      sigma_px(y, x) = std::sqrt(kSharedNoise * kSharedNoise * noise / pp + kModelSigma_px * kModelSigma_px);
    }
  }
}

void SubpixelRefiner::refine(const SubpixelInput& input, const SubpixelParams& params,
                             cv::Mat1f& disparity_px, cv::Mat1f& sigma_px) {
  const cv::Size size = input.reference->size();
  radius_px_ = params.support_px / 2;
  const cv::Size padded(size.width + 2 * radius_px_ + kLanes, size.height + 2 * radius_px_);
  for (Sums* sums : {&pixel_, &row_, &support_}) sums->clear(padded);
  winners_px_.create(padded);
  winners_px_.setTo(kNoWinner_px);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if ((*input.winners_px)(y, x) > 0)
        winners_px_(y + radius_px_, x + radius_px_) = (*input.winners_px)(y, x);
  prepare(*input.reference, reference_);
  for (const SubpixelView& view : input.views) addEquations(view, *input.winners_px);
  sumOverSupport(pixel_, {1, 0}, row_);
  sumOverSupport(row_, {0, 1}, support_);
  disparity_px.create(size);
  sigma_px.create(size);
  solve(disparity_px, sigma_px);
}

}  // namespace cornerstone
