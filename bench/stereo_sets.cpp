#include "stereo_sets.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "bench.h"
#include "cornerstone/base/errors.h"
#include "matchers.h"

namespace cornerstone::bench {
namespace {

constexpr int kBorder_px = 16;         // left out on every side
constexpr double kColumnsShare = 0.8;  // of the image's height: below lies mostly bare table
constexpr int kRepeats = 5;

struct StereoSet {
  StereoImages images;
  cv::Mat1f truth_px;
  cv::Mat1b visible;
  int max_disparity_px = 0;
  double truth_step_px = 0;
};

cv::Mat read(const std::string& folder, const std::string& name, int flags) {
  const std::string path = folder + "/" + name;
  const cv::Mat image = cv::imread(path, flags);
  if (image.empty()) throw InputError(path + ": cannot be read as an image");
  return image;
}

// The smallest difference between two true disparities.
double stepOf(const cv::Mat1f& truth_px) {
  std::vector<float> values(truth_px.begin(), truth_px.end());
  std::sort(values.begin(), values.end());
  double step_px = 1;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] > values[i - 1] && values[i - 1] > 0)
      step_px = std::min<double>(step_px, values[i] - values[i - 1]);
  return step_px;
}

StereoSet loadSet(const std::string& folder) {
  StereoSet set;
  set.images.reference = read(folder, "reference.png", cv::IMREAD_GRAYSCALE);
  set.images.right = read(folder, "right.png", cv::IMREAD_GRAYSCALE);
  if (std::filesystem::exists(folder + "/top.png"))
    set.images.top = read(folder, "top.png", cv::IMREAD_GRAYSCALE);
  read(folder, "disparity.png", cv::IMREAD_UNCHANGED).convertTo(set.truth_px, CV_32F, 1.0 / 256);
  set.visible = read(folder, "visible.png", cv::IMREAD_GRAYSCALE);
  double largest_px = 0;
  cv::minMaxLoc(set.truth_px, nullptr, &largest_px);
  set.max_disparity_px = (static_cast<int>(largest_px) / 16 + 1) * 16;  // as StereoBM counts
  set.truth_step_px = stepOf(set.truth_px);
  return set;
}

TrinocularRig rigOf(const StereoSet& set) {
  TrinocularRig rig;
  rig.image_size_px = set.images.reference.size();
  rig.focal_px = rig.baseline_m = 1;
  if (!set.images.top.empty()) rig.top_shift = cv::Point2d(0, 1);
  return rig;
}

struct Spoiling {
  std::string name;
  double noise_grey = 0, gain = 1;
};

// Right and top as unequal cameras see: brighter or darker by a factor, with noise.
StereoImages spoiled(const StereoImages& images, const Spoiling& how) {
  cv::RNG generator(1);
  const auto spoil = [&](const cv::Mat1b& image) {
    if (image.empty() || (how.noise_grey == 0 && how.gain == 1)) return image;
    cv::Mat1f noise(image.size()), grey;
    generator.fill(noise, cv::RNG::NORMAL, 0, how.noise_grey);
    image.convertTo(grey, CV_32F, how.gain);
    cv::Mat1b out;
    cv::Mat1f(grey + noise).convertTo(out, CV_8U);
    return out;
  };
  return {images.reference, spoil(images.right), spoil(images.top)};
}

struct SetScore {
  double sets = 0, density = 0, bad1 = 0, false_near = 0, missed = 0, within_1_sigma = 0, within_2_sigma = 0;
  double offset_px = 0, within_1_net = 0, within_2_net = 0;  // see SigmaShares
  std::vector<double> ms, ratios;                            // of each set; ratios: to StereoBM
};

struct Deviation {
  double error_px, sigma_px;
};

// Shares of errors within one and two sigma: as they are, and without the truth's own faults: the median
// error of a set taken out, and the deviation of its truth's steps added to sigma.
void judgeSigma(std::vector<Deviation>& deviations, double truth_step_px, SetScore& score) {
  const double count = std::max<double>(1, static_cast<double>(deviations.size()));
  std::vector<double> errors_px;
  for (const Deviation& deviation : deviations) errors_px.push_back(deviation.error_px);
  const double offset_px = median(errors_px), step_sigma_px = truth_step_px / std::sqrt(12.0);
  score.offset_px += std::abs(offset_px);
  for (const auto& [error_px, sigma_px] : deviations) {
    const double net_error_px = std::abs(error_px - offset_px), net_px = std::hypot(sigma_px, step_sigma_px);
    score.within_1_sigma += (std::abs(error_px) < sigma_px) / count;
    score.within_2_sigma += (std::abs(error_px) < 2 * sigma_px) / count;
    score.within_1_net += (net_error_px < net_px) / count;
    score.within_2_net += (net_error_px < 2 * net_px) / count;
  }
}

