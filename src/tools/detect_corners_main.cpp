// Corners of a saved map, as JSON and, on request, as a picture.
#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/mapping/map_files.h"
#include "tools/drawing.h"
#include "tools/program.h"
#include "tools/stopwatch.h"

namespace {

using namespace cornerstone;

nlohmann::json toJson(const CornerLandmark& corner) {
  nlohmann::json covariance = nlohmann::json::array();
  for (int i = 0; i < 9; ++i) covariance.push_back(corner.covariance(i / 3, i % 3));
  return {{"x_m", corner.pose.x_m},
          {"y_m", corner.pose.y_m},
          {"yaw_rad", corner.pose.yaw_rad},
          {"covariance", covariance},
          {"rms_m", corner.rms_m},
          {"kind", corner.kind == CornerKind::kInsideFree ? "inside_free" : "inside_solid"}};
}

Outcome detect(int argc, const char* const* argv) {
  const Arguments arguments(argc, argv, "detect_corners MAP.yaml [--overlay OUT.png]", 1, {"overlay"});
  const GridMap map = loadMap(arguments.positional(0));
  const LandmarkParams params;
  Stopwatch watch;
  const Landmarks landmarks = detectLandmarks(map, params);
  const double elapsed_ms = watch.lap_ms();
  if (arguments.has("overlay"))
    writePicture(pictureOfLandmarks(map, landmarks, params.arm_length_m), arguments.text("overlay"));
  nlohmann::json corners = nlohmann::json::array();
  for (const CornerLandmark& corner : landmarks.corners) corners.push_back(toJson(corner));
  return {landmarks.corners.empty() ? kExitNoAnswer : kExitDone,
          {{"corners", corners}, {"elapsed_ms", elapsed_ms}}};
}

}  // namespace

int main(int argc, char** argv) {
  return cornerstone::runProgram("detect_corners", [&] { return detect(argc, argv); });
}
