#include "cornerstone/base/params.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cornerstone/base/errors.h"

namespace cornerstone {
namespace {

struct InnerParams {
  double tilt_rad = M_PI / 2;
};
void describe(ParamVisitor& visitor, InnerParams& params) { visitor.degrees("tilt_deg", params.tilt_rad); }

struct OuterParams {
  int count = 3;
  double length_m = 0.5;
  bool fast = true;
  std::string name = "a";
  std::vector<std::string> robots{"a", "b"};
  InnerParams inner;
};
void describe(ParamVisitor& visitor, OuterParams& params) {
  visitor.field("count", params.count);
  visitor.field("length_m", params.length_m);
  visitor.field("fast", params.fast);
  visitor.field("name", params.name);
  visitor.field("robots", params.robots);
  visitor.group("inner", [&] { describe(visitor, params.inner); });
}

const char* kGood = "{count: 5, length_m: 2.5, fast: false, name: z, robots: [q], inner: {tilt_deg: 45}}";

std::string refusalOf(const std::string& yaml) {
  try {
    readParams<OuterParams>(YAML::Load(yaml), "some.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Params, ReadsEveryKindOfMember) {
  const auto params = readParams<OuterParams>(YAML::Load(kGood), "some.yaml");
  EXPECT_EQ(params.count, 5);
  EXPECT_NEAR(params.length_m, 2.5, 1e-12);
  EXPECT_FALSE(params.fast);
  EXPECT_EQ(params.name, "z");
  EXPECT_EQ(params.robots, std::vector<std::string>{"q"});
  EXPECT_NEAR(params.inner.tilt_rad, M_PI / 4, 1e-12);
}

TEST(Params, WritesWhatItReads) {
  const YAML::Node node = writeParams(OuterParams{});
  EXPECT_NEAR(node["inner"]["tilt_deg"].as<double>(), 90, 1e-9);
  EXPECT_EQ(readParams<OuterParams>(node, "again").count, 3);
}

struct Shelf {
  std::vector<InnerParams> boards{{}, {}};
};
void describe(ParamVisitor& visitor, Shelf& shelf) { visitor.list("boards", shelf.boards); }

TEST(Params, ListsOfMapsAreReadWrittenAndRefusedByName) {
  const auto refusal = [](const std::string& yaml) -> std::string {
    try {
      readParams<Shelf>(YAML::Load(yaml), "some.yaml");
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const auto shelf =
      readParams<Shelf>(YAML::Load("{boards: [{tilt_deg: 45}, {tilt_deg: 0}, {tilt_deg: 90}]}"), "some.yaml");
  ASSERT_EQ(shelf.boards.size(), 3U);
  EXPECT_NEAR(shelf.boards[0].tilt_rad, M_PI / 4, 1e-12);
  EXPECT_NEAR(shelf.boards[2].tilt_rad, M_PI / 2, 1e-12);
  const YAML::Node written = writeParams(shelf);
  EXPECT_EQ(readParams<Shelf>(written, "again").boards.size(), 3U);
  EXPECT_NEAR(written["boards"][2]["tilt_deg"].as<double>(), 90, 1e-9);
  EXPECT_TRUE(readParams<Shelf>(YAML::Load("{boards: []}"), "some.yaml").boards.empty());
  EXPECT_EQ(refusal("{}"), "some.yaml: parameter 'boards' is missing");
  EXPECT_EQ(refusal("{boards: 3}"), "some.yaml: parameter 'boards' is not a list");
  EXPECT_EQ(refusal("{boards: [3]}"), "some.yaml: parameter 'boards[0]' is not a map");
  EXPECT_EQ(refusal("{boards: [{tilt_deg: 1}, {}]}"), "some.yaml/boards[1]: parameter 'tilt_deg' is missing");
  EXPECT_EQ(refusal("{boards: [{tilt_deg: 1, til: 2}]}"), "some.yaml/boards[0]: unknown parameter 'til'");
  EXPECT_EQ(refusal("{boards: [{tilt_deg: x}]}"),
            "some.yaml/boards[0]: parameter 'tilt_deg' is not a number");
}

TEST(Params, RefusalsNameFileAndKey) {
  EXPECT_EQ(refusalOf(kGood), "");
  EXPECT_EQ(refusalOf("{count: 5, length_m: 2.5, fast: false, name: z, robots: [q]}"),
            "some.yaml: parameter 'inner' is missing");
  EXPECT_EQ(refusalOf("{count: x, length_m: 2.5}"), "some.yaml: parameter 'count' is not a whole number");
  EXPECT_EQ(refusalOf("{count: 5, length_m: .nan}"),
            "some.yaml: parameter 'length_m' is not a finite number");
  EXPECT_EQ(
      refusalOf("{count: 5, length_m: 1, fast: no, name: z, robots: [q], inner: {tilt_deg: 1, til: 2}}"),
      "some.yaml/inner: unknown parameter 'til'");
  EXPECT_EQ(refusalOf("{count: 5, length_m: 1, fast: no, name: z, robots: [q], inner: {tilt_deg: 1}, x: 1}"),
            "some.yaml: unknown parameter 'x'");
  EXPECT_EQ(refusalOf("[1]"), "some.yaml: expected a map of parameters");
}

}  // namespace
}  // namespace cornerstone
