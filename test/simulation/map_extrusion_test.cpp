#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "cornerstone/base/errors.h"
#include "cornerstone/simulation/true_surfaces.h"
#include "cornerstone/simulation/world.h"

namespace cornerstone {
namespace {

// A map of 10 x 8 cells of 0.1 m, its origin at (1, 2): one wall of three cells in a row and one cell in the
// top row.
class MapExtrusionTest : public testing::Test {
 protected:
  void SetUp() override {
    cv::Mat1b image(8, 10, uchar(254));
    image(cv::Rect(4, 6, 3, 1)).setTo(0);  // second row from below: y from 2.1 to 2.2
    image(0, 9) = 0;
    cv::imwrite(directory_ + "extrude.png", image);
    write("0.65");
  }

  void write(const std::string& occupied) const {
    std::ofstream(directory_ + "extrude.yaml")
        << "{image: extrude.png, resolution: 0.1, origin: [1, 2, 0], negate: 0, occupied_thresh: " << occupied
        << ", free_thresh: 0.196}";
  }

  World parse() const {
    return parseWorld(
        "{name: w, seed: 1, extent_m: [0, 0, 3, 3], ceiling_m: 3, robots: [], "
        "map: {file: extrude.yaml, height_m: 2, material: plaster}}",
        "w.yaml", directory_);
  }

  const std::string directory_ = testing::TempDir();
};

TEST_F(MapExtrusionTest, OccupiedCellsBecomeBlocks) {
  const auto solids = solidsOf(parse());
  ASSERT_EQ(solids.size(), 2U);  // the wall is one block, not three
  const TrueSurfaces surfaces(solids);
  EXPECT_NEAR(surfaces.distanceTo({1.55, 2.0}), 0.1, 1e-9);
  EXPECT_NEAR(surfaces.distanceTo({1.3, 2.15}), 0.1, 1e-9);
  EXPECT_NEAR(surfaces.distanceTo({1.95, 2.6}), 0.1, 1e-9);
}

TEST_F(MapExtrusionTest, ThePublishedTextRebuildsTheWorldFromAnywhere) {
  EXPECT_EQ(parseWorld(parse().yaml_text, "published", "/").map_solids.size(), 2U);
}

TEST_F(MapExtrusionTest, RefusalsNameTheFile) {
  write("2");
  try {
    parse();
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("extrude.yaml: 'occupied_thresh'"), std::string::npos)
        << error.what();
  }
  write("0.65");
  std::remove((directory_ + "extrude.png").c_str());
  EXPECT_THROW(parse(), InputError);
}

}  // namespace
}  // namespace cornerstone
