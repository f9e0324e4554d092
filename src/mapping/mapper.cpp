#include "cornerstone/mapping/mapper.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

// The map's frame is the first scan's; a start needs some width, so that covariances stay invertible.
Eigen::Matrix3d startCovariance() { return Eigen::Vector3d(1e-6, 1e-6, 1e-6).asDiagonal(); }

// A robot put into a loaded map by hand: 0.3 m and 10 degrees.
Eigen::Matrix3d handCovariance() { return Eigen::Vector3d(0.09, 0.09, 0.03).asDiagonal(); }

}  // namespace

void describe(ParamVisitor& visitor, MapperParams& params) {
  visitor.group("grid", [&] { describe(visitor, params.grid); });
  visitor.group("fit", [&] { describe(visitor, params.fit); });
  visitor.group("odometry", [&] { describe(visitor, params.odometry); });
  visitor.group("graph", [&] { describe(visitor, params.graph); });
  visitor.group("relocalisation", [&] { describe(visitor, params.relocalisation); });
  visitor.group("loop", [&] { describe(visitor, params.loop); });
  visitor.field("fit_scans", params.fit_scans);
  visitor.field("max_contradictions", params.max_contradictions);
}

namespace {

// Odometry that claims more has gone astray; cells are counted in 32 bits and MRPT's in floats.
constexpr double kFarthest_m = 5000;
constexpr int kLeastScans = 5;        // until what is done beside is taken up
constexpr double kWaySquare_m = 0.2;  // of a way: a robot's radius

void requireSane(const Pose2& odom_from_base) {
  if (!odom_from_base.isFinite()) throw InputError("odometry: odom_from_base is not finite");
  if (odom_from_base.translation().norm() > kFarthest_m)
    throw InputError("odometry: odom_from_base lies too far from the frame's origin (5 km at most)");
}

bool same(const Pose2& a, const Pose2& b) {
  constexpr double kSame_m = 0.15, kSame_rad = 3 * M_PI / 180;
  const Pose2 apart = a.inverse() * b;
  return apart.translation().norm() < kSame_m && std::abs(apart.yaw_rad) < kSame_rad;
}

}  // namespace

Mapper::Mapper(const MapperParams& params, std::size_t levels)
    : params_(params),
      local_maps_{LocalMap(params.grid, levels)},
      filter_(params.odometry),
      graph_(params.graph, params.odometry) {
  requireValid(params.fit);
  requireValid(params.relocalisation);
  requireValid(params.loop);
  requireWithin(params.max_contradictions, 1, 1e6, "max_contradictions");
}

void Mapper::predict(const Pose2& odom_from_base) {
  if (start_) {
    filter_.place({*start_, handCovariance()});
  } else if (!last_odom_) {
    filter_.place({map_from_odom_ * odom_from_base, startCovariance()});
  } else {
    filter_.step(last_odom_->inverse() * odom_from_base);
  }
  start_.reset();
  last_odom_ = odom_from_base;
}

LookMotion Mapper::motion() const {
  if (!last_inserted_) return kFirstLook;
  return motionBetween(*last_inserted_, filter_.pose().map_from_base);
}

// Of the whole look: at the distance of its middle beam.
double Mapper::newShare(const RangeScan& scan) const {
  std::vector<double> ranges_m;
  for (const Beam& beam : scan.beams)
    if (beam.hit) ranges_m.push_back(beam.range_m);
  if (ranges_m.empty()) return 1;
  const auto middle = ranges_m.begin() + static_cast<std::ptrdiff_t>(ranges_m.size() / 2);
  std::nth_element(ranges_m.begin(), middle, ranges_m.end());
  return grid().newShare(*middle, motion());
}

