// The names that a model's file has for its groups and materials, in the order of the file.
#pragma once
#include <string>
#include <vector>

namespace gpgp::cli {

struct AssetNames {
  std::vector<std::string> groups, materials;
};
/// Of .obj files: g or o, and usemtl; of .gltf and .glb: nodes that have meshes, and materials. Others have none; so
/// have files that cannot be read.
AssetNames assetNames(const std::string& path);

} // namespace gpgp::cli
