// What a robot drives by: the range of the nearest obstacle in every image column, against the renderer's
// depth.
#include "range_bench.h"

#include <array>
#include <cmath>

#include "bench.h"
#include "peers.h"
#include "tour.h"
#include "views.h"

namespace cornerstone::bench {
namespace {

constexpr int kViews = 48;
constexpr std::array<double, 4> kEnds_m{1, 2, 4, 8};
// An answer this much nearer than the truth is a phantom, and this much farther misses the obstacle. The
// truth may lie this share of the image's width beside the column (about a degree): edges are where they are
// to a pixel or two.
constexpr double kShare = 0.2, kLeast_m = 0.2;
constexpr int kWidthShare = 80;
constexpr double kMissedWithin_m = 4;  // obstacles that matter
constexpr double kNothing_m = 100;

struct Columns {
  std::size_t all = 0, phantom = 0, near = 0, missed = 0, silent = 0;
  std::array<std::vector<double>, kEnds_m.size()> errors_m;
};

struct Truth {
  double range_m = 0;                    // of the column; 0: nothing there
  double nearest_m = 0, farthest_m = 0;  // in the columns around
};

std::vector<Truth> truthOf(const std::vector<double>& ranges_m) {
  const int count = static_cast<int>(ranges_m.size()), reach = count / kWidthShare;
  std::vector<Truth> truth;
  for (int c = 0; c < count; ++c) {
    Truth here{ranges_m[static_cast<std::size_t>(c)], kNothing_m, 0};
    for (int i = std::max(c - reach, 0); i <= std::min(c + reach, count - 1); ++i) {
      const double range_m = ranges_m[static_cast<std::size_t>(i)];
      here.nearest_m = std::min(here.nearest_m, range_m > 0 ? range_m : kNothing_m);
      here.farthest_m = std::max(here.farthest_m, range_m > 0 ? range_m : kNothing_m);
    }
    truth.push_back(here);
  }
  return truth;
}

void count(double range_m, const Truth& truth, Columns& columns) {
  ++columns.all;
  const bool answered = range_m > 0;
  const auto tolerance_m = [](double at_m) { return std::max(kLeast_m, kShare * at_m); };
  columns.phantom +=
      answered && range_m < kEnds_m.back() && range_m < truth.nearest_m - tolerance_m(truth.nearest_m);
  if (truth.range_m == 0) return;
  const bool matters = truth.range_m < kMissedWithin_m;
  columns.near += matters;
  columns.silent += matters && !answered;
  columns.missed += matters && answered && range_m > truth.farthest_m + tolerance_m(truth.farthest_m);
  for (std::size_t i = 0; answered && i < kEnds_m.size(); ++i)
    if (truth.range_m < kEnds_m[i]) {
      columns.errors_m[i].push_back(std::abs(range_m - truth.range_m));
      break;
    }
}

std::vector<double> scanRanges(const Disparity& disparity, const Eigen::Isometry3d& base_from_camera) {
  const RangeScan scan = scanFromDisparity(disparity, base_from_camera, {});
  std::vector<double> ranges_m;  // beams rise in bearing, which is from the right
  for (auto beam = scan.beams.rbegin(); beam != scan.beams.rend(); ++beam)
    ranges_m.push_back(beam->hit ? beam->range_m : 0);
  return ranges_m;
}

struct Method {
  std::string name;
  std::function<std::vector<double>(const StereoImages&)> ranges;
};

std::vector<Method> methodsFor(int width_px, const StereoMounting& mounting) {
  StereoParams params;
  params.max_disparity_px = maxDisparityOf(width_px);
  TrinocularRig pair = mounting.rig;
  pair.top_shift.reset();
  const auto three = std::make_shared<StereoMatcher>(params), two = std::make_shared<StereoMatcher>(params);
  const CameraView view{mounting.rig, mounting.base_from_camera};
  const auto at = mounting.base_from_camera;
  const auto bm = makeStereoBM(params.max_disparity_px), sgbm = makeStereoSGBM(params.max_disparity_px);
  const auto nearest = [view](const cv::Ptr<cv::StereoMatcher>& matcher) {
    return [view, matcher](const StereoImages& i) {
      return nearestRanges(matchOpenCV(*matcher, i.reference, i.right), view);
    };
  };
  return {{"cornerstone, three cameras",
           [=](const StereoImages& i) { return scanRanges(three->match(i, mounting.rig), at); }},
          {"cornerstone, two cameras",
           [=](const StereoImages& i) {
             return scanRanges(two->match({i.reference, i.right, {}}, pair), at);
           }},
          {"StereoBM 9, nearest pixel", nearest(bm)},
          {"StereoSGBM, nearest pixel", nearest(sgbm)}};
}

std::string perThousand(std::size_t part, std::size_t all) {
  return text(1000.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(all, 1)), 1);
}

void compare(const World& world, const std::vector<Pose2>& poses, int width_px) {
  const RigParams rig = rigOf(width_px);
  const StereoMounting mounting = mountingOf(rig);
  const std::vector<Method> methods = methodsFor(width_px, mounting);
  std::vector<Columns> columns(methods.size());
  for (const View& view : renderViews(world, poses, rig)) {
    cv::Mat1f disparity_px;
    cv::divide(mounting.rig.focal_px * mounting.rig.baseline_m, view.depth_m, disparity_px);
    disparity_px.setTo(0, view.depth_m <= 0);
    const std::vector<Truth> truth =
        truthOf(nearestRanges(disparity_px, {mounting.rig, mounting.base_from_camera}));
    for (std::size_t m = 0; m < methods.size(); ++m) {
      const std::vector<double> ranges_m = methods[m].ranges(view.images);
      for (std::size_t c = 0; c < truth.size(); ++c) count(ranges_m[c], truth[c], columns[m]);
    }
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const Columns& of = columns[m];
    std::vector<std::string> cells{std::to_string(rig.width_px) + "x" + std::to_string(rig.height_px),
                                   methods[m].name, perThousand(of.phantom, of.all),
                                   perThousand(of.missed, of.near), perThousand(of.silent, of.near)};
    for (const auto& errors_m : of.errors_m) cells.push_back(text(1000 * median(errors_m), 0));
    printRow(cells);
  }
}

}  // namespace

void rangePart(const World& world) {
  std::printf(
      "\n### Ranges\n\nThe nearest obstacle between %.2f and %.2f m height in every image column of %d views "
      "on the "
      "same route, cameras spoiled likewise. Phantom: nearer than all that is true within a degree by more "
      "than 20%% and 0.2 m, of "
      "1,000 "
      "columns. Missed: an obstacle within 4 m taken for something farther by as much; silent: no answer; of "
      "1,000 "
      "columns "
      "with one. Error: median of |range - truth| in mm, by the true distance. cornerstone: its scan; the "
      "peers: "
      "the nearest pixel of the column, the rule of depthimage_to_laserscan.\n",
      ScanParams().levels.front().z_min_m, ScanParams().levels.front().z_max_m, kViews);
  printHead({"image", "method", "phantom", "missed", "silent", "0-1 m", "1-2 m", "2-4 m", "4-8 m"});
  const std::vector<Pose2> poses = posesOf(world, kViews);
  for (const int width_px : {160, 320, 640}) compare(world, poses, width_px);
}

}  // namespace cornerstone::bench
