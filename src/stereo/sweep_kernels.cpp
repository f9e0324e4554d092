#include "cornerstone/stereo/sweep_kernels.h"

#include <opencv2/core/utility.hpp>

#include "sweep_kernels_impl.h"

namespace cornerstone {

#ifdef CORNERSTONE_WITH_AVX2
const SweepKernels& sweepKernelsAvx2();
#endif

const SweepKernels& plainSweepKernels() {
  static const SweepKernels plain{kLanes, pairCosts, slide, windowCosts, pathsAlong, pathDown,
                                  fit,    average,   sigma, judge,       squash,     smooth};
  return plain;
}

const SweepKernels& sweepKernels() {
#ifdef CORNERSTONE_WITH_AVX2
  static const bool has_avx2 = cv::checkHardwareSupport(CV_CPU_AVX2);
  if (has_avx2) return sweepKernelsAvx2();
#endif
  return plainSweepKernels();
}

}  // namespace cornerstone
