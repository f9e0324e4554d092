// Where the registration stops answering: drawn offices against overlap, noise and clutter.
#include <cmath>
#include <random>

#include "../test/support/drawn_maps.h"
#include "bench.h"
#include "cornerstone/registration/register_maps.h"

namespace cornerstone::bench {
namespace {

constexpr int kPairs = 20;  // a row: other headings, noise and clutter each
constexpr double kRight_m = 0.5, kRight_rad = 5 * M_PI / 180;
constexpr double kLeft_m = 0, kWidth_m = 17;  // of the drawn office

struct Trial {
  double overlap = 0.6;  // share of the office that both maps see; the rest is divided between them
  double noise =
      0.05;       // share of the wall cells that are missing, and of cells beside walls that are not free
  int boxes = 0;  // of 0.3 m, standing in one map only, in other places in the other
};

GridMap viewOf(const Trial& trial, const DrawnView& view, std::mt19937& random) {
  DrawnWorld world = drawnOffice();
  std::uniform_real_distribution<double> x(kLeft_m, kLeft_m + kWidth_m), y(0, 10);
  for (int i = 0; i < trial.boxes; ++i) {
    const double left = x(random), low = y(random);
    world.solids.push_back({left, low, left + 0.3, low + 0.3});
  }
  return draw(world, view);
}

void row(const std::string& what, const Trial& trial) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> turn(-M_PI, M_PI);
  int right = 0, wrong = 0;
  std::vector<double> errors_m;
  for (unsigned i = 0; i < kPairs; ++i) {
    const double alone_m = kWidth_m * (1 - trial.overlap) / 2;
    const Pose2 there{0, 0, turn(random)}, here{2, 1, turn(random)};
    const DrawnView left{there, {-1, -2, kLeft_m + kWidth_m - alone_m, 12}, trial.noise, 2 * i + 1};
    const DrawnView rest{here, {kLeft_m + alone_m, -2, 18, 12}, trial.noise, 2 * i + 2};
    const GridMap a = viewOf(trial, left, random), b = viewOf(trial, rest, random);
    const Landmarks in_a = detectLandmarks(a, {}), in_b = detectLandmarks(b, {});
    const auto [answer, refusal] = registerMaps(MapView{a, in_a}, MapView{b, in_b}, {}, {});
    if (!answer) continue;
    const Eigen::Vector2d middle = knownCentre(b);
    const Pose2 truth = there.inverse() * here;
    const double error_m = (answer->reference_from_current * middle - truth * middle).norm();
    const bool good =
        error_m < kRight_m &&
        std::abs(wrapAngle(answer->reference_from_current.yaw_rad - truth.yaw_rad)) < kRight_rad;
    ++(good ? right : wrong);
    if (good) errors_m.push_back(error_m);
  }
  printRow({what, std::to_string(right), std::to_string(wrong), std::to_string(kPairs - right - wrong),
            errors_m.empty() ? "" : text(1e3 * median(errors_m), 1)});
}

}  // namespace

void registrationLimitsPart() {
  std::printf(
      "\n### Limits of the registration\n\nA drawn office of 17 m x 11 m, %d pairs a row at any headings, "
      "cells of "
      "0.05 m. Unless a row says otherwise both maps see 60%% of it, 5%% of the wall cells are wrong, and "
      "nothing was "
      "moved. Error: median of the right ones.\n\n",
      kPairs);
  printHead({"", "right", "wrong", "refused", "error mm"});
  for (const int share : {10, 20, 30, 40, 50, 60, 70, 80, 90})
    row("overlap " + std::to_string(share) + "%", {share / 100.0});
  for (const int share : {0, 10, 20, 30, 40})
    row("noise " + std::to_string(share) + "%", {0.6, share / 100.0});
  for (const int boxes : {5, 10, 20, 40, 80})
    row(std::to_string(boxes) + " moved boxes a map", {0.6, 0.05, boxes});
}

}  // namespace cornerstone::bench
