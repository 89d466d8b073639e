#include "pieces.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace gpgp::imgui {

Rect intersect(const Rect& a, const Rect& b) {
  return {std::max(a.left, b.left), std::max(a.top, b.top), std::min(a.right, b.right), std::min(a.bottom, b.bottom)};
}

Rect unite(const Rect& a, const Rect& b) {
  return {std::min(a.left, b.left), std::min(a.top, b.top), std::max(a.right, b.right), std::max(a.bottom, b.bottom)};
}

Rect pixels(float left, float top, float right, float bottom) {
  const auto whole = [](float v) { return static_cast<int>(std::clamp(v, -1e6f, 1e6f)); };
  return {whole(std::floor(left)), whole(std::floor(top)), whole(std::ceil(right)), whole(std::ceil(bottom))};
}

void Pieces::clear() {
  all.clear();
  glyphs.clear();
  lines.clear();
  layers = dropped = 0;
}

namespace {

float linearFromSrgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }

class Collector {
public:
  Collector(ImDrawData& data, const PiecesInfo& info, Pieces& pieces)
      : data_(data), info_(info), pieces_(pieces), screen_(pixels(0, 0, data.DisplaySize.x * data.FramebufferScale.x,
                                                                  data.DisplaySize.y * data.FramebufferScale.y)) {}

  void list(ImDrawList& list) {
    ImVector<ImDrawCmd> commands;
    ImVector<ImDrawIdx> indices;
    indices.reserve(list.IdxBuffer.Size);
    for (const ImDrawCmd& command : list.CmdBuffer) {
      clip_ = intersect(screen_, scissor(command.ClipRect));
      if (command.UserCallback == info_.callback)
        widget(command, commands);
      else if (command.UserCallback)
        commands.push_back(command);
      else
        triangles(list, command, commands, indices);
    }
    list.CmdBuffer.swap(commands);
    list.IdxBuffer.swap(indices);
  }

private:
  float screenX(float x) const { return (x - data_.DisplayPos.x) * data_.FramebufferScale.x; }
  float screenY(float y) const { return (y - data_.DisplayPos.y) * data_.FramebufferScale.y; }

  /// A clip rectangle as ImGui's Vulkan renderer makes its scissor of it.
  Rect scissor(const ImVec4& clip) const {
    const float left = std::max(screenX(clip.x), 0.0f), top = std::max(screenY(clip.y), 0.0f);
    const Rect whole = pixels(left, top, left, top);
    return {whole.left, whole.top, whole.left + static_cast<int>(std::clamp(screenX(clip.z) - left, 0.0f, 1e6f)),
            whole.top + static_cast<int>(std::clamp(screenY(clip.w) - top, 0.0f, 1e6f))};
  }

  /// The callback, and what puts ImGui's state back after it.
  void emit(const ImDrawCmd& at, Piece& piece, ImVector<ImDrawCmd>& out) {
    if (piece.layer < 0) return;
    ImDrawCmd command = at;
    command.ElemCount = 0;
    command.UserCallback = info_.callback;
    command.UserCallbackData = &piece;
    out.push_back(command);
    command.UserCallback = ImDrawCallback_ResetRenderState;
    command.UserCallbackData = nullptr;
    out.push_back(command);
  }

  void widget(const ImDrawCmd& command, ImVector<ImDrawCmd>& out) {
    Piece& piece = *static_cast<Piece*>(command.UserCallbackData);
    if (piece.owner != info_.owner) { // another renderer's
      out.push_back(command);
      return;
    }
    piece.clip = clip_;
    const auto around = [&](float left, float top, float right, float bottom) {
      return pixels(screenX(piece.position.x + left), screenY(piece.position.y + top),
                    screenX(piece.position.x + right), screenY(piece.position.y + bottom));
    };
    const Rect box = piece.drawing ? around(0, 0, piece.size.x, piece.size.y)
                                   : around(piece.ink[0], piece.ink[1], piece.ink[2], piece.ink[3]);
    if (overlap(box, clip_)) {
      if (piece.drawing) {
        const Rect ink = place(piece);
        piece.parts.push_back({ink, intersect(ink, box)}); // it keeps to its box
      } else {
        for (size_t i = piece.firstGlyph; i < piece.firstGlyph + piece.glyphCount; ++i) {
          GpgpTextGlyph& glyph = pieces_.glyphs[i]; // ImGui's units from the position so far
          glyph.x = screenX(piece.position.x + glyph.x);
          glyph.y = screenY(piece.position.y + glyph.y);
          glyph.size *= data_.FramebufferScale.y;
        }
        for (size_t i = piece.firstLine; i < piece.firstLine + piece.lineCount; ++i) {
          GpgpTextRect& line = pieces_.lines[i].rect; // likewise
          line = {screenX(piece.position.x + line.x), screenY(piece.position.y + line.y),
                  line.width * data_.FramebufferScale.x, line.height * data_.FramebufferScale.y};
        }
        piece.parts.push_back({box, box});
      }
      giveLayer(piece);
    }
    emit(command, piece, out);
  }

