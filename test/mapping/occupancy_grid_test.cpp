#include "cornerstone/mapping/occupancy_grid.h"

#include <gtest/gtest.h>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

constexpr float kOccupied = 0.65F, kFree = 0.196F;

// Beams over 90 degrees, all to a wall x = 2 m.
RangeScan wallAt(double x_m, double sigma_m) {
  RangeScan scan;
  for (int i = -40; i <= 40; ++i) {
    Beam beam;
    beam.bearing_rad = i * M_PI / 180;
    beam.width_rad = M_PI / 180;
    beam.hit = true;
    beam.range_m = x_m / std::cos(beam.bearing_rad);
    beam.sigma_m = sigma_m;
    beam.near_m = beam.range_m - 2 * sigma_m;
    beam.far_m = beam.range_m + 2 * sigma_m;
    beam.clear_m = beam.near_m;
    scan.beams.push_back(beam);
  }
  return scan;
}

float at(const OccupancyGrid& grid, double x_m, double y_m) {
  const GridMap map = grid.snapshot();
  const Cell cell = map.geometry.cellAt({x_m, y_m});
  return map.geometry.contains(cell) ? map.occupied(cell.row, cell.col) : kUnseen;
}

TEST(OccupancyGrid, FreeBeforeOccupiedAtUnseenBehind) {
  OccupancyGrid grid({});
  for (int look = 0; look < 4; ++look) grid.insert(wallAt(2.025, 0.02), {});
  EXPECT_LT(at(grid, 1, 0.02), kFree);
  EXPECT_LT(at(grid, 1.8, 0.02), kFree);
  EXPECT_GT(at(grid, 2.02, 0.02), kOccupied);
  EXPECT_GT(at(grid, 2.02, 1.02), kOccupied);
  EXPECT_EQ(at(grid, 2.4, 0.02), kUnseen);
  EXPECT_EQ(at(grid, -0.5, 0.02), kUnseen);  // behind the sensor
  EXPECT_EQ(at(grid, 0.1, 1.5), kUnseen);    // outside the view
}

TEST(OccupancyGrid, OneVagueLookMakesNoWallButSpreadsItsEvidence) {
  GridParams params;
  params.max_sigma_m = 0.5;
  OccupancyGrid grid(params);
  grid.insert(wallAt(4.025, 0.3), {});
  EXPECT_LT(at(grid, 2, 0.02), 0.5F);
  for (const double x : {3.9, 4.02, 4.1}) {
    EXPECT_GT(at(grid, x, 0.02), 0.5F) << x;
    EXPECT_LT(at(grid, x, 0.02), kOccupied) << x;
  }
}

TEST(OccupancyGrid, LooksTooVagueToDrawOnlyClear) {
  OccupancyGrid grid({});
  // 0.15 m is beyond max_sigma_m; the interval starts 3.5 x 0.15 m before the wall, at 3.5 m.
  for (int look = 0; look < 10; ++look) grid.insert(wallAt(4.025, 0.15), {});
  EXPECT_LT(at(grid, 2, 0.02), kFree);
  EXPECT_LT(at(grid, 3.3, 0.02), kFree);
  for (const double x : {3.6, 3.9, 4.02, 4.1, 4.4}) EXPECT_EQ(at(grid, x, 0.02), kUnseen) << x;
}

TEST(OccupancyGrid, FarLooksNeitherSmearNorEraseASharpWall) {
  GridParams params;
  params.max_sigma_m = 0.5;
  OccupancyGrid grid(params);
  for (int look = 0; look < 3; ++look) grid.insert(wallAt(2.025, 0.02), {});
  // From 3 m farther back the wall is at 5 m; half of the looks are 0.25 m off either way.
  for (int look = 0; look < 20; ++look) grid.insert(wallAt(look % 2 ? 4.8 : 5.3, 0.3), {-3, 0, 0});
  EXPECT_GT(at(grid, 2.02, 0.02), kOccupied);
  for (const double x : {1.7, 1.8, 1.9, 2.2, 2.3, 2.4}) EXPECT_LT(at(grid, x, 0.02), kOccupied) << x;
}

