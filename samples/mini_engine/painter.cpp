#include "painter.h"

#include "gpgp_glue.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace mini {

Color rgb(uint32_t hex, float alpha) {
  const auto linear = [](uint32_t byte) { return linearFromSrgb(static_cast<float>(byte & 255u) / 255.0f); };
  return {linear(hex >> 16), linear(hex >> 8), linear(hex), alpha};
}

Box Painter::pixels(const Box& box) const {
  return {std::round(box.left * scale_), std::round(box.top * scale_), std::round(box.right * scale_),
          std::round(box.bottom * scale_)};
}

GpgpListShape Painter::shape(const Box& box, const Color& color, float radius, float width, uint64_t id) const {
  GpgpListShape shape{};
  const Box place = pixels(box);
  const float edges[4] = {place.left, place.top, place.right, place.bottom};
  std::copy(std::begin(edges), std::end(edges), shape.box);
  std::fill(std::begin(shape.radii), std::end(shape.radii), radius * scale_);
  shape.width = width > 0 ? std::max(1.0f, width * scale_) : 0;
  std::copy(color.begin(), color.end(), shape.color);
  shape.id = id;
  return shape;
}

void Painter::add(const GpgpListShape& shape) { gpgp_.check(list_.add(shape), "gpgpAddShapes"); }

void Painter::fill(const Box& box, const Color& color, float radius, uint64_t id) {
  add(shape(box, color, radius, 0, id));
}

void Painter::border(const Box& box, const Color& color, float radius, float width, uint64_t id) {
  add(shape(box, color, radius, width, id));
}

void Painter::fade(const Box& box, const Color& above, const Color& below, float radius, uint64_t id) {
  GpgpGradientStop stops[2] = {};
  stops[1].offset = 1;
  std::copy(above.begin(), above.end(), stops[0].color);
  std::copy(below.begin(), below.end(), stops[1].color);
  const Box place = pixels(box);
  GpgpGradient gradient{};
  gradient.kind = GPGP_GRADIENT_LINEAR;
  gradient.transform[0] = gradient.transform[3] = 1;
  gradient.start[1] = place.top;
  gradient.end[1] = place.bottom;
  gradient.stops = stops;
  gradient.stopCount = 2;
  gradient.interpolateSrgb = VK_TRUE;
  GpgpListShape faded = shape(box, {1, 1, 1, 1}, radius, 0, id);
  faded.gradient = &gradient;
  add(faded);
}

void Painter::slices(const Box& box, const GpgpListImage& image) {
  GpgpListImage scaled = image;
  for (float& border : scaled.borders) border *= scale_;
  scaled.tiles[0] = scaled.tiles[1] = GPGP_TILE_ROUND;
  GpgpListShape sliced = shape(box, {1, 1, 1, 1}, 0, 0, 0);
  sliced.image = &scaled;
  add(sliced);
}

void Painter::ellipse(const Box& box, const Color& color, float border) {
  GpgpListShape round = shape(box, color, 0, border, 0);
  round.kind = GPGP_LIST_ELLIPSE;
  add(round);
}

void Painter::line(float x0, float y0, float x1, float y1, float width, const Color& color, GpgpCap cap) {
  GpgpListShape line{};
  line.kind = GPGP_LIST_LINE;
  const float ends[4] = {x0 * scale_, y0 * scale_, x1 * scale_, y1 * scale_};
  std::copy(std::begin(ends), std::end(ends), line.box);
  line.width = width * scale_;
  line.cap = cap;
  std::copy(color.begin(), color.end(), line.color);
  add(line);
}

TextStyle Painter::style(const Box& box, const Label& label) const {
  const Box place = pixels(box);
  TextStyle style;
  style.size = std::round(label.size * scale_);
  style.bold = label.bold;
  std::copy(label.color.begin(), label.color.end(), style.color);
  style.align = label.align;
  style.width = place.width();
  style.height = label.wrap ? place.height() : 0;
  style.maxLines = label.wrap ? 0 : 1;
  return style;
}

void Painter::glyphs(const TextBlock& block, float x, float y, uint64_t id) {
  const float move[6] = {1, 0, 0, 1, x, y};
  gpgp_.check(list_.pushTransform(move), "gpgpPushTransform");
  text_.add(list_, block, kTextImage, id);
  end();
}

void Painter::text(std::string_view text, const Box& box, const Label& label, uint64_t id) {
  const TextBlock& block = text_.layOut(text, style(box, label));
  const Box place = pixels(box);
  const float middle = (place.top + place.bottom + block.capHeight) * 0.5f; // baseline of a line in the box's middle
  glyphs(block, place.left, label.wrap ? place.top : std::round(middle) - block.baseline, id);
}

void Painter::number(uint32_t value, uint32_t digits, const Box& box, const Label& label) {
  TextStyle digit = style({}, label);
  digit.align = GPGP_TEXT_ALIGN_LEFT;
  digit.maxLines = 0;
  const Box place = pixels(box);
  float advance = 0; // digits differ in width; their places do not
  for (char d = '0'; d <= '9'; ++d) advance = std::max(advance, text_.layOut({&d, 1}, digit).width);
  advance = std::min(std::round(advance), place.width() / static_cast<float>(digits)); // never beyond the box
  float x = label.align == GPGP_TEXT_ALIGN_RIGHT ? place.right : place.left + advance * static_cast<float>(digits);
  for (uint32_t i = 0; i < digits; ++i, value /= 10) {
    x -= advance;
    const char character = static_cast<char>('0' + value % 10);
    const TextBlock& block = text_.layOut({&character, 1}, digit);
    const float middle = (place.top + place.bottom + block.capHeight) * 0.5f;
    glyphs(block, x + (advance - block.width) * 0.5f, std::round(middle) - block.baseline, 0);
  }
}

void Painter::drawing(const gpgp::Drawing& drawing, const Box& box, bool ink) {
  const GpgpDrawingInfo info = gpgp_.take(drawing.info(), "gpgpGetDrawingInfo");
  const float *page = info.viewport, *bounds = info.bounds;
  const Box from =
      ink ? Box{bounds[0], bounds[1], bounds[2], bounds[3]} : Box::sized(page[0], page[1], page[2], page[3]);
  const Box place = pixels(box);
  const float scale = std::min(place.width() / from.width(), place.height() / from.height());
  const float map[6] = {scale,
                        0,
                        0,
                        scale,
                        (place.left + place.right - (from.left + from.right) * scale) * 0.5f,
                        (place.top + place.bottom - (from.top + from.bottom) * scale) * 0.5f};
  gpgp_.check(list_.pushTransform(map), "gpgpPushTransform");
  gpgp_.check(list_.add(drawing), "gpgpAddDrawing");
  end();
}

void Painter::clip(const Box& box, float radius) {
  const GpgpListShape place = shape(box, {}, radius, 0, 0);
  gpgp_.check(list_.pushClip(place.box, radius > 0 ? place.radii : nullptr), "gpgpPushClip");
}

void Painter::place(float x, float y, float angle) {
  const float map[6] = {std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle), x * scale_, y * scale_};
  gpgp_.check(list_.pushTransform(map), "gpgpPushTransform");
}

void Painter::end() { gpgp_.check(list_.pop(), "gpgpPopState"); }

} // namespace mini
