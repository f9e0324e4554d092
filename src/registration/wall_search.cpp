#include "cornerstone/registration/wall_search.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace cornerstone {
namespace {

struct Bounds {
  Eigen::Vector2f low{0, 0};
  Eigen::Vector2f high{0, 0};
};

// A map turned by a yaw, and where each of its parts falls on the transform's grid.
struct Turned {
  const std::vector<EdgeSample>& samples;
  const std::vector<Opinion>& opinions;
  double opinion_cell_m;
  Eigen::Matrix2f rotation;

  Turned by(double yaw) const {
    return {samples, opinions, opinion_cell_m, Pose2{0, 0, yaw}.rotation().cast<float>()};
  }
  Bounds bounds() const {
    Bounds bounds;
    bool first = true;
    for (const Opinion& opinion : opinions) {
      const Eigen::Vector2f p = rotation * opinion.centre_m;
      bounds.low = first ? p : Eigen::Vector2f(bounds.low.cwiseMin(p));
      bounds.high = first ? p : Eigen::Vector2f(bounds.high.cwiseMax(p));
      first = false;
    }
    return bounds;
  }
};

struct Spectra {
  cv::Mat edges;  // how many edges a square holds
  cv::Mat says;   // what the map says to an edge there
};

Spectra transform(const Turned& map, const Eigen::Vector2f& low, float square_m, int size) {
  cv::Mat1f edges(size, size, 0.0f), says(size, size, 0.0f);
  const auto at = [&](cv::Mat1f& grid, const Eigen::Vector2f& p) -> float& {
    const Eigen::Vector2f cell = (map.rotation * p - low) / square_m;
    return grid(std::clamp(static_cast<int>(cell.y() + 0.5f), 0, size - 1),
                std::clamp(static_cast<int>(cell.x() + 0.5f), 0, size - 1));
  };
  for (const EdgeSample& sample : map.samples) at(edges, sample.position_m) += 1;
  const auto share = static_cast<float>(std::pow(map.opinion_cell_m / square_m, 2) / kFullEvidence);
  for (const Opinion& opinion : map.opinions)
    at(says, opinion.centre_m) += share * static_cast<float>(opinion.evidence);
  Spectra spectra;
  cv::dft(edges, spectra.edges);
  cv::dft(says, spectra.says);
  return spectra;
}

// The highest squares of a correlation, none beside a higher one.
std::vector<cv::Point> highest(const cv::Mat1f& scores, std::size_t count) {
  std::vector<std::pair<float, cv::Point>> peaks;
  const int size = scores.rows;
  for (int r = 0; r < size; ++r) {
    const float* row = scores[r];
    const float* above = scores[(r + 1) % size];
    const float* below = scores[(r + size - 1) % size];
    for (int c = 0; c < size; ++c) {
      const float s = row[c];
      const int left = (c + size - 1) % size, right = (c + 1) % size;
      if (s <= 0 || s < row[left] || s <= row[right] || s < below[c] || s <= above[c]) continue;
      peaks.emplace_back(s, cv::Point(c, r));
    }
  }
  count = std::min(count, peaks.size());
  const auto higher = [](const auto& a, const auto& b) {
    return std::make_tuple(-a.first, a.second.y, a.second.x) <
           std::make_tuple(-b.first, b.second.y, b.second.x);
  };
  std::partial_sort(peaks.begin(), peaks.begin() + static_cast<std::ptrdiff_t>(count), peaks.end(), higher);
  std::vector<cv::Point> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(peaks[i].second);
  return points;
}

}  // namespace

std::vector<Pose2> proposeFromWalls(const MapEvidence& reference, const MapEvidence& current,
                                    const std::vector<double>& yaws, const WallSearchOptions& options) {
  const std::vector<Opinion> reference_says = reference.coarse.opinions(),
                             current_says = current.coarse.opinions();
  const Turned there = Turned{reference.samples, reference_says, reference.coarse.cellSize(), {}}.by(0);
  const Turned unturned = Turned{current.samples, current_says, current.coarse.cellSize(), {}}.by(0);
  const Bounds there_bounds = there.bounds();
  const float there_size_m = (there_bounds.high - there_bounds.low).maxCoeff();
  // Turned by any yaw the current map is no larger than its diagonal.
  const Bounds here_bounds = unturned.bounds();
  const float needed_m = there_size_m + (here_bounds.high - here_bounds.low).norm();
  const float square_m = std::max(static_cast<float>(options.square_m),
                                  needed_m / static_cast<float>(options.max_size_squares - 4));
  const int size = cv::getOptimalDFTSize(static_cast<int>(std::ceil(needed_m / square_m)) + 4);
  const Spectra fixed = transform(there, there_bounds.low, square_m, size);
  std::vector<Pose2> poses;
  for (const double yaw : yaws) {
    const Turned here = unturned.by(yaw);
    const Eigen::Vector2f low = here.bounds().low;
    const Spectra moving = transform(here, low, square_m, size);
    cv::Mat one, other;
    cv::mulSpectrums(fixed.says, moving.edges, one, 0, true);
    cv::mulSpectrums(fixed.edges, moving.says, other, 0, true);
    cv::Mat1f scores;
    cv::idft(one + other, scores, cv::DFT_REAL_OUTPUT);
    for (const cv::Point& peak : highest(scores, options.peaks)) {
      // Shifts beyond the reference map's size are negative ones, wrapped round.
      const auto unwrapped = [&](int shift) {
        const auto squares = static_cast<float>(shift);
        return squares * square_m > there_size_m + 2 * square_m ? squares - static_cast<float>(size)
                                                                : squares;
      };
      const Eigen::Vector2f squares(unwrapped(peak.x), unwrapped(peak.y));
      const Eigen::Vector2f shift = squares * square_m + there_bounds.low - low;
      poses.push_back({shift.x(), shift.y(), yaw});
    }
  }
  return poses;
}

}  // namespace cornerstone
