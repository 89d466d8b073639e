// Masks, filters and modes of mixing of SVG as layers: which groups come of them, their regions and numbers by hand,
// what is said of those in error, and the limits.
#include "layer_oracle.h"
#include "svg_import.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace {
using namespace gpgp;
using namespace gpgp::test;
using vector::svg::ImportedGroup;
using vector::svg::ImportedLayer;
using vector::svg::ImportedPath;

using Texts = std::vector<std::string>;

std::string text(double v) {
  char out[32];
  std::snprintf(out, sizeof out, "%.4g", std::abs(v) < 5e-5 ? 0 : v);
  return out;
}
std::string text(const float* values, size_t count) {
  std::string all;
  for (size_t i = 0; i < count; ++i) all += (i ? " " : "") + text(static_cast<double>(values[i]));
  return all;
}

constexpr const char* kKinds[] = {"flood",   "blur",      "shadow",     "offset",   "matrix",   "transfer",
                                  "blend",   "composite", "morphology", "convolve", "displace", "turbulence",
                                  "diffuse", "specular",  "tile",       "group"};

/// "blur S [8 8 32 32] 2 2": what it does, its inputs (S, A, T or a step's index), its region, and its values up to the
/// last that is not 0. "s:" in front: as sRGB encodes colours; "/1" behind the name: its mode.
std::string text(const GpgpFilterStep& s) {
  const auto input = [](uint32_t i) {
    return i < GPGP_FILTER_FIRST_STEP ? std::string(1, "SAT"[i]) : std::to_string(i - GPGP_FILTER_FIRST_STEP);
  };
  const bool none = s.kind == GPGP_FILTER_FLOOD || s.kind == GPGP_FILTER_TURBULENCE || s.kind == GPGP_FILTER_GROUP;
  const bool two =
      s.kind == GPGP_FILTER_BLEND || s.kind == GPGP_FILTER_COMPOSITE || s.kind == GPGP_FILTER_DISPLACEMENT_MAP;
  size_t count = 20;
  while (count && s.values[count - 1] == 0) --count;
  return std::string(s.encoding == GPGP_IMAGE_SRGB ? "s:" : "") + kKinds[s.kind] +
         (s.mode ? "/" + std::to_string(s.mode) : "") + (none ? "" : " " + input(s.input)) +
         (two ? " " + input(s.input2) : "") + " [" + text(s.region, 4) + "]" + (count ? " " : "") +
         text(s.values, count);
}
Texts stepsOf(const ImportedLayer& layer) {
  Texts all;
  for (const GpgpFilterStep& s : layer.steps) all.push_back(text(s));
  return all;
}

struct Found {
  uint32_t group; ///< 1 + index
  const ImportedLayer* layer;
};
std::vector<Found> layersOf(const Import& i) {
  std::vector<Found> found;
  for (size_t g = 0; g < i.drawing.groups.size(); ++g)
    if (i.drawing.groups[g].layer) found.push_back({static_cast<uint32_t>(g + 1), i.drawing.groups[g].layer.get()});
  return found;
}
size_t pathsIn(const Import& i, uint32_t group) {
  size_t count = 0;
  for (const ImportedPath& path : i.drawing.paths)
    for (uint32_t g = path.group; g; g = i.drawing.groups[g - 1].parent) count += g == group;
  return count;
}

/// References lead to later groups without parents, whose paths lie behind all others and belong to nothing else.
void expectSound(const Import& i) {
  const auto& groups = i.drawing.groups;
  std::vector<int> references(groups.size() + 1);
  for (size_t g = 0; g < groups.size(); ++g) {
    EXPECT_LE(groups[g].parent, g);
    if (!groups[g].layer) continue;
    std::vector<uint32_t> all = {groups[g].layer->layer.mask};
    for (const GpgpFilterStep& s : groups[g].layer->steps) {
      all.push_back(s.group);
      EXPECT_EQ(s.kind == GPGP_FILTER_GROUP, s.group != 0);
      const size_t own = static_cast<size_t>(&s - groups[g].layer->steps.data());
      EXPECT_LT(s.input, GPGP_FILTER_FIRST_STEP + own);
      EXPECT_LT(s.input2, GPGP_FILTER_FIRST_STEP + own);
      EXPECT_TRUE(s.region[0] <= s.region[2] && s.region[1] <= s.region[3]);
      for (const float v : s.values) EXPECT_TRUE(std::abs(v) <= 3e7f);
    }
    for (const uint32_t r : all) {
      if (!r) continue;
      ASSERT_LE(r, groups.size());
      EXPECT_GT(r, g + 1);
      EXPECT_EQ(groups[r - 1].parent, 0u);
      EXPECT_GT(pathsIn(i, r), 0u);
      EXPECT_EQ(++references[r], 1);
    }
  }
  bool aside = false;
  for (const ImportedPath& path : i.drawing.paths) {
    ASSERT_LE(path.group, groups.size());
    uint32_t top = path.group;
    while (top && groups[top - 1].parent) top = groups[top - 1].parent;
    EXPECT_TRUE(!aside || references[top]);
    aside = aside || (top && references[top]);
  }
}

const std::string kRect = "<rect x='10' y='20' width='40' height='20' fill='#0a0' ";
const std::string kWhite = "<rect width='100' height='100' fill='#fff'/>";

TEST(SvgLayers, MasksHaveTheirRegions) {
  const struct {
    const char* name;
    std::string inside;
    const char *region, *transform;
    GpgpMaskKind kind = GPGP_MASK_LUMINANCE;
    int32_t encoding = GPGP_IMAGE_SRGB;
  } cases[] = {
      {"a tenth more than the box", "<mask id='m'>" + kWhite + "</mask>" + kRect + "mask='url(#m)'/>", "6 18 54 42",
       "1 0 0 1 0 0"},
      {"parts of the box",
       "<mask id='m' x='50%' y='0' width='.5' height='1'>" + kWhite + "</mask>" + kRect + "mask='url(#m)'/>",
       "30 20 50 40", "1 0 0 1 0 0"},
      {"user space",
       "<mask id='m' maskUnits='userSpaceOnUse' x='1' y='2%' width='30' height='4'>" + kWhite + "</mask>" + kRect +
           "mask='url(#m)'/>",
       "1 2 31 6", "1 0 0 1 0 0"},
      {"the page's tenths in user space",
       "<mask id='m' maskUnits='userSpaceOnUse'>" + kWhite + "</mask>" + kRect + "mask='url(#m)'/>", "-10 -10 110 110",
       "1 0 0 1 0 0"},
      {"moved with the element",
       "<mask id='m'>" + kWhite + "</mask><g transform='translate(5 7) scale(2)'>" + kRect + "mask='url(#m)'/></g>",
       "6 18 54 42", "2 0 0 2 5 7"},
      {"by alpha", "<mask id='m' style='mask-type:alpha'>" + kWhite + "</mask>" + kRect + "mask='url(#m)'/>",
       "6 18 54 42", "1 0 0 1 0 0", GPGP_MASK_ALPHA},
      {"in linear light",
       "<mask id='m' color-interpolation='linearRGB'>" + kWhite + "</mask>" + kRect + "style='mask:url(\"#m\")'/>",
       "6 18 54 42", "1 0 0 1 0 0", GPGP_MASK_LUMINANCE, GPGP_IMAGE_LINEAR},
      {"of a group: around all that it holds",
       "<mask id='m' x='0' y='0' width='1' height='1'>" + kWhite + "</mask><g mask='url(#m)'>" + kRect +
           "/><circle cx='80' cy='80' r='10'/></g>",
       "10 20 90 90", "1 0 0 1 0 0"},
      {"strokes do not count",
       "<mask id='m' x='0' y='0' width='1' height='1'>" + kWhite + "</mask>" + kRect +
           "stroke='red' stroke-width='9' mask='url(#m)'/>",
       "10 20 50 40", "1 0 0 1 0 0"},
      {"of a use: in its coordinates",
       "<mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='9' height='9'>" + kWhite +
           "</mask><defs><path id='p' d='M0 0h9v9'/></defs><use href='#p' x='30' y='40' mask='url(#m)'/>",
       "0 0 9 9", "1 0 0 1 30 40"},
      {"inside of a viewport",
       "<mask id='m'>" + kWhite + "</mask><svg x='10' width='50' height='50' viewBox='0 0 100 100'>" + kRect +
           "mask='url(#m)'/></svg>",
       "6 18 54 42", "0.5 0 0 0.5 10 0"},
      {"inside of a switch and an a",
       "<mask id='m'>" + kWhite + "</mask><switch><a>" + kRect + "mask='url(#m)'/></a></switch>", "6 18 54 42",
       "1 0 0 1 0 0"},
      {"on an a", "<mask id='m'>" + kWhite + "</mask><a mask='url(#m)'>" + kRect + "/></a>", "6 18 54 42",
       "1 0 0 1 0 0"},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.name);
    const Import i = page(c.inside);
    EXPECT_EQ(i.placed, Texts());
    expectSound(i);
    const auto layers = layersOf(i);
    ASSERT_EQ(layers.size(), 1u);
    const GpgpLayer& l = layers[0].layer->layer;
    EXPECT_EQ(text(l.maskRegion, 4), c.region);
    EXPECT_EQ(text(l.maskTransform, 6), c.transform);
    EXPECT_EQ(l.maskKind, c.kind);
    EXPECT_EQ(l.maskEncoding, c.encoding);
    EXPECT_EQ(pathsIn(i, l.mask), 1u);
    EXPECT_GE(pathsIn(i, layers[0].group), 1u);
  }
}

