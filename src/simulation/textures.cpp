#include "textures.h"

#include <opencv2/imgproc.hpp>

namespace cornerstone {
namespace {

constexpr int kTexels = 512;        // a side; a power of two, as mipmaps like it
constexpr double kTexel_m = 0.008;  // finer than what 160 px over 90 degrees resolve beyond 0.6 m

// Smooth periodic noise of zero mean and the given spread, with details of about `cell` texels.
cv::Mat1f noise(cv::RNG& rng, cv::Size cell, double sigma) {
  cv::Mat1f coarse(std::max(kTexels / cell.height, 2), std::max(kTexels / cell.width, 2));
  rng.fill(coarse, cv::RNG::NORMAL, 0.0, sigma);
  constexpr int kMargin = 2;
  cv::Mat1f padded, fine;
  cv::copyMakeBorder(coarse, padded, kMargin, kMargin, kMargin, kMargin, cv::BORDER_WRAP);
  const double scale_x = double(kTexels) / coarse.cols, scale_y = double(kTexels) / coarse.rows;
  cv::resize(padded, fine, {}, scale_x, scale_y, cv::INTER_CUBIC);
  const cv::Point corner(cvRound(kMargin * scale_x), cvRound(kMargin * scale_y));
  return fine(cv::Rect(corner, cv::Size(kTexels, kTexels))).clone();
}

cv::Mat1f grain(cv::RNG& rng, double base, double sigma) {
  cv::Mat1f image(kTexels, kTexels, float(base));
  for (const int cell : {2, 5, 12, 32}) image += noise(rng, {cell, cell}, sigma);
  image += noise(rng, {128, 128}, 1.5 * sigma);
  return image;
}

double between(cv::RNG& rng, double low, double high) { return rng.uniform(low, high); }

// Scuffs, filled holes and stains: thin and faint, more of them near the floor.
void addMarks(cv::RNG& rng, cv::Mat1f& image, int count) {
  for (int i = 0; i < count; ++i) {
    const double height = between(rng, 0, 1);
    const cv::Point2d at(between(rng, 20, kTexels - 20), kTexels * (1 - height * height));
    const double angle = between(rng, -0.6, 0.6), length = between(rng, 2, 22);
    const cv::Point2d end = at + cv::Point2d(std::cos(angle), std::sin(angle)) * length;
    const float change = float(between(rng, -28, 14));
    const int row = std::clamp(int(at.y), 0, kTexels - 1), col = std::clamp(int(at.x), 0, kTexels - 1);
    cv::line(image, at, end, cv::Scalar(image(row, col) + change), rng.uniform(1, 3), cv::LINE_AA);
  }
}

// Walls: row 0 is at 4.1 m, the last row on the floor. Darker towards the floor, and a skirting board.
void addWallShading(cv::Mat1f& image, double skirting_grey) {
  for (int row = 0; row < image.rows; ++row) {
    const double z_m = (image.rows - 0.5 - row) * kTexel_m;
    const double shade = -14 * std::exp(-z_m / 0.25);
    image.row(row) += cv::Scalar(shade);
    if (z_m < 0.08) image.row(row) += cv::Scalar(skirting_grey - 160);
    if (z_m >= 0.08 && z_m < 0.09) image.row(row) -= cv::Scalar(45);
  }
}

struct WallLook {
  double grey, grain_sigma;
  int marks;
  double skirting_grey;
};

cv::Mat1f wall(cv::RNG& rng, const WallLook& look) {
  cv::Mat1f image = grain(rng, look.grey, look.grain_sigma);
  addMarks(rng, image, look.marks);
  addWallShading(image, look.skirting_grey);
  return image;
}

cv::Mat1f wood(cv::RNG& rng) {
  cv::Mat1f image = grain(rng, 128, 1.5);
  image += noise(rng, {4, 64}, 6) + noise(rng, {12, 128}, 6);
  return image;
}

// Fronts of drawers and doors, 0.41 m wide, with gaps, handles and labels.
cv::Mat1f cabinet(cv::RNG& rng) {
  cv::Mat1f image = grain(rng, 150, 2.0);
  constexpr int kDoor = kTexels / 10;
  for (int col = 0; col + kDoor <= kTexels; col += kDoor) {
    const int drawer = kDoor * rng.uniform(2, 6) / 3;
    for (int row = kTexels; row > 0; row -= drawer) {
      const cv::Rect front(col, row - drawer, kDoor, drawer);
      cv::rectangle(image, front, cv::Scalar(95 + between(rng, -8, 8)), 1);
      const cv::Point handle(col + kDoor / 2, row - drawer + 8);
      cv::rectangle(image, {handle.x - 7, handle.y - 1, 14, 3}, cv::Scalar(80), cv::FILLED);
      if (rng.uniform(0, 3) == 0)
        cv::rectangle(image, {handle.x - 10, handle.y + 8, 18, 9}, cv::Scalar(between(rng, 180, 220)),
                      cv::FILLED);
    }
  }
  return image;
}

// Shelves 0.35 m apart with the backs of books and folders.
cv::Mat1f books(cv::RNG& rng) {
  cv::Mat1f image(kTexels, kTexels, 60.F);
  constexpr int kShelf = 44;
  for (int bottom = kTexels; bottom > 0; bottom -= kShelf) {
    for (int col = 0; col < kTexels;) {
      const int width = rng.uniform(3, 10), height = rng.uniform(26, 38);
      const double grey = between(rng, 60, 210);
      cv::rectangle(image, {col, bottom - height - 3, width, height}, cv::Scalar(grey), cv::FILLED);
      cv::rectangle(image, {col, bottom - height + rng.uniform(3, 14), width, rng.uniform(2, 8)},
                    cv::Scalar(between(rng, 60, 220)), cv::FILLED);
      col += width;
    }
    cv::rectangle(image, {0, bottom - 3, kTexels, 3}, cv::Scalar(165), cv::FILLED);
  }
  image += noise(rng, {2, 2}, 2.0);
  return image;
}

void drawPoster(cv::RNG& rng, cv::Mat1f poster) {
  poster.setTo(between(rng, 170, 235));
  const cv::Rect picture(10, 12, poster.cols - 20, poster.rows / 2 - 16);
  poster(picture).setTo(between(rng, 70, 150));
  for (int i = 0; i < 9; ++i) {
    const cv::Point at(rng.uniform(picture.x + 14, picture.br().x - 14),
                       rng.uniform(picture.y + 14, picture.br().y - 14));
    cv::circle(poster, at, rng.uniform(3, 13), cv::Scalar(between(rng, 30, 220)), cv::FILLED, cv::LINE_AA);
  }
  for (int row = poster.rows / 2 + 6; row < poster.rows - 8; row += 7) {
    for (int col = 12; col < poster.cols - 16;) {
      const int word = std::min(rng.uniform(4, 18), poster.cols - 12 - col);
      cv::rectangle(poster, {col, row, word, 3}, cv::Scalar(70), cv::FILLED);
      col += word + 4;
    }
  }
}

cv::Mat1f posters(cv::RNG& rng) {
  cv::Mat1f image(kTexels, kTexels);
  const cv::Size size(kTexels / kPosterColumns, kTexels / kPosterRows);
  for (int row = 0; row < kPosterRows; ++row)
    for (int col = 0; col < kPosterColumns; ++col)
      drawPoster(rng, image(cv::Rect({col * size.width, row * size.height}, size)));
  return image;
}

// Tiles of 0.585 m: 7 to a texture.
cv::Mat1f ceiling(cv::RNG& rng) {
  cv::Mat1f image = grain(rng, 205, 2.0);
  for (int i = 0; i < 7; ++i) {
    const int at = i * kTexels / 7;
    image.row(at) -= cv::Scalar(40);
    image.col(at) -= cv::Scalar(40);
  }
  for (const int tile : {1, 4})
    for (const int other : {2, 5})
      image(cv::Rect(tile * kTexels / 7 + 4, other * kTexels / 7 + 4, 65, 65)).setTo(245);
  return image;
}

// Boards and shutters, 3 to 15 cm high, that run along the wall: nothing to tell one place of a row from the
// next.
cv::Mat1f stripes(cv::RNG& rng) {
  cv::Mat1f image(kTexels, kTexels);
  for (int row = 0; row < kTexels;) {
    const int end = std::min(row + rng.uniform(4, 20), kTexels);
    image.rowRange(row, end) = between(rng, 70, 200);
    row = end;
  }
  return image;
}

cv::Mat1f surface(Material material, cv::RNG& rng) {
  switch (material) {
    case Material::kPlaster:
      return wall(rng, {168, 2.6, 90, 110});
    case Material::kPaint:
      return wall(rng, {150, 1.6, 60, 90});
    case Material::kConcrete:
      return wall(rng, {130, 4.5, 160, 150});
    case Material::kWood:
      return wood(rng);
    case Material::kMetal:
      return grain(rng, 105, 2.0);
    case Material::kCabinet:
      return cabinet(rng);
    case Material::kFabric:
      return grain(rng, 92, 5.0);
    case Material::kBooks:
      return books(rng);
    case Material::kPoster:
      return posters(rng);
    case Material::kCarpet:
      return grain(rng, 100, 4.0);
    case Material::kCeiling:
      return ceiling(rng);
    case Material::kRobot:
      return grain(rng, 60, 10.0);
    case Material::kStripes:
      return stripes(rng);
  }
  throw std::logic_error("makeTexture: unknown material");
}

}  // namespace

Texture makeTexture(Material material, std::uint64_t seed) {
  cv::RNG rng(seed * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(material) + 1);
  Texture texture;
  surface(material, rng).convertTo(texture.grey, CV_8U);
  texture.width_m = texture.height_m = kTexels * kTexel_m;
  return texture;
}

}  // namespace cornerstone
