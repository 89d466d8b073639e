// SVG to filled paths.
//
// Supported: path, rect, circle, ellipse, line, polyline, polygon, g, a, svg (nested too), use, symbol, switch;
// transforms; fill, stroke with joins, caps and dashes (made into fills), markers, opacities, colours, style sheets;
// linear and radial gradients, patterns; clip paths, masks, filters, blend modes; opacity of groups; embedded images;
// text where it is shaped. What is not supported is named with its place while the rest is drawn. Any bytes are safe:
// depth, copies, points and messages are limited, and a limit that is met is said.
#pragma once
#include "core/result.h"
#include "vector/geometry/shape.h"
#include "vector/import/svg/reporter.h"

#include <memory>
#include <span>
#include <string>

namespace gpgp::vector::svg {

/// How finely strokes and arcs are made, and for whom.
struct ImportDetail {
  double scale = 1;      ///< the largest at which the drawing is shown, pixels per pixel of the page
  double strokes = 0.05; ///< they are off by less than this, in pixels at that scale
  double arcs = 1e-4;    ///< likewise
  bool layers = true;    ///< false: whoever draws it has none; what would need one is left out, which is said
};

struct ImportLimits {
  size_t depth = 200;        ///< of elements in each other, <use> included
  size_t elements = 500'000; ///< visited, copies by <use> included
  size_t paths = 250'000;
  size_t points = 32'000'000;           ///< of all paths
  size_t matches = 20'000'000;          ///< style selectors and declarations looked at
  size_t layers = 4096;                 ///< that blend, are masked or filtered, and their masks
  size_t filterSteps = 32'768;          ///< of all filters
  size_t filterNumbers = 4'000'000;     ///< of the tables and kernels of all filters
  size_t imageBytes = size_t(64) << 20; ///< of images in other files
  size_t sheets = 64;                   ///< style sheets of other files
  size_t sheetBytes = size_t(16) << 20; ///< of all of them
};

struct Gradient {
  GpgpGradient gradient{}; ///< its stops are the ones beside it
  std::vector<GpgpGradientStop> stops;
};

/// Who decodes embedded images.
struct ImageDecoder {
  GpgpSvgImageFn fn = nullptr;
  void* userData = nullptr;
};

/// Who shapes text.
struct TextShaper {
  GpgpSvgTextFn fn = nullptr;
  void* userData = nullptr;
};

struct ImportedPath {
  std::vector<GpgpPathVerb> verbs;
  std::vector<float> points; ///< x, y pairs in pixels of the page
  GpgpFillRule rule = GPGP_FILL_NON_ZERO;
  float color[4] = {};                         ///< linear RGB, straight alpha
  std::shared_ptr<const Gradient> gradient;    ///< instead of the colour, whose alpha still counts
  std::shared_ptr<const GpgpImagePaint> image; ///< likewise
  Place place;                                 ///< of the element it comes from
  std::string element;                         ///< "<path>"
  uint32_t group = 0;                          ///< 1 + its index in Imported::groups

  GpgpPath view() const {
    return {verbs.data(),
            static_cast<uint32_t>(verbs.size()),
            points.data(),
            static_cast<uint32_t>(points.size() / 2),
            rule,
            {color[0], color[1], color[2], color[3]},
            gradient ? &gradient->gradient : nullptr,
            nullptr,
            image.get(),
            0,
            group};
  }
};

/// What makes a group a layer (layers.h): its numbers, and what they refer to.
struct ImportedLayer {
  GpgpLayer layer{}; ///< `filter` and `filterCount` aside
  std::vector<GpgpFilterStep> steps;
  std::vector<std::shared_ptr<const std::vector<float>>> tables; ///< of the steps

  GpgpLayer view() const {
    GpgpLayer whole = layer;
    whole.filter = steps.empty() ? nullptr : steps.data();
    whole.filterCount = static_cast<uint32_t>(steps.size());
    return whole;
  }
};

/// Elements that are clipped, faded, masked, filtered or mixed as one.
struct ImportedGroup {
  uint32_t parent = 0; ///< 1 + index
  float opacity = 1;
  bool clipped = false;
  std::vector<ImportedPath> clip;
  std::shared_ptr<const ImportedLayer> layer = nullptr;
};

struct Imported {
  std::vector<ImportedPath> paths; ///< in painting order; those of masks and filters come last
  std::vector<ImportedGroup> groups;
  double width = 0, height = 0;  ///< of the page in pixels; 0: the file does not say
  double strokeMilliseconds = 0; ///< of the time that importing took, on making strokes into fills
};

/// What was imported as the API takes it. It refers to what was imported.
struct ImportedViews {
  explicit ImportedViews(const Imported& imported) {
    for (const ImportedPath& path : imported.paths) paths.push_back(path.view());
    size_t count = 0;
    for (const ImportedGroup& group : imported.groups) count += group.clip.size();
    clips.reserve(count + 1); // so that a clip without paths is one nevertheless
    layers.reserve(imported.groups.size());
    for (const ImportedGroup& group : imported.groups) {
      if (group.layer) layers.push_back(group.layer->view());
      groups.push_back({group.parent, group.opacity, group.clipped ? clips.data() + clips.size() : nullptr,
                        static_cast<uint32_t>(group.clip.size()), group.layer ? &layers.back() : nullptr});
      for (const ImportedPath& path : group.clip) clips.push_back(path.view());
    }
  }
  ImportedViews(const ImportedViews&) = delete;
  std::vector<GpgpPath> paths, clips;
  std::vector<GpgpPathGroup> groups;
  std::vector<GpgpLayer> layers;
};

/// The size of an SVG's page in pixels; 0: the file does not say.
struct PageSize {
  double width = 0, height = 0;
};
core::Result<PageSize> pageSize(std::span<const std::byte> bytes, const GpgpFileSystem* files = nullptr);

/// The map from the page of an SVG (x, y, width, height) into a picture, as if the picture's size were what the
/// outermost element asks for: the viewBox, or the page where there is none, fitted as preserveAspectRatio says.
core::Result<Affine> fitPage(std::span<const std::byte> bytes, const float (&page)[4], double width, double height);

/// Errors where the bytes are no SVG at all; everything milder goes to the reporter. Style sheets of other files are
/// read through `files`, by names relative to the drawing's folder.
core::Result<Imported> importSvg(std::span<const std::byte> bytes, Reporter& reporter, const ImportLimits& limits = {},
                                 const ImageDecoder& images = {}, const ImportDetail& detail = {},
                                 const GpgpFileSystem* files = nullptr, const TextShaper& text = {});

} // namespace gpgp::vector::svg
