// What the stages that describe the canvas's passes share: the list, its resources, and the forms that passes come in.
#pragma once
#include "core/passes.h"
#include "shaders/vector_shaders.h"
#include "vector/passes/names.h"
#include "vector/passes/sizes.h"

namespace gpgp::vector {

using Spirv = core::ShaderCode;
/// By drawings: one, several, projective items (shaders.cmake).
using Forms = std::array<Spirv, 3>;
using FormNames = std::array<const char*, 3>;

class PassBuilder {
public:
  PassBuilder(const CanvasSizes& sizes, const core::Device& device, std::pmr::memory_resource* memory);

  /// A pass whose shader fetches from drawings.
  core::Pass& dispatch(const char* name, Spirv spirv, std::initializer_list<core::Use> uses, uint32_t groups,
                       uint32_t condition);
  /// Shaders that fetch from drawings come in three forms: one need not choose among drawings at each access, two know
  /// no projective items. Of the three passes one is recorded, by condition, condition + 1, condition + 2.
  void forms(const FormNames& names, const Forms& spirv, std::initializer_list<core::Use> uses, uint32_t groups,
             uint32_t condition);
  /// Clears what tiles have: their words or entries (software devices).
  void clear(const char* name, Spirv spirv, core::ResourceIndex what);
  /// Gives tiles with edges their entries. withRows: it also lists the rows that have any (software devices).
  void allocate(const char* name, Spirv spirv, uint32_t groups, bool withRows);
  /// From the lists that mark has written, or without them where these did not suffice; allocate says which.
  void fill(const char* name, Spirv spirv, bool fromLists, uint32_t condition, bool beside);
  /// Paints tiles that passes before have listed, by target, for those that the canvas writes.
  void painted(const FormNames& names, const Forms& byTarget, uint32_t condition, VkDeviceSize arguments);
  core::Pass& listedTiles(const char* name, Spirv spirv, uint32_t condition, VkDeviceSize arguments);
  /// Adds the image that a pass writes, and its condition.
  void target(core::Pass& pass, uint32_t target, uint32_t condition) const;
  void useImages(core::Pass& pass) const;

  core::PassList list;
  const CanvasSizes& sizes;
  const bool subgroups; ///< shaders with subgroup arithmetic
  core::ResourceIndex history = 0, image8 = 0, image16 = 0;
  core::ResourceIndex fromHost = 0, paths = 0, words = 0, bins = 0, entries = 0, counters = 0, items = 0, images = 0,
                      segments = 0, rows = 0, shapes = 0, aside = 0, pictures = 0, operations = 0, layeredHistory = 0,
                      imageColors = 0;
};

// Stages, in the order in which they are recorded.
void addBegin(PassBuilder& builder);          ///< begin, and where there are small glyphs alone those
void addPlace(PassBuilder& builder);          ///< place, small glyphs
void addMark(PassBuilder& builder);           ///< mark, pack
void addImages(PassBuilder& builder);         ///< colours of images, where these come in pages
void addFill(PassBuilder& builder);           ///< allocate, split, fill
void addRaster(PassBuilder& builder);         ///< raster
void addSoftwareFill(PassBuilder& builder);   ///< addFill's on software devices
void addSoftwareRaster(PassBuilder& builder); ///< addRaster's on software devices
void addLayers(PassBuilder& builder);         ///< what composites and filters layers

/// All passes of a canvas. `sizes` only need live during the call.
core::PassList describePasses(const CanvasSizes& sizes, const core::Device& device, std::pmr::memory_resource* memory);

} // namespace gpgp::vector