  /// The drawing's page in its box.
  Rect place(Piece& piece) {
    GpgpDrawingInfo info = GPGP_DRAWING_INFO_INIT;
    if (gpgpGetDrawingInfo(piece.drawing, &info) < 0) return {};
    const float* page = info.viewport;
    const float width = piece.size.x * data_.FramebufferScale.x, height = piece.size.y * data_.FramebufferScale.y;
    const float scale = std::min(width / std::max(page[2], 1e-6f), height / std::max(page[3], 1e-6f));
    float* t = piece.transform;
    t[0] = t[3] = scale;
    t[1] = t[2] = 0;
    t[4] = screenX(piece.position.x) + (width - page[2] * scale) / 2 - page[0] * scale;
    t[5] = screenY(piece.position.y) + (height - page[3] * scale) / 2 - page[1] * scale;
    return pixels(info.bounds[0] * scale + t[4], info.bounds[1] * scale + t[5], info.bounds[2] * scale + t[4],
                  info.bounds[3] * scale + t[5]);
  }

  // ---- text in ImGui's triangles

  bool isGlyph(const ImDrawCmd& command, const ImDrawVert& vertex, uint32_t& number) const {
    if (vertex.uv.x < 1.5f || command.GetTexID() != info_.atlasTexture) return false;
    number = static_cast<uint32_t>((vertex.uv.x - 1.5f) / 2) + 1024u * static_cast<uint32_t>((vertex.uv.y - 1.5f) / 2);
    return number < info_.atlas->size();
  }

  void triangles(const ImDrawList& list, const ImDrawCmd& command, ImVector<ImDrawCmd>& out,
                 ImVector<ImDrawIdx>& indices) {
    ImDrawCmd plain = command;
    plain.IdxOffset = static_cast<unsigned>(indices.Size);
    const auto flushPlain = [&] {
      plain.ElemCount = static_cast<unsigned>(indices.Size) - plain.IdxOffset;
      if (plain.ElemCount > 0) out.push_back(plain);
      plain.IdxOffset = static_cast<unsigned>(indices.Size);
    };
    const auto flushText = [&] {
      if (runs_.empty()) return;
      flushPlain(); // what the text lies on
      emit(command, closeText(), out);
    };
    const ImDrawIdx* from = list.IdxBuffer.Data + command.IdxOffset;
    const ImDrawVert* vertices = list.VtxBuffer.Data + command.VtxOffset;
    for (unsigned i = 0; i + 2 < command.ElemCount; i += 3) {
      const ImDrawVert &a = vertices[from[i]], &b = vertices[from[i + 1]], &c = vertices[from[i + 2]];
      uint32_t number = 0;
      if (isGlyph(command, a, number)) {
        // A quad is (a, b, c), (a, c, d) with a and c opposite; the first triangle says it all.
        if (i < 3 || from[i] != from[i - 3] || from[i + 1] != from[i - 1]) glyph(number, a, c);
        continue;
      }
      // Later triangles may go below text that they do not touch: so one piece has the text of many widgets.
      if (!runs_.empty()) {
        const auto [x0, x1] = std::minmax({a.pos.x, b.pos.x, c.pos.x});
        const auto [y0, y1] = std::minmax({a.pos.y, b.pos.y, c.pos.y});
        const Rect box = pixels(screenX(x0), screenY(y0), screenX(x1), screenY(y1));
        if (std::any_of(runs_.begin(), runs_.end(), [&](const Piece::Part& run) { return overlap(run.shown, box); }))
          flushText();
      }
      indices.push_back(from[i]);
      indices.push_back(from[i + 1]);
      indices.push_back(from[i + 2]);
    }
    flushPlain();
    flushText();
  }