TEST(SvgLayers, TheContentOfAMaskStandsWhereItSays) {
  const auto contentOf = [](const std::string& inside) {
    const Import i = page(inside);
    EXPECT_EQ(i.placed, Texts());
    return i.drawing.paths.back().points;
  };
  using Floats = std::vector<float>;
  EXPECT_EQ(
      contentOf("<mask id='m'><path d='M1 2H3V4'/></mask>" + kRect + "transform='translate(5 0)' mask='url(#m)'/>"),
      (Floats{6, 2, 8, 2, 8, 4}));
  EXPECT_EQ(contentOf("<mask id='m' maskContentUnits='objectBoundingBox'><path d='M0 0H1V.5'/></mask>" + kRect +
                      "mask='url(#m)'/>"),
            (Floats{10, 20, 50, 20, 50, 30}));
  // It inherits from where it stands, and its own transform is none.
  const Import i = page("<g fill='red'><mask id='m' transform='scale(9)' opacity='.5' fill-opacity='.5'><path "
                        "d='M1 2H3V4'/></mask></g><g fill='blue'>" +
                        kRect + "mask='url(#m)'/></g>");
  ASSERT_EQ(i.drawing.paths.size(), 2u);
  EXPECT_EQ(i.drawing.paths[1].points, (Floats{1, 2, 3, 2, 3, 4}));
  EXPECT_EQ(i.drawing.paths[1].color[0], 1.0f);
  EXPECT_EQ(i.drawing.paths[1].color[3], 0.5f);
}

TEST(SvgLayers, MasksHaveMasksAndClips) {
  const Import i = page("<mask id='n'><path d='M0 0H9V9'/></mask><mask id='m' mask='url(#n)'>" + kWhite + "</mask>" +
                        kRect + "mask='url(#m)'/>");
  EXPECT_EQ(i.placed, Texts());
  expectSound(i);
  const auto layers = layersOf(i);
  ASSERT_EQ(layers.size(), 2u);
  EXPECT_EQ(text(layers[1].layer->layer.maskRegion, 4), "6 18 54 42"); // by what is masked in the end
  EXPECT_EQ(pathsIn(i, layers[1].layer->layer.mask), 1u);
  // Its own clip-path does not count, as in browsers and resvg.
  const Import clipped = page("<clipPath id='c'><path d='M0 0H9V9'/></clipPath><mask id='m' clip-path='url(#c)'>" +
                              kWhite + "</mask>" + kRect + "mask='url(#m)'/>");
  EXPECT_EQ(clipped.placed, Texts());
  expectSound(clipped);
  EXPECT_TRUE(std::none_of(clipped.drawing.groups.begin(), clipped.drawing.groups.end(),
                           [](const ImportedGroup& g) { return g.clipped; }));
}

TEST(SvgLayers, WhatShowsNothingIsNotDrawn) {
  for (const char* hidden :
       {"<mask id='m'/>", "<mask id='m'><g/></mask>", "<mask id='m' width='0'><path d='M0 0h9v9'/></mask>",
        "<mask id='m' height='-1'><path d='M0 0h9v9'/></mask>", "<mask id='m'><path d='M0 0h9v9' fill='none'/></mask>",
        "<filter id='f'/>", "<filter id='f' width='0'><feFlood/></filter>",
        "<filter id='f' height='-1'><feFlood/></filter>", "<filter id='f'><title>a</title></filter>"}) {
    const Import i = page(std::string(hidden) + kRect + (hidden[1] == 'm' ? "mask='url(#m)'/>" : "filter='url(#f)'/>") +
                          "<path d='M0 0h9v9'/>");
    EXPECT_EQ(i.placed, Texts()) << hidden;
    EXPECT_EQ(i.drawing.paths.size(), 1u) << hidden;
    EXPECT_EQ(i.drawing.groups.size(), 0u) << hidden;
  }
  // Boxes without extent have no parts.
  for (const char* effect : {"mask='url(#m)'", "filter='url(#f)'"}) {
    const Import i = page(std::string("<mask id='m'><path d='M0 0h9v9'/></mask><filter id='f'><feFlood/></filter>"
                                      "<path d='M5 20H35' stroke='red' ") +
                          effect + "/>");
    EXPECT_EQ(i.drawing.paths.size(), 0u) << effect;
  }
}

TEST(SvgLayers, WhatIsNotThereDoesNotCount) {
  const struct {
    const char *before, *attribute, *message;
  } cases[] = {
      {"", "mask='url(#m)'", "mask 'url(#m)' does not exist: <rect> is drawn without it"},
      {"<g id='m'/>", "mask='url(#m)'", "mask 'url(#m)' is not a mask: <rect> is drawn without it"},
      {"", "mask='url(a.svg#m)'", "mask 'url(a.svg#m)' is not supported: <rect> is drawn without it"},
      {"", "filter='url(#f)'", "filter '#f' does not exist: <rect> is drawn without it"},
      {"<g id='f'/>", "filter='url(#f)'", "filter '#f' is not a filter: <rect> is drawn without it"},
      {"", "filter='blur(2px) url(#f)'", "filter '#f' does not exist: <rect> is drawn without it"},
      {"", "filter='url(a.svg#f)'", "filter 'a.svg#f' of another file is not supported: <rect> is drawn without it"},
      {"<mask id='m' maskContentUnits='objectBoundingBox' maskUnits='userSpaceOnUse'><path d='M0 0h1v1'/></mask>"
       "<path d='M5 20H35' stroke='red' mask='url(#m)'/>",
       "", "mask is in units of a box without extent: <path> is drawn without it"},
  };
  for (const auto& c : cases) {
    const Import i = page(std::string(c.before) + kRect + c.attribute + "/>");
    ASSERT_EQ(i.placed.size(), 1u) << c.message;
    EXPECT_EQ(i.placed[0].substr(i.placed[0].find("warning: ") + 9), c.message);
    EXPECT_GE(i.drawing.paths.size(), 1u);
    for (const auto& found : layersOf(i)) EXPECT_EQ(found.layer->layer.mask, 0u);
  }
}

