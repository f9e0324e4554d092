#include "cornerstone/registration/wall_search.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/core/utility.hpp>
#include <tuple>
#include <utility>
#include <vector>

namespace cornerstone {
namespace {

constexpr double kSameYaw_rad = 2 * M_PI / 180;  // half a square at 6 m: the climb makes it good

struct Bounds {
  Eigen::Vector2f low{0, 0};
  Eigen::Vector2f high{0, 0};
};

// A map turned by a yaw, and where each of its parts falls on the transform's grid.
struct Turned {
  const EdgeSamples& samples;
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

// The grid of the transform.
struct Raster {
  float square_m;
  cv::Size size;
  float contradiction;  // weight of what says that no edge is there
};

Spectra transform(const Turned& map, const Eigen::Vector2f& low, const Raster& raster) {
  const auto& [square_m, size, contradiction] = raster;
  cv::Mat1f edges(size, 0.0f), says(size, 0.0f);
  int used_rows = 0;
  const auto at = [&](cv::Mat1f& grid, const Eigen::Vector2f& p) -> float& {
    const Eigen::Vector2f cell = (map.rotation * p - low) / raster.square_m;
    const int row = std::clamp(static_cast<int>(cell.y() + 0.5f), 0, grid.rows - 1);
    used_rows = std::max(used_rows, row + 1);
    return grid(row, std::clamp(static_cast<int>(cell.x() + 0.5f), 0, grid.cols - 1));
  };
  for (std::size_t i = 0; i < map.samples.size(); ++i) at(edges, map.samples.position_m(i)) += 1;
  const auto share = static_cast<float>(std::pow(map.opinion_cell_m / square_m, 2) / kFullEvidence);
  for (const Opinion& opinion : map.opinions)
    at(says, opinion.centre_m) +=
        share * (opinion.evidence < 0 ? contradiction * static_cast<float>(opinion.evidence)
                                      : static_cast<float>(opinion.evidence));
  Spectra spectra;
  cv::dft(edges, spectra.edges, 0, used_rows);
  cv::dft(says, spectra.says, 0, used_rows);
  return spectra;
}

using Peak = std::pair<float, cv::Point>;
bool isHigher(const Peak& a, const Peak& b) {
  return std::make_tuple(-a.first, a.second.y, a.second.x) <
         std::make_tuple(-b.first, b.second.y, b.second.x);
}

// The highest of all peaks that come along, row by row.
class HighestPeaks {
 public:
  explicit HighestPeaks(std::size_t count) : count_(count) { peaks_.reserve(4 * count); }

  // What is no higher cannot be among them.
  float floor() const { return floor_; }
  void add(const Peak& peak) {
    peaks_.push_back(peak);
    if (peaks_.size() < 4 * count_) return;
    cut();
    floor_ = peaks_.back().first;  // of like ones the first to come is kept
  }
  std::vector<cv::Point> best() {
    cut();
    std::vector<cv::Point> points;
    for (const Peak& peak : peaks_) points.push_back(peak.second);
    return points;
  }

 private:
  void cut() {
    const std::size_t count = std::min(count_, peaks_.size());
    std::partial_sort(peaks_.begin(), peaks_.begin() + static_cast<std::ptrdiff_t>(count), peaks_.end(),
                      isHigher);
    peaks_.resize(count);
  }

  std::size_t count_;
  float floor_ = 0;
  std::vector<Peak> peaks_;
};

// The highest squares of a correlation, none beside a higher one.
std::vector<cv::Point> highest(const cv::Mat1f& scores, std::size_t count) {
  HighestPeaks peaks(count);
  const int rows = scores.rows, cols = scores.cols;
  for (int r = 0; r < rows; ++r) {
    const float* row = scores[r];
    const float* above = scores[(r + 1) % rows];
    const float* below = scores[(r + rows - 1) % rows];
    for (int c = 0; c < cols; ++c) {
      const float s = row[c];
      if (s <= peaks.floor()) continue;
      const int left = c == 0 ? cols - 1 : c - 1, right = c + 1 == cols ? 0 : c + 1;
      if (s < row[left] || s <= row[right] || s < below[c] || s <= above[c]) continue;
      peaks.add({s, cv::Point(c, r)});
    }
  }
  return peaks.best();
}

// Both maps on grids of one size.
class Correlation {
 public:
  Correlation(const Turned& there, const Turned& here, const WallSearchOptions& options)
      : here_(here), peaks_(options.peaks), low_(there.bounds().low) {
    const Bounds there_bounds = there.bounds(), here_bounds = here.bounds();
    there_size_m_ = there_bounds.high - there_bounds.low;
    // Turned by any yaw the current map is no larger than its diagonal.
    const Eigen::Vector2f needed_m = there_size_m_.array() + (here_bounds.high - here_bounds.low).norm();
    const float square_m = std::max(static_cast<float>(options.square_m),
                                    needed_m.maxCoeff() / static_cast<float>(options.max_size_squares - 4));
    const auto squares = [&](float length_m) {
      return cv::getOptimalDFTSize(static_cast<int>(std::ceil(length_m / square_m)) + 4);
    };
    raster_ = {
        square_m, {squares(needed_m.x()), squares(needed_m.y())}, static_cast<float>(options.contradiction)};
    fixed_ = transform(there, low_, raster_);
  }

