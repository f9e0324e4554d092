#include "cornerstone/simulation/renderer.h"

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/opengl/CFBORender.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfTexturedTriangles.h>
#include <mrpt/poses/CPose3D.h>

#include <opencv2/imgproc.hpp>

#include "cornerstone/base/errors.h"
#include "mesh.h"

namespace cornerstone {
namespace {

constexpr float kNear_m = 0.05F;  // a camera is never nearer to a wall than its robot's radius
constexpr float kFar_m = 100.0F;

// MRPT draws without mipmaps: they are made as soon as it has loaded the texture. The nearest level is
// enough: levels change at details finer than the shrunk image can hold, and blending two of them takes twice
// the time.
class MipmappedTriangles : public mrpt::opengl::CSetOfTexturedTriangles {
 public:
  void initializeTextures() const override {
    mrpt::opengl::CSetOfTexturedTriangles::initializeTextures();
    if (mipmapped_) return;
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    mipmapped_ = true;
  }

 private:
  mutable bool mipmapped_ = false;
};

mrpt::opengl::TTriangle triangleOf(const std::array<MeshVertex, 3>& vertices) {
  mrpt::opengl::TTriangle triangle;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3f at = vertices[i].at_m.cast<float>(), normal = vertices[i].normal.cast<float>();
    triangle.vertices[i].xyzrgba.pt = {at.x(), at.y(), at.z()};
    triangle.vertices[i].normal = {normal.x(), normal.y(), normal.z()};
    triangle.vertices[i].uv = {float(vertices[i].uv.x()), float(vertices[i].uv.y())};
    triangle.vertices[i].setColor(mrpt::img::TColor(255, 255, 255));
  }
  return triangle;
}

std::shared_ptr<MipmappedTriangles> objectOf(const std::vector<std::array<MeshVertex, 3>>& mesh,
                                             const Texture& texture, double brightness) {
  auto object = std::make_shared<MipmappedTriangles>();
  cv::Mat lit, colour;
  texture.grey.convertTo(lit, CV_8U, brightness);
  cv::cvtColor(lit, colour, cv::COLOR_GRAY2BGR);
  object->assignImage(mrpt::img::CImage(colour, mrpt::img::DEEP_COPY));
  object->enableTextureLinearInterpolation(true);
  object->enableLight(false);  // twice as fast; see mesh.h
  object->cullFaces(mrpt::opengl::TCullFace::BACK);
  for (const auto& triangle : mesh) object->insertTriangle(triangleOf(triangle));
  return object;
}

mrpt::img::TCamera pinholeOf(const RendererSetup& setup) {
  const int n = setup.supersampling;
  mrpt::img::TCamera camera;
  camera.ncols = std::uint32_t(setup.image_size_px.width * n);
  camera.nrows = std::uint32_t(setup.image_size_px.height * n);
  camera.fx(setup.focal_px * n);
  camera.fy(setup.focal_px * n);
  // OpenGL counts from the outer edge of the first pixel, images from its centre.
  camera.cx((setup.centre_x_px + 0.5) * n);
  camera.cy((setup.centre_y_px + 0.5) * n);
  return camera;
}

mrpt::poses::CPose3D poseOf(const Eigen::Isometry3d& pose) {
  return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(pose.matrix()));
}

}  // namespace

struct Renderer::Impl {
  explicit Impl(const RendererSetup& the_setup)
      : setup(the_setup),
        fbo(unsigned(setup.image_size_px.width * setup.supersampling),
            unsigned(setup.image_size_px.height * setup.supersampling)) {}

  void look(const Eigen::Isometry3d& world_from_camera) {
    auto& camera = fbo.getCamera(scene);
    camera.set6DOFMode(true);
    camera.setProjectiveFromPinhole(pinholeOf(setup));
    camera.setPose(poseOf(world_from_camera));
  }

  RendererSetup setup;
  mrpt::opengl::CFBORender fbo;
  mrpt::opengl::COpenGLScene scene;
  std::vector<std::shared_ptr<MipmappedTriangles>> bodies;
  mrpt::img::CImage frame;
};

Renderer::Renderer(const World& world, const std::vector<MovingBody>& bodies, const RendererSetup& setup) {
  try {
    impl_ = std::make_unique<Impl>(setup);
  } catch (const std::exception& error) {
    throw InputError(std::string("no off-screen OpenGL (Debian packages libegl1, libgl1-mesa-dri): ") +
                     error.what());
  }
  auto viewport = impl_->scene.getViewport();
  viewport->setViewportClipDistances(kNear_m, kFar_m);
  const std::vector<Solid> solids = solidsOf(world);
  Textures textures;
  const auto need = [&](Material material) {
    textures.try_emplace(material, makeTexture(material, world.seed));
  };
  need(Material::kCarpet);
  need(Material::kCeiling);
  for (const Solid& solid : solids) need(solid.material);
  for (const MovingBody& body : bodies) need(body.solid.material);
  Meshes meshes = meshSolids(solids, textures, true);
  addFloorAndCeiling(world, textures, meshes);
  for (const auto& [finish, mesh] : meshes)
    impl_->scene.insert(objectOf(mesh, textures.at(finish.material), brightnessOf(finish.shade)));
  for (const MovingBody& body : bodies) {
    const Meshes mesh = meshSolids({body.solid}, textures, false);
    impl_->bodies.push_back(objectOf(mesh.begin()->second, textures.at(body.solid.material), 1));
    impl_->scene.insert(impl_->bodies.back());
  }
}

Renderer::~Renderer() = default;

void Renderer::place(std::size_t body, const Pose2& world_from_body) {
  impl_->bodies.at(body)->setPose(
      mrpt::poses::CPose3D(world_from_body.x_m, world_from_body.y_m, 0, world_from_body.yaw_rad, 0, 0));
}

void Renderer::show(std::size_t body, bool visible) { impl_->bodies.at(body)->setVisibility(visible); }

cv::Mat1f Renderer::render(const Eigen::Isometry3d& world_from_camera) {
  impl_->look(world_from_camera);
  impl_->fbo.render_RGB(impl_->scene, impl_->frame);
  const auto& colour = impl_->frame.asCvMatRef();
  cv::Mat1b channel;
  cv::extractChannel(colour, channel, 1);
  cv::Mat1f large, grey;
  channel.convertTo(large, CV_32F);
  cv::resize(large, grey, impl_->setup.image_size_px, 0, 0, cv::INTER_AREA);
  return grey;
}

cv::Mat1f Renderer::renderDepth(const Eigen::Isometry3d& world_from_camera) {
  impl_->look(world_from_camera);
  mrpt::math::CMatrixFloat depth;
  impl_->fbo.render_depth(impl_->scene, depth);
  const int n = impl_->setup.supersampling;
  cv::Mat1f z_m(impl_->setup.image_size_px);
  for (int row = 0; row < z_m.rows; ++row)
    for (int col = 0; col < z_m.cols; ++col) z_m(row, col) = depth(row * n + n / 2, col * n + n / 2);
  return z_m;
}

}  // namespace cornerstone
