// Dense stereo on rendered views against the renderer's own depth.
#include <cmath>

#include "bench.h"
#include "matchers.h"
#include "peers.h"
#include "range_bench.h"
#include "tour.h"
#include "views.h"

namespace cornerstone::bench {
namespace {

constexpr int kViews = 12;
constexpr int kRepeats = 5;
constexpr std::size_t kStereoBM = 2;  // of the matchers with three cameras

struct Score {
  std::size_t pixels = 0, answers = 0, off1 = 0, off2 = 0;
  std::vector<double> times_ms;
};

// Of the pixels whose true match lies within the right image and the range searched.
void judge(const cv::Mat1f& disparity_px, const cv::Mat1f& depth_m, const TrinocularRig& rig, Score& score) {
  for (int row = 0; row < depth_m.rows; ++row)
    for (int col = 0; col < depth_m.cols; ++col) {
      if (depth_m(row, col) <= 0) continue;
      const double truth_px = rig.focal_px * rig.baseline_m / depth_m(row, col);
      if (truth_px >= maxDisparityOf(depth_m.cols) || truth_px > col) continue;
      ++score.pixels;
      if (disparity_px(row, col) <= 0) continue;
      ++score.answers;
      const double error_px = std::abs(disparity_px(row, col) - truth_px);
      score.off1 += error_px > 1;
      score.off2 += error_px > 2;
    }
}

std::vector<Matcher> timedMatchers(const TrinocularRig& rig, int max_disparity_px) {
  std::vector<Matcher> matchers = allMatchers(rig, max_disparity_px);
  matchers.push_back(cornerstoneMatcher(rig, max_disparity_px, 3, 2));
  const auto bm = makeStereoBM(max_disparity_px);
  matchers.push_back({"StereoBM 9, checked, not padded", [bm](const StereoImages& images, Disparity& out) {
                        cv::Mat fixed_point;
                        bm->compute(images.reference, images.right, fixed_point);
                        fixed_point.convertTo(out.disparity_px, CV_32F, 1.0 / 16);
                      }});
  return matchers;
}

void compare(const Tour& tour, int width_px) {
  const RigParams rig_params = rigOf(width_px);
  const TrinocularRig rig = mountingOf(rig_params).rig;
  const int max_disparity_px = maxDisparityOf(width_px);
  const std::vector<Matcher> matchers = timedMatchers(rig, max_disparity_px);
  std::vector<Score> scores(matchers.size());
  std::vector<Disparity> answers(matchers.size());
  for (const View& view : renderViews(tour, rig_params))
    for (int repeat = 0; repeat < kRepeats; ++repeat)
      for (std::size_t i = 0; i < matchers.size(); ++i) {
        scores[i].times_ms.push_back(elapsed_ms([&] { matchers[i].match(view.images, answers[i]); }));
        if (repeat == 0) judge(answers[i].disparity_px, view.depth_m, rig, scores[i]);
      }
  const double bm_ms = median(scores[kStereoBM].times_ms);
  for (std::size_t i = 0; i < matchers.size(); ++i) {
    const Score& s = scores[i];
    const double answered = std::max<double>(1, double(s.answers)), ms = median(s.times_ms);
    printRow({std::to_string(rig_params.width_px) + "x" + std::to_string(rig_params.height_px),
              std::to_string(max_disparity_px), matchers[i].name,
              percent(double(s.answers) / double(s.pixels)), percent(double(s.off1) / answered, 2),
              percent(double(s.off2) / answered, 2), text(ms), text(ms / bm_ms)});
  }
}

}  // namespace

void stereoPart() {
  std::puts(
      "\n## Stereo\n\n12 views along robot a's route in `worlds/office.yaml`, 5 repeats in turns, one "
      "thread where nothing else is said. "
      "Cameras spoiled by 2 grey levels of noise, gains that differ by up to 5%, 0.1 px of rectification "
      "error. Truth: the renderer's depth; every pixel counts whose true match lies in the right image, bare "
      "walls and half-hidden pixels included.\n\n"
      "- StereoBM 9, checked: block 9, texture threshold 10, uniqueness 10, left-right check 1 px, speckles "
      "100 px (range 16).\n"
      "- StereoSGBM: block 5, P1 200, P2 800, left-right check 1 px, uniqueness 10, speckles 100 px (range "
      "2).\n"
      "- Both get images padded at the left, or they lose as many columns as disparities are searched: the "
      "last row of each size shows what that costs.");
  printHead({"image", "D px", "matcher", "density", "bad 1 px", "bad 2 px", "ms", "time / StereoBM"});
  const Tour tour = tourOf({"office.yaml", "a", 1}, kViews);
  for (const int width_px : {160, 320, 640}) compare(tour, width_px);
  rangePart();
}

}  // namespace cornerstone::bench
