// Boxes, lines and texts on a gpgp list, in the units that a person designs a screen in.
#pragma once
#include "text.h"

#include <array>

namespace mini {

struct Box {
  float left = 0, top = 0, right = 0, bottom = 0;
  float width() const { return right - left; }
  float height() const { return bottom - top; }
  Box inset(float by) const { return {left + by, top + by, right - by, bottom - by}; }
  static Box sized(float left, float top, float width, float height) { return {left, top, left + width, top + height}; }
};

/// Linear, straight alpha.
using Color = std::array<float, 4>;
/// From 0xrrggbb as sRGB has it.
Color rgb(uint32_t hex, float alpha = 1.0f);

/// The images of what a painter paints.
enum Images : uint32_t { kFrameImage, kTextImage };

/// How a text lies in its box.
struct Label {
  float size = 16;
  Color color{1, 1, 1, 1};
  bool bold = false;
  GpgpTextAlign align = GPGP_TEXT_ALIGN_LEFT;
  bool wrap = false; // from the top of the box, as many lines as fit; else one line in the middle of its height
};

class Painter {
public:
  /// scale: pixels (units of the list) per unit. Edges and baselines lie on whole pixels.
  Painter(gpgp::List& list, Text& text, Gpgp& gpgp, float scale)
      : list_(list), text_(text), gpgp_(gpgp), scale_(scale) {}

  /// id: what a hit test finds; of the texts on it, too.
  void fill(const Box& box, const Color& color, float radius = 0, uint64_t id = 0);
  /// From the one colour above to the other below.
  void fade(const Box& box, const Color& above, const Color& below, float radius = 0, uint64_t id = 0);
  void border(const Box& box, const Color& color, float radius = 0, float width = 1.5f, uint64_t id = 0);
  /// The picture's borders keep their size; its sides and middle repeat, a whole number of times.
  void slices(const Box& box, const GpgpListImage& image);
  void ellipse(const Box& box, const Color& color, float border = 0);
  void line(float x0, float y0, float x1, float y1, float width, const Color& color, GpgpCap cap = GPGP_CAP_ROUND);
  /// Cut off with an ellipsis where it does not fit.
  void text(std::string_view text, const Box& box, const Label& label, uint64_t id = 0);
  /// A number whose digits have places of equal width, from digits that were laid out before: nothing is shaped.
  void number(uint32_t value, uint32_t digits, const Box& box, const Label& label);
  /// Puts a drawing in a box, undistorted, in its middle: its page, or its ink without the page's margins.
  void drawing(const gpgp::Drawing& drawing, const Box& box, bool ink = false);
  /// What follows shows only inside of the box, until end().
  void clip(const Box& box, float radius = 0);
  /// What follows is turned by an angle (radians, clockwise) and moved to x, y, until end().
  void place(float x, float y, float angle);
  void end();

private:
  Box pixels(const Box& box) const;
  void add(const GpgpListShape& shape);
  void glyphs(const TextBlock& block, float x, float y, uint64_t id);
  GpgpListShape shape(const Box& box, const Color& color, float radius, float width, uint64_t id) const;
  TextStyle style(const Box& box, const Label& label) const;
  gpgp::List& list_;
  Text& text_;
  Gpgp& gpgp_;
  float scale_;
};

} // namespace mini