TEST(SvgLayers, WhatContainsItselfEnds) {
  for (const char* inside :
       {"<mask id='m'><rect width='9' height='9' mask='url(#m)'/></mask><rect width='9' height='9' mask='url(#m)'/>",
        "<mask id='m' mask='url(#m)'><rect width='9' height='9'/></mask><rect width='9' height='9' mask='url(#m)'/>",
        "<mask id='m'><use href='#r'/></mask><rect id='r' width='9' height='9' mask='url(#m)'/>",
        "<mask id='m'><g mask='url(#n)'><path d='M0 0h9v9'/></g></mask><mask id='n'><g mask='url(#m)'><path d='M0 "
        "0h9v9'/>"
        "</g></mask><path d='M0 0h9v9' mask='url(#m)'/>",
        "<filter id='f'><feImage href='#r'/></filter><rect id='r' width='9' height='9' filter='url(#f)'/>",
        "<filter id='f'><feImage href='#g'/></filter><g id='g'><rect width='9' height='9' filter='url(#f)'/></g>",
        "<defs><rect id='r' width='9' height='9' filter='url(#f)'/></defs><filter id='f'><feImage href='#r'/></filter>"
        "<rect width='9' height='9' filter='url(#f)'/>",
        "<filter id='f' href='#f'><feFlood/></filter><rect width='9' height='9' filter='url(#f)'/>"}) {
    const Import i = page(inside);
    expectSound(i);
    EXPECT_GE(i.drawing.paths.size(), 1u) << inside;
    if (std::string_view(inside).find("href='#f'") == std::string_view::npos) {
      ASSERT_EQ(i.placed.size(), 1u) << inside;
      EXPECT_NE(i.placed[0].find("contains itself"), std::string::npos) << i.placed[0];
    }
  }
}

TEST(SvgLayers, OfARingOnlyTheFirstCounts) {
  // Whichever way the second leads back to the first, the picture is that of the first alone.
  const std::string shape = "<path d='M5 5h40v40h-40z' fill='white'", part = "<rect width='9' height='9' fill='white'";
  const std::string alone = kRect + "mask='url(#m)'/><mask id='m'>" + shape + "/></mask>";
  const std::string rings[] = {
      "<mask id='m' mask='url(#n)'>" + shape + "/></mask><mask id='n' mask='url(#m)'>" + part + "/></mask>",
      "<mask id='m'>" + shape + " mask='url(#n)'/></mask><mask id='n'>" + part + " mask='url(#m)'/></mask>",
      "<mask id='m'>" + shape + " mask='url(#n)'/></mask><mask id='n' mask='url(#o)'>" + part +
          "/></mask><mask id='o'><g mask='url(#m)'>" + part + "/></g></mask>"};
  const auto shownBy = [](const Import& i) { return LayerOracle(i.drawing, 60, 60, 1).draw(); };
  for (const std::string& ring : rings) {
    const Import i = page(kRect + "mask='url(#m)'/>" + ring);
    ASSERT_EQ(i.placed.size(), 1u) << ring;
    EXPECT_NE(i.placed[0].find("mask 'url(#n)' contains itself"), std::string::npos) << i.placed[0];
    EXPECT_EQ(shownBy(i), shownBy(page(alone))) << ring;
  }
  const Import clips =
      page("<clipPath id='c' clip-path='url(#d)'><path d='M5 5h40v40h-40z'/></clipPath><clipPath id='d' "
           "clip-path='url(#c)'><rect width='9' height='9'/></clipPath>" +
           kRect + "clip-path='url(#c)'/>");
  EXPECT_EQ(clips.placed, Texts{"test.svg:2:1: warning: clip-path 'url(#d)' contains itself: <clipPath> is drawn "
                                "without it"});
  EXPECT_LE(worst(picture(clips), picture(page("<path d='M10 20h35v20h-35z' fill='#0a0'/>"))), 0.51);
}

/// The steps of a filter of the rectangle (10, 20) to (50, 40) with the primitives inside.
Texts steps(const std::string& primitives, const std::string& attributes = "", Texts* messages = nullptr) {
  const Import i = page("<filter id='f'" + attributes + ">" + primitives + "</filter>" + kRect + "filter='url(#f)'/>");
  if (messages)
    *messages = i.placed;
  else
    EXPECT_EQ(i.placed, Texts()) << primitives;
  expectSound(i);
  const auto layers = layersOf(i);
  return layers.size() == 1 ? stepsOf(*layers[0].layer) : Texts{"no filter"};
}
const std::string kUser = " filterUnits='userSpaceOnUse' x='0' y='0' width='100' height='90'";

TEST(SvgLayers, PrimitivesBecomeSteps) {
  const struct {
    const char* primitives;
    Texts steps;
  } cases[] = {
      {"<feFlood flood-color='#f00' flood-opacity='.5'/>", {"flood [0 0 100 90] 1 0 0 0.5"}},
      {"<feGaussianBlur stdDeviation='2'/>", {"blur S [0 0 100 90] 2 2"}},
      {"<feGaussianBlur stdDeviation='2, 3' in='SourceAlpha' color-interpolation-filters='sRGB'/>",
       {"s:blur A [0 0 100 90] 2 3"}},
      {"<feGaussianBlur stdDeviation='0 3'/>", {"blur S [0 0 100 90] 0 3"}},
      {"<feGaussianBlur/>", {"offset S [0 0 100 90]"}},
      {"<feDropShadow/>", {"shadow S [0 0 100 90] 2 2 2 2 0 0 0 1"}},
      {"<feDropShadow dx='3' dy='-4' stdDeviation='5 6' flood-color='rgba(0,0,255,.5)' flood-opacity='.5'/>",
       {"shadow S [0 0 100 90] 5 6 3 -4 0 0 1 0.25"}},
      {"<feOffset dx='3'/><feOffset dy='4'/>", {"offset S [0 0 100 90] 3", "offset 0 [0 0 100 90] 0 4"}},
      {"<feColorMatrix values='1 2 3 4 5  6 7 8 9 10  11 12 13 14 15  16 17 18 19 20'/>",
       {"matrix S [0 0 100 90] 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20"}},
      {"<feColorMatrix type='saturate' values='0'/>",
       {"matrix S [0 0 100 90] 0.213 0.715 0.072 0 0 0.213 0.715 0.072 0 0 0.213 0.715 0.072 0 0 0 0 0 1"}},
      {"<feColorMatrix type='hueRotate' values='90'/>",
       {"matrix S [0 0 100 90] 0 0 1 0 0 0.356 0.855 -0.211 0 0 -0.574 1.43 0.144 0 0 0 0 0 1"}},
      {"<feColorMatrix type='luminanceToAlpha'/>",
       {"matrix S [0 0 100 90] 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0.2125 0.7154 0.0721"}},
      {"<feColorMatrix/>", {"offset S [0 0 100 90]"}},
      {"<feFlood result='a'/><feBlend in='SourceGraphic' in2='a' mode='color-dodge'/>",
       {"flood [0 0 100 90] 0 0 0 1", "blend/6 S 0 [0 0 100 90]"}},
      {"<feComposite in2='SourceAlpha' operator='xor'/>", {"composite/4 S A [0 0 100 90]"}},
      {"<feComposite in2='SourceAlpha' operator='arithmetic' k1='1' k3='-.5'/>",
       {"composite/6 S A [0 0 100 90] 1 0 -0.5"}},
      {"<feMorphology radius='2'/>", {"morphology S [0 0 100 90] 2 2"}},
      {"<feMorphology operator='dilate' radius='0 3'/>", {"morphology/1 S [0 0 100 90] 0 3"}},
      {"<feMorphology/>", {"offset S [0 0 100 90]"}},
      {"<feConvolveMatrix kernelMatrix='0 1 0 1 0 1 0 1 0'/>", {"convolve/1 S [0 0 100 90] 3 3 1 1 4"}},
      {"<feConvolveMatrix order='1 2' kernelMatrix='1 -1' targetY='0' edgeMode='wrap' preserveAlpha='true' bias='.5'/>",
       {"convolve/2 S [0 0 100 90] 1 2 0 0 1 0.5 1"}},
      {"<feDisplacementMap in2='SourceAlpha' scale='7' xChannelSelector='G' yChannelSelector='R'/>",
       {"displace/1 S A [0 0 100 90] 7"}},
      {"<feTurbulence baseFrequency='.1' numOctaves='2' seed='-3.7' stitchTiles='stitch'/>",
       {"turbulence/1 [0 0 100 90] 0.1 0.1 2 -3 1"}},
      {"<feTurbulence type='fractalNoise' baseFrequency='.1 .2'/>", {"turbulence [0 0 100 90] 0.1 0.2 1"}},
      {"<feDiffuseLighting lighting-color='#0f0' surfaceScale='2'><feDistantLight azimuth='180' elevation='90'/>"
       "</feDiffuseLighting>",
       {"diffuse S [0 0 100 90] 2 1 0 1 0 3.142 1.571"}},
      {"<feDiffuseLighting><fePointLight x='1' y='2' z='3'/></feDiffuseLighting>",
       {"diffuse/1 S [0 0 100 90] 1 1 1 1 1 1 2 3"}},
      {"<feSpecularLighting specularExponent='5' specularConstant='.5'><feSpotLight x='1' y='2' z='3' pointsAtX='4' "
       "pointsAtY='5' pointsAtZ='6' specularExponent='7' limitingConeAngle='-60'/></feSpecularLighting>",
       {"specular/2 S [0 0 100 90] 1 0.5 1 1 1 5 1 2 3 4 5 6 7 0.5"}},
      {"<feSpecularLighting specularExponent='500'><feSpotLight/></feSpecularLighting>",
       {"specular/2 S [0 0 100 90] 1 1 1 1 1 128 0 0 0 0 0 0 1 -1"}},
      {"<feFlood x='1' y='2' width='3' height='4'/><feTile/>", {"flood [1 2 4 6] 0 0 0 1", "tile 0 [0 0 100 90]"}},
      {"<feMerge><feMergeNode/><feMergeNode in='SourceAlpha'/><feMergeNode in='SourceGraphic'/></feMerge>",
       {"composite A S [0 0 100 90]", "composite S 0 [0 0 100 90]"}},
      {"<feMerge><feMergeNode in='SourceAlpha'/></feMerge>", {"offset A [0 0 100 90]"}},
      {"<feMerge/>", {"flood [0 0 100 90]"}},
  };
  for (const auto& c : cases) EXPECT_EQ(steps(c.primitives, kUser), c.steps) << c.primitives;
}

