#include "cornerstone/ros/diagnostics.h"

#include <ros/console.h>

#include <algorithm>

namespace cornerstone {

StageDiagnostics::StageDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node,
                                   const std::string& stage)
    : name_(private_node.getNamespace()), updater_(node, private_node, name_) {
  updater_.setHardwareID("none");
  updater_.add(stage, this, &StageDiagnostics::report);
  // By the steady clock: a stage tells of itself when simulated time stands still, too. Forced: update()
  // keeps a time of its own and would be silent after a jump back in time.
  timer_ = node.createSteadyTimer(ros::WallDuration(1.0),
                                  [this](const ros::SteadyTimerEvent&) { updater_.force_update(); });
}

void StageDiagnostics::processed(double seconds) {
  ++processed_;
  busy_s_ += seconds;
  longest_s_ = std::max(longest_s_, seconds);
}

void StageDiagnostics::dropped(const std::string& cause) {
  ++dropped_[cause];
  ros::WallTime& logged = logged_[cause];
  if (ros::WallTime::now() - logged < ros::WallDuration(10)) return;
  logged = ros::WallTime::now();
  ROS_WARN_STREAM(name_ << ": dropped: " << cause);
}

void StageDiagnostics::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  unsigned all = 0;
  for (const auto& [cause, count] : dropped_) all += count;
  using diagnostic_msgs::DiagnosticStatus;
  if (!complaint_.empty())
    status.summary(DiagnosticStatus::ERROR, complaint_);
  else if (all > 0)
    status.summary(DiagnosticStatus::WARN, "messages were dropped");
  else
    status.summary(processed_ > 0 ? DiagnosticStatus::OK : DiagnosticStatus::STALE, "");
  status.add("processed", processed_);
  status.add("dropped", all);
  status.addf("mean_ms", "%.2f", processed_ > 0 ? 1e3 * busy_s_ / processed_ : 0.0);
  status.addf("longest_ms", "%.2f", 1e3 * longest_s_);
  for (const auto& [name, value] : told_) status.add(name, value());
  for (const auto& [cause, count] : dropped_) status.add("dropped: " + cause, count);
}

}  // namespace cornerstone
