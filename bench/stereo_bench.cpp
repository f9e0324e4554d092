// Dense stereo on rendered views against the renderer's own depth.
#include <cmath>

#include "bench.h"
#include "peers.h"
#include "range_bench.h"
#include "tour.h"
#include "views.h"

namespace cornerstone::bench {
namespace {

constexpr int kViews = 12;
constexpr int kRepeats = 5;
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

void compare(const World& world, const std::vector<Pose2>& poses, int width_px) {
  const RigParams rig_params = rigOf(width_px);
  const TrinocularRig rig = mountingOf(rig_params).rig;
  StereoParams params;
  params.max_disparity_px = maxDisparityOf(width_px);
  StereoMatcher three(params), two(params);
  TrinocularRig pair = rig;
  pair.top_shift.reset();
  auto bm = makeStereoBM(params.max_disparity_px), sgbm = makeStereoSGBM(params.max_disparity_px);
  using Match = std::function<cv::Mat1f(const StereoImages&)>;
  const std::vector<std::pair<std::string, Match>> matchers{
      {"cornerstone, three cameras", [&](const StereoImages& i) { return three.match(i, rig).disparity_px; }},
      {"cornerstone, two cameras",
       [&](const StereoImages& i) {
         return two.match({i.reference, i.right, {}}, pair).disparity_px;
       }},
      {"StereoBM 9, checked", [&](const StereoImages& i) { return matchOpenCV(*bm, i.reference, i.right); }},
      {"StereoSGBM", [&](const StereoImages& i) { return matchOpenCV(*sgbm, i.reference, i.right); }}};
  std::vector<Score> scores(matchers.size());
  for (const View& view : renderViews(world, poses, rig_params))
    for (int repeat = 0; repeat < kRepeats; ++repeat)
      for (std::size_t i = 0; i < matchers.size(); ++i) {
        cv::Mat1f answer;
        scores[i].times_ms.push_back(elapsed_ms([&] { answer = matchers[i].second(view.images); }));
        if (repeat == 0) judge(answer, view.depth_m, rig, scores[i]);
      }
  const double bm_ms = median(scores[2].times_ms);
  for (std::size_t i = 0; i < matchers.size(); ++i) {
    const Score& s = scores[i];
    const double answers = std::max<double>(1, double(s.answers)), ms = median(s.times_ms);
    printRow({std::to_string(rig_params.width_px) + "x" + std::to_string(rig_params.height_px),
              matchers[i].first, percent(double(s.answers) / double(s.pixels)),
              percent(double(s.off1) / answers, 2), percent(double(s.off2) / answers, 2), text(ms),
              text(ms / bm_ms)});
  }
}

}  // namespace

void stereoPart() {
  std::puts(
      "\n## Stereo\n\n12 views along robot a's route in `worlds/office.yaml`, disparities searched up to a "
      "fifth of "
      "the image's width (0.3 m), 5 repeats in turns. Cameras spoiled by 2 grey levels of noise, gains that "
      "differ "
      "by up to 5%, 0.1 px of rectification error. Truth: the renderer's depth; every pixel counts whose "
      "true match "
      "lies in the right image, bare walls and half-hidden pixels included.\n\n"
      "- StereoBM 9, checked: block 9, texture threshold 10, uniqueness 10, left-right check 1 px, speckles "
      "100 px "
      "(range 16).\n"
      "- StereoSGBM: block 5, P1 200, P2 800, left-right check 1 px, uniqueness 10, speckles 100 px (range "
      "2).\n"
      "- Both get images padded at the left, or they lose as many columns as disparities are searched.");
  printHead({"image", "matcher", "density", "bad 1 px", "bad 2 px", "ms", "time / StereoBM"});
  const World world = shippedWorld("office.yaml");
  const std::vector<Pose2> poses = posesOf(world, kViews);
  for (const int width_px : {160, 320, 640}) compare(world, poses, width_px);
  rangePart(world);
}

}  // namespace cornerstone::bench
