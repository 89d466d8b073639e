// The outermost element: its page, its background, and what is to be said of the file as a whole.
#include "vector/import/svg/importer.h"

#include <algorithm>

namespace gpgp::vector::svg {

core::Result<PageSize> pageSize(std::span<const std::byte> bytes, const GpgpFileSystem* files) {
  Document document;
  if (auto ok = document.load(bytes); !ok) return ok.error();
  Reporter quiet(nullptr, nullptr, "");
  return Importer(document, quiet, {}, {}, {}, files, {}).pageSize();
}

PageSize Importer::pageSize() {
  begin();
  return {result_.width, result_.height};
}

/// Elements that act on others or on the whole are looked for wherever they stand: nothing draws what is in a <defs>.
void Importer::reportEverywhere() {
  for (const pugi::xml_node node : document_.all({"script", "animate", "animateColor", "animateMotion",
                                                  "animateTransform", "set", "discard", "handler", "listener", "link"}))
    reporter_.warn(document_.place(node), element(node) + " is not supported");
  constexpr std::string_view shown[] = {"video", "audio", "canvas", "iframe", "img", "embed", "object"};
  for (const Document::Html& html : document_.html())
    if (oneOf(html.name, shown)) reporter_.warn(html.place, "HTML's <" + html.name + "> is not supported");
  for (const Document::Unknown& entity : document_.unknownEntities())
    reporter_.ignored(entity.place, "the entity '" + entity.text + "' is not defined in this file; ignored");
}

/// CSS Backgrounds 3, 2.11.2: that of the outermost element lies below the whole page.
void Importer::paintBackground(const State& state) {
  const pugi::xml_node root = document_.root();
  const Style::Background& background = state.style.background;
  if (background.hasImage)
    reporter_.warn(document_.place(root), "background-image is not supported: <svg> is drawn without it");
  const Color color = background.color.isCurrent ? state.style.color : background.color.color;
  if (!(color.a > 0) || !state.style.visible) return;
  if (!(result_.width > 0 && result_.height > 0))
    return reporter_.warn(document_.place(root), "background is not supported where <svg> has neither a size nor a "
                                                 "viewBox: <svg> is drawn without it");
  group_ = state.group;
  // A transform of its own moves its box as well, from the coordinates of the page.
  const Affine map = !state.style.isMoved() ? Affine{} : state.transform * inverseOf(toPage_);
  emit(rectangle(0, 0, result_.width, result_.height, 0, 0, 1), map, GPGP_FILL_NON_ZERO, {color, nullptr},
       state.opacity, root);
}

Importer::State Importer::begin() {
  mayBlend_ = document_.mayBlend();
  sharesClips_ = !document_.mayLayer();
  for (const pugi::xml_node clipPath : document_.all({"clipPath"})) // shapes in it that have clips make it a layer
    for (const pugi::xml_node shape : clipPath.children())
      if (shape.attribute("clip-path") ||
          std::string_view(shape.attribute("style").value()).find("clip-path") != std::string_view::npos)
        sharesClips_ = false;
  readSheets();
  const pugi::xml_node root = document_.root();
  const pugi::xml_attribute boxText = root.attribute("viewBox");
  const std::optional<ViewBox> box = parseViewBox(boxText.value());
  if (boxText && !box) ignored(root, boxText);
  State state;
  // A page in percent has the size of its viewBox: there is nothing around it.
  state.lengths.width = box ? box->width : 100;
  state.lengths.height = box ? box->height : 100;
  bool hasWidth = false, hasHeight = false;
  Style style;
  cascade(root, {}, state.lengths, style);
  state.lengths.rootFontSize = style.fontSize;
  LengthContext lengths = state.lengths;
  lengths.fontSize = style.fontSize;
  double width = extent(root, style, "width", lengths, LengthAxis::X, 0, &hasWidth);
  double height = extent(root, style, "height", lengths, LengthAxis::Y, 0, &hasHeight);
  empty_ = !hasExtent(root, hasWidth ? width : 1, hasHeight ? height : 1, box);
  const auto isPercent = [&](const char* name) {
    const std::string* styled = style.geometryOf(name);
    const std::string_view text = styled ? std::string_view(*styled) : root.attribute(name).value();
    return text.find('%') != text.npos || text.find('v') != text.npos; // a part of what is not known, as vw
  };
  if (isPercent("width")) hasWidth = false;
  if (isPercent("height")) hasHeight = false;
  if (empty_) {
    if (hasWidth && hasHeight) result_.width = width, result_.height = height;
    return state;
  }
  if (box && !hasWidth) width = hasHeight ? height * box->width / box->height : box->width;
  if (box && !hasHeight) height = hasWidth ? width * box->height / box->width : box->height;
  if (box || (hasWidth && hasHeight)) {
    result_.width = width;
    result_.height = height;
  }
  if (box) {
    state.transform = fitViewBox(*box, width, height, aspectRatio(root));
    state.lengths.width = box->width;
    state.lengths.height = box->height;
  } else {
    if (hasWidth) state.lengths.width = width;
    if (hasHeight) state.lengths.height = height;
  }
  state.lengths.pageWidth = result_.width > 0 ? result_.width : state.lengths.width;
  state.lengths.pageHeight = result_.height > 0 ? result_.height : state.lengths.height;
  toPage_ = state.transform;
  return state;
}

} // namespace gpgp::vector::svg
