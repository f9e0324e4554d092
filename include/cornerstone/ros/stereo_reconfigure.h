// Stereo parameters that are changed while the nodelet runs (dynamic_reconfigure, cfg/Stereo.cfg).
#pragma once

#include <cornerstone/StereoConfig.h>

#include "cornerstone/stereo/stereo_matcher.h"

namespace cornerstone {

// `params` with the members that `config` names changed. InputError when a name or type is not the struct's;
// the values are for StereoMatcher to judge.
StereoParams changedBy(const StereoConfig& config, const StereoParams& params);

}  // namespace cornerstone
