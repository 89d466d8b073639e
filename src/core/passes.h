// Passes are data: a service describes its work as a list of resources and passes, once, when a recorder is created.
//
// From the list come the scratch layout, the barriers, the descriptor set layout (binding number = resource number),
// the recorded commands, debug labels, timestamps, and the pass tables of the documentation. Nothing about a recording
// is decided again while recording.
#pragma once
#include "core/shader_code.h"

#include <array>
#include <memory_resource>
#include <span>
#include <vector>

namespace gpgp::core {

using ResourceIndex =
    uint32_t; // its place in PassList::resources, and its binding in descriptor set 0 (textures: below)

enum class ResourceKind : uint8_t {
  buffer,  ///< given with each recording: the engine's, an asset's or a history's
  image,   ///< given with each recording: a storage image of the engine's
  texture, ///< given with each recording: an image of the engine's with a sampler, read only. Textures lie in a row, in
           ///< descriptor set 1, which recordings without them leave unbound
  scratch, ///< part of the scratch buffer, contents undefined between recordings
  constants, ///< written by the CPU with each recording, read by shaders
  uniforms,  ///< the same as a uniform block, for what is small and every invocation reads
  report,    ///< a recording's report where the host reads it, for passes that write it themselves (Record::reports)
};

struct Resource {
  const char* name;
  ResourceKind kind;
  VkDeviceSize bytes = 0; ///< scratch, constants and uniforms; buffer: room for what a recording gives from the host
  bool optional = false;  ///< buffer, image, texture: a recording may leave it out; an unused range is bound instead
  bool written = false;   ///< by a pass (finish)
};

constexpr VkDescriptorType descriptorType(ResourceKind kind) {
  switch (kind) {
  case ResourceKind::image: return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  case ResourceKind::texture: return VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  case ResourceKind::uniforms: return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  default: return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  }
}

enum class UseKind : uint8_t { read, write, readWrite, indirect };
struct Use {
  ResourceIndex resource;
  UseKind kind;
};

constexpr uint32_t kMaxSpecialization = 10;
struct ShaderDesc {
  const char* name;
  ShaderCode spirv;
  std::array<uint32_t, kMaxSpecialization> specialization = {}; ///< by constant_id
  uint32_t specializationCount = 0;
  /// The resources that it binds, a bit each, where pipelines stand in for it that other recorders made: the same in
  /// all of them. 0: those that its code uses.
  uint64_t bindings = 0;
  bool replaced = false; ///< in every recording (Record::replacement): no pipeline is made of it
};

enum class PassKind : uint8_t { dispatch, dispatchIndirect, fill };
constexpr uint32_t kMaxUses = 32;
constexpr uint32_t kMaxPassConstants = 8;

struct Pass {
  const char* name;
  PassKind kind;
  uint32_t shader = 0;                 ///< index in PassList::shaders
  std::array<Use, kMaxUses> uses = {}; ///< all that its shader could touch, for barriers
  uint32_t useCount = 0;
  uint32_t groups = 0;                                    ///< dispatch: index in a recording's list of workgroup counts
  ResourceIndex target = 0;                               ///< indirect: arguments; fill: destination
  VkDeviceSize offset = 0, size = VK_WHOLE_SIZE;          ///< indirect, fill: bytes in the resource
  uint32_t value = 0;                                     ///< fill
  std::array<uint32_t, kMaxPassConstants> constants = {}; ///< push constants, the same in every recording
  uint32_t constantCount = 0;
  uint32_t condition = UINT32_MAX; ///< index in a recording's list of flags: left out of the recording when false
  uint32_t level = 0;              ///< left out of recordings that ask for as many levels or fewer
  bool beside = false;             ///< needs no barrier after the pass before: what both write, they add to, or
                                   ///< only one of them is recorded
  bool paged = false;              ///< dispatched for each page of textures that a recording gives, with the page's
                                   ///< number and constant as push constants
  bool stepped = false;            ///< dispatched as a recording's steps say, any number of times; such passes lie in a
                                   ///< row
  bool barrierBefore = false;      ///< worked out by finish()
  uint32_t kindsAhead = 0;         ///< worked out by finish(): bits by PassKind, of this pass and those behind it up to
                                   ///< the next barrier
};

struct PassList {
  explicit PassList(std::pmr::memory_resource* memory)
      : resources(memory), shaders(memory), passes(memory), scratchOffsets(memory) {}
  std::pmr::vector<Resource> resources;
  std::pmr::vector<ShaderDesc> shaders;
  std::pmr::vector<Pass> passes;
  ResourceIndex report = UINT32_MAX; ///< a scratch resource: its first reportBytes are copied to the host at the end,
                                     ///< unless passes write it to a resource of kind report
  uint32_t reportBytes = 0;
  ResourceIndex readBack = UINT32_MAX; ///< a scratch resource: as much as a recording says (Record::readBackBytes) of
                                       ///< its first readBackBytes comes to the host behind the report
  uint32_t readBackBytes = 0;          ///< a multiple of 8
  uint32_t groupCounts = 0;            ///< how many workgroup counts a recording gives
  uint32_t texturePages = 1;           ///< a recording's textures at most: as many times those of the list

  // worked out by finish()
  std::pmr::vector<VkDeviceSize> scratchOffsets; ///< by resource
  VkDeviceSize scratchBytes = 0;
  VkDeviceSize constantsBytes = 0;

  ResourceIndex add(Resource resource) {
    resources.push_back(resource);
    return static_cast<ResourceIndex>(resources.size() - 1);
  }
  uint32_t add(ShaderDesc shader) {
    shaders.push_back(shader);
    return static_cast<uint32_t>(shaders.size() - 1);
  }
  Pass& dispatch(const char* name, uint32_t shader, std::initializer_list<Use> uses, uint32_t groups,
                 std::initializer_list<uint32_t> constants = {});
  Pass& dispatchIndirect(const char* name, uint32_t shader, std::initializer_list<Use> uses, ResourceIndex arguments,
                         VkDeviceSize offset, std::initializer_list<uint32_t> constants = {});
  Pass& fill(const char* name, ResourceIndex target, uint32_t value, VkDeviceSize offset = 0,
             VkDeviceSize size = VK_WHOLE_SIZE);

  /// Lays out scratch (alignment: minStorageBufferOffsetAlignment) and decides barriers: a pass gets one before it
  /// when it uses what a pass since the last barrier wrote, or writes what one used, unless it goes beside that.
  void finish(VkDeviceSize alignment);
};

} // namespace gpgp::core
