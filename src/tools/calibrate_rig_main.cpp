// calibrate_rig REFERENCE RIGHT --board COLSxROWS --square METRES --out FOLDER [--top TOP]: lenses, mounting
// and rectification of two or three cameras from images of one chessboard. Each of REFERENCE, RIGHT and TOP
// is a folder or a pattern; the images of one instant stand at the same place in the order of names. Or from
// a recording: --bag FILE --topics REFERENCE,RIGHT[,TOP] [--tolerance SECONDS].
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <opencv2/imgcodecs.hpp>

#include "cornerstone/base/errors.h"
#include "cornerstone/stereo/trinocular_rig.h"
#include "tools/calibration_bag.h"
#include "tools/calibration_files.h"
#include "tools/program.h"

namespace cornerstone {
namespace {

const char* const kUsage =
    "calibrate_rig REFERENCE RIGHT --board COLSxROWS --square METRES --out FOLDER [--top TOP]\n"
    "       calibrate_rig --bag FILE --topics REFERENCE,RIGHT[,TOP] [--tolerance SECONDS] --board ... --out "
    "...\n"
    "  REFERENCE, RIGHT, TOP: folder of images, or a pattern like 'boards/left*.png'; topics of the bag\n"
    "  COLSxROWS: inner corners of the chessboard";

Chessboard boardOf(const Arguments& arguments) {
  const std::string text = arguments.text("board");
  Chessboard board;
  char between = 0;
  std::istringstream stream(text);
  stream >> board.inner_corners.width >> between >> board.inner_corners.height;
  if (!stream || between != 'x' || stream.peek() != std::istringstream::traits_type::eof())
    throw InputError("--board: '" + text + "' is not COLSxROWS, as in 8x6");
  board.square_m = arguments.number("square", 0);
  requireUsable(board);
  return board;
}

CameraViews viewsAt(const std::string& name, const std::string& where, const Chessboard& board,
                    cv::Size& size) {
  CameraViews views;
  views.name = name;
  for (const std::string& path : imagesAt(where)) {
    const cv::Mat1b image = cv::imread(path, cv::IMREAD_GRAYSCALE);
    if (image.empty()) throw InputError(path + ": cannot be read as an image");
    if (size.empty()) size = image.size();
    if (image.size() != size) throw InputError(path + ": size differs from that of the images before");
    views.corners.push_back(findCorners(image, board));
    if (views.corners.back().empty())
      std::cerr << "calibrate_rig: " << path << ": no whole board, left out\n";
  }
  return views;
}

nlohmann::json writeAll(const RigCalibration& rig, const std::filesystem::path& folder) {
  nlohmann::json result;
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const CameraCalibration& camera = rig.cameras[i];
    std::ofstream file(folder / (camera.name + ".yaml"));
    file << cameraInfoYaml(camera);
    if (!file.flush()) throw InputError((folder / (camera.name + ".yaml")).string() + ": cannot be written");
    result["cameras"][camera.name] = {{"rms_px", rig.rms_px[i]}, {"focal_px", camera.intrinsics_px(0, 0)}};
  }
  for (const PairReport& pair : rig.pairs)
    result["pairs"][pair.name] = {{"sets", pair.sets},
                                  {"rms_px", pair.rms_px},
                                  {"epipolar_rms_px", pair.epipolar_rms_px},
                                  {"baseline_m", pair.baseline_m}};
  const std::filesystem::path picture = folder / "epipolar.png";
  if (!cv::imwrite(picture.string(), epipolarPicture(rig)))
    throw InputError(picture.string() + ": cannot be written");
  std::ofstream(folder / "report.json") << result.dump(2) << "\n";
  return result;
}

std::vector<CameraViews> viewsInFolders(const Arguments& arguments, const Chessboard& board, cv::Size& size) {
  std::vector<CameraViews> views{viewsAt("reference", arguments.positional(0), board, size),
                                 viewsAt("right", arguments.positional(1), board, size)};
  if (arguments.has("top")) views.push_back(viewsAt("top", arguments.text("top"), board, size));
  return views;
}

CalibrationBag bagOf(const Arguments& arguments) {
  CalibrationBag bag;
  bag.path = arguments.text("bag");
  std::istringstream topics(arguments.text("topics"));
  for (std::string topic; std::getline(topics, topic, ',');) bag.topics.push_back(topic);
  if (bag.topics.size() < 2 || bag.topics.size() > 3)
    throw InputError("--topics: '" + arguments.text("topics") + "' is not two or three topics with commas");
  bag.tolerance_s = arguments.number("tolerance", bag.tolerance_s);
  requireWithin(bag.tolerance_s, 0, 1, "--tolerance");
  return bag;
}

Outcome run(int argc, char** argv) {
  const bool is_bag = std::any_of(argv, argv + argc, [](const std::string& word) { return word == "--bag"; });
  const Arguments arguments(
      argc, argv, kUsage, is_bag ? 0 : 2,
      is_bag ? std::vector<std::string>{"board", "square", "out", "bag", "topics", "tolerance"}
             : std::vector<std::string>{"board", "square", "out", "top"});
  for (const char* needed : {"board", "square", "out"})
    if (!arguments.has(needed))
      throw InputError(std::string("--") + needed + " is missing\nusage: " + kUsage);
  const Chessboard board = boardOf(arguments);
  cv::Size size;
  const std::vector<CameraViews> views =
      is_bag ? viewsInBag(bagOf(arguments), board, size) : viewsInFolders(arguments, board, size);
  std::string why;
  const auto rig = calibrateRig(views, size, board, why);
  if (!rig) {
    std::cerr << "calibrate_rig: no answer: " << why << "\n";
    return {kExitNoAnswer, {{"calibrated", false}, {"why", why}}};
  }
  // What cannot be matched is not worth writing.
  makeRig(rig->cameras[0], rig->cameras[1], views.size() > 2 ? std::optional(rig->cameras[2]) : std::nullopt);
  std::filesystem::create_directories(arguments.text("out"));
  nlohmann::json result = writeAll(*rig, arguments.text("out"));
  result["calibrated"] = true;
  return {kExitDone, result};
}

}  // namespace
}  // namespace cornerstone

int main(int argc, char** argv) {
  return cornerstone::runProgram("calibrate_rig", [&] { return cornerstone::run(argc, argv); });
}