TEST(OccupancyGrid, FollowsAChangingWorld) {
  OccupancyGrid grid({});
  for (int look = 0; look < 40; ++look) grid.insert(wallAt(3.025, 0.02), {});
  for (int look = 0; look < 2; ++look) grid.insert(wallAt(1.025, 0.02), {});
  EXPECT_GT(at(grid, 1.02, 0.02), kOccupied);  // a new obstacle after 2 looks
  for (int look = 0; look < 40; ++look) grid.insert(wallAt(1.025, 0.02), {});
  for (int look = 0; look < 10; ++look) grid.insert(wallAt(3.025, 0.02), {});
  EXPECT_LT(at(grid, 1.02, 0.02), kFree);  // gone after 10
  EXPECT_GT(at(grid, 3.02, 0.02), kOccupied);
}

TEST(OccupancyGrid, RepeatedLooksFromOnePlaceCountLittle) {
  OccupancyGrid grid({});
  grid.insert(wallAt(2.025, 0.1), {});
  const float once = at(grid, 2.02, 0.02);
  for (int look = 0; look < 2; ++look) grid.insert(wallAt(2.025, 0.1), {}, {0, 0});
  EXPECT_NEAR(at(grid, 2.02, 0.02), once, 0.05);
}

TEST(OccupancyGrid, EmptyBeamsSayNothing) {
  OccupancyGrid grid({});
  RangeScan scan = wallAt(2, 0.02);
  for (Beam& beam : scan.beams) beam = {beam.bearing_rad, beam.width_rad, false, 0, 0, 0, 0, 0};
  grid.insert(scan, {});
  EXPECT_TRUE(grid.empty());
  EXPECT_EQ(grid.snapshot().occupied.total(), 0U);
}

TEST(OccupancyGrid, EvidenceThatCancelsIsNotUnseen) {
  const EvidenceScale scale(0.03);
  EXPECT_EQ(scale.published(0), kUnseen);
  EXPECT_NE(scale.published(1), kUnseen);
  EXPECT_NE(scale.published(-1), kUnseen);
  EXPECT_EQ(scale.fromPublished(kUnseen), 0);
  for (int value = -112; value <= 64; ++value)
    EXPECT_EQ(scale.fromPublished(scale.published(static_cast<EvidenceCell>(value))), value);
}

TEST(OccupancyGrid, PublishedProbabilityOfHandNumbers) {
  const EvidenceScale scale(0.1);
  // l = 0.5: odds e^0.5 / 9, P = 0.15483; published 0.5 + 0.05483 / 1.8
  EXPECT_NEAR(scale.published(-8), 0.5305, 1e-4);
  // l = -0.5: P = 0.06314; published 0.06314 / 0.2
  EXPECT_NEAR(scale.published(8), 0.3157, 1e-4);
}

TEST(OccupancyGrid, TilesKeepTheirPlaceAndTellWhatChanged) {
  OccupancyGrid grid({});
  grid.insert(wallAt(2, 0.02), {});
  const auto first = grid.changedTiles(0);
  ASSERT_FALSE(first.empty());
  const std::uint64_t version = grid.version();
  EXPECT_TRUE(grid.changedTiles(version).empty());
  grid.insert(wallAt(2, 0.02), {-20, 0, M_PI});  // 22 m to the left of the origin
  for (const TileIndex& index : grid.changedTiles(version)) EXPECT_LT(index.col, -5);
  const GridMap tile = grid.tile({-1, 0});
  EXPECT_NEAR(tile.geometry.origin_x_m, -3.2, 1e-9);
  EXPECT_NEAR(tile.geometry.origin_y_m, 0, 1e-9);
  EXPECT_EQ(tile.occupied.rows, kTileCells);
  const GridMap all = grid.snapshot();
  std::size_t points = 0;
  for (const TileIndex& index : grid.changedTiles(0)) {
    const GridMap part = grid.tile(index);
    points += part.surface.size();
    const Cell at = all.geometry.cellAt(part.geometry.centreOf({0, 0}));
    const cv::Mat same = all.occupied(cv::Rect(at.col, at.row, kTileCells, kTileCells)) != part.occupied;
    EXPECT_EQ(cv::countNonZero(same), 0);
  }
  EXPECT_GT(points, 40u);
  EXPECT_EQ(all.surface.size(), points);
  for (const SurfacePoint& point : all.surface) {
    EXPECT_NEAR(std::abs(point.x_m + 10), 12, 0.03) << "the walls at 2 m and -22 m";
    EXPECT_GT(point.weight, 0);
  }
}

