#include "cornerstone/ros/align_service.h"

#include "cornerstone/base/errors.h"
#include "cornerstone/mapping/map_files.h"
#include "cornerstone/registration/register_maps.h"
#include "cornerstone/ros/transforms.h"

namespace cornerstone {
namespace {

RegistrationHints hintsOf(const AlignMaps::Request& request) {
  RegistrationHints hints;
  if (!request.has_prior) return hints;
  hints.prior = Pose2{request.x, request.y, wrapAngle(request.yaw)};
  if (!hints.prior->isFinite()) throw InputError("align: x, y or yaw of the prior is not finite");
  return hints;
}

void fill(const Registration& answer, AlignMaps::Response& response) {
  response.registered = true;
  response.x = answer.reference_from_current.x_m;
  response.y = answer.reference_from_current.y_m;
  response.yaw = answer.reference_from_current.yaw_rad;
  response.covariance = toRowMajor(answer.covariance);
  response.matched = static_cast<unsigned>(answer.matches.size());
  response.rms = answer.rms_m;
  response.overlap = answer.overlap;
  response.second_best = answer.second_best;
}

}  // namespace

AlignMaps::Response alignFiles(const AlignMaps::Request& request, const LandmarkParams& landmarks,
                               const RegistrationParams& registration) {
  AlignMaps::Response response;
  try {
    const RegistrationHints hints = hintsOf(request);
    const GridMap reference = loadMap(request.reference), current = loadMap(request.current);
    const Landmarks there = detectLandmarks(reference, landmarks), here = detectLandmarks(current, landmarks);
    const RegistrationOutcome outcome =
        registerMaps(MapView{reference, there}, MapView{current, here}, hints, registration);
    response.message = outcome.refusal;
    if (outcome.registration) fill(*outcome.registration, response);
  } catch (const InputError& error) {
    response.message = error.what();
  }
  return response;
}

}  // namespace cornerstone
