// Instances as a glTF 2 binary file of triangles.
#pragma once
#include <gpgp/spawn.h>

#include <glm/glm.hpp>

#include <filesystem>
#include <functional>
#include <span>
#include <string>

namespace gpgp::cli {

/// The unit shape's point p placed by the instance.
glm::vec3 placed(const GpgpInstance& instance, const glm::vec3& p);

/// One mesh a bucket, its instances expanded, without normals: viewers light such triangles flat. Throws where it would
/// be larger than the 4 GiB that the format holds, or cannot be written.
void writeGlb(const std::filesystem::path& file, std::span<const GpgpInstance> instances, uint32_t buckets,
              const std::function<std::string(uint32_t)>& name, const std::function<glm::vec3(uint32_t)>& colour);

} // namespace gpgp::cli