  // The best shifts of the current map turned by a yaw and, on request, by the opposite one: that only turns
  // the current map's grid about its origin, so that the correlation becomes a convolution.
  std::vector<Pose2> search(double yaw, bool opposite_too) const {
    std::vector<Pose2> poses;
    const Turned here = here_.by(yaw);
    const Eigen::Vector2f low = here.bounds().low;
    const Spectra moving = transform(here, low, raster_);
    for (const cv::Point& peak : highest(product(moving, true), peaks_)) {
      const Eigen::Vector2f shift = raster_.square_m * unwrapped(peak);
      poses.push_back(poseOf(shift + low_ - low, yaw));
    }
    if (!opposite_too) return poses;
    for (const cv::Point& peak : highest(product(moving, false), peaks_)) {
      const Eigen::Vector2f shift =
          raster_.square_m * Eigen::Vector2f(static_cast<float>(peak.x), static_cast<float>(peak.y));
      poses.push_back(poseOf(shift + low_ + low, wrapAngle(yaw + M_PI)));
    }
    return poses;
  }

 private:
  cv::Mat1f product(const Spectra& moving, bool correlate) const {
    cv::Mat one, other;
    cv::mulSpectrums(fixed_.says, moving.edges, one, 0, correlate);
    cv::mulSpectrums(fixed_.edges, moving.says, other, 0, correlate);
    cv::Mat1f scores;
    cv::idft(one + other, scores, cv::DFT_REAL_OUTPUT);
    return scores;
  }
  // Shifts beyond the reference map's size are negative ones, wrapped round.
  Eigen::Vector2f unwrapped(const cv::Point& shift) const {
    const auto along = [&](int squares, int size, float there_m) {
      const float shift_m = static_cast<float>(squares) * raster_.square_m;
      return static_cast<float>(shift_m > there_m + 2 * raster_.square_m ? squares - size : squares);
    };
    return {along(shift.x, raster_.size.width, there_size_m_.x()),
            along(shift.y, raster_.size.height, there_size_m_.y())};
  }
  static Pose2 poseOf(const Eigen::Vector2f& shift_m, double yaw) { return {shift_m.x(), shift_m.y(), yaw}; }

  Turned here_;
  std::size_t peaks_;
  Eigen::Vector2f low_;
  Eigen::Vector2f there_size_m_;
  Raster raster_;
  Spectra fixed_;
};

struct Turn {
  double yaw;
  bool opposite_too;
};

// Yaws of which one is the opposite of another become one turn.
std::vector<Turn> turnsOf(const std::vector<double>& yaws) {
  std::vector<Turn> turns;
  std::vector<bool> done(yaws.size());
  for (std::size_t i = 0; i < yaws.size(); ++i) {
    if (done[i]) continue;
    turns.push_back({yaws[i], false});
    for (std::size_t k = i + 1; k < yaws.size(); ++k) {
      if (std::abs(wrapAngle(yaws[k] - yaws[i] - M_PI)) > kSameYaw_rad) continue;
      done[k] = turns.back().opposite_too = true;
    }
  }
  return turns;
}

}  // namespace

std::vector<Pose2> proposeFromWalls(const EvidencePair& maps, const std::vector<double>& yaws,
                                    const WallSearchOptions& options) {
  const auto& [reference, current] = maps;
  const std::vector<Opinion> reference_says = reference.coarse.opinions(),
                             current_says = current.coarse.opinions();
  const Correlation correlation(
      Turned{reference.samples, reference_says, reference.coarse.squareSize(), {}}.by(0),
      Turned{current.samples, current_says, current.coarse.squareSize(), {}}.by(0), options);
  const std::vector<Turn> turns = turnsOf(yaws);
  std::vector<std::vector<Pose2>> found(turns.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(turns.size())), [&](const cv::Range& range) {
    for (auto i = static_cast<std::size_t>(range.start); i < static_cast<std::size_t>(range.end); ++i)
      found[i] = correlation.search(turns[i].yaw, turns[i].opposite_too);
  });
  std::vector<Pose2> poses;
  for (const std::vector<Pose2>& of_turn : found) poses.insert(poses.end(), of_turn.begin(), of_turn.end());
  return poses;
}

}  // namespace cornerstone
