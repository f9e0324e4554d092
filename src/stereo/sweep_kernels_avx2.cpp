// Compiled with -mavx2 where the compiler has it (CMakeLists.txt); what OpenCV's headers define gets a
// namespace of its own by CV_CPU_DISPATCH_MODE.
#ifdef __AVX2__
#include <immintrin.h>
#define CV_AVX2 1
#define CV_CPU_DISPATCH_MODE AVX2

#include "sweep_kernels_impl.h"

namespace cornerstone {

const SweepKernels& sweepKernelsAvx2();
const SweepKernels& sweepKernelsAvx2() {
  static const SweepKernels kernels{kLanes, pairCosts, slide, windowCosts, pathsAlong, pathDown,
                                    fit,    average,   sigma, judge,       squash,     smooth};
  return kernels;
}

}  // namespace cornerstone
#endif
