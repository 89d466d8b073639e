// A list: what the engine adds to a user interface in a frame, as it will be placed.
//
// Moves and even scales are applied to shapes and glyphs as they come, so that what differs by them alone shares a
// base: the map that leads from their coordinates to the list's space. Everything else of the state is in the command.
#pragma once
#include "core/context.h"
#include "vector/patch/drawing.h"
#include "vector/patch/layers.h"
#include "vector/raster/place.h"

#include <gpgp/ui.h>

namespace gpgp::vector {

class List final : public core::Object {
public:
  static core::Result<core::Unique<List>> create(core::Context& context, const GpgpListCreateInfo& info);
  List(core::Context& owner, const char* name);

  void reset();
  core::Result<void> pushTransform(const float* transform, const float* perspective);
  core::Result<void> pushClip(const float* box, const float* radii);
  core::Result<void> pushOpacity(float opacity);
  core::Result<void> pushGroup(float opacity);
  core::Result<void> pushLayer(const GpgpListLayer& layer);
  core::Result<uint32_t> pushMask(); ///< its number
  core::Result<void> pop();
  core::Result<void> addShapes(std::span<const GpgpListShape> shapes);
  core::Result<void> addTriangles(const GpgpListTriangles& triangles);
  core::Result<void> addText(const core::Object& glyphSet, std::span<const GpgpGlyphInstance> glyphs, uint64_t id);
  void addDrawing(const core::Object& drawing, uint32_t firstImage, uint64_t id);

  /// The space in which something was added: scale and move lead to the base's, whose map leads to the list's.
  struct Space {
    uint32_t base = 0, clip = 0, group = 0; ///< clip, group: 1 + the index; 0: none
    double scale = 1, x = 0, y = 0;
    bool operator==(const Space&) const = default;
    Map map() const { return {scale, 0, 0, scale, x, y}; }
  };
  struct Clip {
    shader::ShapeRecord shape; ///< in the base's space
    uint32_t base, parent, depth;
  };
  struct Group {
    float opacity; ///< times those pushed around it, up to the next group
    uint32_t parent, depth;
  };
  struct Shape {
    shader::ShapeRecord record; ///< in the base's space; paint: of paints(). Triangles: toRecord() completes it
    shader::vec4 color;
    uint64_t id; ///< of a triangle: its index among those that were given
  };
  /// A triangle's record with its colours as a canvas mixes them.
  static shader::ShapeRecord toRecord(const shader::ShapeRecord& triangle, bool blendSrgb);
  /// What happens with the picture of the commands that follow its own.
  struct Layer {
    uint32_t node; ///< of plan()
    uint32_t mask; ///< 1 + the index of the command that begins it; 0: none
    bool inverted, backdrop, bounded;
    float bounds[4];
  };
  enum class Kind : uint32_t { shapes, triangles, text, drawing, layer, mask };
  struct Command {
    Kind kind;
    /// Of shapes() (triangles, too) or glyphs(). Layer: of layers(); layer, mask: how many commands are its own.
    uint32_t first = 0, count = 0;
    uint32_t firstEntry = 0; ///< as GpgpHit::entry counts
    Space space;
    float opacity = 1;       ///< of a drawing or layer; the others have it in their colours
    uint32_t firstImage = 0; ///< of a drawing
    uint32_t picture = 0;    ///< 1 + the command of the innermost layer or mask that it lies in; 0: none
    const core::Slot* slot = nullptr;
    uint32_t generation = 0;
    uint64_t id = 0; ///< of triangles, a text or a drawing
    /// The glyph set or drawing; null where it was destroyed.
    const core::Object* asset() const { return slot->generation == generation ? slot->object : nullptr; }
  };
  uint32_t depth() const { return static_cast<uint32_t>(stack_.size()); } ///< pushes that are not popped
  std::span<const Map> bases() const { return bases_; }
  std::span<const Clip> clips() const { return clips_; }
  std::span<const Group> groups() const { return groups_; }
  std::span<const Command> commands() const { return commands_; }
  std::span<const Layer> layers() const { return layers_; }
  uint32_t masks() const { return static_cast<uint32_t>(masks_.size()); }
  const LayerPlan& plan() const { return plan_; }       ///< nodes and steps of layers alone
  const LayerBounds& bounds() const { return bounds_; } ///< of steps alone
  std::span<const Shape> shapes() const { return shapes_; }
  std::span<const GpgpGlyphInstance> glyphs() const { return glyphs_; }
  const Drawing& paints() const { return paints_; } ///< paints and stops alone
  uint32_t images() const { return images_; }       ///< that shapes need, from the item's first one on

private:
  struct State {
    Space space;
    float opacity = 1;     ///< of each thing within the group
    uint32_t open = 0;     ///< 1 + the command of the innermost layer or mask; 0: none
    uint32_t pictures = 0; ///< layers and masks in each other
  };
  core::Result<void> checkDepth() const;
  core::Result<void> checkOpacity(float opacity) const;
  core::Result<void> addShape(const GpgpListShape& shape);
  core::Result<uint32_t> addPaint(const GpgpListShape& shape);
  core::Result<uint32_t> addImagePaint(const GpgpListImage& image, const shader::vec4& box);
  Command& addCommand(Kind what);
  void beginPicture(Kind what, uint32_t index);

  State state_;
  std::pmr::vector<State> stack_;
  std::pmr::vector<Map> bases_;
  std::pmr::vector<Clip> clips_;
  std::pmr::vector<Group> groups_;
  std::pmr::vector<Layer> layers_;
  std::pmr::vector<uint32_t> masks_; ///< their commands
  LayerPlan plan_;
  LayerBounds bounds_;
  std::pmr::vector<Command> commands_;
  std::pmr::vector<Shape> shapes_;
  std::pmr::vector<GpgpGlyphInstance> glyphs_;
  Drawing paints_;
  uint32_t images_ = 0, entries_ = 0;
  size_t closed_ = 0; ///< commands up to the last layer or mask that was popped
};

} // namespace gpgp::vector
