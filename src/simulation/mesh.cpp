#include "mesh.h"

#include <Eigen/Geometry>
#include <cmath>

namespace cornerstone {
namespace {

struct Quad {
  std::array<Eigen::Vector3d, 4> corners_m;  // counter-clockwise seen from outside
  std::array<Eigen::Vector2d, 4> uv;
};

// Daylight from above and one side.
int shadeOf(const Eigen::Vector3d& normal) {
  const double lit = std::max(normal.dot(Eigen::Vector3d(-0.7, -0.4, 0.6).normalized()), 0.0);
  return int(std::lround(lit * (kShades - 1)));
}

void addQuad(const Quad& quad, const Finish& finish, Meshes& meshes) {
  const Eigen::Vector3d normal =
      (quad.corners_m[1] - quad.corners_m[0]).cross(quad.corners_m[3] - quad.corners_m[0]).normalized();
  const auto vertex = [&](std::size_t i) { return MeshVertex{quad.corners_m[i], normal, quad.uv[i]}; };
  meshes[finish].push_back({vertex(0), vertex(1), vertex(2)});
  meshes[finish].push_back({vertex(0), vertex(2), vertex(3)});
}

// A number in [0, 1) that differs between places but not within a plane (1 cm steps).
double shiftOf(double a, double b) {
  const double mixed = std::sin(std::round(a * 100) * 12.9898 + std::round(b * 100) * 78.233) * 43758.5453;
  return mixed - std::floor(mixed);
}

// The cell of the texture that a face of its own fills: one poster among several, or all of it.
std::array<Eigen::Vector2d, 4> fittedUv(Material material, const Eigen::Vector3d& place_m) {
  double u0 = 0, v0 = 0, u1 = 1, v1 = 1;
  if (material == Material::kPoster) {
    const int cell = int(shiftOf(place_m.x() * 7, place_m.y() * 3) * kPosterColumns * kPosterRows);
    u0 = double(cell % kPosterColumns) / kPosterColumns;
    v0 = double(cell / kPosterColumns) / kPosterRows;
    u1 = u0 + 1.0 / kPosterColumns;
    v1 = v0 + 1.0 / kPosterRows;
  }
  return {Eigen::Vector2d{u0, v1}, {u1, v1}, {u1, v0}, {u0, v0}};
}

// Where a solid's faces go, and with which look.
struct Drawing {
  const Texture& texture;
  bool shaded;
  Meshes& meshes;
};

void addSide(const Solid& solid, std::size_t i, const Drawing& drawing) {
  const Texture& texture = drawing.texture;
  const Eigen::Vector2d &a = solid.polygon_m[i], &b = solid.polygon_m[(i + 1) % solid.polygon_m.size()];
  const Eigen::Vector2d along = (b - a).normalized();
  const Eigen::Vector2d outward(along.y(), -along.x());
  Quad quad;
  quad.corners_m = {Eigen::Vector3d{a.x(), a.y(), solid.z_min_m},
                    {b.x(), b.y(), solid.z_min_m},
                    {b.x(), b.y(), solid.z_max_m},
                    {a.x(), a.y(), solid.z_max_m}};
  if (solid.fit_texture) {
    quad.uv = fittedUv(solid.material, quad.corners_m[0]);
  } else {
    const double shift = shiftOf(outward.dot(a), std::atan2(outward.y(), outward.x()));
    const double u0 = along.dot(a) / texture.width_m + shift, u1 = along.dot(b) / texture.width_m + shift;
    const double v0 = 1 - solid.z_min_m / texture.height_m, v1 = 1 - solid.z_max_m / texture.height_m;
    quad.uv = {Eigen::Vector2d{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
  }
  addQuad(quad, {solid.material, drawing.shaded ? shadeOf({outward.x(), outward.y(), 0}) : 0},
          drawing.meshes);
}

// Top (facing up) or bottom of a prism: a fan.
void addLid(const Solid& solid, bool top, const Drawing& drawing) {
  const Texture& texture = drawing.texture;
  const Eigen::Vector3d normal(0, 0, top ? 1 : -1);
  auto& mesh = drawing.meshes[{solid.material, drawing.shaded ? shadeOf(normal) : 0}];
  const auto vertex = [&](std::size_t i) {
    const Eigen::Vector2d& p = solid.polygon_m[i];
    const double z_m = top ? solid.z_max_m : solid.z_min_m;
    return MeshVertex{{p.x(), p.y(), z_m}, normal, {p.x() / texture.width_m, p.y() / texture.height_m}};
  };
  for (std::size_t i = 1; i + 1 < solid.polygon_m.size(); ++i) {
    if (top)
      mesh.push_back({vertex(0), vertex(i), vertex(i + 1)});
    else
      mesh.push_back({vertex(0), vertex(i + 1), vertex(i)});
  }
}

}  // namespace

double brightnessOf(int shade) { return 0.85 + 0.15 * shade / (kShades - 1); }

Meshes meshSolids(const std::vector<Solid>& solids, const Textures& textures, bool shaded) {
  Meshes meshes;
  for (const Solid& solid : solids) {
    const Drawing drawing{textures.at(solid.material), shaded, meshes};
    for (std::size_t i = 0; i < solid.polygon_m.size(); ++i) addSide(solid, i, drawing);
    addLid(solid, true, drawing);
    if (solid.z_min_m > 0) addLid(solid, false, drawing);
  }
  return meshes;
}

void addFloorAndCeiling(const World& world, const Textures& textures, Meshes& meshes) {
  const double x0 = world.min_m.x(), y0 = world.min_m.y(), x1 = world.max_m.x(), y1 = world.max_m.y();
  const auto plane = [&](double z_m, Material material, bool up) {
    const Texture& texture = textures.at(material);
    Quad quad;
    quad.corners_m = {Eigen::Vector3d{x0, y0, z_m}, {x1, y0, z_m}, {x1, y1, z_m}, {x0, y1, z_m}};
    if (!up) std::swap(quad.corners_m[1], quad.corners_m[3]);
    for (std::size_t i = 0; i < 4; ++i)
      quad.uv[i] = {quad.corners_m[i].x() / texture.width_m, quad.corners_m[i].y() / texture.height_m};
    addQuad(quad, {material, shadeOf({0, 0, up ? 1.0 : -1.0})}, meshes);
  };
  plane(0, Material::kCarpet, true);
  plane(world.ceiling_m, Material::kCeiling, false);
}

}  // namespace cornerstone