TEST(OccupancyGrid, TileOfNegativeCells) {
  EXPECT_EQ(tileOf({0, 63}), (TileIndex{0, 0}));
  EXPECT_EQ(tileOf({-1, 64}), (TileIndex{-1, 1}));
  EXPECT_EQ(tileOf({-64, -65}), (TileIndex{-1, -2}));
}

TEST(OccupancyGrid, RefusesBadInputAndStaysAsItWas) {
  OccupancyGrid grid({});
  EXPECT_THROW(grid.insert(wallAt(2, 0.02), {NAN, 0, 0}), InputError);
  RangeScan scan = wallAt(2, 0.02);
  scan.beams[3].far_m = INFINITY;
  EXPECT_THROW(grid.insert(scan, {}), InputError);
  EXPECT_TRUE(grid.empty());
  GridParams params;
  params.resolution_m = 0.5;
  EXPECT_THROW(OccupancyGrid{params}, InputError);
  EXPECT_THROW(grid.load({{0.1, 0, 0, 2, 2}, cv::Mat1f(2, 2, kUnseen)}), InputError);
}

TEST(OccupancyGrid, CellsFromTwoToTwentyCentimetres) {
  for (const double resolution_m : {0.02, 0.05, 0.1, 0.2}) {
    GridParams params;
    params.resolution_m = resolution_m;
    OccupancyGrid grid(params);
    const double wall_m = 2 + resolution_m / 2;  // the middle of a cell
    for (int look = 0; look < 4; ++look) grid.insert(wallAt(wall_m, 0.01), {});
    EXPECT_GT(at(grid, wall_m, resolution_m / 2), kOccupied) << resolution_m;
    EXPECT_GT(at(grid, wall_m, 1 + resolution_m / 2), kOccupied) << resolution_m;
    EXPECT_LT(at(grid, wall_m - 2 * resolution_m, resolution_m / 2), kFree) << resolution_m;
    EXPECT_LT(at(grid, 1, 0), kFree) << resolution_m;
    EXPECT_EQ(at(grid, wall_m + 3 * resolution_m, resolution_m / 2), kUnseen) << resolution_m;
    EXPECT_NEAR(grid.geometry().resolution_m, resolution_m, 1e-12);
  }
  for (const double resolution_m : {0.019, 0.21, 0.0, -0.05}) {
    GridParams params;
    params.resolution_m = resolution_m;
    EXPECT_THROW(OccupancyGrid{params}, InputError) << resolution_m;
  }
}

TEST(OccupancyGrid, TheGeometrySpansAllTilesAfterEveryKindOfChange) {
  OccupancyGrid grid({}), redrawn({});
  grid.insert(wallAt(2, 0.02), {});
  grid.insert(wallAt(2, 0.02), {-20, 0, M_PI});
  const GridGeometry wide = grid.geometry();
  EXPECT_LT(wide.origin_x_m, -20);
  EXPECT_GT(wide.origin_x_m + wide.cols * wide.resolution_m, 2);
  redrawn.insert(wallAt(2, 0.02), {0, 15, 0});
  grid.becomeRedrawn(std::move(redrawn));
  const GridGeometry both = grid.geometry();  // what was there goes out as unseen, it is still spanned
  EXPECT_EQ(both.origin_x_m, wide.origin_x_m);
  EXPECT_GT(both.origin_y_m + both.rows * both.resolution_m, 15);
  EXPECT_EQ(at(grid, -21.98, 0.02), kUnseen);
  grid.clear();
  EXPECT_EQ(grid.geometry().cols, 0);
  grid.insert(wallAt(2, 0.02), {});
  EXPECT_GE(grid.geometry().origin_x_m, -3.2);
}

TEST(OccupancyGrid, LoadsWhatItPublished) {
  OccupancyGrid grid({}), again({});
  for (int look = 0; look < 3; ++look) grid.insert(wallAt(2, 0.05), {0.3, 0.2, 1});
  again.load(grid.snapshot());
  const GridMap a = grid.snapshot(), b = again.snapshot();
  ASSERT_EQ(a.occupied.size(), b.occupied.size());
  EXPECT_LT(cv::norm(a.occupied, b.occupied, cv::NORM_INF), 1e-6);
}

}  // namespace
}  // namespace cornerstone
