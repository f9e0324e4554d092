// stereo_match: disparity of a rectified image pair or triple in files.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "cornerstone/base/errors.h"
#include "cornerstone/stereo/stereo_matcher.h"
#include "tools/program.h"

namespace cornerstone {
namespace {

constexpr int kRepeats = 7;  // timed matches, of which the median is told
constexpr double kFileUnits = 256;

cv::Mat1b readGrey(const std::string& file) {
  cv::Mat1b image = cv::imread(file, cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw InputError(file + ": cannot be read as an image");
  return image;
}

// Beside the file and then renamed, so that nobody ever reads half a picture.
void writeWhole(const std::string& file, const cv::Mat& image) {
  const std::filesystem::path target(file);
  const std::filesystem::path part =
      target.parent_path() / ("." + target.stem().string() + "." + std::to_string(getpid()) + ".part.png");
  bool written = false;
  try {
    written = cv::imwrite(part.string(), image);
  } catch (const cv::Exception&) {
    written = false;
  }
  std::error_code failed;
  if (written) std::filesystem::rename(part, target, failed);
  if (written && !failed) return;
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  throw InputError(file + ": cannot be written");
}

double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

Outcome run(int argc, const char* const* argv) {
  const Arguments arguments(
      argc, argv, "stereo_match REF.png RIGHT.png [--top TOP.png] [--max-disparity N] --out OUT.png", 2,
      {"top", "max-disparity", "out"});
  if (!arguments.has("out")) throw InputError("--out is missing");
  const StereoImages images{readGrey(arguments.positional(0)), readGrey(arguments.positional(1)),
                            arguments.has("top") ? readGrey(arguments.text("top")) : cv::Mat1b()};
  for (const auto& [name, image] :
       {std::pair(arguments.positional(1), images.right), {arguments.text("top"), images.top}})
    if (!image.empty() && image.size() != images.reference.size())
      throw InputError(name + ": size differs from that of " + arguments.positional(0));

  StereoParams params;
  params.max_disparity_px = arguments.wholeNumber("max-disparity", params.max_disparity_px);
  TrinocularRig rig;  // only what matching needs: three cameras with equal baselines
  rig.image_size_px = images.reference.size();
  if (!images.top.empty()) rig.top_shift = cv::Point2d(0, 1);
  StereoMatcher matcher(params);
  Disparity disparity = matcher.match(images, rig);  // the first match also prepares the buffers
  std::vector<double> elapsed_ms;
  for (int i = 0; i < kRepeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    matcher.match(images, rig, disparity);
    elapsed_ms.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  cv::Mat encoded;
  disparity.disparity_px.convertTo(encoded, CV_16U, kFileUnits);
  writeWhole(arguments.text("out"), encoded);
  const double answered =
      static_cast<double>(cv::countNonZero(encoded)) / static_cast<double>(encoded.total());
  return {kExitDone, {{"elapsed_ms", medianOf(elapsed_ms)}, {"density", answered}}};
}

}  // namespace
}  // namespace cornerstone

int main(int argc, char** argv) {
  return cornerstone::runProgram("stereo_match", [&] { return cornerstone::run(argc, argv); });
}