MapperUpdate Mapper::update(const RangeScan& raw, const Pose2& odom_from_base) {
  requireSane(odom_from_base);
  predict(odom_from_base);
  const RangeScan scan = corrected(raw, graph_.calibration());
  ScanFit fit;
  if (params_.fit_scans) fit = fitScan(scan, grid(), {filter_.pose(), newShare(scan)}, params_.fit);
  place_ = seek(scan, odom_from_base, fit);
  if (place_ == Place::kAsFitted && fit.state == FitState::kFitted) filter_.correct(fit.pose);
  const bool contradicts =
      place_ == Place::kUnsure || (place_ == Place::kAsFitted && fit.state == FitState::kContradicts);
  contradictions_ = contradicts ? contradictions_ + 1 : 0;

  const bool says_something =
      std::any_of(scan.beams.begin(), scan.beams.end(), [](const Beam& beam) { return beam.hit; });
  const bool trusted = contradictions_ == 0 || contradictions_ > params_.max_contradictions;
  const bool insert = says_something && trusted;
  const bool remembers = insert && params_.graph.use && params_.fit_scans && !loaded_;
  if (remembers) remember(raw, whole_from_odom_ * odom_from_base);
  if (insert) {
    current().insert(scan, filter_.pose().map_from_base, motion());
    last_inserted_ = filter_.pose().map_from_base;
    if (!remembers) notePlace();
  }
  if (remembers) {
    lookForLoop();
    straighten();
  }
  map_from_odom_ = filter_.pose().map_from_base * odom_from_base.inverse();
  return {map_from_odom_, insert, fit.state == FitState::kFitted, fit.matches, filter_.pose().covariance};
}

bool Mapper::isDoubtful(const ScanFit& fit) const {
  const RelocalisationParams& params = params_.relocalisation;
  return fit.state == FitState::kContradicts || fit.innovation_sigmas > params.slip_sigmas ||
         fit.knownAgreeingShare(params_.fit.min_matches) < params.doubtful_share;
}

// Where scan and odometry exclude each other the robot is sought nearby, then at every heading. There one
// look may mislead: two in a row have to be found at the same pose.
Mapper::Place Mapper::seek(const RangeScan& scan, const Pose2& odom_from_base, const ScanFit& fit) {
  constexpr double kAsGood = 0.9;  // a place nearby needs this much of the best one's agreement
  const RelocalisationParams& params = params_.relocalisation;
  const std::optional<Pose2> before = found_map_from_odom_;
  found_map_from_odom_.reset();
  if (place_ != Place::kUnsure && !isDoubtful(fit)) return Place::kAsFitted;
  const Pose2 by_odometry = filter_.pose().map_from_base;
  const auto sought = [&](double reach_m, double reach_rad, double agreeing_share) {
    RelocalisationParams asked = params;
    asked.min_agreeing_share = agreeing_share;
    return relocalise({scan, grid()}, {by_odometry, reach_m, reach_rad}, params_.fit, asked);
  };
  const Relocalisation near = sought(params.slip_reach_m, params.slip_reach_rad, params.min_agreeing_share);
  // No place agrees by more than 1, so that a good one nearby needs no other to be held against.
  const bool is_best = near.pose && near.agreeing >= kAsGood;
  const Relocalisation far =
      is_best ? Relocalisation{} : sought(params.reach_m, M_PI, params.min_agreeing_share_far);
  if (near.pose && near.agreeing >= kAsGood * far.agreeing) {
    goOnAt(*near.pose, odom_from_base);
    return Place::kFound;
  }
  if (!far.pose) return near.elsewhere || far.elsewhere ? Place::kUnsure : Place::kAsFitted;
  found_map_from_odom_ = far.pose->map_from_base * odom_from_base.inverse();
  if (!before || !same(*before * odom_from_base, far.pose->map_from_base)) return Place::kUnsure;
  goOnAt(*far.pose, odom_from_base);
  return Place::kFound;
}

// What the graph takes for odometry goes on from where the robot is; the rates must not learn from a slip.
void Mapper::goOnAt(const PoseEstimate& found, const Pose2& odom_from_base) {
  const Pose2 slip = filter_.pose().map_from_base.inverse() * found.map_from_base;
  whole_from_odom_ = whole_from_odom_ * odom_from_base * slip * odom_from_base.inverse();
  filter_.place(found);
  found_map_from_odom_.reset();
  ++slips_;
}

void Mapper::notePlace() {
  const Eigen::Vector2d at = last_inserted_->translation();
  if (places_.empty() || (places_.back() - at).norm() > kWaySquare_m) places_.push_back(at);
}

std::vector<Eigen::Vector2d> Mapper::way() const {
  std::vector<Eigen::Vector2d> way = places_;
  for (const KeyFrame& frame : graph_.frames()) way.push_back(frame.map_from_base.translation());
  if (last_inserted_) way.push_back(last_inserted_->translation());
  const auto squareOf = [](const Eigen::Vector2d& at) {
    return std::pair(std::floor(at.x() / kWaySquare_m), std::floor(at.y() / kWaySquare_m));
  };
  std::stable_sort(way.begin(), way.end(), [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return squareOf(a) < squareOf(b);
  });
  way.erase(std::unique(way.begin(), way.end(),
                        [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                          return squareOf(a) == squareOf(b);
                        }),
            way.end());
  return way;
}

