// What the registration costs against the size of the maps and the number of robots.
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "bench.h"
#include "cornerstone/registration/corner_matching.h"
#include "cornerstone/registration/register_maps.h"

namespace cornerstone::bench {
namespace {

constexpr double kCell_m = 0.05;
constexpr int kRepeats = 3;

// A square floor of rooms in rows, none like another, each with a door and a cabinet; a map that is turned by
// an angle, and in which a share of the wall is missing.
GridMap floorPlan(double side_m, double turn_deg, unsigned noise_seed) {
  const int side = static_cast<int>(side_m / kCell_m);
  cv::Mat1f plan(side + 60, side + 60, kUnseen);
  std::mt19937 rooms(1);
  const auto cells = [&](double low_m, double high_m) {
    return static_cast<int>(std::uniform_real_distribution<double>(low_m, high_m)(rooms) / kCell_m);
  };
  for (int y = 30; y < side;) {
    const int high = cells(3, 6);
    for (int x = 30; x < side;) {
      const int wide = cells(3, 7);
      const cv::Rect room(x, y, wide, high);
      cv::rectangle(plan, room, cv::Scalar(0), cv::FILLED);
      cv::rectangle(plan, room, cv::Scalar(1), 3);
      cv::rectangle(plan, {x + wide / 2, y, cells(0.5, 1.5), cells(0.4, 0.9)}, cv::Scalar(1), cv::FILLED);
      cv::rectangle(plan, {x + 4, y + high - 4, 18, 8}, cv::Scalar(0), cv::FILLED);
      x += wide;
    }
    y += high;
  }
  std::mt19937 noise(noise_seed);
  for (float& cell : plan)
    if (cell == 1 && noise() % 20 == 0) cell = kUnseen;
  const float middle = 0.5F * static_cast<float>(plan.cols);
  const cv::Mat turn = cv::getRotationMatrix2D({middle, middle}, turn_deg, 1);
  cv::Mat1f turned;
  cv::warpAffine(plan, turned, turn, plan.size(), cv::INTER_NEAREST, cv::BORDER_CONSTANT,
                 cv::Scalar(kUnseen));
  return {{kCell_m, 0, 0, turned.cols, turned.rows}, turned};
}

struct Prepared {
  Landmarks landmarks;
  MapEvidence evidence;
};
Prepared prepare(const GridMap& map) {
  Landmarks landmarks = detectLandmarks(map, {});
  MapEvidence evidence = gatherEvidence({map, landmarks}, {});
  return {std::move(landmarks), std::move(evidence)};
}

void sizeRow(double area_m2) {
  const GridMap a = floorPlan(std::sqrt(area_m2), 3, 1), b = floorPlan(std::sqrt(area_m2), 31, 2);
  std::vector<double> detect_ms, evidence_ms, register_ms;
  bool answered = false;
  std::size_t corners = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    Landmarks in_a, in_b;
    detect_ms.push_back(elapsed_ms([&] { in_a = detectLandmarks(a, {}); }));
    in_b = detectLandmarks(b, {});
    corners = in_a.corners.size();
    evidence_ms.push_back(elapsed_ms([&] { gatherEvidence({a, in_a}, {}); }));
    const MapEvidence there = gatherEvidence({a, in_a}, {}), here = gatherEvidence({b, in_b}, {});
    register_ms.push_back(elapsed_ms([&] {
      answered =
          registerMaps(PreparedMap{in_a, there}, PreparedMap{in_b, here}, {}, {}).registration.has_value();
    }));
  }
  printRow({text(area_m2, 0), std::to_string(corners), text(median(detect_ms), 1),
            text(median(evidence_ms), 1), text(median(register_ms), 1), answered ? "yes" : "no"});
}

void robotsRow(int robots) {
  std::vector<GridMap> maps;
  for (int i = 0; i < robots; ++i) maps.push_back(floorPlan(20, 360.0 * i / robots, unsigned(i)));
  std::vector<Prepared> prepared;
  const double detect_ms = elapsed_ms([&] {
    for (const GridMap& map : maps) prepared.push_back(prepare(map));
  });
  int answered = 0;
  const double register_ms = elapsed_ms([&] {
    for (int i = 1; i < robots; ++i) {
      const Prepared& robot = prepared[static_cast<std::size_t>(i)];
      answered += registerMaps(PreparedMap{prepared[0].landmarks, prepared[0].evidence},
                               PreparedMap{robot.landmarks, robot.evidence}, {}, {})
                      .registration.has_value();
    }
  });
  printRow({std::to_string(robots), text(detect_ms, 1), text(register_ms, 1),
            std::to_string(answered) + " of " + std::to_string(robots - 1)});
}

// 200 corners of each map, 10 cm and 3 degrees off: pairs and pose.
double cornerMatching_ms() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-40, 40), turn(-M_PI, M_PI);
  std::vector<CornerLandmark> there, here;
  const Pose2 off{0.1, 0, 0.05};
  for (int i = 0; i < 200; ++i) {
    CornerLandmark corner;
    corner.pose = {place(random), place(random), turn(random)};
    corner.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    there.push_back(corner);
    corner.pose = off * corner.pose;
    here.push_back(corner);
  }
  std::vector<double> times_ms;
  for (int repeat = 0; repeat < 21; ++repeat)
    times_ms.push_back(elapsed_ms([&] { solvePairs(there, here, pairNearest(there, here, {}, {}), {}); }));
  return median(times_ms);
}

}  // namespace

void registrationCostPart() {
  std::puts(
      "\n### Cost of the registration\n\nDrawn floors full of rooms, cells of 0.05 m, no prior; one map each "
      "for "
      "detection and evidence, a pair for the registration.");
  printHead({"area m2", "corners", "detection ms", "evidence ms", "registration ms", "answered"});
  for (const double area_m2 : {400.0, 1600.0, 6400.0, 20000.0, 40000.0}) sizeRow(area_m2);
  std::puts("\nEvery robot to the first, floors of 400 m2, all maps new at once:");
  printHead({"robots", "detection and evidence ms", "registrations ms", "answered"});
  for (const int robots : {2, 4, 8, 16, 32}) robotsRow(robots);
  std::printf("\n200 corners against 200, paired and solved: %.2f ms.\n", cornerMatching_ms());
}

}  // namespace cornerstone::bench
