// What clip-path refers to: the shapes of a clipPath as the clip of a group.
#include "vector/import/svg/importer.h"

#include <algorithm>

namespace gpgp::vector::svg {
namespace {
/// "#id" of url(#id), with or without quotes; empty where it is something else.
std::string referenceOf(std::string_view text) {
  if (text.substr(0, 4) != "url(" || text.back() != ')') return {};
  text = trim(text.substr(4, text.size() - 5));
  if (text.size() > 1 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front())
    text = text.substr(1, text.size() - 2);
  return std::string(text.substr(0, 1) == "#" ? text : std::string_view());
}
} // namespace

void Importer::clip(pugi::xml_node node, std::string_view name, State& state) {
  const std::string& value = state.style.clipPath;
  const std::string reference = referenceOf(value);
  const pugi::xml_node target = reference.empty() ? pugi::xml_node() : document_.find(reference);
  const auto without = [&](const std::string& why) {
    reporter_.warn(document_.line(node),
                   std::string("clip-path ") + why + ": " + element(node) + " is drawn without it");
  };
  const std::string shown = std::string("'") + value.substr(0, 60) + "'";
  if (!target || document_.name(target) != "clipPath") return without(shown + " is no clipPath of this file");
  if (std::find(used_.begin(), used_.end(), target) != used_.end()) return without(shown + " contains itself");
  if (state.clips >= shader::kMaxClipDepth) return without("is inside too many others");
  State inner;
  inner.transform = state.transform;
  inner.lengths = state.lengths;
  inner.depth = state.depth;
  cascade(target, "clipPath", Style{}, state.lengths, inner.style);
  if (const pugi::xml_attribute text = target.attribute("transform")) {
    Affine own;
    if (!parseTransform(text.value(), own)) return without(shown + " has an error in its transform");
    inner.transform = inner.transform * own;
  }
  if (std::string_view(target.attribute("clipPathUnits").value()) == "objectBoundingBox") {
    if (!isShape(name)) return without("with clipPathUnits objectBoundingBox is supported on shapes only");
    const Box box = boxOf(shapeOf(node, name, state));
    if (box.left <= box.right)
      inner.transform = inner.transform * Affine{box.right - box.left, 0, 0, box.bottom - box.top, box.left, box.top};
  }
  used_.push_back(target);
  if (!inner.style.clipPath.empty()) { // what the clipPath is clipped by clips as well
    State around = state;
    ++around.clips; // so that no chain of them is too long
    around.style.clipPath = inner.style.clipPath;
    clip(target, "clipPath", around);
    state.group = around.group;
    state.clips = around.clips;
  }
  inner.style = inner.style.inherited();
  std::vector<ImportedPath> paths;
  std::swap(paths, result_.paths);
  clipping_ = true;
  for (const pugi::xml_node child : target.children()) {
    const std::string_view what = document_.name(child);
    if (isShape(what) || what == "use" || what == "text") visit(child, inner);
  }
  clipping_ = false;
  std::swap(paths, result_.paths);
  used_.pop_back();
  result_.groups.push_back({state.group, 1, true, std::move(paths)});
  state.group = static_cast<uint32_t>(result_.groups.size());
  ++state.clips;
}

} // namespace gpgp::vector::svg