TEST(SvgLayers, KernelsLightsAndRegionsAreOfPixels) {
  const std::string filter = "<filter id='f' filterUnits='userSpaceOnUse' x='0.3' y='2.1' width='50' height='20'>"
                             "<feConvolveMatrix kernelMatrix='0 1 0 1 0 1 0 1 0'/><feDiffuseLighting>"
                             "<feDistantLight azimuth='180' elevation='90'/></feDiffuseLighting></filter>";
  const auto at = [&](double scale, const std::string& transform) {
    const Import i = import("<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>" + filter + "<g " +
                                transform + ">" + kRect + "filter='url(#f)'/></g></svg>",
                            {}, scale);
    EXPECT_EQ(i.placed, Texts());
    return stepsOf(*layersOf(i).at(0).layer);
  };
  EXPECT_EQ(at(1, ""), (Texts{"convolve/1 S [0 2 51 23] 3 3 1 1 4", "diffuse 0 [0 2 51 23] 1 1 1 1 1 3.142 1.571"}));
  EXPECT_EQ(at(4, ""), (Texts{"convolve/1 S [0.25 2 50.5 22.25] 3 3 1 1 4 0 0 0.25 0.25",
                              "diffuse 0 [0.25 2 50.5 22.25] 1 1 1 1 1 3.142 1.571 0 0 0 0 0 0 0 0.25 0.25"}));
  // Kernels do not turn over with their element.
  EXPECT_EQ(at(1, "transform='scale(-.5 2)'")[0], "convolve/1 S [0.3 2.1 50.3 22.1] 3 3 1 1 4 0 0 -2 0.5");
}

TEST(SvgLayers, TransferFunctionsAreTables) {
  const Import i = page("<filter id='f'><feComponentTransfer><feFuncR type='table' tableValues='0 1 0'/><feFuncG "
                        "type='discrete' tableValues='.25,.75'/><feFuncB type='linear' slope='.5' intercept='.1'/>"
                        "<feFuncA type='linear'/><feFuncA type='gamma' amplitude='2' exponent='2' offset='-.1'/>"
                        "</feComponentTransfer></filter>" +
                        kRect + "filter='url(#f)'/>");
  EXPECT_EQ(i.placed, Texts());
  ASSERT_EQ(layersOf(i).size(), 1u);
  const GpgpFilterStep& s = layersOf(i)[0].layer->steps.at(0);
  ASSERT_EQ(s.tableCount, 1024u);
  for (uint32_t k = 0; k < 256; ++k) {
    const double c = k / 255.0;
    const double expected[4] = {c < 0.5 ? 2 * c : 2 - 2 * c, c < 0.5 ? 0.25 : 0.75, 0.5 * c + 0.1,
                                std::clamp(2 * c * c - 0.1, 0.0, 1.0)};
    for (uint32_t channel = 0; channel < 4; ++channel)
      EXPECT_NEAR(static_cast<double>(s.table[256 * channel + k]), expected[channel], 1e-6) << channel << " " << k;
  }
}

TEST(SvgLayers, InputsAndRegions) {
  const struct {
    const char* primitives;
    std::string attributes;
    Texts steps;
  } cases[] = {
      // The filter's own region.
      {"<feFlood/>", "", {"flood [6 18 54 42] 0 0 0 1"}},
      {"<feFlood/>", " x='0' y='.5' width='1' height='50%'", {"flood [10 30 50 40] 0 0 0 1"}},
      {"<feFlood/>", " filterUnits='userSpaceOnUse'", {"flood [-10 -10 110 110] 0 0 0 1"}},
      // A primitive's: part by part, then that of its inputs, or of the filter.
      {"<feFlood x='3' width='50%'/>", kUser, {"flood [3 0 53 90] 0 0 0 1"}},
      {"<feFlood x='3' y='4' width='5' height='6'/><feGaussianBlur stdDeviation='1'/>",
       kUser,
       {"flood [3 4 8 10] 0 0 0 1", "blur 0 [3 4 8 10] 1 1"}},
      {"<feFlood x='3' y='4' width='5' height='6' result='a'/><feOffset dx='1' x='50' y='50' width='9' height='9'/>"
       "<feComposite in2='a'/>",
       kUser,
       {"flood [3 4 8 10] 0 0 0 1", "offset 0 [50 50 59 59] 1", "composite 1 0 [3 4 59 59]"}},
      {"<feFlood x='3' y='4' width='5' height='6' result='a'/><feBlend in2='SourceGraphic'/>",
       kUser,
       {"flood [3 4 8 10] 0 0 0 1", "blend 0 S [0 0 100 90]"}},
      {"<feFlood x='-50' y='4' width='500' height='6'/>", kUser, {"flood [0 4 100 10] 0 0 0 1"}},
      {"<feFlood width='0'/>", kUser, {"flood [0 0 0 0]"}},
      // Units of the box, 40 by 20.
      {"<feFlood x='.5' y='0' width='.25' height='.5'/><feOffset dx='.5' dy='.5'/>",
       kUser + " primitiveUnits='objectBoundingBox'",
       {"flood [30 20 40 30] 0 0 0 1", "offset 0 [30 20 40 30] 20 10"}},
      {"<feGaussianBlur stdDeviation='.1'/>", " primitiveUnits='objectBoundingBox'", {"blur S [6 18 54 42] 4 2"}},
      // What are no parts of the box do not count; em is of where it stands.
      {"<feFlood x='1em' width='2em'/>", kUser + " style='font-size:20px'", {"flood [20 0 60 90] 0 0 0 1"}},
      {"<feFlood/>",
       " filterUnits='userSpaceOnUse' x='1em' y='0' width='9' height='9' style='font-size:20px'",
       {"flood [20 0 29 9] 0 0 0 1"}},
      // Names: the last one counts, those unknown mean what comes before.
      {"<feFlood result='a'/><feFlood flood-color='red' result='a'/><feOffset in='a'/><feOffset in='a' "
       "result='SourceGraphic'/>"
       "<feOffset in='SourceGraphic'/>",
       kUser,
       {"flood [0 0 100 90] 0 0 0 1", "flood [0 0 100 90] 1 0 0 1", "offset 1 [0 0 100 90]", "offset 1 [0 0 100 90]",
        "offset S [0 0 100 90]"}},
      // What is inherited: from the filter, and from another one.
      {"<feGaussianBlur stdDeviation='1'/>",
       kUser + " color-interpolation-filters='sRGB'",
       {"s:blur S [0 0 100 90] 1 1"}},
  };
  for (const auto& c : cases) EXPECT_EQ(steps(c.primitives, c.attributes), c.steps) << c.primitives << c.attributes;
  Texts said;
  EXPECT_EQ(steps("<feFlood/><feOffset in='nix'/><feOffset in='BackgroundImage'/>", kUser, &said),
            (Texts{"flood [0 0 100 90] 0 0 0 1", "offset 0 [0 0 100 90]", "offset 1 [0 0 100 90]"}));
  EXPECT_EQ(said,
            (Texts{"test.svg:2:105: warning: <feOffset> has in 'nix', which is not valid; ignored",
                   "test.svg:2:111: warning: in 'BackgroundImage' is not supported: <feOffset> is drawn without it"}));
  EXPECT_EQ(steps("<feFlood x='1em'/>", " primitiveUnits='objectBoundingBox' x='1em'", &said),
            Texts{"flood [6 18 54 42] 0 0 0 1"});
  EXPECT_EQ(said.size(), 2u);
  const Import i =
      page("<filter id='a' x='0' y='0' width='1' height='1'><feOffset dx='1'/></filter><filter id='b' y='-1' "
           "href='#a'/><filter id='f' height='3' href='#b'/>" +
           kRect + "filter='url(#f)'/>");
  EXPECT_EQ(i.placed, Texts());
  ASSERT_EQ(layersOf(i).size(), 1u);
  EXPECT_EQ(stepsOf(*layersOf(i)[0].layer), Texts{"offset S [10 0 50 60] 1"});
}

