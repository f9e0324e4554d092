#include "nodelets/image_sets.h"

#include <algorithm>
#include <boost/bind/bind.hpp>

namespace cornerstone {
namespace {

constexpr int kStartImages = 30;  // reference images without a set before one counts as missing: 3 s at 10 Hz

}  // namespace

ImageSets::ImageSets(ros::NodeHandle& node, const TrinocularStereoParams& params,
                     StageDiagnostics& diagnostics, Take take)
    : params_(params), diagnostics_(diagnostics), take_(std::move(take)), transport_(node) {
  const std::size_t count = params_.third_camera ? 3 : 2;
  for (std::size_t i = 0; i < count; ++i)
    images_[i].subscribe(transport_, std::string(kCameras[i]) + "/" + params_.images,
                         static_cast<unsigned>(params_.queue_size));
  synchronise();
}

void ImageSets::synchronise() {
  namespace p = boost::placeholders;
  const auto queue = static_cast<unsigned>(params_.queue_size);
  const ros::Duration tolerance(params_.sync_tolerance_s);
  images_[0].registerCallback(boost::bind(&ImageSets::await, this, p::_1));
  if (params_.third_camera) {
    images_[2].registerCallback(boost::bind(&ImageSets::hearThird, this, p::_1));
    three_.emplace(Three(queue), images_[0], images_[1], images_[2]);
    three_->setMaxIntervalDuration(tolerance);
    three_->registerCallback(boost::bind(&ImageSets::complete, this, p::_1, p::_2, p::_3));
  }
  if (params_.third_camera && !(params_.third_camera_silence_s > 0)) return;
  two_.emplace(Two(queue), images_[0], images_[1]);
  two_->setMaxIntervalDuration(tolerance);
  two_->registerCallback(boost::bind(&ImageSets::takePair, this, p::_1, p::_2));
}

// Remembers each reference image until its set is complete, so that incomplete sets are counted.
void ImageSets::await(const Image& reference) {
  // At the start the cameras' connections come one by one.
  if (!any_set_ && ++before_first_set_ < kStartImages) return;
  awaited_.push_back(reference->header.stamp);
  if (awaited_.size() > static_cast<std::size_t>(params_.queue_size)) dropAwaited();
}

void ImageSets::dropAwaited() {
  awaited_.pop_front();
  diagnostics_.dropped("a set of images is incomplete: a camera is silent or its stamps differ");
}

// With three cameras, a pair goes on alone when the third camera has been silent for long.
void ImageSets::takePair(const Image& reference, const Image& right) {
  const ros::Time stamp = reference->header.stamp;
  if (params_.third_camera) {
    if (third_heard_.isZero() || stamp < third_heard_ - ros::Duration(params_.third_camera_silence_s))
      third_heard_ = stamp;  // the first set, or time has jumped back
    if ((stamp - third_heard_).toSec() < params_.third_camera_silence_s) return;
  }
  complete(reference, right, Image());
}

void ImageSets::complete(const Image& reference, const Image& right, const Image& third) {
  any_set_ = true;
  while (!awaited_.empty() && awaited_.front() < reference->header.stamp) dropAwaited();
  if (!awaited_.empty() && awaited_.front() == reference->header.stamp) awaited_.pop_front();
  take_({{reference, right, third}, ros::WallTime::now()});
}

}  // namespace cornerstone
