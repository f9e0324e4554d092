// The pose of one saved map in another, or a refusal with its reason.
#include <cmath>
#include <functional>
#include <future>
#include <utility>

#include "cornerstone/mapping/map_files.h"
#include "cornerstone/registration/register_maps.h"
#include "tools/drawing.h"
#include "tools/program.h"
#include "tools/stopwatch.h"

namespace {

using namespace cornerstone;

std::optional<Pose2> priorOf(const Arguments& arguments) {
  if (!arguments.has("prior")) return std::nullopt;
  const std::vector<double> numbers = numbersOf(arguments.text("prior"), 3, "--prior X,Y,YAW_DEG");
  return Pose2{numbers[0], numbers[1], wrapAngle(numbers[2] * M_PI / 180)};
}

std::optional<Eigen::Vector2d> focusOf(const Arguments& arguments) {
  if (!arguments.has("focus")) return std::nullopt;
  const std::vector<double> numbers = numbersOf(arguments.text("focus"), 2, "--focus X,Y");
  return Eigen::Vector2d(numbers[0], numbers[1]);
}

void addAnswer(const Registration& answer, nlohmann::json& result) {
  nlohmann::json covariance = nlohmann::json::array();
  for (int i = 0; i < 9; ++i) covariance.push_back(answer.covariance(i / 3, i % 3));
  result.update({{"x_m", answer.reference_from_current.x_m},
                 {"y_m", answer.reference_from_current.y_m},
                 {"yaw_rad", answer.reference_from_current.yaw_rad},
                 {"covariance", covariance},
                 {"matched", answer.matches.size()},
                 {"rms_m", answer.rms_m},
                 {"probability", answer.probability},
                 {"agreement", answer.agreement},
                 {"overlap", answer.overlap},
                 {"second_best", answer.second_best}});
}

struct MapLook {
  Landmarks landmarks;
  MapEvidence evidence;
};

MapLook lookAt(const GridMap& map) {
  Landmarks landmarks = detectLandmarks(map, {});
  MapEvidence evidence = gatherEvidence({map, landmarks}, {});
  return {std::move(landmarks), std::move(evidence)};
}

Outcome align(int argc, const char* const* argv) {
  const Arguments arguments(
      argc, argv, "align_maps REF.yaml CUR.yaml [--prior X,Y,YAW_DEG] [--focus X,Y] [--overlay OUT.png]", 2,
      {"prior", "focus", "overlay"});
  const RegistrationHints hints{priorOf(arguments), focusOf(arguments)};
  const GridMap reference = loadMap(arguments.positional(0)), current = loadMap(arguments.positional(1));
  Stopwatch watch;
  auto other = std::async(std::launch::async, lookAt, std::cref(current));  // both maps at once
  const MapLook there = lookAt(reference), here = other.get();
  const double detect_ms = watch.lap_ms();
  const auto [answer, refusal] = registerMaps(PreparedMap{there.landmarks, there.evidence},
                                              PreparedMap{here.landmarks, here.evidence}, hints, {});
  const double register_ms = watch.lap_ms();

  nlohmann::json result{
      {"registered", answer.has_value()},
      {"elapsed_ms", {{"detect", detect_ms}, {"register", register_ms}, {"total", detect_ms + register_ms}}}};
  if (answer)
    addAnswer(*answer, result);
  else
    result["reason"] = refusal;
  if (arguments.has("overlay")) {
    const Overlay overlay{reference, there.landmarks, current, here.landmarks,
                          answer ? answer->matches : std::vector<std::pair<int, int>>{}};
    writePicture(
        pictureOfOverlay(overlay, answer ? answer->reference_from_current : hints.prior.value_or(Pose2{})),
        arguments.text("overlay"));
  }
  return {answer ? kExitDone : kExitNoAnswer, result};
}

}  // namespace

int main(int argc, char** argv) {
  return cornerstone::runProgram("align_maps", [&] { return align(argc, argv); });
}