TEST(SvgLayers, PrimitivesInErrorPassOnOrShowNothing) {
  const struct {
    const char* primitive;
    const char* step;
  } cases[] = {
      {"<feGaussianBlur stdDeviation='-1'/>", "offset S [0 0 100 90]"},
      {"<feGaussianBlur stdDeviation='1 2 3'/>", "offset S [0 0 100 90]"},
      {"<feGaussianBlur stdDeviation='one'/>", "offset S [0 0 100 90]"},
      {"<feMorphology radius='-1'/>", "offset S [0 0 100 90]"},
      {"<feColorMatrix values='1 2 3'/>", "offset S [0 0 100 90]"},
      {"<feColorMatrix type='nix'/>", "offset S [0 0 100 90]"},
      {"<feConvolveMatrix kernelMatrix='1 2'/>", "flood [0 0 100 90]"},
      {"<feConvolveMatrix/>", "flood [0 0 100 90]"},
      {"<feConvolveMatrix order='1 1' kernelMatrix='1 2'/>", "flood [0 0 100 90]"},
      {"<feConvolveMatrix order='-1' kernelMatrix='0 0 0 0 1 0 0 0 0'/>", "convolve/1 S [0 0 100 90] 3 3 1 1 1"},
      {"<feConvolveMatrix order='1.5' kernelMatrix='2'/>", "convolve/1 S [0 0 100 90] 1 1 0 0 2"},
      {"<feConvolveMatrix targetX='3' kernelMatrix='1 1 1 1 1 1 1 1 1'/>", "flood [0 0 100 90]"},
      {"<feConvolveMatrix order='33' kernelMatrix='1'/>", "offset S [0 0 100 90]"},
      {"<feDiffuseLighting/>", "flood [0 0 100 90]"},
      {"<feTurbulence baseFrequency='-1'/>", "flood [0 0 100 90]"},
      {"<feImage href='#nix'/>", "flood [0 0 100 90]"},
      {"<feImage href='a.png'/>", "flood [0 0 100 90]"},
      {"<feNix/><feOffset/>", "offset S [0 0 100 90]"},
      {"<feGaussianBlur stdDeviation='1' edgeMode='wrap'/>", "blur S [0 0 100 90] 1 1"},
      {"<feBlend mode='nix'/>", "blend S S [0 0 100 90]"},
      {"<feBlend mode='plus-lighter'/>", "blend S S [0 0 100 90]"},
      {"<feComposite operator='nix'/>", "composite S S [0 0 100 90]"},
  };
  for (const auto& c : cases) {
    Texts said;
    EXPECT_EQ(steps(c.primitive, kUser, &said), Texts{c.step}) << c.primitive;
    ASSERT_EQ(said.size(), 1u) << c.primitive;
    EXPECT_EQ(said[0].rfind("test.svg:2:", 0), 0u) << said[0];
  }
}

TEST(SvgLayers, FunctionsOfCss) {
  const auto stepsOfStyle = [](const std::string& value, const std::string& more = "") {
    const Import i = page("<path d='M10 10H20V30' style='" + more + "filter:" + value + "'/>");
    EXPECT_EQ(i.placed, Texts()) << value;
    expectSound(i);
    const auto layers = layersOf(i);
    return layers.size() == 1 ? stepsOf(*layers[0].layer) : Texts{};
  };
  const std::string box = " [10 10 20 30]";
  EXPECT_EQ(stepsOfStyle("blur(10px)"), Texts{"s:blur S [-21 -21 51 61] 10 10"});
  EXPECT_EQ(stepsOfStyle("blur(1em)", "font-size:10px;"), Texts{"s:blur S [-21 -21 51 61] 10 10"});
  EXPECT_EQ(stepsOfStyle("drop-shadow(5px -4px)", "color:red;"), Texts{"s:shadow S [10 6 25 30] 0 0 5 -4 1 0 0 1"});
  EXPECT_EQ(stepsOfStyle("drop-shadow(#00f 5px 4px 10px)"), Texts{"s:shadow S [-16 -17 56 65] 10 10 5 4 0 0 1 1"});
  EXPECT_EQ(stepsOfStyle("brightness(50%)"),
            Texts{"s:matrix S" + box + " 0.5 0 0 0 0 0 0.5 0 0 0 0 0 0.5 0 0 0 0 0 1"});
  EXPECT_EQ(stepsOfStyle("contrast(2)"), Texts{"s:matrix S" + box + " 2 0 0 0 -0.5 0 2 0 0 -0.5 0 0 2 0 -0.5 0 0 0 1"});
  EXPECT_EQ(stepsOfStyle("invert(300%)"), Texts{"s:matrix S" + box + " -1 0 0 0 1 0 -1 0 0 1 0 0 -1 0 1 0 0 0 1"});
  EXPECT_EQ(stepsOfStyle("opacity(.25)"), Texts{"s:matrix S" + box + " 1 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 0 0.25"});
  EXPECT_EQ(stepsOfStyle("grayscale()"), Texts{"s:matrix S" + box +
                                               " 0.2126 0.7152 0.0722 0 0 0.2126 0.7152 0.0722 0 0 0.2126 "
                                               "0.7152 0.0722 0 0 0 0 0 1"});
  EXPECT_EQ(stepsOfStyle("sepia(0)"), Texts{"s:matrix S" + box + " 1 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 0 1"});
  EXPECT_EQ(stepsOfStyle("saturate(0)"), stepsOfStyle("SATURATE(calc(1 - 1))"));
  EXPECT_EQ(stepsOfStyle("hue-rotate(.25turn)"), stepsOfStyle("hue-rotate(90deg)"));
  EXPECT_EQ(stepsOfStyle("opacity(1) blur(10px) opacity(1)"),
            (Texts{"s:matrix S" + box + " 1 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 0 1", "s:blur 0 [-21 -21 51 61] 10 10",
                   "s:matrix 1 [-21 -21 51 61] 1 0 0 0 0 0 1 0 0 0 0 0 1 0 0 0 0 0 1"}));
  EXPECT_EQ(stepsOfStyle("none"), Texts{});
  // References in the list have their regions; the alpha of what came before is made where it is asked for.
  const Import i = page("<filter id='f' x='0' y='0' width='1' height='1'><feOffset in='SourceAlpha'/></filter>" +
                        kRect + "style='filter:url(#f) blur(10px) url(&quot;#f&quot;)'/>");
  EXPECT_EQ(i.placed, Texts());
  ASSERT_EQ(layersOf(i).size(), 1u);
  EXPECT_EQ(stepsOf(*layersOf(i)[0].layer),
            (Texts{"offset A [10 20 50 40]", "s:blur 0 [-21 -11 81 71] 10 10", "s:offset 1 [10 20 50 40]",
                   "s:matrix 2 [10 20 50 40] 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1", "offset 3 [10 20 50 40]"}));
  EXPECT_EQ(text(layersOf(i)[0].layer->layer.filterRegion, 4), "10 20 50 40");
  for (const char* bad : {"blur(-1px)", "blur(2)x", "blur(10%)", "blur(1px 2px)", "drop-shadow(1px)",
                          "drop-shadow(red)", "drop-shadow(1px red 2px)", "drop-shadow(1px 2px -3px)", "brightness(-1)",
                          "nix(1)", "blur(1px),", "none blur(1px)", "hue-rotate(1px)", "", "url(#f"}) {
    const Import wrong = page(kRect + "style='filter:" + bad + "'/>");
    EXPECT_EQ(wrong.placed.size(), 1u) << bad;
    EXPECT_TRUE(layersOf(wrong).empty()) << bad;
  }
}