void Mapper::remember(const RangeScan& scan, const Pose2& odom_from_base) {
  if (graph_.frameDue(odom_from_base)) {
    filter_.correct(graph_.addFrame(scan, odom_from_base, filter_.pose()));
  } else {
    graph_.addLook(scan, odom_from_base);
  }
}

// What the thread beside has done is taken up after a fixed count of scans, so that the same scans always
// make the same map. It needs some milliseconds a frame in all, and is waited for where it is slower.
void Mapper::straighten() {
  if (redraw_) {
    redraw();
  } else if (beside_.valid()) {
    if (--scans_to_take_up_ <= 0) redraw_ = beside_.get();
  } else if (graph_.solveDue() || found_loop_) {
    constexpr int kFramesPerScan = 30;
    scans_to_take_up_ = kLeastScans + static_cast<int>(graph_.frames().size()) / kFramesPerScan;
    beside_ = startRedraw(graph_, LocalMap(params_.grid, current().levelCount()),
                          {std::exchange(found_loop_, std::nullopt),
                           params_.loop.max_strain_sigmas,
                           {params_.graph.redraw_shift_m, params_.graph.match_distance_m}});
  }
}

void Mapper::lookForLoop() {
  constexpr std::size_t kSearchAfterFrames = 10;  // 2 m of way
  const std::size_t frames = graph_.frames().size();
  if (loop_beside_.valid()) {
    if (--scans_to_loop_ > 0) return;
    LoopSearch search = loop_beside_.get();
    if (search.sure) sure_frame_ = search.now;
    found_loop_ = std::move(search.found);
  } else if (!found_loop_ && frames >= searched_frames_ + kSearchAfterFrames) {
    searched_frames_ = frames;
    std::optional<OpenLoop> loop = openLoop(graph_, sure_frame_, params_.loop);
    if (!loop) return;
    scans_to_loop_ = kLeastScans;
    loop_beside_ = std::async(std::launch::async, findLoop, std::move(*loop),
                              LoopSearchParams{params_.loop, params_.graph, params_.relocalisation,
                                               params_.fit, params_.grid, graph_.calibration()});
  }
}

void Mapper::redraw() {
  redraw_->goOn(graph_.frames(), params_.graph.redraw_looks_per_scan);
  if (!redraw_->finished(graph_.frames())) return;
  const GraphSolution& solution = redraw_->solution();
  const Pose2 correction = correctionOf(solution, graph_.frames());
  filter_.moveBy(correction, solution.rates);
  last_inserted_ = correction * *last_inserted_;
  graph_.adopt(solution);
  current().becomeRedrawn(redraw_->takeMap());
  redraw_.reset();
  ++redraws_;
}

void Mapper::reset() {
  current().clear();
  filter_ = OdometryFilter(params_.odometry);
  graph_ = FrameGraph(params_.graph, params_.odometry);
  redraw_.reset();
  beside_ = {};
  loop_beside_ = {};
  found_loop_.reset();
  sure_frame_ = 0;
  searched_frames_ = 0;
  redraws_ = 0;
  loaded_ = false;
  map_from_odom_ = {};
  last_odom_.reset();
  start_.reset();
  last_inserted_.reset();
  places_.clear();
  contradictions_ = 0;
  found_map_from_odom_.reset();
  place_ = Place::kAsFitted;
  whole_from_odom_ = {};
  slips_ = 0;
  ++epoch_;
}

void Mapper::load(const std::vector<GridMap>& levels, const Pose2& map_from_base) {
  if (!map_from_base.isFinite()) throw InputError("map to load: the robot's pose in it is not finite");
  if (levels.size() > current().levelCount())
    throw InputError("map to load: it has more levels than this map");
  LocalMap loaded(params_.grid, current().levelCount());
  for (std::size_t level = 0; level < levels.size(); ++level)
    if (!levels[level].occupied.empty()) loaded.load(level, levels[level]);
  reset();
  current() = std::move(loaded);
  start_ = map_from_base;
  loaded_ = true;
}

}  // namespace cornerstone
