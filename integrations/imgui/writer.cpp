#include "writer.h"

#include "gpgp_srgb.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpgp::imgui {
using integration::linearFromSrgb;
namespace {

constexpr float kFar = 1e6f; // pixels

/// Framebuffer pixels.
struct Box {
  float left = 0, top = 0, right = 0, bottom = 0;
  bool empty() const { return !(left < right && top < bottom); }
  bool operator==(const Box&) const = default;
};
Box meet(const Box& a, const Box& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

constexpr int kShifts[4] = {IM_COL32_R_SHIFT, IM_COL32_G_SHIFT, IM_COL32_B_SHIFT, IM_COL32_A_SHIFT};

class Writer {
public:
  Writer(const ImDrawData& data, const WriterInfo& info, Painter& painter, List& list, Written& written)
      : data_(data), info_(info), painter_(painter), list_(list),
        written_(written), screen_{0, 0, std::floor(data.DisplaySize.x * data.FramebufferScale.x),
                                   std::floor(data.DisplaySize.y * data.FramebufferScale.y)} {}

  GpgpResult write() {
    for (listNumber_ = 0; listNumber_ < data_.CmdListsCount && error_ >= 0; ++listNumber_) {
      const ImDrawList& list = *data_.CmdLists[listNumber_];
      for (commandNumber_ = 0; commandNumber_ < list.CmdBuffer.Size && error_ >= 0; ++commandNumber_)
        command(list, list.CmdBuffer[commandNumber_]);
    }
    leaveClip();
    return error_;
  }

private:
  float screenX(float x) const { return (x - data_.DisplayPos.x) * data_.FramebufferScale.x; }
  float screenY(float y) const { return (y - data_.DisplayPos.y) * data_.FramebufferScale.y; }

  bool did(GpgpResult result) {
    if (result < 0 && error_ >= 0) error_ = result;
    return error_ >= 0;
  }
  /// With the place in the draw data.
  void refuse(GpgpResult result, const std::string& what) {
    if (error_ < 0) return;
    error_ = result;
    const char* owner = data_.CmdLists[listNumber_]->_OwnerName;
    written_.error = "draw list " + std::to_string(listNumber_) + (owner ? " (" + std::string(owner) + ")" : "") +
                     ", command " + std::to_string(commandNumber_) + ": " + what;
  }

  /// A clip rectangle as ImGui's Vulkan renderer makes its scissor of it.
  Box scissor(const ImVec4& clip) const {
    const float left = std::max(screenX(clip.x), 0.0f), top = std::max(screenY(clip.y), 0.0f);
    const float width = std::clamp(screenX(clip.z) - left, 0.0f, kFar),
                height = std::clamp(screenY(clip.w) - top, 0.0f, kFar);
    const Box box{std::floor(left), std::floor(top), std::floor(left) + std::floor(width),
                  std::floor(top) + std::floor(height)};
    return meet(screen_, box);
  }
  /// What is added next is cut by this box.
  void enterClip(const Box& box) {
    if (clipped_ && clip_ == box) return;
    leaveClip();
    const float corners[4] = {box.left, box.top, box.right, box.bottom};
    clipped_ = did(list_.pushClip(corners));
    clip_ = box;
  }
  void leaveClip() {
    if (clipped_) did(list_.pop());
    clipped_ = false;
  }

  void command(const ImDrawList& list, const ImDrawCmd& command) {
    commandClip_ = scissor(command.ClipRect);
    if (command.UserCallback == ImDrawCallback_ResetRenderState) return; // there is none
    if (command.UserCallback) {
      const auto* data = static_cast<const Widget*>(command.UserCallbackData);
      if (command.UserCallback != info_.callback)
        refuse(GPGP_ERROR_UNSUPPORTED, "a draw callback, which gpgp cannot call inside a canvas");
      else if (data->owner != info_.owner)
        refuse(GPGP_ERROR_INVALID_HANDLE, "a widget of another renderer");
      else if (!commandClip_.empty())
        widget(*data);
      return;
    }
    if (command.ElemCount > 0) triangles(list, command);
  }

  // ---- triangles, and text in them

  bool isGlyph(const ImDrawVert& vertex, uint32_t& number) const {
    if (!glyphs_ || !(vertex.uv.x >= 1.5f && vertex.uv.y >= 1.5f && vertex.uv.x < kFar && vertex.uv.y < kFar))
      return false;
    number = static_cast<uint32_t>((vertex.uv.x - 1.5f) / 2) + 1024u * static_cast<uint32_t>((vertex.uv.y - 1.5f) / 2);
    return number < info_.glyphs->size();
  }

  void triangles(const ImDrawList& list, const ImDrawCmd& command) {
    const ImTextureID id = command.GetTexID();
    if (const GpgpResult known = painter_.texture(id, false, texture_); known < 0) return badTexture(known, id);
    if (size_t{command.IdxOffset} + command.ElemCount > static_cast<size_t>(list.IdxBuffer.Size) ||
        command.VtxOffset > static_cast<size_t>(list.VtxBuffer.Size))
      return refuse(GPGP_ERROR_INVALID_ARGUMENT, "indices beyond those of the list");
    textureId_ = id;
    glyphs_ = info_.glyphs && info_.atlasTexture && id == info_.atlasTexture;
    const ImDrawIdx* from = list.IdxBuffer.Data + command.IdxOffset;
    const ImDrawVert* vertices = list.VtxBuffer.Data + command.VtxOffset;
    const size_t count = static_cast<size_t>(list.VtxBuffer.Size) - command.VtxOffset;
    for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
      if (from[i] >= count || from[i + 1] >= count || from[i + 2] >= count)
        return refuse(GPGP_ERROR_INVALID_ARGUMENT, "index " + std::to_string(command.IdxOffset + i) +
                                                       " or one of the next two lies beyond the list's vertices");
      const std::array corners{&vertices[from[i]], &vertices[from[i + 1]], &vertices[from[i + 2]]};
      uint32_t number = 0;
      if (isGlyph(*corners[0], number)) {
        // A quad is (a, b, c), (a, c, d) with a and c opposite; the first triangle says it all.
        if (i < 3 || from[i] != from[i - 3] || from[i + 1] != from[i - 1]) glyph(number, *corners[0], *corners[2]);
      } else {
        triangle(corners);
      }
      if (error_ < 0) return;
    }
    flushTriangles();
    flushGlyphs();
  }

  void badTexture(GpgpResult result, ImTextureID id) {
    char text[32];
    std::snprintf(text, sizeof text, "texture %p", static_cast<void*>(id));
    refuse(result,
           std::string(text) + (result == GPGP_ERROR_INVALID_HANDLE ? " is none of createFontTexture's and addTexture's"
                                                                    : " is one more than RendererInfo::maxTextures"));
  }

  void triangle(const std::array<const ImDrawVert*, 3>& corners) {
    std::array<GpgpListVertex, 3> made{};
    bool placed = true, white = texture_.white.has_value();
    for (size_t k = 0; k < 3; ++k) {
      const ImDrawVert& v = *corners[k];
      GpgpListVertex& to = made[k];
      to.x = screenX(v.pos.x);
      to.y = screenY(v.pos.y);
      to.u = v.uv.x;
      to.v = v.uv.y;
      for (size_t c = 0; c < 4; ++c) to.color[c] = static_cast<uint8_t>(v.col >> kShifts[c] & 255u);
      placed =
          placed && std::abs(to.x) < kFar && std::abs(to.y) < kFar && std::abs(to.u) < kFar && std::abs(to.v) < kFar;
      white = white && to.u == texture_.white->x && to.v == texture_.white->y;
    }
    if (!placed) {
      ++written_.dropped;
      return;
    }
    const auto [x0, x1] = std::minmax({made[0].x, made[1].x, made[2].x});
    const auto [y0, y1] = std::minmax({made[0].y, made[1].y, made[2].y});
    const float turn =
        (made[1].x - made[0].x) * (made[2].y - made[0].y) - (made[1].y - made[0].y) * (made[2].x - made[0].x);
    if (meet({x0, y0, x1, y1}, commandClip_).empty() || turn == 0) return;
    if (written_.triangles == info_.maxTriangles) {
      ++written_.dropped;
      return;
    }
    ++written_.triangles;
    flushGlyphs(); // what the triangle lies on
    if (white != white_) flushTriangles();
    white_ = white;
    vertices_.insert(vertices_.end(), made.begin(), made.end());
  }

  void flushTriangles() {
    if (vertices_.empty() || error_ < 0) return;
    GpgpListTriangles triangles{};
    triangles.vertices = vertices_.data();
    triangles.vertexCount = static_cast<uint32_t>(vertices_.size());
    triangles.encoding = info_.srgbTarget ? GPGP_IMAGE_LINEAR : GPGP_IMAGE_SRGB;
    triangles.image = GPGP_IMAGE_NONE;
    triangles.id = GPGP_ID_NOT_HIT;
    if (!white_) {
      if (const GpgpResult used = painter_.texture(textureId_, true, texture_); used < 0)
        return badTexture(used, textureId_);
      triangles.image = texture_.image;
    }
    enterClip(commandClip_);
    did(list_.add(triangles));
    vertices_.clear();
  }

  void glyph(uint32_t number, const ImDrawVert& low, const ImDrawVert& high) {
    const Box quad{screenX(low.pos.x), screenY(low.pos.y), screenX(high.pos.x), screenY(high.pos.y)};
    if (meet(quad, commandClip_).empty()) return;
    if (written_.glyphs == info_.maxGlyphs) {
      ++written_.dropped;
      return;
    }
    const AtlasGlyph& known = (*info_.glyphs)[number];
    const ImVec2 corner = glyphCorner(number);
    const float width = known.box[2] - known.box[0], height = known.box[3] - known.box[1];
    const float du = high.uv.x - low.uv.x, dv = high.uv.y - low.uv.y;
    const bool wide = du * width > dv * height; // the longer side tells the size best
    const float size = wide ? (quad.right - quad.left) / (du * width) : (quad.bottom - quad.top) / (dv * height);
    GpgpTextGlyph glyph{known.font, known.glyph};
    glyph.size = size;
    glyph.x = quad.left - (known.box[0] + (low.uv.x - corner.x) * width) * size;
    glyph.y = quad.top - (known.box[1] + (low.uv.y - corner.y) * height) * size;
    if (!(std::abs(glyph.x) < kFar && std::abs(glyph.y) < kFar && glyph.size > 0 && glyph.size < kFar)) {
      ++written_.dropped;
      return;
    }
    for (int i = 0; i < 4; ++i) {
      const float value = static_cast<float>(low.col >> kShifts[i] & 255u) / 255.0f;
      glyph.color[i] = i == 3 || info_.srgbTarget ? value : linearFromSrgb(value);
    }
    // Quads that ImGui has cut show a part of the glyph: their texture coordinates say on which sides.
    constexpr float kCut = 1e-3f;
    Box shown = commandClip_;
    if (low.uv.x > corner.x + kCut) shown.left = std::max(shown.left, quad.left);
    if (low.uv.y > corner.y + kCut) shown.top = std::max(shown.top, quad.top);
    if (high.uv.x < corner.x + 1 - kCut) shown.right = std::min(shown.right, quad.right);
    if (high.uv.y < corner.y + 1 - kCut) shown.bottom = std::min(shown.bottom, quad.bottom);
    flushTriangles(); // what the text lies on
    if (!run_.empty() && runClip_ != shown) flushGlyphs();
    runClip_ = shown;
    run_.push_back(glyph);
    ++written_.glyphs;
  }

  void flushGlyphs() {
    if (run_.empty() || error_ < 0) return;
    enterClip(runClip_);
    did(painter_.text(run_, {}));
    run_.clear();
  }

  // ---- widgets

  void widget(const Widget& widget) {
    if (widget.drawing) return drawing(widget);
    glyphsOfWidget_ = widget.glyphs; // ImGui's units from the position so far
    if (glyphsOfWidget_.size() > info_.maxGlyphs - written_.glyphs) {
      written_.dropped += static_cast<uint32_t>(glyphsOfWidget_.size()) - (info_.maxGlyphs - written_.glyphs);
      glyphsOfWidget_.resize(info_.maxGlyphs - written_.glyphs);
    }
    for (GpgpTextGlyph& glyph : glyphsOfWidget_) {
      glyph.x = screenX(widget.position.x + glyph.x);
      glyph.y = screenY(widget.position.y + glyph.y);
      glyph.size *= data_.FramebufferScale.y;
    }
    linesOfWidget_ = widget.lines;
    for (GpgpTextDecoration& line : linesOfWidget_)
      line.rect = {screenX(widget.position.x + line.rect.x), screenY(widget.position.y + line.rect.y),
                   line.rect.width * data_.FramebufferScale.x, line.rect.height * data_.FramebufferScale.y};
    written_.glyphs += static_cast<uint32_t>(glyphsOfWidget_.size());
    ++written_.widgets;
    enterClip(commandClip_);
    did(painter_.text(glyphsOfWidget_, linesOfWidget_));
  }

  /// The drawing's page in its box.
  void drawing(const Widget& widget) {
    GpgpDrawingInfo info = GPGP_DRAWING_INFO_INIT;
    if (gpgpGetDrawingInfo(widget.drawing, &info) < 0)
      return refuse(GPGP_ERROR_INVALID_HANDLE, "a widget's drawing is none, or was destroyed");
    const float* page = info.viewport;
    const float left = screenX(widget.position.x), top = screenY(widget.position.y);
    const float width = widget.size.x * data_.FramebufferScale.x, height = widget.size.y * data_.FramebufferScale.y;
    const float scale = std::min(width / std::max(page[2], 1e-6f), height / std::max(page[3], 1e-6f));
    const Box shown = meet(commandClip_, {left, top, left + width, top + height}); // it keeps to its box
    if (shown.empty()) return;
    const float place[6] = {scale,
                            0,
                            0,
                            scale,
                            left + (width - page[2] * scale) / 2 - page[0] * scale,
                            top + (height - page[3] * scale) / 2 - page[1] * scale};
    ++written_.widgets;
    enterClip(shown);
    if (!did(list_.pushTransform(place))) return;
    did(list_.add(widget.drawing, 0, GPGP_ID_NOT_HIT));
    did(list_.pop());
  }

  const ImDrawData& data_;
  const WriterInfo& info_;
  Painter& painter_;
  List& list_;
  Written& written_;
  const Box screen_;
  GpgpResult error_ = GPGP_SUCCESS;
  int listNumber_ = 0, commandNumber_ = 0;
  Box commandClip_, clip_, runClip_;
  bool clipped_ = false; // clip_ is pushed
  // Of the command at hand.
  ImTextureID textureId_ = nullptr;
  TextureUse texture_;
  bool glyphs_ = false; // of outlines may be in it
  bool white_ = false;  // vertices_ need no texture
  std::vector<GpgpListVertex> vertices_;
  std::vector<GpgpTextGlyph> run_, glyphsOfWidget_;
  std::vector<GpgpTextDecoration> linesOfWidget_;
};

} // namespace

GpgpResult writeList(const ImDrawData& data, const WriterInfo& info, Painter& painter, List& list, Written& written) {
  return Writer(data, info, painter, list, written).write();
}

} // namespace gpgp::imgui