TEST(SvgLayers, WhatIsInsideCountsForFunctions) {
  // A blurred circle reaches three deviations further; so does the blur around it.
  const Import i =
      page("<g style='filter:opacity(.5)'><rect x='20' y='20' width='10' height='10' style='filter:blur(1px)'/>"
           "<path d='M40 40h5v5z' stroke='red' stroke-width='2' stroke-linejoin='round'/></g>");
  EXPECT_EQ(i.placed, Texts());
  ASSERT_EQ(layersOf(i).size(), 2u);
  const float* r = layersOf(i)[0].layer->steps[0].region;
  EXPECT_NEAR(static_cast<double>(r[0]), 16.9, 1e-4);
  EXPECT_NEAR(static_cast<double>(r[1]), 16.9, 1e-4);
  EXPECT_NEAR(static_cast<double>(r[2]), 46, 0.1);
  EXPECT_NEAR(static_cast<double>(r[3]), 46, 0.1);
}

TEST(SvgLayers, FiltersStandWhereTheirElementDoes) {
  const auto transformOf = [](const std::string& inside, const std::string& attributes = "") {
    const Import i = page("<filter id='f'><feFlood/></filter>" + inside, attributes);
    EXPECT_EQ(i.placed, Texts());
    expectSound(i);
    const auto layers = layersOf(i);
    return layers.empty()
               ? std::string("none")
               : text(layers[0].layer->layer.filterTransform, 6) + " " + text(layers[0].layer->steps[0].region, 4);
  };
  const std::string rect = "<rect x='10' y='10' width='10' height='10' ", on = "filter='url(#f)'/>";
  EXPECT_EQ(transformOf(rect + on), "1 0 0 1 0 0 9 9 21 21");
  EXPECT_EQ(transformOf("<g transform='scale(2)'>" + rect + on + "</g>"), "2 0 0 2 0 0 9 9 21 21");
  EXPECT_EQ(transformOf("<defs>" + rect + "id='r'/></defs><use href='#r' x='7' " + on), "1 0 0 1 7 0 9 9 21 21");
  EXPECT_EQ(transformOf("<svg x='5' width='40' height='40' viewBox='0 0 20 20'>" + rect + on + "</svg>"),
            "2 0 0 2 5 0 9 9 21 21");
  EXPECT_EQ(transformOf("<marker id='m' markerUnits='userSpaceOnUse' markerWidth='20' markerHeight='20'>" + rect + on +
                        "</marker><path d='M50 40h9' marker-start='url(#m)'/>"),
            "1 0 0 1 50 40 9 9 21 21");
  // In a pattern each tile has its own, in the tile's place.
  const Import tiles =
      page("<filter id='f'><feImage href='#d'/></filter><defs><path id='d' d='M0 0h3v3'/></defs><pattern id='p' "
           "width='20' height='20' patternUnits='userSpaceOnUse'><rect width='10' height='10' filter='url(#f)'/>"
           "</pattern><rect width='40' height='20' fill='url(#p)'/>");
  expectSound(tiles);
  ASSERT_EQ(layersOf(tiles).size(), 2u);
  EXPECT_EQ(text(layersOf(tiles)[0].layer->layer.filterTransform, 6), "1 0 0 1 0 0");
  EXPECT_EQ(text(layersOf(tiles)[1].layer->layer.filterTransform, 6), "1 0 0 1 20 0");
  EXPECT_EQ(stepsOf(*layersOf(tiles)[1].layer), Texts{"group [-1 -1 11 11] 1 0 0 1 -20"});
  // The outermost element is a box of CSS: its effects are in pixels of the page, its box is the page.
  EXPECT_EQ(transformOf(rect + "/>", " viewBox='0 0 50 50' filter='url(#f)'"), "1 0 0 1 0 0 -10 -10 110 110");
  // Inside a clipPath there are none.
  EXPECT_EQ(transformOf("<clipPath id='c'>" + rect + on + "</clipPath>" + rect + "clip-path='url(#c)'/>"), "none");
}

TEST(SvgLayers, AFilterMakesSomethingOfNothing) {
  const Import i =
      page("<filter id='f' filterUnits='userSpaceOnUse' x='1' y='2' width='3' height='4'><feFlood/></filter>"
           "<path d='M0 0h9v9'/><g filter='url(#f)'/><path d='M0 0h9v9'/>");
  EXPECT_EQ(i.placed, Texts());
  expectSound(i);
  ASSERT_EQ(i.drawing.paths.size(), 3u);
  EXPECT_EQ(i.drawing.paths[1].color[3], 0.0f); // it holds the place in the order
  EXPECT_EQ(i.drawing.paths[1].group, layersOf(i).at(0).group);
}

TEST(SvgLayers, ImagesOfFiltersAreGroups) {
  const Import i = page("<filter id='f'" + kUser +
                        "><feImage href='#d' x='5' y='6' width='20' height='20'/></filter><defs><path id='d' "
                        "d='M0 0h3v3' fill='red'/></defs>" +
                        kRect + "filter='url(#f)'/>");
  EXPECT_EQ(i.placed, Texts());
  expectSound(i);
  ASSERT_EQ(layersOf(i).size(), 1u);
  EXPECT_EQ(stepsOf(*layersOf(i)[0].layer), Texts{"group [5 6 25 26] 1 0 0 1"});
  EXPECT_EQ(i.drawing.paths.back().points, (std::vector<float>{5, 6, 8, 6, 8, 9})); // where its region begins
  EXPECT_EQ(i.drawing.paths.back().color[0], 1.0f);
}

TEST(SvgLayers, BlendingAndIsolation) {
  const std::string back = "<rect width='100' height='100' fill='red'/>",
                    mixed = kRect + "style='mix-blend-mode:multiply'/>";
  const auto layers = [&](const std::string& inside) {
    const Import i = page(inside);
    EXPECT_EQ(i.placed, Texts()) << inside;
    expectSound(i);
    std::string all;
    for (const auto& found : layersOf(i))
      all += (all.empty() ? "" : " ") + std::to_string(found.group) + ":" + std::to_string(found.layer->layer.blend) +
             (found.layer->layer.isolated ? "i" : "");
    return all;
  };
  EXPECT_EQ(layers(back + mixed), "1:1");
  EXPECT_EQ(layers(back + "<g>" + mixed + "</g>"), "1:1");
  EXPECT_EQ(layers(back + "<g style='isolation:isolate'>" + mixed + "</g>"), "1:0i 2:1");
  EXPECT_EQ(layers(back + "<g style='isolation:isolate'>" + kRect + "/></g>"), "");
  EXPECT_EQ(layers(back + mixed + "<g style='isolation:isolate'>" + kRect + "/></g>"), "1:1");
  EXPECT_EQ(layers(back + "<clipPath id='c'><path d='M0 0h9v9'/></clipPath><g clip-path='url(#c)'>" + mixed + "</g>"),
            "2:0i 3:1");
  EXPECT_EQ(layers(back + "<style>.a {mix-blend-mode:plus-lighter}</style>" + kRect + "class='a'/>"), "1:16");
  EXPECT_EQ(layers(back + kRect + "style='mix-blend-mode:normal'/>"), "");
  // It is no attribute, and what is no mode is said.
  EXPECT_TRUE(layersOf(page(kRect + "mix-blend-mode='multiply'/>")).empty());
  EXPECT_EQ(page(kRect + "style='mix-blend-mode:plus-darker'/>").placed.size(), 1u);
  // What is in the tile of a pattern mixes with the tile alone.
  EXPECT_EQ(layers("<pattern id='p' width='50' height='100' patternUnits='userSpaceOnUse'>" + mixed +
                   "</pattern><rect width='50' height='100' fill='url(#p)'/>")
                .substr(0, 4),
            "1:0i");
}