void judgePixels(const Disparity& answer, const StereoSet& set, SetScore& score) {
  double pixels = 0, answers = 0, bad1 = 0;
  std::vector<Deviation> deviations;
  for (int y = kBorder_px; y < set.truth_px.rows - kBorder_px; ++y)
    for (int x = kBorder_px; x < set.truth_px.cols - kBorder_px; ++x) {
      if (set.visible(y, x) == 0 || !(set.truth_px(y, x) > 0)) continue;
      ++pixels;
      if (!(answer.disparity_px(y, x) > 0)) continue;
      ++answers;
      const float error_px = answer.disparity_px(y, x) - set.truth_px(y, x);
      bad1 += std::abs(error_px) > 1;
      if (!answer.sigma_px.empty()) deviations.push_back({error_px, answer.sigma_px(y, x)});
    }
  score.density += answers / pixels;
  score.bad1 += bad1 / std::max(answers, 1.0);
  if (!deviations.empty()) judgeSigma(deviations, set.truth_step_px, score);
}

void judgeColumns(const Disparity& answer, const StereoSet& set, SetScore& score) {
  const cv::Range rows(kBorder_px, static_cast<int>(set.truth_px.rows * kColumnsShare));
  const cv::Range columns(kBorder_px, set.truth_px.cols - kBorder_px);
  cv::Mat1f nearest_true, nearest;
  cv::reduce(set.truth_px(rows, columns), nearest_true, 0, cv::REDUCE_MAX);
  cv::reduce(answer.disparity_px(rows, columns), nearest, 0, cv::REDUCE_MAX);
  nearest = cv::max(nearest, 0.F);
  score.false_near += cv::countNonZero(nearest > nearest_true + 1) / double(columns.size());
  score.missed += cv::countNonZero(nearest < nearest_true - 1) / double(columns.size());
}

// Scores by matcher's name, in the order of the first set's matchers.
using Scores = std::vector<std::pair<std::string, SetScore>>;

SetScore& scoreOf(Scores& scores, const std::string& name) {
  for (auto& [known, score] : scores)
    if (known == name) return score;
  return scores.emplace_back(name, SetScore{}).second;
}

void measure(const StereoSet& set, const Spoiling& how, Scores& scores) {
  const StereoImages images = spoiled(set.images, how);
  const std::vector<Matcher> matchers = allMatchers(rigOf(set), set.max_disparity_px);
  std::vector<Disparity> answers(matchers.size());
  std::vector<std::vector<double>> times_ms(matchers.size());
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (std::size_t i = 0; i < matchers.size(); ++i)
      times_ms[i].push_back(elapsed_ms([&] { matchers[i].match(images, answers[i]); }));
  const double bm_ms = median(times_ms[matchers.size() - 2]);
  for (std::size_t i = 0; i < matchers.size(); ++i) {
    SetScore& score = scoreOf(scores, matchers[i].name);
    ++score.sets;
    judgePixels(answers[i], set, score);
    judgeColumns(answers[i], set, score);
    score.ms.push_back(median(times_ms[i]));
    score.ratios.push_back(score.ms.back() / bm_ms);
  }
}

void print(const std::string& sets, const Spoiling& how, const Scores& scores) {
  for (const auto& [name, score] : scores) {
    const auto share = [&, sets_count = score.sets](double sum) { return percent(sum / sets_count, 2); };
    const bool has_sigma = score.within_2_sigma > 0;
    const auto sigma = [&](double sum) { return has_sigma ? share(sum) : std::string(); };
    printRow({sets, how.name, name, share(score.density), share(score.bad1), share(score.false_near),
              share(score.missed), sigma(score.within_1_sigma), sigma(score.within_2_sigma),
              has_sigma ? text(score.offset_px / score.sets) : "", sigma(score.within_1_net),
              sigma(score.within_2_net), text(median(score.ms)), text(median(score.ratios))});
  }
}

}  // namespace

void stereoSetsPart(const std::vector<std::string>& folders) {
  std::puts(
      "\n### Image sets with true disparity\n\nMeans over the sets; pixels that every camera sees, 16 px of "
      "border left out. Bad 1 px: of the answers. False near, missed: columns whose largest answer is more "
      "than 1 px nearer, or farther, than the column's nearest true point (bottom fifth of the image left "
      "out). Within 1 and 2 sigma: of the answers. Net: without what is the truth's own fault, its offset "
      "from the "
      "images (median error of a set, given as a mean of its size) and its steps, whose deviation is added "
      "to "
      "sigma. Spoiled: right and top images. Medians of ms and of the "
      "ratio to StereoBM.");
  printHead({"sets", "images", "matcher", "density", "bad 1 px", "false near", "missed", "within 1 sigma",
             "within 2 sigma", "offset px", "net 1 sigma", "net 2 sigma", "ms", "time / StereoBM"});
  std::vector<StereoSet> triples, pairs;
  for (const std::string& folder : folders) {
    const StereoSet set = loadSet(folder);
    (set.images.top.empty() ? pairs : triples).push_back(set);
  }
  for (const auto& [name, sets] : {std::pair{"three cameras", &triples}, std::pair{"two cameras", &pairs}})
    for (const Spoiling& how : {Spoiling{"as they are", 0, 1}, Spoiling{"noise 4, gain 0.85", 4, 0.85}}) {
      Scores scores;
      for (const StereoSet& set : *sets) measure(set, how, scores);
      print(std::to_string(sets->size()) + " of " + name, how, scores);
    }
}

}  // namespace cornerstone::bench
