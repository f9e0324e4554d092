// What one scan says about every cell of its field of view: each cell is visited once, however many beams
// cross it (near) or however wide a beam is (far), and takes the mean of the beams that overlap it.
#pragma once

#include <vector>

#include "beam_evidence.h"
#include "cell_sectors.h"
#include "range_minimum.h"

namespace cornerstone {

class ScanWedge {
 public:
  // The window is changed in place by apply(); both must outlive the wedge.
  ScanWedge(const RangeScan& scan, const Pose2& map_from_sensor, const OccupancyGrid& grid);
  const CellWindow& window() const { return window_; }
  void apply(const LookMotion& motion);
  const std::vector<SurfaceHit>& hits() const { return hits_; }

 private:
  struct Look {  // the mean of what the beams over one cell say
    double posterior = 0;
    int beams = 0;
    double cause = 0;  // of the beam most likely to have measured this cell
    const BeamEvidence* beam = nullptr;
  };
  struct Sector {  // of the table
    int first = 0, last = 0;
    double range_m = 0;
  };
  void makeBearingTable(const RangeScan& scan);
  Look lookAt(const Sector& sector, double occupied) const;
  void updateCell(Cell cell, EvidenceCell& evidence, const Sector& sector, const LookMotion& motion);
  EvidenceCell updated(EvidenceCell cell, double change, double new_share) const;

  const OccupancyGrid& grid_;
  Pose2 map_from_sensor_;
  CellWindow window_;
  std::vector<BeamEvidence> beams_;  // of beams that hit
  std::vector<int> beam_at_;         // by bearing; -1: none
  // By bearing; infinite: no beam. What lies nearer is free, what lies farther learns nothing.
  RangeMinimum free_up_to_m_, minus_end_m_;
  EvidenceCell emptiest_;  // nothing can be taken from it
  double table_start_rad_ = 0;
  double table_step_rad_ = 0;
  double reach_m_ = 0;
  std::vector<SurfaceHit> hits_;
};

}  // namespace cornerstone
