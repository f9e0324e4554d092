// A textured surface seen by a rectified L of three cameras, with its disparity known at every reference
// pixel.
#pragma once

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone {

// Grey levels over the plane, drawn with 4 samples a pixel and a border for what lies outside the image.
class Texture {
 public:
  Texture(cv::Size size_px, double blur_px, double contrast, cv::RNG& random)
      : samples_((size_px + kBorder * 2) * 4) {
    random.fill(samples_, cv::RNG::NORMAL, 0, 1);
    cv::GaussianBlur(samples_, samples_, {}, 4 * blur_px);
    cv::Scalar mean, deviation;
    cv::meanStdDev(samples_, mean, deviation);
    samples_ = (samples_ - mean[0]) * (contrast / deviation[0]) + 120;
  }
  float at(double x_px, double y_px) const {
    const double column = 4 * (x_px + kBorder.width), row = 4 * (y_px + kBorder.height);
    const int c = static_cast<int>(std::floor(column)), r = static_cast<int>(std::floor(row));
    const auto fc = static_cast<float>(column - c), fr = static_cast<float>(row - r);
    return (1 - fr) * ((1 - fc) * samples_(r, c) + fc * samples_(r, c + 1)) +
           fr * ((1 - fc) * samples_(r + 1, c) + fc * samples_(r + 1, c + 1));
  }

 private:
  inline static const cv::Size kBorder{40, 40};
  cv::Mat1f samples_;
};

struct Surface {  // disparity = at_left_px + slope * x
  double at_left_px = 5;
  double slope = 0;
  double disparityAt(int x) const { return at_left_px + slope * x; }
};

struct CameraFaults {
  double noise = 2;  // grey levels
  double gain = 1;   // of the right camera; the top one has 2 - gain
};

inline cv::Mat1b photographed(const cv::Mat1f& scene, double noise, double gain, cv::RNG& random) {
  cv::Mat1f spoiled(scene.size());
  random.fill(spoiled, cv::RNG::NORMAL, 0, std::max(noise, 1e-9));
  spoiled += scene * gain;
  cv::Mat1b image;
  spoiled.convertTo(image, CV_8U);
  return image;
}

inline StereoImages viewsOf(const Texture& texture, const Surface& surface, const CameraFaults& faults,
                            cv::RNG& random) {
  const cv::Size size(160, 120);
  cv::Mat1f reference(size), right(size), top(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      reference(y, x) = texture.at(x, y);
      // The right pixel u shows the reference pixel x = u + d(x), the top pixel v shows y = v - d(x).
      right(y, x) = texture.at((x + surface.at_left_px) / (1 - surface.slope), y);
      top(y, x) = texture.at(x, y - surface.disparityAt(x));
    }
  }
  return {photographed(reference, faults.noise, 1, random),
          photographed(right, faults.noise, faults.gain, random),
          photographed(top, faults.noise, 2 - faults.gain, random)};
}

inline TrinocularRig rigOf(const StereoImages& images) {
  TrinocularRig rig;
  rig.image_size_px = images.reference.size();
  rig.focal_px = 80;
  rig.baseline_m = 0.12;
  if (!images.top.empty()) rig.top_shift = cv::Point2d(0, 1);
  return rig;
}

inline Disparity matched(const StereoImages& images, const StereoParams& params = {}) {
  StereoMatcher matcher(params);
  return matcher.match(images, rigOf(images));
}

}  // namespace cornerstone