TEST(SvgLayers, OneLayerAnElement) {
  // Opacity, mask and filter of one element are one group's, inside its clip, which its mode is around.
  const Import i = page("<filter id='f'><feOffset dx='1'/></filter><mask id='m'>" + kWhite +
                        "</mask><clipPath id='c'><path d='M0 "
                        "0h50v50'/></clipPath>" +
                        kRect +
                        "opacity='.5' filter='url(#f)' mask='url(#m)' clip-path='url(#c)' "
                        "style='mix-blend-mode:screen'/>");
  EXPECT_EQ(i.placed, Texts());
  expectSound(i);
  ASSERT_EQ(i.drawing.groups.size(), 4u);
  ASSERT_TRUE(i.drawing.groups[0].layer);
  EXPECT_EQ(i.drawing.groups[0].layer->layer.blend, GPGP_BLEND_SCREEN);
  EXPECT_TRUE(i.drawing.groups[1].clipped);
  EXPECT_EQ(i.drawing.groups[1].parent, 1u);
  const ImportedGroup& g = i.drawing.groups[2];
  EXPECT_EQ(g.parent, 2u);
  EXPECT_EQ(g.opacity, 0.5f);
  ASSERT_TRUE(g.layer);
  EXPECT_EQ(g.layer->layer.blend, GPGP_BLEND_NORMAL);
  EXPECT_EQ(g.layer->layer.mask, 4u);
  EXPECT_EQ(g.layer->steps.size(), 1u);
  EXPECT_EQ(i.drawing.paths[0].color[3], 1.0f);
}

TEST(SvgLayers, ShapesOfClipsHaveClips) {
  const std::string half = "<clipPath id='h'><path d='M0 0H30V100H0Z'/></clipPath>";
  const Import i = page(half +
                        "<clipPath id='c'><rect x='20' y='20' width='60' height='60' clip-path='url(#h)'/><rect x='70' "
                        "y='70' width='20' height='20'/></clipPath>" +
                        kWhite + "<rect width='100' height='100' clip-path='url(#c)'/>");
  EXPECT_EQ(i.placed, Texts());
  expectSound(i);
  const auto layers = layersOf(i);
  ASSERT_EQ(layers.size(), 1u);
  EXPECT_EQ(layers[0].layer->layer.maskKind, GPGP_MASK_ALPHA);
  EXPECT_EQ(pathsIn(i, layers[0].layer->layer.mask), 2u);
  const size_t last = i.drawing.paths.size() - 2; // of the mask: the first has a clip around it
  EXPECT_TRUE(i.drawing.groups[i.drawing.paths[last].group - 1].clipped);
  EXPECT_EQ(i.drawing.paths[last + 1].group, layers[0].layer->layer.mask);
  // What contains itself ends, what shows nothing hides.
  const Import self =
      page("<clipPath id='c'><rect width='9' height='9' clip-path='url(#c)'/></clipPath><rect width='9' "
           "height='9' clip-path='url(#c)'/>");
  ASSERT_EQ(self.placed.size(), 1u);
  EXPECT_NE(self.placed[0].find("contains itself"), std::string::npos);
  // A clipPath inside that leads back is none: the shape that it clips is whole.
  const Import back = page("<clipPath id='e'><rect width='9' height='4' clip-path='url(#c)'/></clipPath><clipPath "
                           "id='c'><rect width='9' height='9' clip-path='url(#e)'/></clipPath><rect width='9' "
                           "height='9' clip-path='url(#c)'/>");
  EXPECT_EQ(back.placed, Texts{"test.svg:2:94: warning: clip-path 'url(#e)' contains what it clips: <rect> is drawn "
                               "without it"});
  ASSERT_EQ(layersOf(back).size(), 1u);
  EXPECT_EQ(pathsIn(back, layersOf(back)[0].layer->layer.mask), 1u);
  const Import none =
      page("<clipPath id='n'/><clipPath id='c'><rect width='9' height='9' clip-path='url(#n)'/></clipPath><rect "
           "width='9' height='9' clip-path='url(#c)'/>");
  EXPECT_EQ(none.placed, Texts());
  expectSound(none);
}

TEST(SvgLayers, ClipsAreNotSharedAroundLayers) {
  // The paths of a layer lie in a row: neighbours in the same clip do not share it where one has a filter.
  const std::string clip = "<clipPath id='c'><path d='M0 0h50v50'/></clipPath>";
  const Import i = page(clip + kRect + "clip-path='url(#c)'/>" + kRect + "/>" + kRect +
                        "clip-path='url(#c)' style='filter:blur(1px)'/>");
  ASSERT_EQ(i.drawing.paths.size(), 3u);
  const auto clipOf = [&](size_t path) {
    uint32_t g = i.drawing.paths[path].group;
    while (g && !i.drawing.groups[g - 1].clipped) g = i.drawing.groups[g - 1].parent;
    return g;
  };
  EXPECT_NE(clipOf(0), 0u);
  EXPECT_NE(clipOf(2), 0u);
  EXPECT_NE(clipOf(0), clipOf(2));
}

TEST(SvgLayers, WithoutLayersTheyAreNamed) {
  const auto without = [](const std::string& inside) {
    const Import i = import("<svg xmlns='http://www.w3.org/2000/svg' width='100' height='100'>" + inside + "</svg>", {},
                            1, nullptr, false);
    EXPECT_TRUE(layersOf(i).empty()) << inside;
    EXPECT_GE(i.drawing.paths.size(), 1u) << inside;
    return i.messages;
  };
  const Texts left{
      "W line 1: mask, filter or mix-blend-mode is not drawn inside a render pass: <rect> is drawn without it"};
  EXPECT_EQ(without("<mask id='m'>" + kWhite + "</mask>" + kRect + "mask='url(#m)'/>"), left);
  EXPECT_EQ(without(kRect + "style='filter:blur(2px)'/>"), left);
  EXPECT_EQ(without(kRect + "style='mix-blend-mode:screen'/>"), left);
  EXPECT_EQ(without("<g style='isolation:isolate'>" + kRect + "/></g>"), Texts());
  EXPECT_EQ(
      without("<clipPath id='h'><path d='M0 0h9v9'/></clipPath><clipPath id='c'><rect width='9' height='9' "
              "clip-path='url(#h)'/></clipPath>" +
              kRect + "clip-path='url(#c)'/>"),
      Texts{"W line 1: clip-path inside a clipPath is not drawn inside a render pass: <clipPath> is drawn without it"});
  std::string fading;
  for (int i = 0; i < 5; ++i) fading = "<g opacity='.9'>" + fading + "<path d='M0 0h9v9'/><path d='M0 0h9v9'/></g>";
  EXPECT_EQ(without(fading),
            Texts{"W line 1: opacity of <g>, inside too many that fade, is applied to each of its paths"});
}

TEST(SvgLayers, SymbolsHaveReferences) {
  const auto first = [](const std::string& attributes) {
    const Import i = page("<symbol id='s' viewBox='10 10 20 20' overflow='visible' " + attributes +
                          "><path d='M10 10H30V30'/></symbol><use href='#s' x='50' y='40' width='40' height='40'/>");
    EXPECT_EQ(i.placed, Texts()) << attributes;
    const auto& p = i.drawing.paths.at(0).points;
    return text(static_cast<double>(p[0])) + " " + text(static_cast<double>(p[1]));
  };
  EXPECT_EQ(first(""), "50 40");
  EXPECT_EQ(first("refX='10' refY='10'"), "50 40");
  EXPECT_EQ(first("refX='20' refY='30'"), "30 0");
  EXPECT_EQ(first("refX='center'"), "30 40");
  EXPECT_EQ(first("refY='bottom'"), "50 0");
}

