// Prisms -> textured triangles, one mesh a material. u runs along a face by its place in the world, so that
// pieces of one wall continue one another; v by height.
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

using Meshes = std::map<Material, std::vector<std::array<MeshVertex, 3>>>;
using Textures = std::map<Material, Texture>;

Meshes meshSolids(const std::vector<Solid>& solids, const Textures& textures);

// Floor and ceiling of the world's extent.
void addFloorAndCeiling(const World& world, const Textures& textures, Meshes& meshes);

}  // namespace cornerstone
