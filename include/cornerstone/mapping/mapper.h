// Scans and odometry in, a map and the drift of the odometry out: each scan is fitted to the map before it is
// inserted.
//
// The pose is carried by odometry from scan to scan with its covariance (odometry_filter.h), corrected by
// each fit (scan_fit.h); where a scan fits nothing, odometry alone moves it on. Scans that contradict the map
// in most of their beams are not inserted unless they go on doing so: then it is the world that changed.
//
// Wheels slip, and robots are pushed: where scan and odometry exclude each other the robot is sought on the
// map (relocalisation.h).
//
// Behind that a graph of key frames bends the whole way so that all looks agree (frame_graph.h), also where a
// laser's robot comes back to an old place after a way that drifted (loop_closure.h). When it moves them, the
// map is drawn anew beside the running one, which goes on until the new one takes its place: then the pose
// and map_from_odom step by what was corrected. In a loaded map there is no graph: its cells do not move.
#pragma once

#include <future>
#include <optional>
#include <vector>

#include "cornerstone/mapping/local_map.h"
#include "cornerstone/mapping/map_redraw.h"
#include "cornerstone/mapping/odometry_filter.h"
#include "cornerstone/mapping/relocalisation.h"
#include "cornerstone/mapping/scan_fit.h"

namespace cornerstone {

struct MapperParams {
  GridParams grid;
  ScanFitParams fit;
  OdometryNoise odometry;
  FrameGraphParams graph;
  RelocalisationParams relocalisation;
  LoopParams loop;
  bool fit_scans = true;        // false: odometry as it is (for robots that localise by other means)
  int max_contradictions = 10;  // scans in a row that fit ill before they are taken for a changed world
};
void describe(ParamVisitor& visitor, MapperParams& params);

struct MapperUpdate {
  Pose2 map_from_odom;
  bool inserted = false;                                 // false: the scan said nothing or did not fit
  bool fitted = false;                                   // the scan corrected the pose
  int matches = 0;                                       // beam ends that found a surface of the map
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of map_from_base: x, y, yaw
};

class Mapper {
 public:
  // levels: of the scans to come. Throws InputError naming a parameter out of range.
  explicit Mapper(const MapperParams& params, std::size_t levels = 1);
  // odom_from_base: at the scan's instant; not finite: InputError and nothing changes.
  MapperUpdate update(const RangeScan& scan, const Pose2& odom_from_base);
  // Empties the map and starts it at the robot's pose in odom; a new epoch.
  void reset();
  // Goes on in a saved map (a new epoch), one grid a level, in which the robot's next scan is taken at
  // map_from_base. Levels that are empty or missing begin anew.
  void load(const std::vector<GridMap>& levels, const Pose2& map_from_base);

  const std::vector<LocalMap>& localMaps() const { return local_maps_; }
  // One level of all local maps, in the map's frame.
  GridMap map(std::size_t level = 0) const { return composed(local_maps_, level); }
  // Of the current local map.
  const OccupancyGrid& grid(std::size_t level = 0) const { return local_maps_.back().grid(level); }
  const Pose2& mapFromOdom() const { return map_from_odom_; }
  PoseEstimate pose() const { return filter_.pose(); }
  // Where the robot has been in this epoch, m in the map's frame, a point in each square of 0.2 m.
  std::vector<Eigen::Vector2d> way() const;
  const OdometryFilter& odometry() const { return filter_; }
  const FrameGraph& graph() const { return graph_; }
  std::uint32_t epoch() const { return epoch_; }
  int redraws() const { return redraws_; }  // how often the map was drawn anew in this epoch
  int slips() const { return slips_; }  // how often the robot was not where odometry had it, in this epoch

 private:
  void predict(const Pose2& odom_from_base);
  enum class Place { kAsFitted, kFound, kUnsure };  // kUnsure: perhaps elsewhere
  bool isDoubtful(const ScanFit& fit) const;
  Place seek(const RangeScan& scan, const Pose2& odom_from_base, const ScanFit& fit);
  void goOnAt(const PoseEstimate& found, const Pose2& odom_from_base);
  void notePlace();
  void remember(const RangeScan& scan, const Pose2& odom_from_base);  // as or with a key frame
  void straighten();                                                  // the map, by what the graph knows
  void lookForLoop();
  void redraw();
  LookMotion motion() const;  // since the last look that was inserted
  double newShare(const RangeScan& scan) const;

  MapperParams params_;
  LocalMap& current() { return local_maps_.back(); }

  std::vector<LocalMap> local_maps_;  // the last is the current one; one for now
  Pose2 map_from_odom_;
  OdometryFilter filter_;
  FrameGraph graph_;
  std::future<std::optional<MapRedraw>> beside_;  // solves and draws in a thread of its own
  int scans_to_take_up_ = 0;
  std::future<LoopSearch> loop_beside_;  // looks for a loop in a thread of its own
  int scans_to_loop_ = 0;
  std::size_t searched_frames_ = 0;      // when a loop was last looked for
  std::size_t sure_frame_ = 0;           // the last that was seen to stand on the old map where it should
  std::optional<FoundLoop> found_loop_;  // to be closed when the map is drawn anew
  std::optional<MapRedraw> redraw_;      // its last looks
  int redraws_ = 0;
  bool loaded_ = false;
  std::optional<Pose2> last_odom_;       // odom_from_base of the last scan
  std::optional<Pose2> start_;           // where a loaded map says the robot is
  std::optional<Pose2> last_inserted_;   // map_from_base
  std::vector<Eigen::Vector2d> places_;  // on the way, where no key frames tell it
  int contradictions_ = 0;
  std::optional<Pose2> found_map_from_odom_;  // of the last scan, by a wide search
  Place place_ = Place::kAsFitted;            // of the last scan
  int slips_ = 0;
  Pose2 whole_from_odom_;  // odometry with the slips that were found put in
  std::uint32_t epoch_ = 1;
};

}  // namespace cornerstone
