#include "scan_wedge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cornerstone {
namespace {

constexpr int kMaxBeamsPerCell = 8;  // of many beams over a cell beside the sensor, these are looked at
constexpr double kMinHitCause =
    0.3;  // a surface point takes part in a look that it caused by this probability
constexpr double kSmallestProbability = 1e-9;

double logit(double probability) {
  const double p = std::clamp(probability, kSmallestProbability, 1 - kSmallestProbability);
  return std::log(p / (1 - p));
}

double reachOf(const Beam& beam, double max_range_m) {
  return std::min(max_range_m, beam.range_m + 2 * (beam.far_m - beam.range_m));
}

// The rectangle of cells that the sensor and the ends of its beams span.
CellWindow windowOf(const RangeScan& scan, const Pose2& map_from_sensor, const OccupancyGrid& grid) {
  const double margin_m = 2 * grid.params().resolution_m;
  const PointMotion to_map(map_from_sensor);
  Eigen::Vector2d low_m = map_from_sensor.translation(), high_m = low_m;
  for (const Beam& beam : scan.beams) {
    if (!beam.hit) continue;
    const double reach_m = reachOf(beam, grid.params().max_range_m) + margin_m;
    for (const double side : {-0.5, 0.5}) {
      const double angle_rad = beam.bearing_rad + side * beam.width_rad;
      const Eigen::Vector2d end_m =
          to_map * (reach_m * Eigen::Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
      low_m = low_m.cwiseMin(end_m);
      high_m = high_m.cwiseMax(end_m);
    }
  }
  return grid.readWindow(low_m, high_m);
}

}  // namespace

ScanWedge::ScanWedge(const RangeScan& scan, const Pose2& map_from_sensor, const OccupancyGrid& grid)
    : grid_(grid),
      map_from_sensor_(map_from_sensor),
      window_(windowOf(scan, map_from_sensor, grid)),
      emptiest_(EvidenceScale::cellOf(grid.params().min_log_odds)) {
  beams_.reserve(scan.beams.size());
  for (const Beam& beam : scan.beams) {
    if (!beam.hit) continue;
    beams_.emplace_back(beam, window_, grid);
    beams_.back().trace(map_from_sensor.translation(), map_from_sensor.yaw_rad + beam.bearing_rad);
    reach_m_ = std::max(reach_m_, beams_.back().end_m());
  }
  makeBearingTable(scan);
}

void ScanWedge::makeBearingTable(const RangeScan& scan) {
  if (beams_.empty()) return;
  double narrowest_rad = M_PI;
  for (const Beam& beam : scan.beams) narrowest_rad = std::min(narrowest_rad, beam.width_rad);
  table_step_rad_ = std::max(narrowest_rad / 2, 2 * M_PI / 16384);
  table_start_rad_ = scan.beams.front().bearing_rad - scan.beams.front().width_rad / 2;
  const double end_rad = scan.beams.back().bearing_rad + scan.beams.back().width_rad / 2;
  beam_at_.assign(static_cast<std::size_t>((end_rad - table_start_rad_) / table_step_rad_) + 1, -1);
  int index = 0;
  for (const Beam& beam : scan.beams) {
    if (!beam.hit) continue;
    const double first = (beam.bearing_rad - beam.width_rad / 2 - table_start_rad_) / table_step_rad_;
    const double last = (beam.bearing_rad + beam.width_rad / 2 - table_start_rad_) / table_step_rad_;
    for (auto i = static_cast<std::size_t>(std::max(0.0, std::round(first)));
         i < std::min(beam_at_.size(), static_cast<std::size_t>(std::max(0.0, std::round(last)))); ++i)
      beam_at_[i] = index;
    ++index;
  }
  // A beam that is surely no mismatch takes the whole free step from every cell before its interval: with
  // outlier o, logit(o P) - logit(P) <= log o.
  const double surely = std::exp(-grid_.params().free_step);
  std::vector<float> free_m, end_m;
  for (const int at : beam_at_) {
    const BeamEvidence* beam = at < 0 ? nullptr : &beams_[static_cast<std::size_t>(at)];
    const double before_m =
        beam && beam->outlier() <= surely ? std::min(beam->start_m(), beam->clear_m()) : 0;
    free_m.push_back(beam ? static_cast<float>(before_m) : std::numeric_limits<float>::infinity());
    end_m.push_back(beam ? static_cast<float>(-beam->end_m()) : std::numeric_limits<float>::infinity());
  }
  free_up_to_m_ = RangeMinimum(std::move(free_m));
  minus_end_m_ = RangeMinimum(std::move(end_m));
}

void ScanWedge::apply(const LookMotion& motion) {
  if (beams_.empty()) return;
  const int table_size = static_cast<int>(beam_at_.size());
  const float all_free_m = free_up_to_m_.of(0, table_size - 1);
  CellSectors sectors(window_.geometry, map_from_sensor_, {table_start_rad_, table_step_rad_, table_size});
  for (int row = 0; row < window_.geometry.rows; ++row) {
    EvidenceCell* cells = &window_.at({0, row});
    const CellSectors::Columns columns = sectors.look(row, reach_m_);
    for (int col = columns.begin; col < columns.end; ++col) {
      const int first = sectors.first(col), last = sectors.last(col);
      if (first < 0 || last >= table_size) continue;  // not wholly in view
      const float range_m = sectors.range_m(col);
      if (range_m < all_free_m && cells[col] == emptiest_) continue;
      // Most cells lie before all of their beams' intervals, or behind them.
      const float free_m = free_up_to_m_.of(first, last);
      if (std::isinf(free_m) || range_m > -minus_end_m_.of(first, last)) continue;
      const Sector sector{first, last, static_cast<double>(range_m)};
      if (range_m >= free_m)
        updateCell({col, row}, cells[col], sector, motion);
      else if (cells[col] != emptiest_)
        cells[col] = updated(cells[col], -grid_.params().free_step, grid_.newShare(sector.range_m, motion));
    }
  }
}

ScanWedge::Look ScanWedge::lookAt(const Sector& sector, double occupied) const {
  Look look;
  const int stride = std::max(1, (sector.last - sector.first) / kMaxBeamsPerCell);
  int previous = -1;
  for (int i = sector.first; i <= sector.last; i += stride) {
    const int index = beam_at_[static_cast<std::size_t>(i)];
    if (index < 0 || index == previous) continue;
    previous = index;
    const BeamEvidence& beam = beams_[static_cast<std::size_t>(index)];
    const bool before = sector.range_m < beam.start_m();
    if (sector.range_m > beam.end_m() || (sector.range_m > beam.clear_m() && before)) continue;
    const double cause = before ? 0 : beam.causeOf(sector.range_m, occupied);
    look.posterior += before ? beam.outlier() * occupied : beam.posteriorOf(sector.range_m, occupied);
    ++look.beams;
    if (cause <= look.cause) continue;
    look.cause = cause;
    look.beam = &beam;
  }
  return look;
}

void ScanWedge::updateCell(Cell cell, EvidenceCell& evidence, const Sector& sector,
                           const LookMotion& motion) {
  const double occupied = grid_.scale().occupied(evidence);
  const Look look = lookAt(sector, occupied);
  if (look.beams == 0) return;
  const double change = logit(look.posterior / look.beams) - logit(occupied);
  const double new_share = grid_.newShare(sector.range_m, motion);
  evidence = updated(evidence, change, new_share);
  if (look.cause < kMinHitCause) return;
  const double sigma_m = look.beam->sigma_m();
  hits_.push_back({{window_.first.col + cell.col, window_.first.row + cell.row},
                   look.beam->end(),
                   new_share * look.cause / (sigma_m * sigma_m)});
}

// What confirms the cell counts by how new the look is. A look that tips the cell without being wholly new
// only leaves it contested, one step on the new side; the next look decides in full: a thing that came is
// there after two looks of a robot that stands, and one that went does not linger between.
EvidenceCell ScanWedge::updated(EvidenceCell cell, double change, double new_share) const {
  const GridParams& params = grid_.params();
  const double before = EvidenceScale::logOddsOf(cell);
  const bool contested = cell == 1 || cell == -1;
  const bool confirms = change * before >= 0 && !contested;
  const double step =
      std::clamp(change, -params.free_step, params.occupied_step) * (confirms ? new_share : 1);
  const EvidenceCell after =
      EvidenceScale::cellOf(std::clamp(before + step, params.min_log_odds, params.max_log_odds));
  const bool tips = cell != 0 && !contested && (cell > 0) != (after > 0);
  // 0 is kept for "never seen": evidence that cancels stays one step on the side of the last look.
  if ((after == 0 && cell != 0) || (tips && new_share < 1))
    return static_cast<EvidenceCell>(change > 0 ? -1 : 1);
  return after;
}

}  // namespace cornerstone
