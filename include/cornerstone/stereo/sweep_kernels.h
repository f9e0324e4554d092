// The inner loops of the disparity search, compiled once for every processor of the architecture and on
// x86-64 once more for AVX2, which sweepKernels() chooses where the processor has it. Rows of costs lie pixel
// by pixel: cost(x, i) at x * disparities + i, where i is a disparity less one.
#pragma once

#include <cstddef>
#include <cstdint>

namespace cornerstone {

constexpr int kFeatureChannels = 4;
constexpr int kLargestFeature = 31;  // two cameras' differences over all channels fit a byte
// The cost of pixels that have nothing to do with each other, as measured on natural images.
constexpr int kChanceCost = 80;
constexpr int kSearchChance = 60;  // the same in the costs of the search; path costs end at 255

// Where a secondary camera sees the pixels of one reference row: its feature c at disparity i + 1 of column x
// is lines[c][x * step + i]; seen[x] disparities of column x lie within its image. Readable a vector beyond.
struct SeenLines {
  const std::uint8_t* lines[kFeatureChannels] = {};
  std::ptrdiff_t step = 0;
  const short* seen = nullptr;
};

// What no camera sees is given the pixel's cost at disparity 0, that of unrelated pixels as a rule: on a bare
// wall it is nothing, so that the border of what is seen makes no match there.
struct PairCostRow {
  const std::uint8_t* reference[kFeatureChannels] = {};
  SeenLines cameras[2];
  int camera_count = 1;
  const std::uint8_t* unseen = nullptr;  // costs of unseen disparities by column
  int width = 0, disparities = 0;
};

struct WindowRow {
  const std::uint16_t* column_sums = nullptr;  // over the rows of the window
  const int* entering = nullptr;               // column that enters the window at x, and the one that leaves
  const int* leaving = nullptr;
  int window_px = 0, width = 0, disparities = 0;
  unsigned scale = 0;  // costs = sums * scale >> 16
};

// Of each pixel of a row, over all disparities.
struct PathWinners {
  short* disparities_px = nullptr;  // i + 1 of the lowest sum
  std::uint8_t* margins = nullptr;  // second lowest sum, not at a neighbouring disparity, less lowest
  std::uint8_t* leads = nullptr;    // lowest of the pixel's costs, likewise, less the winner's; not below 0
};

// Each pixel's path costs lie between two bytes of 255: cost(x, i) at x * (disparities + 2) + 1 + i.
struct PathRow {
  const std::uint8_t* costs = nullptr;
  const std::uint8_t* jump_ahead = nullptr;  // penalty of a depth step between x - 1 and x
  const std::uint8_t* jump_down = nullptr;   // between the row above and this one
  int width = 0, disparities = 0;
  std::uint8_t slope_penalty = 0;  // of a change by one disparity
  std::uint8_t *from_left = nullptr, *from_right = nullptr, *from_above = nullptr;
  std::uint8_t* lowest_above = nullptr;  // of each pixel's costs from above
  std::uint8_t* sums = nullptr;          // of one pixel, scratch
  PathWinners winners;
};

// Weighted means over a line of values around each of a row, of those within a step of the middle one.
struct AverageRow {
  const float *values = nullptr, *weights = nullptr;  // of the row
  std::ptrdiff_t step = 0;                            // from one value of a line to the next
  int radius = 0, width = 0;                          // the line: 2 radius + 1 values
  float largest_step = 0;
  float *means = nullptr, *weight_sums = nullptr;
};

// Equiangular fits of a row, see SubpixelRefiner.
struct FitRow {
  const short *whole_px = nullptr, *before = nullptr, *cost = nullptr, *after = nullptr;
  const std::uint8_t* rejections = nullptr;
  int width = 0;
  float noise_share = 1, least_cost = 0;  // sigma of a cost: noise_share * (cost + least_cost)
  float none_px = 0;                      // the answer of a rejected pixel, whose weight is 0
  float *fits_px = nullptr, *weights = nullptr;
};

// Standard deviations of means of fits, see SubpixelRefiner. The spread is that of the fits around the plane
// through the means.
struct SigmaRow {
  const float *fits = nullptr, *means = nullptr;  // of the row, and `reach` pixels around
  const float* weights = nullptr;                 // of the means
  std::ptrdiff_t step = 0;                        // from a row to the next
  int reach = 0, width = 0;
  float largest_step = 0;    // fits farther from the plane are those of another surface
  float noise_variance = 0;  // of a mean, times its weight
  float model_variance = 0;  // added to that of the noise and of the spread
  float* sigmas = nullptr;
};

// What the costs of a row of winners say, see Validator: a verdict and a class of evidence for each.
struct WinnerRow {
  const short *disparities_px = nullptr, *costs = nullptr, *before = nullptr, *after = nullptr,
              *chance = nullptr;
  const std::uint8_t *margins = nullptr, *leads = nullptr;
  int width = 0, last_px = 0, smallest_margin = 0, least_cost = 0, no_cost = 0;
  float flat_gain = 0, strong_product = 0;
  std::uint8_t none = 0, outside = 0, texture = 0, uniqueness = 0, range = 0;  // verdicts
  std::uint8_t weak = 0, flat = 0, strong = 0;                                 // evidence
};

// Features of a row: see GradientFeatures. Whole vectors are read and written beyond the end.
struct SquashRow {
  const std::uint8_t *ahead = nullptr, *behind = nullptr;
  float noise_grey = 1;
  int width = 0;
};

struct SweepKernels {
  int lanes;  // disparities are padded to a multiple
  void (*pairCosts)(const PairCostRow& row, std::uint8_t* costs);
  // sums += entering - leaving
  void (*slide)(std::uint16_t* sums, const std::uint8_t* entering, const std::uint8_t* leaving, int count);
  // Window sums, and costs: scaled, less the pixel's lowest.
  void (*windowCosts)(const WindowRow& row, std::uint16_t* sums, std::uint8_t* costs);
  // Path costs from the left and from the right.
  void (*pathsAlong)(const PathRow& row);
  // Takes the path from above on to this row, and chooses the winners by the sum of all paths.
  void (*pathDown)(const PathRow& row);
  void (*fit)(const FitRow& row);
  void (*average)(const AverageRow& row);
  void (*sigma)(const SigmaRow& row);
  void (*judge)(const WinnerRow& row, std::uint8_t* verdicts, std::uint8_t* evidence);
  void (*squash)(const SquashRow& row, std::uint8_t* features);
  // Weights 1 2 1 along and across, over 16; rows[1] is the middle one. Reads one pixel before the row.
  void (*smooth)(const std::uint8_t* const* rows, int width, std::uint8_t* out);
};

const SweepKernels& sweepKernels();       // the fastest that this processor has
const SweepKernels& plainSweepKernels();  // those of every processor of the architecture

}  // namespace cornerstone
