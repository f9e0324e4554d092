#include "cornerstone/stereo/box_sums.h"

namespace cornerstone {
namespace {

void addRow(const std::uint8_t* row, int width, std::uint16_t* columns) {
  for (int x = 0; x < width; ++x) columns[x] = static_cast<std::uint16_t>(columns[x] + row[x]);
}

void exchangeRows(const std::uint8_t* entering, const std::uint8_t* leaving, int width,
                  std::uint16_t* columns) {
  for (int x = 0; x < width; ++x)
    columns[x] = static_cast<std::uint16_t>(columns[x] + entering[x] - leaving[x]);
}

}  // namespace

int mirrored(int at, int count) {
  while (at < 0 || at >= count) at = at < 0 ? -1 - at : 2 * count - 1 - at;
  return at;
}

void BoxSums::compute(const cv::Mat1b& image, int window_px, cv::Mat1s& sums) {
  const int rows = image.rows, width = image.cols, radius = window_px / 2;
  sums.create(image.size());
  columns_.assign(static_cast<std::size_t>(width + 2 * radius), 0);
  std::uint16_t* columns = columns_.data() + radius;
  for (int i = -radius; i <= radius; ++i) addRow(image[mirrored(i, rows)], width, columns);
  for (int y = 0; y < rows; ++y) {
    if (y > 0)
      exchangeRows(image[mirrored(y + radius, rows)], image[mirrored(y - 1 - radius, rows)], width, columns);
    for (int i = 1; i <= radius; ++i) {
      columns[-i] = columns[mirrored(-i, width)];
      columns[width - 1 + i] = columns[mirrored(width - 1 + i, width)];
    }
    short* out = sums[y];
    for (int x = 0; x < width; ++x) out[x] = static_cast<short>(columns[x]);
    for (int i = 1; i <= radius; ++i)
      for (int x = 0; x < width; ++x) out[x] = static_cast<short>(out[x] + columns[x - i] + columns[x + i]);
  }
}

}  // namespace cornerstone
