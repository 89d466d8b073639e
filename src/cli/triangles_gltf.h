// Triangles as a glTF 2 binary file.
#pragma once
#include <glm/glm.hpp>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gpgp::cli {

/// One mesh a bucket, of three corners a triangle, without normals: viewers light such triangles flat. Throws where it
/// would be larger than the 4 GiB that the format holds, or cannot be written.
void writeGlb(const std::filesystem::path& file, const std::vector<std::vector<glm::vec3>>& corners,
              const std::function<std::string(uint32_t)>& name, const std::function<glm::vec3(uint32_t)>& colour);

} // namespace gpgp::cli