  void glyph(uint32_t number, const ImDrawVert& low, const ImDrawVert& high) {
    const Rect shown =
        intersect(clip_, pixels(screenX(low.pos.x), screenY(low.pos.y), screenX(high.pos.x), screenY(high.pos.y)));
    if (shown.empty()) return;
    if (pieces_.glyphs.size() == info_.maxGlyphs) {
      ++pieces_.dropped;
      return;
    }
    // Quads that ImGui has clipped show a part of the glyph: their texture coordinates say which.
    const AtlasGlyph& known = (*info_.atlas)[number];
    const ImVec2 corner = glyphCorner(number);
    const float width = known.box[2] - known.box[0], height = known.box[3] - known.box[1];
    const float du = high.uv.x - low.uv.x, dv = high.uv.y - low.uv.y;
    const bool wide = du * width > dv * height; // the longer side tells the size best
    const float size = wide ? (screenX(high.pos.x) - screenX(low.pos.x)) / (du * width)
                            : (screenY(high.pos.y) - screenY(low.pos.y)) / (dv * height);
    GpgpTextGlyph glyph{known.font, known.glyph};
    glyph.size = size;
    glyph.x = screenX(low.pos.x) - (known.box[0] + (low.uv.x - corner.x) * width) * size;
    glyph.y = screenY(low.pos.y) - (known.box[1] + (low.uv.y - corner.y) * height) * size;
    if (!(std::abs(glyph.x) < 1e6f && std::abs(glyph.y) < 1e6f && glyph.size > 0 && glyph.size < 1e6f)) return;
    const int shifts[4] = {IM_COL32_R_SHIFT, IM_COL32_G_SHIFT, IM_COL32_B_SHIFT, IM_COL32_A_SHIFT};
    for (int i = 0; i < 4; ++i) {
      const float value = static_cast<float>(low.col >> shifts[i] & 255u) / 255.0f;
      glyph.color[i] = i == 3 || info_.srgbTarget ? value : linearFromSrgb(value);
    }
    if (runs_.empty()) firstGlyph_ = pieces_.glyphs.size();
    pieces_.glyphs.push_back(glyph);
    const Rect ink = pixels(glyph.x + known.box[0] * size, glyph.y + known.box[1] * size, glyph.x + known.box[2] * size,
                            glyph.y + known.box[3] * size);
    // Onto the end of the line before, if it is the same line.
    if (!runs_.empty()) {
      Piece::Part& last = runs_.back();
      const bool sameLine = shown.top < last.shown.bottom && last.shown.top < shown.bottom;
      if (sameLine && static_cast<float>(std::abs(shown.left - last.shown.right)) < size) {
        last = {unite(last.ink, ink), unite(last.shown, shown)};
        return;
      }
    }
    runs_.push_back({ink, shown});
  }

  Piece& closeText() {
    Piece& piece = pieces_.all.emplace_back();
    piece.owner = info_.owner;
    piece.clip = clip_;
    piece.firstGlyph = firstGlyph_;
    piece.glyphCount = pieces_.glyphs.size() - firstGlyph_;
    // Lines that share pixels become one part: none is to be blended twice.
    for (Piece::Part run : runs_) {
      for (size_t i = 0; i < piece.parts.size();) {
        Piece::Part& part = piece.parts[i];
        if (!overlap(part.shown, run.shown)) {
          ++i;
          continue;
        }
        run = {unite(run.ink, part.ink), unite(run.shown, part.shown)};
        part = piece.parts.back();
        piece.parts.pop_back();
        i = 0; // larger now: it may touch those before
      }
      piece.parts.push_back(run);
    }
    runs_.clear();
    giveLayer(piece);
    return piece;
  }

  /// The lowest layer with room. Layers lie below each other in the canvas: what is painted over a layer's edge is in
  /// the next one's way, so all ink is in the canvas's coordinates.
  void giveLayer(Piece& piece) {
    if (piece.drawing && drawings_ == info_.maxDrawings) {
      ++pieces_.dropped;
      return;
    }
    const int height = screen_.bottom;
    for (uint32_t layer = 0; layer < info_.maxLayers; ++layer) {
      const int down = static_cast<int>(layer) * height;
      const auto inWay = [&](const Piece::Part& part) {
        const Rect ink{part.ink.left, part.ink.top + down, part.ink.right, part.ink.bottom + down};
        return std::any_of(taken_.begin(), taken_.end(), [&](const Rect& other) { return overlap(ink, other); });
      };
      if (std::any_of(piece.parts.begin(), piece.parts.end(), inWay)) continue;
      piece.layer = static_cast<int>(layer);
      for (const Piece::Part& part : piece.parts)
        taken_.push_back({part.ink.left, part.ink.top + down, part.ink.right, part.ink.bottom + down});
      pieces_.layers = std::max(pieces_.layers, layer + 1);
      drawings_ += piece.drawing ? 1 : 0;
      return;
    }
    pieces_.dropped += static_cast<uint32_t>(std::max<size_t>(piece.glyphCount, 1));
  }

  ImDrawData& data_;
  const PiecesInfo& info_;
  Pieces& pieces_;
  const Rect screen_;
  Rect clip_;
  std::vector<Piece::Part> runs_; // of the text at hand
  size_t firstGlyph_ = 0;
  std::vector<Rect> taken_;
  uint32_t drawings_ = 0;
};

} // namespace

void collect(ImDrawData& data, const PiecesInfo& info, Pieces& pieces) {
  Collector collector(data, info, pieces);
  for (int i = 0; i < data.CmdListsCount; ++i) collector.list(*data.CmdLists[i]);
}

} // namespace gpgp::imgui
