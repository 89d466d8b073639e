// A list of gpgp's of what ImGui's draw data hold, in their order: triangles, glyphs, widgets, each cut by its clip
// rectangle.
#pragma once
#include "fonts.h"

#include <gpgp/gpgp.hpp>

#include <deque>
#include <optional>
#include <span>
#include <string>

namespace gpgp::imgui {

/// A drawing or a layout, at its place in a draw list by a callback that has a pointer to it. ImGui's units.
struct Widget {
  const void* owner = nullptr;
  GpgpAsset drawing = nullptr; ///< null: glyphs and lines
  ImVec2 position, size;       ///< size: of a drawing's box
  std::vector<GpgpTextGlyph> glyphs;
  std::vector<GpgpTextDecoration> lines;
};

/// What textures are to the writer.
struct TextureUse {
  uint32_t image = GPGP_IMAGE_NONE; ///< among those of the recording
  std::optional<ImVec2> white;      ///< texture coordinates at which it is white
};

/// What the writer asks of whoever keeps textures and glyphs.
class Painter {
public:
  virtual ~Painter() = default;
  /// INVALID_HANDLE: there is no such texture. INVALID_ARGUMENT: more than a recording may have.
  virtual GpgpResult texture(ImTextureID id, bool used, TextureUse& use) = 0;
  /// Adds glyphs and lines at their places.
  virtual GpgpResult text(std::span<const GpgpTextGlyph> glyphs, std::span<const GpgpTextDecoration> lines) = 0;
};

struct WriterInfo {
  ImDrawCallback callback = nullptr; ///< of widgets
  const void* owner = nullptr;
  const std::vector<AtlasGlyph>* glyphs = nullptr; ///< known by texture coordinates of atlasTexture
  ImTextureID atlasTexture = nullptr;
  bool srgbTarget = false;
  uint32_t maxTriangles = 0, maxGlyphs = 0;
};

/// What came of it.
struct Written {
  uint32_t triangles = 0, glyphs = 0, widgets = 0, dropped = 0;
  std::string error; ///< what the result is an error for
};

GpgpResult writeList(const ImDrawData& data, const WriterInfo& info, Painter& painter, List& list, Written& written);

} // namespace gpgp::imgui
