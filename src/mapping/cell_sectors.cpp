#include "cell_sectors.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>

namespace cornerstone {
namespace {

using Floats = cv::v_float32;
using Ints = cv::v_int32;

Floats floatsOf(double value) { return cv::vx_setall_f32(static_cast<float>(value)); }

// Within 2e-6 rad. Polynomial of Hastings, Approximations for Digital Computers (1955), sheet 13.
Floats arcTangent(const Floats& y, const Floats& x) {
  const Floats ax = cv::v_abs(x), ay = cv::v_abs(y), zero = cv::vx_setzero_f32();
  const Floats z = cv::v_min(ax, ay) / cv::v_max(cv::v_max(ax, ay), floatsOf(1e-30)), z2 = z * z;
  Floats sum = floatsOf(-0.0117212);
  for (const double factor : {0.05265332, -0.11643287, 0.19354346, -0.33262347, 0.99997726})
    sum = sum * z2 + floatsOf(factor);
  Floats angle = sum * z;
  angle = cv::v_select(ay > ax, floatsOf(M_PI / 2) - angle, angle);
  angle = cv::v_select(x < zero, floatsOf(M_PI) - angle, angle);
  return cv::v_select(y < zero, zero - angle, angle);
}

}  // namespace

CellSectors::CellSectors(const GridGeometry& grid, const Pose2& grid_from_sensor, const BearingTable& table)
    : grid_(grid),
      sensor_m_(grid_from_sensor.translation()),
      ahead_(grid_from_sensor.rotation().col(0).cast<float>()),
      left_(grid_from_sensor.rotation().col(1).cast<float>()),
      table_(table) {
  const std::size_t room = index(grid.cols) + Floats::nlanes;  // whole vectors are written
  for (std::size_t col = 0; col < room; ++col)
    to_right_m_.push_back(static_cast<float>(grid.centreOf({static_cast<int>(col), 0}).x() - sensor_m_.x()));
  range_m_.resize(room);
  first_.resize(room);
  last_.resize(room);
}

CellSectors::Columns CellSectors::look(int row, double reach_m) {
  const double up_m = grid_.centreOf({0, row}).y() - sensor_m_.y();
  const double half_m = std::sqrt(std::max(0.0, reach_m * reach_m - up_m * up_m));
  const double sensor_col = grid_.toCells(sensor_m_).x(), half_cols = half_m / grid_.resolution_m;
  const Columns columns{std::max(0, static_cast<int>(std::ceil(sensor_col - half_cols))),
                        std::min(grid_.cols, static_cast<int>(std::floor(sensor_col + half_cols)) + 1)};
  const Floats ahead_up = floatsOf(ahead_.y() * up_m), left_up = floatsOf(left_.y() * up_m);
  const Floats ahead_x = cv::vx_setall_f32(ahead_.x()), left_x = cv::vx_setall_f32(left_.x());
  const Floats start = floatsOf(table_.start_rad), per_rad = floatsOf(1 / table_.step_rad);
  const Floats cell_m = floatsOf(grid_.resolution_m),
               half_cell = floatsOf(0.5 * grid_.resolution_m / table_.step_rad);
  const Ints few = cv::vx_setall_s32(2);
  for (int col = columns.begin; col < columns.end; col += Floats::nlanes) {
    const Floats right = cv::vx_load(&to_right_m_[index(col)]);
    const Floats x = ahead_x * right + ahead_up, y = left_x * right + left_up;
    const Floats range = cv::v_sqrt(x * x + y * y);
    const Floats centre = (arcTangent(y, x) - start) * per_rad, half = half_cell / cv::v_max(range, cell_m);
    const Ints first = cv::v_floor(centre - half), last = cv::v_floor(centre + half);
    const Ints middle = cv::v_floor(centre), wide = last - first > few;
    cv::v_store(&range_m_[index(col)], range);
    cv::v_store(&first_[index(col)], cv::v_select(wide, first, middle));
    cv::v_store(&last_[index(col)], cv::v_select(wide, last, middle));
  }
  return columns;
}

}  // namespace cornerstone
