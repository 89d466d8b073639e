// What both renderers need: device, gpgp, the world's buffers, pictures of triangle numbers, the sun's shadow.
#pragma once
#include "buffer_set.h"
#include "forward.h"
#include "gpgp_glue.h"
#include "world.h"

#include <array>
#include <functional>

namespace streaming {

constexpr uint32_t kShadowSide = 2048; // surface.glsl

/// A buffer that the host reads or writes.
mini::Buffer makeHostBuffer(mini::Device& device, VkDeviceSize bytes, VkBufferUsageFlags usage);
mini::Buffer makeDeviceBuffer(mini::Device& device, VkDeviceSize bytes);

void barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written, VkPipelineStageFlags to,
             VkAccessFlags read);

/// Device, gpgp's context and one frame after another, each waited for.
class Stage {
public:
  Stage(const std::string& device, bool validate);
  /// Records, submits and waits. gpgp's pending uploads come first.
  void run(const std::function<void(VkCommandBuffer, const GpgpFrame&)>& record);
  /// Throws where a validation message came.
  void checkMessages() const;

  mini::Device device;
  mini::Gpgp gpgp;

private:
  gpgp::sdl2::Frames frames_;
};

/// Geometry and materials in storage buffers, in the order of surface.glsl's bindings.
struct SceneBuffers {
  SceneBuffers(mini::Device& device, const World& world);
  std::vector<const mini::Buffer*> all() const { return {&positions, &normals, &indices, &draws, &meshes, &materials}; }
  mini::Buffer positions, normals, indices, draws, meshes, materials;
};

/// Draws triangle numbers, barycentrics and depth (visible.frag) into a buffer of one uvec4 for each pixel.
class TrianglePicture {
public:
  TrianglePicture(mini::Device& device, const World& world, const SceneBuffers& scene, VkExtent2D extent);
  ~TrianglePicture();
  TrianglePicture(const TrianglePicture&) = delete;
  TrianglePicture& operator=(const TrianglePicture&) = delete;
  /// The buffer is then ready for compute shaders.
  void record(VkCommandBuffer commands, const glm::mat4& viewProjection);
  mini::Buffer pixels;

private:
  mini::Device& device_;
  const World& world_;
  VkExtent2D extent_;
  mini::Image colour_, depth_;
  VkRenderPass renderPass_ = VK_NULL_HANDLE;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
  mini::BufferSet set_;
  mini::Pipeline pipeline_;
};

/// The sun's picture of the whole world, made once.
class Shadow {
public:
  Shadow(Stage& stage, const World& world, const SceneBuffers& scene);
  mini::Buffer pixels;
  glm::mat4 matrix;
};

/// Place and reach of the lantern at a time.
glm::vec4 lanternAt(double seconds, const World& world);

} // namespace streaming
