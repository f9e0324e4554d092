// Fits the corner model to a map's edges (paper, section 3.3) (its residuals are a Ceres cost), then moves
// its arms onto the faces of one kind: on a thin wall the distance field alone would settle between the two
// faces. Poses in metres of the map's frame. No answer where an arm has too little support, where the fit
// leaves the neighbourhood of its first guess, or where the model stays too far from the edges.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cornerstone/landmarks/corner_cost.h"
#include "cornerstone/landmarks/detect_corners.h"
#include "cornerstone/landmarks/edge_index.h"

namespace cornerstone {

class CornerFitter {
 public:
  // Field and index must outlive the fitter.
  CornerFitter(const DistanceField& field, const EdgeIndex& index, const GridGeometry& geometry,
               const LandmarkParams& params);

  // The corners near a first guess, at most one of each kind.
  std::vector<CornerLandmark> fit(const Pose2& guess);

 private:
  using EdgesByFacing = std::array<std::vector<EdgePoint>, 2>;
  const EdgesByFacing& edgesAround(const Pose2& corner);
  // The pose nearest to a first guess, by the distance field.
  Pose2 approach(const Pose2& guess);
  // The corner of one kind, from the edges that face the right way.
  std::optional<CornerLandmark> settle(const Pose2& near, const std::vector<EdgePoint>& edges,
                                       CornerKind kind) const;

  GridGeometry geometry_;
  LandmarkParams params_;
  const EdgeIndex& index_;
  CornerCost cost_;
  // Kept from fit to fit for their memory.
  EdgesByFacing around_;
  Eigen::VectorXd residuals_;
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> jacobian_;
};

}  // namespace cornerstone