TEST(SvgLayers, HostileFilesAreBounded) {
  const auto repeated = [](const std::string& what, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += what;
    return all;
  };
  const auto saidOf = [](const Import& i) {
    expectSound(i);
    std::string all;
    for (const std::string& message : i.messages) all += message + "\n";
    return all;
  };
  const auto filtered = [&](const std::string& primitives) {
    return page("<filter id='f'>" + primitives + "</filter>" + kRect + "filter='url(#f)'/>");
  };
  const Import long_ = filtered(repeated("<feOffset dx='1'/>", 10'000));
  EXPECT_EQ(saidOf(long_), "W line 2: filter has more steps than are supported: <rect> is drawn without it\n");
  EXPECT_EQ(long_.drawing.paths.size(), 1u);
  // Nor is there anything of what the steps show.
  const Import image = page("<defs><path id='d' d='M0 0h9v9'/></defs><filter id='f'><feImage href='#d'/>" +
                            repeated("<feOffset dx='1'/>", 300) + "</filter>" + kRect + "filter='url(#f)'/>");
  EXPECT_EQ(saidOf(image), "W line 2: filter has more steps than are supported: <rect> is drawn without it\n");
  EXPECT_EQ(image.drawing.paths.size(), 1u);
  EXPECT_EQ(saidOf(filtered("<feMerge>" + repeated("<feMergeNode/>", 10'000) + "</feMerge>")),
            "W line 2: filter has more steps than are supported: <rect> is drawn without it\n");
  // Sizes that no one can mean are taken as the largest that makes a difference.
  const auto first = [&](const std::string& primitive) {
    const Import i = filtered(primitive);
    EXPECT_EQ(saidOf(i), "") << primitive;
    return layersOf(i).empty() ? std::string() : text(layersOf(i)[0].layer->steps[0]);
  };
  EXPECT_EQ(first("<feGaussianBlur stdDeviation='1e9'/>"), "blur S [6 18 54 42] 6.554e+04 6.554e+04");
  EXPECT_EQ(first("<feMorphology radius='1e9'/>"), "morphology S [6 18 54 42] 48 24");
  EXPECT_EQ(first("<feOffset dx='1e30' dy='-1e300'/>"), "offset S [6 18 54 42] 3e+07 -3e+07");
  EXPECT_EQ(first("<feTurbulence baseFrequency='1e30' numOctaves='1000000'/>"),
            "turbulence/1 [6 18 54 42] 1e+06 1e+06 16");
  EXPECT_EQ(first("<feColorMatrix type='saturate' values='1e12'/>"),
            "matrix S [6 18 54 42] 2.361e+07 -2.145e+07 -2.16e+06 0 0 -6.39e+06 8.55e+06 -2.16e+06 0 0 -6.39e+06 "
            "-2.145e+07 2.784e+07 0 0 0 0 0 1");
  for (const char* function : {"brightness(1e12)", "contrast(1e12)", "saturate(1e12)", "contrast(1e300)"})
    EXPECT_EQ(saidOf(page(kRect + "style='filter:" + function + "'/>")), "") << function; // expectSound looks at values
  const Import contrast = page(kRect + "style='filter:contrast(1e12)'/>");
  ASSERT_EQ(layersOf(contrast).size(), 1u); // half of the intensity stays in the middle
  EXPECT_EQ(text(layersOf(contrast)[0].layer->steps[0].values, 5), "3e+07 0 0 0 -1.5e+07");
  // Of kernels and their divisors the ratio counts.
  const auto convolved = [&](const std::string& attributes) {
    const Import i = filtered("<feConvolveMatrix order='2 1' " + attributes + "/>");
    EXPECT_EQ(saidOf(i), "") << attributes;
    if (layersOf(i).size() != 1) return std::string();
    const GpgpFilterStep& s = layersOf(i)[0].layer->steps[0];
    return text(s.table, s.tableCount) + " / " + text(static_cast<double>(s.values[4]));
  };
  EXPECT_EQ(convolved("kernelMatrix='1e9 0'"), "3e+07 0 / 3e+07");
  EXPECT_EQ(convolved("kernelMatrix='1e300 1e300'"), "1.5e+07 1.5e+07 / 3e+07");
  EXPECT_EQ(convolved("kernelMatrix='3e8 -3e8' divisor='100'"), "3e+07 -3e+07 / 10");
  EXPECT_EQ(convolved("kernelMatrix='1 2' divisor='3e8'"), "0.1 0.2 / 3e+07");
  EXPECT_EQ(convolved("kernelMatrix='1 2' divisor='1e-60'"), "1 2 / 3");
  EXPECT_EQ(convolved("kernelMatrix='1 -1' divisor='1e-60'"), "1 -1 / 1");
  EXPECT_EQ(saidOf(filtered("<feConvolveMatrix order='1000' kernelMatrix='" + repeated("1 ", 1'000'000) + "'/>")),
            "W line 2: order above 32 is not supported: <feConvolveMatrix> is drawn without it\n");
  // Groups that fade in each other.
  std::string fading;
  for (int i = 0; i < 33; ++i) fading = "<g opacity='.9'>" + fading + "<path d='M0 0h9v9'/><path d='M0 0h9v9'/></g>";
  EXPECT_EQ(saidOf(page(fading)),
            "W line 2: opacity of <g>, inside too many that fade, is applied to each of its paths\n");
  // Masks in each other.
  std::string masks;
  for (int i = 0; i < 500; ++i)
    masks += "<mask id='m" + std::to_string(i) + "'><rect width='99' height='99' fill='#fff' mask='url(#m" +
             std::to_string(i + 1) + ")'/></mask>";
  EXPECT_EQ(saidOf(page(masks + kRect + "mask='url(#m0)'/>")),
            "W line 2: mask, filter or mix-blend-mode is inside too many others: <rect> is drawn without it\n");
  // Twice in each other, which would be 2 to the 30th.
  std::string doubled;
  for (int i = 0; i < 30; ++i)
    doubled += "<mask id='m" + std::to_string(i) + "'>" +
               repeated("<rect width='99' height='99' fill='#fff' mask='url(#m" + std::to_string(i + 1) + ")'/>", 2) +
               "</mask>";
  const Import many = page(doubled + "<mask id='m30'>" + kWhite + "</mask>" + kRect + "mask='url(#m0)'/>");
  EXPECT_NE(saidOf(many).find("one more than the 4096 that a drawing can have"), std::string::npos);
  // The same for filters of many elements.
  const std::string steps200 = "<filter id='f'>" + repeated("<feOffset dx='1'/>", 200) + "</filter>";
  const Import wide = page(steps200 + repeated(kRect + "filter='url(#f)'/>", 1000));
  EXPECT_NE(saidOf(wide).find("filter has more steps than are supported"), std::string::npos);
  size_t all = 0;
  for (const auto& found : layersOf(wide)) all += found.layer->steps.size();
  EXPECT_LE(all, vector::svg::ImportLimits{}.filterSteps);
  const Import tiled =
      page("<filter id='f'><feOffset/></filter><pattern id='p' width='1' height='1' patternUnits='userSpaceOnUse'>"
           "<path d='M0 0h1v1' filter='url(#f)'/></pattern><rect width='90' height='90' fill='url(#p)'/>");
  EXPECT_NE(saidOf(tiled).find("whose tiles have more masks, filters and blend modes than are supported"),
            std::string::npos);
  // Coordinates without an inverse.
  EXPECT_EQ(page("<mask id='m'>" + kWhite + "</mask><g transform='scale(0 1)'>" + kRect + "mask='url(#m)'/></g>")
                .drawing.groups.size(),
            0u);
  for (const char* attribute : {"mask='url(#m)'", "style='filter:blur(2px)'"}) // it has one, but not as floats
    EXPECT_EQ(saidOf(page("<mask id='m'>" + kWhite + "</mask><g transform='matrix(1 1 1 1.00000005 0 0)'>" + kRect +
                          attribute + "/></g>")),
              "W line 2: mask, filter or mix-blend-mode has coordinates that are too large or too small: <rect> is "
              "drawn without it\n");
}

} // namespace
