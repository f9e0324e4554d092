// What a pinhole camera sees of a world, through MRPT's off-screen renderer: drawn larger and shrunk over
// areas, with mipmapped textures, so that far texture neither flickers nor differs between neighbouring
// cameras. Pixel (x, y) is the centre of that pixel: X/Z = (x - centre_x) / focal. Camera frame: z forward, x
// right, y down. One renderer a process (MRPT fails with a second), used in the thread that made it only (it
// owns the GL context).
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "cornerstone/simulation/world.h"

namespace cornerstone {

struct RendererSetup {
  cv::Size image_size_px;
  double focal_px = 0;
  double centre_x_px = 0;
  double centre_y_px = 0;
  int supersampling = 3;  // drawn so many times as wide and high
};

// Something that moves: drawn at the pose given to place(), its solid given in its own frame.
struct MovingBody {
  Solid solid;
};

class Renderer {
 public:
  // Throws InputError when the machine has no off-screen OpenGL.
  Renderer(const World& world, const std::vector<MovingBody>& bodies, const RendererSetup& setup);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  void place(std::size_t body, const Pose2& world_from_body);
  void show(std::size_t body, bool visible);
  // Grey levels 0-255, not rounded.
  cv::Mat1f render(const Eigen::Isometry3d& world_from_camera);
  // Z along the optical axis in m of the nearest surface at each pixel's centre sample; 0: nothing there.
  cv::Mat1f renderDepth(const Eigen::Isometry3d& world_from_camera);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace cornerstone
