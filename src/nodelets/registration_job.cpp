#include "nodelets/registration_job.h"

#include <ros/time.h>

#include <utility>

namespace cornerstone {

RegistrationFindings run(RegistrationJob job, MapRegistrar& registrar) {
  const ros::WallTime start = ros::WallTime::now();
  job.task.current = job.own.map();
  job.task.current_way_m = job.own.way();
  if (!job.robot.empty()) job.task.reference = job.other.map();
  job.task.reference_way_m = job.other.way();
  RegistrationFindings found;
  found.attempt = registrar.attempt(job.task);
  if (job.merge_into) {
    std::vector<PlacedMap> placed;
    for (const PlacedTiles& tiles : job.merge)
      placed.push_back({tiles.tiles.map(), tiles.reference_from_map});
    found.merged = mergeMaps(job.merge_into->map(), placed);
  }
  found.centre_m = job.task.hints.focus_in_current_m.value_or(knownCentre(job.task.current));
  found.job = std::move(job);
  found.elapsed_s = (ros::WallTime::now() - start).toSec();
  return found;
}

}  // namespace cornerstone
