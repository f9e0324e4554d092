#include "tools/calibration_bag.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "cornerstone/base/errors.h"
#include "cornerstone/ros/image_messages.h"

namespace cornerstone {
namespace {

using Corners = std::vector<cv::Point2f>;
using CornersByStamp = std::map<ros::Time, Corners>;

// A board none of whose corners has moved by more, of the image's width, is the same once more: it adds time,
// no knowledge. Where so many sets are left that solving takes minutes, they must differ by more.
constexpr double kSameBoard_width = 0.01;
constexpr double kWider = 1.5;
constexpr std::size_t kMostSets = 60;

// Every topic must be there and hold images.
void requireTopics(rosbag::Bag& bag, const CalibrationBag& source) {
  std::map<std::string, std::string> types;
  rosbag::View all(bag);
  for (const rosbag::ConnectionInfo* connection : all.getConnections())
    types[connection->topic] = connection->datatype;
  std::string known;
  for (const auto& [topic, type] : types) known += (known.empty() ? "" : ", ") + topic;
  for (const std::string& topic : source.topics) {
    const auto found = types.find(topic);
    if (found == types.end())
      throw InputError(source.path + ": no topic " + topic + "; it holds " +
                       (known.empty() ? "none" : known));
    if (found->second != "sensor_msgs/Image" && found->second != "sensor_msgs/CompressedImage")
      throw InputError(source.path + ": topic " + topic + " is of type " + found->second + ", no images");
  }
}

struct StampedImage {
  ros::Time stamp;
  cv::Mat1b grey;
};

StampedImage imageOf(const rosbag::MessageInstance& message, const std::string& name) {
  if (const auto image = message.instantiate<sensor_msgs::Image>())
    return {image->header.stamp, toGrey(image, name).clone()};
  const auto packed = message.instantiate<sensor_msgs::CompressedImage>();
  const cv::Mat1b grey = cv::imdecode(packed->data, cv::IMREAD_GRAYSCALE);
  if (grey.empty()) throw InputError(name + ": format '" + packed->format + "' cannot be read as an image");
  return {packed->header.stamp, grey};
}

// The entry whose stamp is nearest, if it is near enough.
const Corners* at(const CornersByStamp& corners, ros::Time stamp, double tolerance_s) {
  const Corners* nearest = nullptr;
  double apart_s = tolerance_s;
  const auto after = corners.lower_bound(stamp);
  for (auto it = after == corners.begin() ? after : std::prev(after); it != corners.end(); ++it) {
    const double here_s = std::abs((it->first - stamp).toSec());
    if (here_s <= apart_s) nearest = &it->second, apart_s = here_s;
    if (it->first > stamp) break;
  }
  return nearest;
}

double largestDistance(const Corners& a, const Corners& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, cv::norm(a[i] - b[i]));
  return largest;
}

// Sets of the stamps at which the reference camera has seen a board.
std::vector<CameraViews> setsOf(const std::vector<CornersByStamp>& seen, double tolerance_s,
                                double same_board_px) {
  const std::vector<std::string> names{"reference", "right", "top"};
  std::vector<CameraViews> views(seen.size());
  for (std::size_t i = 0; i < views.size(); ++i) views[i].name = names[i];
  for (const auto& [stamp, corners] : seen[0]) {
    const auto same = [&, &board = corners](const Corners& kept) {
      return largestDistance(kept, board) <= same_board_px;
    };
    if (std::any_of(views[0].corners.begin(), views[0].corners.end(), same)) continue;
    std::vector<Corners> set{corners};
    for (std::size_t i = 1; i < seen.size(); ++i) {
      const Corners* other = at(seen[i], stamp, tolerance_s);
      set.push_back(other ? *other : Corners());
    }
    if (std::all_of(set.begin() + 1, set.end(), [](const Corners& other) { return other.empty(); })) continue;
    for (std::size_t i = 0; i < set.size(); ++i) views[i].corners.push_back(set[i]);
  }
  return views;
}

}  // namespace

std::vector<CameraViews> viewsInBag(const CalibrationBag& source, const Chessboard& board, cv::Size& size) {
  rosbag::Bag bag;
  try {
    bag.open(source.path, rosbag::bagmode::Read);
  } catch (const rosbag::BagException& error) {
    throw InputError(source.path + ": cannot be read as a bag: " + error.what());
  }
  requireTopics(bag, source);
  std::vector<CornersByStamp> seen(source.topics.size());
  for (const rosbag::MessageInstance& message : rosbag::View(bag, rosbag::TopicQuery(source.topics))) {
    const std::string name = source.path + ", " + message.getTopic();
    const StampedImage image = imageOf(message, name);
    if (size.empty()) size = image.grey.size();
    if (image.grey.size() != size) throw InputError(name + ": size differs from that of the images before");
    const auto camera = std::find(source.topics.begin(), source.topics.end(), message.getTopic());
    Corners corners = findCorners(image.grey, board);
    if (!corners.empty())
      seen[static_cast<std::size_t>(camera - source.topics.begin())][image.stamp] = corners;
  }
  double same_board_px = kSameBoard_width * size.width;
  std::vector<CameraViews> views = setsOf(seen, source.tolerance_s, same_board_px);
  while (views[0].corners.size() > kMostSets)
    views = setsOf(seen, source.tolerance_s, same_board_px *= kWider);
  return views;
}

}  // namespace cornerstone
