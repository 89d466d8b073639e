// Drawings to measure with: files, and generated ones of the sizes of the thesis's (section 5.4). Cairo draws them too.
#pragma once
#include <gpgp/vector.h>

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gpgp::bench {

struct Shape {
  std::vector<GpgpPathVerb> verbs;
  std::vector<float> points;
  float color[4] = {0, 0, 0, 1};
  GpgpFillRule rule = GPGP_FILL_NON_ZERO;
  const GpgpGradient* gradient = nullptr;
  uint32_t group = 0;
  void add(GpgpPathVerb verb, std::initializer_list<double> values) {
    verbs.push_back(verb);
    for (const double v : values) points.push_back(static_cast<float>(v));
  }
  GpgpPath view() const {
    return {verbs.data(),  static_cast<uint32_t>(verbs.size()),
            points.data(), static_cast<uint32_t>(points.size() / 2),
            rule,          {color[0], color[1], color[2], color[3]},
            gradient,      nullptr,
            nullptr,       0,
            group};
  }
};
struct Scene {
  std::string name;
  std::vector<Shape> shapes;
  double width = 1000, height = 1000;
  std::shared_ptr<void> source; // what shapes and groups refer to
  std::span<const GpgpPathGroup> groups = {};
  std::vector<Shape> glyphs = {};           // in em units; where there are any, the shapes can be drawn as the text
  std::vector<GpgpGlyphInstance> text = {}; // glyph: 1 + its place among these
  bool changes = false;                     // another string every record
};

Scene streetMap();  ///< 45 000 paths, 545 000 curves (paris-70k)
Scene contourMap(); ///< 53 000 paths, 188 000 curves (contour)
Scene page();       ///< a text of 12 000 glyph-like shapes
Scene livePage();   ///< the same, with another string every record
Scene drops();      ///< 204 paths of five curves (drops)
Scene embrace();    ///< 225 paths, 5 000 curves: smooth bands over each other (embrace)
Scene clipArt();    ///< a sheet of 691 paths, 7 000 curves (sample_v2)
Scene botanical();  ///< 1 137 paths, 53 000 curves: leaves with toothed edges (hawaii)
Scene townPlan();   ///< 1 922 paths, 28 000 curves: blocks, lots and roads (boston)
Scene feather();    ///< 180 barbs, each thinner than a pixel at 12 x 14 pixels
/// A screen of an application, 1 024 pixels a side, nearly all arcs of circles: windows and buttons with round corners,
/// knobs, gauges, pie charts. `arcs`: how far its curves may lie from them, in pixels.
Scene panels(double arcs = 1e-4);
/// Random shapes that together cover about half of the page, each of `curves` cubics.
Scene blobs(int paths, int curves);
/// One of these (map, contours, page, live, drops, embrace, clipart, botanical, plan, feather, panels), or a file. Ends
/// the program where that is no SVG.
Scene sceneOf(const std::string& word, double arcs = 1e-4);

/// A generated scene as an SVG, so that the command can draw it. Ends the program where it has gradients or groups.
void writeSvg(const Scene& scene, const std::string& path);

/// Of the paths as they come: neither moves nor closing lines count.
size_t curvesOf(const Scene& scene);

/// Median milliseconds of cairo drawing over white; 0 where it is not built in. `pixels`, where it is not NULL, gets
/// the picture: BGRX bytes.
double cairoTime(const Scene& scene, uint32_t width, uint32_t height, int repeat, double scale,
                 std::vector<uint8_t>* pixels = nullptr);

} // namespace gpgp::bench
