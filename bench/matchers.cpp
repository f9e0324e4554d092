#include "matchers.h"

#include <memory>

#include "peers.h"

namespace cornerstone::bench {

Matcher cornerstoneMatcher(const TrinocularRig& rig, int max_disparity_px, int cameras, int threads) {
  StereoParams params;
  params.max_disparity_px = max_disparity_px;
  params.threads = threads;
  const std::string in_threads = threads == 1 ? "" : ", " + std::to_string(threads) + " threads";
  const auto matcher = std::make_shared<StereoMatcher>(params);
  if (cameras == 3)
    return {"cornerstone, three cameras" + in_threads,
            [=](const StereoImages& images, Disparity& out) { matcher->match(images, rig, out); }};
  TrinocularRig pair = rig;
  pair.top_shift.reset();
  return {"cornerstone, two cameras" + in_threads, [=](const StereoImages& images, Disparity& out) {
            matcher->match({images.reference, images.right, {}}, pair, out);
          }};
}

Matcher bmMatcher(int max_disparity_px) {
  return {"StereoBM 9, checked",
          [bm = makeStereoBM(max_disparity_px)](const StereoImages& images, Disparity& out) {
            out.disparity_px = matchOpenCV(*bm, images.reference, images.right);
          }};
}

Matcher sgbmMatcher(int max_disparity_px) {
  return {"StereoSGBM",
          [sgbm = makeStereoSGBM(max_disparity_px)](const StereoImages& images, Disparity& out) {
            out.disparity_px = matchOpenCV(*sgbm, images.reference, images.right);
          }};
}

std::vector<Matcher> allMatchers(const TrinocularRig& rig, int max_disparity_px) {
  std::vector<Matcher> matchers;
  if (rig.top_shift) matchers.push_back(cornerstoneMatcher(rig, max_disparity_px, 3));
  matchers.push_back(cornerstoneMatcher(rig, max_disparity_px, 2));
  matchers.push_back(bmMatcher(max_disparity_px));
  matchers.push_back(sgbmMatcher(max_disparity_px));
  return matchers;
}

}  // namespace cornerstone::bench
