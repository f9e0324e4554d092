// Every file of config/ is the defaults of its struct: who reads the one knows the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "cornerstone/ros/nodelet_params.h"
#include "cornerstone/ros/simulation_messages.h"
#include "support/laid_over.h"

namespace cornerstone {
namespace {

const std::string kConfig = std::string(CORNERSTONE_SOURCE_DIR) + "/config/";

// Files may round: a struct's 2 rad/s is a file's 115 degrees a second.
double toleranceFor(const std::string& key) { return key.find("_deg") == std::string::npos ? 1e-9 : 5e-3; }

void expectEqual(const YAML::Node& shipped, const YAML::Node& defaults, const std::string& key) {
  ASSERT_EQ(shipped.Type(), defaults.Type()) << key;
  if (shipped.IsMap()) {
    ASSERT_EQ(shipped.size(), defaults.size()) << key;
    for (const auto& member : defaults) {
      const auto name = member.first.as<std::string>();
      expectEqual(shipped[name], member.second, key + "/" + name);
    }
    return;
  }
  if (shipped.IsSequence()) {
    ASSERT_EQ(shipped.size(), defaults.size()) << key;
    for (std::size_t i = 0; i < shipped.size(); ++i)
      expectEqual(shipped[i], defaults[i], key + "[" + std::to_string(i) + "]");
    return;
  }
  double number = 0, expected = 0;
  if (YAML::convert<double>::decode(shipped, number) && YAML::convert<double>::decode(defaults, expected))
    EXPECT_NEAR(number, expected, toleranceFor(key) * std::max(1e-12, std::abs(expected))) << key;
  else
    EXPECT_EQ(shipped.as<std::string>(), defaults.as<std::string>()) << key;
}

template <typename Params>
void expectDefaults(const std::string& file) {
  SCOPED_TRACE(file);
  const YAML::Node shipped = YAML::LoadFile(kConfig + file);
  expectEqual(writeParams(readParams<Params>(shipped, file)), writeParams(Params{}), file);
}

TEST(ShippedParameters, EveryFileIsTheDefaultsOfItsStruct) {
  expectDefaults<TrinocularStereoParams>("stereo.yaml");
  expectDefaults<OccupancyMapperParams>("mapper.yaml");
  expectDefaults<RegistrationNodeletParams>("registration.yaml");
  expectDefaults<SimulatorParams>("simulator.yaml");
}

TEST(ShippedParameters, ALasersFileLiesOverTheMappers) {
  YAML::Node whole = YAML::LoadFile(kConfig + "mapper.yaml");
  ASSERT_TRUE(test::laidOver(whole, YAML::LoadFile(kConfig + "mapper_laser.yaml")));
  const auto params = readParams<OccupancyMapperParams>(whole, "mapper_laser.yaml");
  EXPECT_EQ(params.input, "scan");
  EXPECT_NO_THROW(Mapper(params.mapper));
  EXPECT_FALSE(test::laidOver(whole, YAML::Load("{mapper: {grid: {max_rnage_m: 15}}}")));
}

TEST(ShippedParameters, NoFileIsForgotten) {
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(kConfig))
    found.insert(entry.path().filename());
  EXPECT_EQ(found, (std::set<std::string>{"mapper.yaml", "mapper_laser.yaml", "registration.yaml",
                                          "simulator.yaml", "stereo.yaml"}));
}

TEST(ShippedParameters, TheComparisonSeesASmallDifference) {
  OccupancyMapperParams changed;
  changed.tf_timeout_s *= 1 + 1e-6;
  const YAML::Node ours = writeParams(OccupancyMapperParams{}), theirs = writeParams(changed);
  const double difference_s =
      std::abs(ours["tf_timeout_s"].as<double>() - theirs["tf_timeout_s"].as<double>());
  EXPECT_GT(difference_s, toleranceFor("tf_timeout_s"));
}

}  // namespace
}  // namespace cornerstone
