// cfg/Stereo.cfg is held against the struct that it changes.
#include "cornerstone/ros/stereo_reconfigure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

std::string textOf(const StereoParams& params) { return YAML::Dump(writeParams(params)); }

StereoConfig withValue(const std::string& name, double value) {
  dynamic_reconfigure::Config message;
  StereoConfig config = StereoConfig::__getDefault__();
  config.__toMessage__(message);
  for (auto& entry : message.ints)
    if (entry.name == name) entry.value = static_cast<int>(value);
  for (auto& entry : message.doubles)
    if (entry.name == name) entry.value = value;
  config.__fromMessage__(message);
  return config;
}

bool isAccepted(const StereoConfig& config) {
  try {
    StereoMatcher matcher(changedBy(config, {}));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

// The names and values of a configuration's numbers.
std::map<std::string, double> numbersOf(const StereoConfig& config) {
  dynamic_reconfigure::Config message;
  config.__toMessage__(message);
  std::map<std::string, double> numbers;
  for (const auto& entry : message.ints) numbers[entry.name] = entry.value;
  for (const auto& entry : message.doubles) numbers[entry.name] = entry.value;
  return numbers;
}

TEST(StereoReconfigure, NamesTypesAndDefaultsAreThoseOfTheStruct) {
  EXPECT_EQ(textOf(changedBy(StereoConfig::__getDefault__(), {})), textOf({}));
}

// The lower end itself may be refused (a step of 0 px), what is below it always.
TEST(StereoReconfigure, RangesAreThoseThatTheMatcherAccepts) {
  const auto low = numbersOf(StereoConfig::__getMin__());
  for (const auto& [name, high] : numbersOf(StereoConfig::__getMax__())) {
    EXPECT_FALSE(isAccepted(withValue(name, low.at(name) - 1))) << name;
    if (!std::isfinite(high)) continue;
    EXPECT_TRUE(isAccepted(withValue(name, high))) << name;
    EXPECT_FALSE(isAccepted(withValue(name, high + 1))) << name;
  }
}

TEST(StereoReconfigure, OnlyWhatIsNamedChanges) {
  StereoParams expected;
  expected.max_disparity_px = 64;
  EXPECT_EQ(textOf(changedBy(withValue("max_disparity_px", 64), {})), textOf(expected));
}

TEST(StereoReconfigure, WhatIsNoNumberIsRefused) {
  EXPECT_FALSE(isAccepted(withValue("strong_product", std::nan(""))));
  EXPECT_FALSE(isAccepted(withValue("window_px", 4)));
}

}  // namespace
}  // namespace cornerstone
