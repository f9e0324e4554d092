#include <filesystem>

#include "cornerstone/base/errors.h"
#include "tools/drawing.h"
#include "tools/program.h"
#include "tools/run_metrics.h"
#include "tools/run_pictures.h"

namespace {

using namespace cornerstone;

// Each robot's map and landmarks, and the maps of the registered pair laid over each other.
std::vector<std::string> drawMaps(const RunRecording& run, const std::string& folder) {
  std::vector<std::string> written;
  const auto write = [&](const cv::Mat3b& picture, const std::string& name) {
    if (picture.empty()) return;
    writePicture(picture, folder + "/" + name);
    written.push_back(name);
  };
  std::map<std::string, Landmarks> landmarks;
  const LandmarkParams params;
  for (const auto& [name, robot] : run.robots) {
    if (robot.map.occupied.empty()) continue;
    landmarks[name] = detectLandmarks(robot.map, params);
    write(pictureOfLandmarks(robot.map, landmarks[name], params.arm_length_m), "landmarks_" + name + ".png");
    write(pictureOfMapAndTruth(run, name), "map_" + name + ".png");
  }
  if (run.registrations.empty()) return written;
  const MapRegistration& last = run.registrations.back();
  if (landmarks.count(last.reference_robot) == 0 || landmarks.count(last.current_robot) == 0) return written;
  const Overlay overlay{run.robots.at(last.reference_robot).map,
                        landmarks[last.reference_robot],
                        run.robots.at(last.current_robot).map,
                        landmarks[last.current_robot],
                        {}};
  write(pictureOfOverlay(overlay, Pose2{}), "overlay_before.png");
  if (last.state == MapRegistration::REGISTERED)
    write(pictureOfOverlay(overlay, {last.x, last.y, last.yaw}), "overlay_after.png");
  return written;
}

Outcome drawRun(const Arguments& arguments) {
  const std::string folder = arguments.text("out");
  if (folder.empty()) throw InputError("--out FOLDER is missing");
  std::filesystem::create_directories(folder);
  const RunRecording run = readRun(arguments.positional(0));
  std::vector<std::string> written = drawMaps(run, folder);
  const std::string robot = arguments.text("robot", run.robots.begin()->first);
  if (run.robots.count(robot) == 0 || run.robots.at(robot).truth.empty())
    throw InputError(run.path + ": no robot '" + robot + "'");
  const double start_s = run.robots.at(robot).truth.front().time_s;
  writePicture(pictureOfOneFrame(run.path, robot, start_s + arguments.number("at", 5)),
               folder + "/figure_2.png");
  written.push_back("figure_2.png");
  return {kExitDone, {{"folder", folder}, {"pictures", written}}};
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("draw_run", [&] {
    return drawRun(Arguments(argc, argv, "draw_run BAG_OR_RESULTS --out FOLDER [--robot NAME] [--at SECONDS]",
                             1, {"out", "robot", "at"}));
  });
}
