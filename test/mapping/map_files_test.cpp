#include "cornerstone/mapping/map_files.h"

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

namespace fs = std::filesystem;

class MapFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("cornerstone_map_files_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  // Three pixels in a row: free, unknown, occupied in map_server's grey values; two rows.
  void writeImage(const std::string& name) const {
    cv::imwrite(path(name), cv::Mat1b((cv::Mat1b(2, 3) << 254, 205, 0, 254, 254, 254)));
  }
  std::string refusal(const std::string& yaml) const {
    write("map.yaml", yaml);
    try {
      loadMap(path("map.yaml"));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

const std::string kTail =
    "resolution: 0.1\norigin: [-1, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";

TEST_F(MapFiles, ReadsTrinaryMapsWithTheFirstImageRowOnTop) {
  writeImage("map.png");
  write("map.yaml", "image: map.png\n" + kTail);
  const GridMap map = loadMap(path("map.yaml"));
  EXPECT_EQ(map.geometry.cols, 3);
  EXPECT_EQ(map.geometry.rows, 2);
  EXPECT_NEAR(map.geometry.origin_x_m, -1, 1e-12);
  EXPECT_EQ(map.occupied(1, 0), 0);  // image row 0 is grid row 1
  EXPECT_EQ(map.occupied(1, 1), kUnseen);
  EXPECT_EQ(map.occupied(1, 2), 1);
  EXPECT_EQ(map.occupied(0, 1), 0);
}

TEST_F(MapFiles, ReadsScaleRawAndNegate) {
  cv::imwrite(path("map.pgm"), cv::Mat1b((cv::Mat1b(1, 4) << 0, 50, 100, 255)));
  write("raw.yaml", "image: map.pgm\nmode: raw\n" + kTail);
  const GridMap raw = loadMap(path("raw.yaml"));
  EXPECT_NEAR(raw.occupied(0, 1), 0.5F, 1e-6);
  EXPECT_EQ(raw.occupied(0, 2), 1);
  EXPECT_EQ(raw.occupied(0, 3), kUnseen);
  write("scale.yaml",
        "image: map.pgm\nmode: scale\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 1\n"
        "occupied_thresh: 0.8\nfree_thresh: 0.2\n");
  const GridMap scale = loadMap(path("scale.yaml"));
  EXPECT_EQ(scale.occupied(0, 0), 0);
  EXPECT_NEAR(scale.occupied(0, 2), (100 / 255.0 - 0.2) / 0.6, 1e-6);
  EXPECT_EQ(scale.occupied(0, 3), 1);
}

TEST_F(MapFiles, WhatIsSavedComesBack) {
  GridMap map{{0.05, -1.25, 3.1, 40, 30}, cv::Mat1f(30, 40)};
  for (int i = 0; i < 1200; ++i) map.occupied(i / 40, i % 40) = static_cast<float>(i) / 1199;
  map.occupied(3, 4) = kUnseen;
  map.occupied(5, 6) = 0.501F;
  saveMap(map, path("saved.yaml"));
  const GridMap again = loadMap(path("saved.yaml"));
  EXPECT_NEAR(again.geometry.origin_x_m, -1.25, 1e-12);
  EXPECT_NEAR(again.geometry.origin_y_m, 3.1, 1e-12);
  ASSERT_EQ(again.occupied.size(), map.occupied.size());
  EXPECT_LE(cv::norm(again.occupied, map.occupied, cv::NORM_INF), 1 / 509.0);
  EXPECT_EQ(again.occupied(3, 4), kUnseen);
  EXPECT_NE(again.occupied(5, 6), kUnseen);  // seen and undecided is not unseen
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
}

TEST_F(MapFiles, MrptsOwnFormComesBack) {
  GridMap map{{0.05, -1.25, 3.1, 40, 30}, cv::Mat1f(30, 40)};
  for (int i = 0; i < 1200; ++i) map.occupied(i / 40, i % 40) = static_cast<float>(i) / 1199;
  map.occupied(3, 4) = kUnseen;
  map.occupied(5, 6) = 0.5001F;
  for (const std::string name : {"saved.gridmap", "saved.gridmap.gz"}) {
    saveMap(map, path(name));
    const GridMap again = loadMap(path(name));
    EXPECT_NEAR(again.geometry.origin_x_m, -1.25, 1e-9);
    EXPECT_NEAR(again.geometry.origin_y_m, 3.1, 1e-9);
    EXPECT_NEAR(again.geometry.resolution_m, 0.05, 1e-12);
    ASSERT_EQ(again.occupied.size(), map.occupied.size());
    EXPECT_LE(cv::norm(again.occupied, map.occupied, cv::NORM_INF), 0.016);
    EXPECT_EQ(again.occupied(3, 4), kUnseen);
    EXPECT_GT(again.occupied(5, 6), kUnseen);  // seen and undecided is not unseen
    saveMap(again, path("twice.gridmap"));
    EXPECT_EQ(cv::norm(loadMap(path("twice.gridmap")).occupied, again.occupied, cv::NORM_INF), 0);
  }
  // As MRPT's own programs read it.
  mrpt::maps::COccupancyGridMap2D grid;
  mrpt::io::CFileGZInputStream file(path("saved.gridmap.gz"));
  auto archive = mrpt::serialization::archiveFrom(file);
  archive >> grid;
  EXPECT_NEAR(grid.getCell(39, 29), 0, 0.02);  // MRPT keeps the probability of free
  EXPECT_NEAR(grid.getCell(0, 0), 1, 0.02);
  EXPECT_EQ(grid.getCell(4, 3), 0.5F);
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
  fs::resize_file(path("saved.gridmap"), 300);
  EXPECT_THROW(loadMap(path("saved.gridmap")), InputError);
  EXPECT_THROW(saveMap(map, path("no/such/folder/x.gridmap")), InputError);
  EXPECT_THROW(saveMap(map, path("saved.txt")), InputError);
}

TEST_F(MapFiles, LevelsAreFilesBesideTheFirst) {
  const GridMap first{{0.05, 0, 0, 2, 2}, cv::Mat1f(2, 2, 0.1F)},
      ceiling{{0.05, 0, 0, 2, 2}, cv::Mat1f(2, 2, 0.9F)};
  const std::vector<std::string> names{"obstacles", "ceiling", "shelf"};
  for (const std::string ending : {"", ".yaml", ".gridmap", ".gridmap.gz"}) {
    saveLevels({first, ceiling, {}}, path("map" + ending), names);
    EXPECT_TRUE(fs::exists(path("map_ceiling" + (ending.empty() ? ".yaml" : ending))));
    const std::vector<GridMap> again = loadLevels(path("map" + ending), names);
    ASSERT_EQ(again.size(), 3U);
    EXPECT_NEAR(again[0].occupied(0, 0), 0.1, 0.01);
    EXPECT_NEAR(again[1].occupied(0, 0), 0.9, 0.01);
    EXPECT_TRUE(again[2].occupied.empty());
  }
  EXPECT_THROW(loadLevels(path("nothing"), names), InputError);
}

TEST_F(MapFiles, RefusalsNameFileAndField) {
  writeImage("map.png");
  EXPECT_EQ(refusal("image: map.png\n" + kTail), "");
  EXPECT_NE(refusal(kTail).find("map.yaml: field 'image' is missing"), std::string::npos);
  EXPECT_NE(refusal("image: none.png\n" + kTail).find("none.png"), std::string::npos);
  EXPECT_NE(refusal("image: map.yaml\n" + kTail).find("not an image"), std::string::npos);
  const std::string good = "image: map.png\n" + kTail;
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return refusal(text.replace(text.find(from), from.size(), to));
  };
  EXPECT_NE(with("resolution: 0.1", "resolution: 0").find("'resolution'"), std::string::npos);
  EXPECT_NE(with("resolution: 0.1", "resolution: .nan").find("'resolution'"), std::string::npos);
  EXPECT_NE(with("resolution: 0.1", "resolution: abc").find("'resolution'"), std::string::npos);
  EXPECT_NE(with("[-1, 2, 0]", "[-1, 2, 0.3]").find("yaw"), std::string::npos);
  EXPECT_NE(with("[-1, 2, 0]", "[-1, 2]").find("'origin'"), std::string::npos);
  EXPECT_NE(with("negate: 0", "negate: 5").find("'negate'"), std::string::npos);
  EXPECT_NE(with("0.65", "1.5").find("'occupied_thresh'"), std::string::npos);
  EXPECT_NE(with("0.196", "0.7").find("'free_thresh'"), std::string::npos);
  EXPECT_NE(with("negate: 0", "negate: 0\nmode: odd").find("'mode'"), std::string::npos);
  EXPECT_NE(refusal("- 1\n").find("not a map"), std::string::npos);
  EXPECT_NE(refusal("{ image: ").find("not YAML"), std::string::npos);
  EXPECT_THROW(loadMap(path("nothing.yaml")), InputError);
  EXPECT_THROW(saveMap({{0.1, 0, 0, 1, 1}, cv::Mat1f(1, 1, 0.2F)}, path("no/such/folder/x.yaml")),
               InputError);
}

TEST_F(MapFiles, RefusesATruncatedImage) {
  cv::Mat1b noise(64, 64);
  cv::randu(noise, 0, 255);
  cv::imwrite(path("whole.png"), noise);
  fs::copy_file(path("whole.png"), path("map.png"));
  fs::resize_file(path("map.png"), 900);
  EXPECT_NE(refusal("image: map.png\n" + kTail), "");
}

TEST(MrptMaps, ReadsGridMaps) {
  const std::string path = "/usr/share/mrpt/datasets/2006-MalagaCampus.gridmap.gz";
  ASSERT_TRUE(fs::exists(path)) << path << " comes with the Debian package mrpt-common";
  const GridMap map = loadMap(path);
  EXPECT_GT(cv::countNonZero(map.occupied > 0.65F), 1000);
  EXPECT_GT(cv::countNonZero(map.occupied < 0.196F), 10000);
  EXPECT_GT(cv::countNonZero(map.occupied == kUnseen), 10000);
}

}  // namespace
}  // namespace cornerstone
