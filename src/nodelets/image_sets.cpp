#include "nodelets/image_sets.h"

#include <algorithm>
#include <boost/bind/bind.hpp>

namespace cornerstone {
namespace {

constexpr int kStartImages = 30;  // reference images without a set before one counts as missing: 3 s at 10 Hz
constexpr std::size_t kRemembered = 64;  // stamps of each camera: more than any queue of sets in use
constexpr unsigned kLargestGap = 1000;   // of one publisher's numbers: 100 s at 10 Hz

}  // namespace

ImageSets::ImageSets(ros::NodeHandle& node, const TrinocularStereoParams& params,
                     StageDiagnostics& diagnostics, Take take)
    : params_(params), diagnostics_(diagnostics), take_(std::move(take)), transport_(node) {
  const std::size_t count = params_.third_camera ? 3 : 2;
  for (std::size_t i = 0; i < count; ++i) {
    names_[i] = node.resolveName(kCameras[i]);
    images_[i].subscribe(transport_, std::string(kCameras[i]) + "/" + params_.images,
                         static_cast<unsigned>(params_.queue_size));
    images_[i].registerCallback([this, i](const Image& image) { hear(i, image); });
  }
  synchronise();
}

// Stamps may differ by the tolerance. Images of one camera are taken to be at least twice that apart, or a
// set would be complete only when the next one has begun.
template <typename Synchroniser>
void ImageSets::configure(Synchroniser& synchroniser, int cameras) const {
  const ros::Duration tolerance(params_.sync_tolerance_s);
  synchroniser.setMaxIntervalDuration(tolerance);
  for (int i = 0; i < cameras; ++i) synchroniser.getPolicy()->setInterMessageLowerBound(i, tolerance * 2);
}

void ImageSets::synchronise() {
  namespace p = boost::placeholders;
  const auto queue = static_cast<unsigned>(params_.queue_size);
  if (params_.third_camera) {
    three_.emplace(Three(queue), images_[0], images_[1], images_[2]);
    configure(*three_, 3);
    three_->registerCallback(boost::bind(&ImageSets::complete, this, p::_1, p::_2, p::_3));
  }
  if (params_.third_camera && !(params_.third_camera_silence_s > 0)) return;
  two_.emplace(Two(queue), images_[0], images_[1]);
  configure(*two_, 2);
  two_->registerCallback(boost::bind(&ImageSets::takePair, this, p::_1, p::_2));
}

void ImageSets::hear(std::size_t camera, const Image& image) {
  std::deque<ros::Time>& heard = heard_[camera];
  if (!heard.empty() && image->header.stamp < heard.back()) heard.clear();  // time has jumped back
  heard.push_back(image->header.stamp);
  if (heard.size() > kRemembered) heard.pop_front();
  if (camera == 0) await(image);
  if (camera == 2) third_heard_ = image->header.stamp;
}

// Remembers each reference image until its set is complete, so that incomplete sets are counted.
void ImageSets::await(const Image& reference) {
  countLost(reference);
  // At the start the cameras' connections come one by one.
  if (!any_set_ && ++before_first_set_ < kStartImages) return;
  awaited_.push_back(reference->header.stamp);
  if (awaited_.size() > static_cast<std::size_t>(params_.queue_size)) dropAwaited();
}

// Images that were thrown away before they came here leave gaps in what their publisher counts.
void ImageSets::countLost(const Image& reference) {
  const unsigned number = reference->header.seq, expected = last_reference_ ? *last_reference_ + 1 : number;
  last_reference_ = number;
  if (number < expected || number - expected > kLargestGap) return;  // another publisher
  for (unsigned lost = expected; lost < number; ++lost)
    diagnostics_.dropped(names_[0] + ": the queue was full, images come faster than they are matched");
}

void ImageSets::dropAwaited() {
  const std::string cause = causeOf(awaited_.front());
  awaited_.pop_front();
  diagnostics_.dropped(cause);
}

std::string ImageSets::causeOf(ros::Time stamp) const {
  const ros::Duration tolerance(params_.sync_tolerance_s);
  for (std::size_t i = 1; i < (params_.third_camera ? 3 : 2); ++i) {
    const std::deque<ros::Time>& heard = heard_[i];
    if (heard.empty() || heard.back() < stamp - tolerance)
      return names_[i] + ": no image, the camera is silent";
    const bool in_time = std::any_of(heard.begin(), heard.end(), [&](ros::Time other) {
      return other >= stamp - tolerance && other <= stamp + tolerance;
    });
    if (!in_time)
      return names_[i] + ": its stamps differ from the reference camera's by more than sync_tolerance_s";
  }
  return "the queue of sets was full";
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
