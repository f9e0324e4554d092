#include "cornerstone/stereo/secondary_view.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace cornerstone {
namespace {

constexpr int kVector_bytes = 64;  // kernels read whole vectors

// std::reverse_copy and cv::flip go byte by byte.
void reverseRow(const std::uint8_t* from, int count, std::uint8_t* to) {
  constexpr int kTogether = 8;
  int x = 0;
  for (; x + kTogether <= count; x += kTogether) {
    std::uint64_t together = 0;
    std::memcpy(&together, from + x, kTogether);
    together = __builtin_bswap64(together);
    std::memcpy(to + count - kTogether - x, &together, kTogether);
  }
  std::reverse_copy(from + x, from + count, to);
}

}  // namespace

void SecondaryView::prepare(const GradientFeatures& features, const cv::Point2d& shift, int disparities) {
  features_ = &features;
  shift_fixed_ = cv::Point2d(shift.x * (1 << kFractionBits), shift.y * (1 << kFractionBits));
  vertical_ = std::abs(shift.y) > std::abs(shift.x);
  backwards_ = (vertical_ ? shift.y : shift.x) < 0;
  disparities_ = disparities;
  steps_.resize(static_cast<std::size_t>(disparities));
  unit_ = true;
  for (int i = 0; i < disparities; ++i) {
    const cv::Point offset = offsetAt(i + 1);
    int& step = steps_[static_cast<std::size_t>(i)];
    step = std::abs(vertical_ ? offset.y : offset.x);
    unit_ = unit_ && step == i + 1;
  }
  countSeen();
  const cv::Rect image(0, 0, lineLength(), lineCount());
  for (std::size_t c = 0; c < lines_.size(); ++c) {
    const bool fresh =
        lines_[c].rows != image.height || lines_[c].cols != image.width + disparities + kVector_bytes;
    lines_[c].create(image.height, image.width + disparities + kVector_bytes);
    if (fresh) lines_[c].setTo(0);
    cv::Mat1b ordered = lines_[c](image);
    const cv::Mat1b* along = &features.channel(c);
    if (vertical_) {
      cv::transpose(*along, turned_);
      along = &turned_;
    }
    for (int line = 0; line < image.height; ++line)
      if (backwards_)
        reverseRow((*along)[line], image.width, ordered[line]);
      else
        std::copy_n((*along)[line], image.width, ordered[line]);
  }
}

// Where shifts are no whole pixels, the features are fetched one by one.
void SecondaryView::gather(int row, const cv::Range& columns, Gathered& gathered) const {
  const int length = lineLength();
  for (std::size_t c = 0; c < lines_.size(); ++c) {
    const int bytes = columns.size() * disparities_ + kVector_bytes;
    if (gathered[c].cols < bytes) gathered[c].create(1, bytes);
    std::uint8_t* out = gathered[c][0];
    for (int x = columns.start; x < columns.end; ++x) {
      const int at = vertical_ ? row : x, from = backwards_ ? length - 1 - at : at;
      const std::uint8_t* line = lines_[c][vertical_ ? x : row] + from;
      const int end = length - from;
      for (int i = 0; i < disparities_; ++i, ++out) {
        const int step = steps_[static_cast<std::size_t>(i)];
        *out = step < end ? line[step] : std::uint8_t{0};
      }
    }
  }
}

void SecondaryView::countSeen() {
  const cv::Size size = features_->size();
  const auto seenFrom = [&](int at) {
    const int room = backwards_ ? at : lineLength() - 1 - at;
    return static_cast<short>(std::upper_bound(steps_.begin(), steps_.end(), room) - steps_.begin());
  };
  seen_.resize(static_cast<std::size_t>(vertical_ ? size.height : 1));
  for (std::vector<short>& row : seen_) row.resize(static_cast<std::size_t>(size.width));
  for (int at = 0; at < lineLength(); ++at) {
    if (vertical_)
      std::fill(seen_[static_cast<std::size_t>(at)].begin(), seen_[static_cast<std::size_t>(at)].end(),
                seenFrom(at));
    else
      seen_[0][static_cast<std::size_t>(at)] = seenFrom(at);
  }
}

SeenLines SecondaryView::linesOf(int row, const cv::Range& columns, Gathered& gathered) const {
  SeenLines lines;
  lines.seen = seenOf(row) + columns.start;
  if (!unit_) {
    gather(row, columns, gathered);
    for (std::size_t c = 0; c < lines_.size(); ++c) lines.lines[c] = gathered[c][0];
    lines.step = disparities_;
    return lines;
  }
  const int length = lineLength(), at = vertical_ ? row : 0;
  lines.step = vertical_ ? static_cast<std::ptrdiff_t>(lines_[0].step) : backwards_ ? -1 : 1;
  for (std::size_t c = 0; c < lines_.size(); ++c)
    lines.lines[c] =
        lines_[c][vertical_ ? 0 : row] + (backwards_ ? length - at : at + 1) + columns.start * lines.step;
  return lines;
}

}  // namespace cornerstone
