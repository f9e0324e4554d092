// Prisms -> textured triangles, one mesh a material and shade: the renderer's own lighting costs as much time
// as all the rest, so that faces get their shade from their direction here, the same for every camera. u runs
// along a face by its place in the world, so that pieces of one wall continue one another; v by height.
#pragma once

#include <array>
#include <map>

#include "cornerstone/simulation/world.h"
#include "textures.h"

namespace cornerstone {

struct MeshVertex {
  Eigen::Vector3d at_m;
  Eigen::Vector3d normal;
  Eigen::Vector2d uv;
};

struct Finish {
  Material material = Material::kPlaster;
  int shade = 0;  // 0: lit least, kShades - 1: lit fully
  bool operator<(const Finish& other) const {
    return material != other.material ? material < other.material : shade < other.shade;
  }
};
constexpr int kShades = 4;
double brightnessOf(int shade);

using Meshes = std::map<Finish, std::vector<std::array<MeshVertex, 3>>>;
using Textures = std::map<Material, Texture>;

// shaded = false for what turns: all of it gets the least shade.
Meshes meshSolids(const std::vector<Solid>& solids, const Textures& textures, bool shaded);

// Floor and ceiling of the world's extent.
void addFloorAndCeiling(const World& world, const Textures& textures, Meshes& meshes);

}  // namespace cornerstone
