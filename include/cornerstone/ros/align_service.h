// The align service: two saved maps in, the pose of the one in the other or a refusal out.
#pragma once

#include "cornerstone/AlignMaps.h"
#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/registration/registration_params.h"

namespace cornerstone {

// Never throws on bad input: what is wrong with a file or the prior is the response's message.
AlignMaps::Response alignFiles(const AlignMaps::Request& request, const LandmarkParams& landmarks,
                               const RegistrationParams& registration);

}  // namespace cornerstone
