// Brings the images of two or three cameras together by their stamps, and tells which sets stay incomplete
// and why.
#pragma once

#include <image_transport/subscriber_filter.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>

#include <array>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "cornerstone/ros/diagnostics.h"
#include "cornerstone/ros/nodelet_params.h"

namespace cornerstone {

constexpr std::array<const char*, 3> kCameras{"reference", "right", "top"};

struct ImageSet {
  std::array<sensor_msgs::ImageConstPtr, 3> images;  // by kCameras; the last is null without a third camera
  ros::WallTime taken;
};

class ImageSets {
 public:
  using Take = std::function<void(const ImageSet&)>;
  ImageSets(ros::NodeHandle& node, const TrinocularStereoParams& params, StageDiagnostics& diagnostics,
            Take take);
  ImageSets(const ImageSets&) = delete;
  ImageSets& operator=(const ImageSets&) = delete;

 private:
  using Image = sensor_msgs::ImageConstPtr;
  using Two = message_filters::sync_policies::ApproximateTime<sensor_msgs::Image, sensor_msgs::Image>;
  using Three = message_filters::sync_policies::ApproximateTime<sensor_msgs::Image, sensor_msgs::Image,
                                                                sensor_msgs::Image>;

  void synchronise();
  template <typename Synchroniser>
  void configure(Synchroniser& synchroniser, int cameras) const;
  void hear(std::size_t camera, const Image& image);
  void await(const Image& reference);
  void countLost(const Image& reference);
  void dropAwaited();
  // Why the set of a reference image with this stamp is not complete.
  std::string causeOf(ros::Time stamp) const;
  void takePair(const Image& reference, const Image& right);
  void complete(const Image& reference, const Image& right, const Image& third);

  TrinocularStereoParams params_;
  std::array<std::string, 3> names_;
  StageDiagnostics& diagnostics_;
  Take take_;
  image_transport::ImageTransport transport_;
  std::array<image_transport::SubscriberFilter, 3> images_;
  bool any_set_ = false;
  int before_first_set_ = 0;                    // reference images
  std::deque<ros::Time> awaited_;               // stamps of reference images whose set is not complete yet
  std::array<std::deque<ros::Time>, 3> heard_;  // stamps of each camera's newest images
  std::optional<unsigned> last_reference_;      // its number, which its publisher counts
  ros::Time third_heard_;                       // stamp of the third camera's newest image
  std::optional<message_filters::Synchronizer<Two>> two_;
  std::optional<message_filters::Synchronizer<Three>> three_;
};

}  // namespace cornerstone
