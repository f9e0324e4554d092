// The landmarks of a map that grows and improves: only where it changed are they looked for again, and
// corners keep their identity. Metres of the map's frame; seconds of any rising clock.
//
// The result is that of detectLandmarks on the whole map, except where a chain of uncertain cells leads a
// state out of the searched region, and where of two near corners another one is suppressed. A map of another
// resolution, or one whose cells lie between those of the last, is searched as a whole.
#pragma once

#include "cornerstone/landmarks/detect_corners.h"

namespace cornerstone {

class LandmarkFollower {
 public:
  explicit LandmarkFollower(const LandmarkParams& params) : params_(params) {}

  const Landmarks& update(const GridMap& map, double time_s);
  const Landmarks& landmarks() const { return landmarks_; }
  // Share of the map's cells that the last update looked at.
  double searchedShare() const { return searched_share_; }

 private:
  void searchAll(const GridMap& map);
  void searchAround(const GridMap& map, const cv::Rect& changed);
  void dropOutside(const GridGeometry& geometry);
  void keepIdentities(const std::vector<CornerLandmark>& before, double time_s);

  LandmarkParams params_;
  GridMap map_;  // of the last update
  Landmarks landmarks_;
  std::uint32_t last_id_ = 0;
  double searched_share_ = 0;
};

}  // namespace cornerstone
