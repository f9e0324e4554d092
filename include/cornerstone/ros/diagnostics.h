// Counts what a nodelet did and what it dropped, by cause, and reports both as diagnostics and on demand.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>

#include <functional>
#include <map>
#include <string>
#include <utility>

namespace cornerstone {

class StageDiagnostics {
 public:
  StageDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const std::string& stage);
  void processed(double seconds);
  // Logs the cause (once in ten seconds for each) and counts it.
  void dropped(const std::string& cause);
  // Something that is wrong as long as it is not cleared by an empty text.
  void complain(const std::string& complaint) { complaint_ = complaint; }
  // A value beside the counts, asked for at each report.
  void tell(const std::string& name, std::function<std::string()> value) { told_[name] = std::move(value); }

 private:
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  std::string name_;
  diagnostic_updater::Updater updater_;
  ros::SteadyTimer timer_;
  unsigned processed_ = 0;
  double busy_s_ = 0;
  double longest_s_ = 0;
  std::map<std::string, unsigned> dropped_;
  std::map<std::string, ros::WallTime> logged_;
  std::map<std::string, std::function<std::string()>> told_;
  std::string complaint_;
};

}  // namespace cornerstone
