// Whether the registration is taken in by buildings that look the same elsewhere: right, wrong and refused
// answers by what both robots share.
#include <array>
#include <cmath>

#include "../test/support/self_similar.h"
#include "bench.h"
#include "cornerstone/registration/register_maps.h"

namespace cornerstone::bench {
namespace {

constexpr unsigned kBuildings = 4;  // of each kind, view, share and furnishing
constexpr std::array<int, 4> kFurniture{0, 3, 6, 12};
constexpr std::array<int, 7> kShares_percent{0, 5, 10, 15, 20, 30, 50};
constexpr double kRight_m = 0.5, kRight_rad = 5 * M_PI / 180;

struct Kind {
  const char* name;
  Likeness likeness;
};
struct Count {
  int right = 0, wrong = 0, refused = 0;

  void add(const SharedViews& views) {
    const Landmarks there = detectLandmarks(views.reference, {}), here = detectLandmarks(views.current, {});
    const auto [answer, refusal] =
        registerMaps(MapView{views.reference, there}, MapView{views.current, here}, {}, {});
    if (!answer) {
      ++refused;
      return;
    }
    const Pose2 &found = answer->reference_from_current, &truth = views.reference_from_current;
    const Eigen::Vector2d wall = here.edges[here.edges.size() / 2].position_m;
    const bool good = (found * wall - truth * wall).norm() < kRight_m &&
                      std::abs(wrapAngle(found.yaw_rad - truth.yaw_rad)) < kRight_rad;
    ++(good ? right : wrong);
  }
  std::string inWords() const {
    return std::to_string(right) + " / " + std::to_string(wrong) + " / " + std::to_string(refused);
  }
};

void row(const Kind& kind, const std::string& view, const LookAround& look) {
  std::vector<std::string> cells{std::string(kind.name) + ", " + view};
  for (const int percent : kShares_percent) {
    Count count;
    for (const int furniture : kFurniture)
      for (unsigned i = 1; i <= kBuildings; ++i) {
        const unsigned seed =
            1000 * static_cast<unsigned>(kind.likeness) + 100 * static_cast<unsigned>(furniture) + i;
        count.add(viewsOf(drawnBuilding({kind.likeness, furniture, seed}), percent / 100.0, look,
                          7 * seed + static_cast<unsigned>(percent)));
      }
    cells.push_back(count.inWords());
  }
  printRow(cells);
}

}  // namespace

void registrationSelfSimilarPart() {
  std::printf(
      "\n### Buildings that look the same elsewhere\n\nDrawn buildings of 16 m to 40 m: an office that is "
      "its "
      "own half turn, like rooms in a row, a ring with four like sides, and two like wings, with 0, 3, 6 and "
      "12 "
      "pieces of furniture that have no like. Each robot maps one end; the columns say what share of the "
      "building's length both see. %d pairs a cell: right / wrong / refused. Laser: 360 degrees, 15 m; "
      "narrow: "
      "60 degrees, 5 m.\n",
      static_cast<int>(kBuildings * kFurniture.size()));
  std::vector<std::string> head{"both see"};
  for (const int percent : kShares_percent) head.push_back(std::to_string(percent) + "%");
  printHead(head);
  for (const Kind& kind : {Kind{"half turn", Likeness::kHalfTurn}, Kind{"row of rooms", Likeness::kRow},
                           Kind{"ring", Likeness::kRing}, Kind{"two wings", Likeness::kWings}}) {
    row(kind, "laser", laserLook());
    row(kind, "narrow", narrowLook());
  }
}

}  // namespace cornerstone::bench
