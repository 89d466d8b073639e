// Lists of shapes: paths, paints and modifiers.
#include "vector/import/lottie/read_value.h"

namespace gpgp::vector::lottie {
namespace {
constexpr size_t kMaxShapeDepth = 64, kMaxItems = 65'536;
}

void Reader::gradient(const Json& value, ShapeItem& item) {
  auto gradient = std::make_shared<Gradient>();
  const int type = intOf(value, "t", 1);
  if (type != 1 && type != 2) unsupported(value, "gradients other than linear and radial ones are drawn as linear");
  gradient->radial = type == 2;
  gradient->start = property(value, "s", {0, 0});
  gradient->end = property(value, "e", {100, 0});
  gradient->highlight = property(value, "h", {0});
  gradient->angle = property(value, "a", {0});
  if (const Json* g = find(value, "g")) {
    gradient->stops = property(*g, "k");
    gradient->colors = static_cast<size_t>(std::clamp(numberOf(*g, "p"), 0.0, 4096.0));
  }
  item.gradient = std::move(gradient);
}

void Reader::stroke(const Json& value, ShapeItem& item) {
  item.kind = ShapeKind::Stroke;
  item.width = property(value, "w", {1});
  item.cap = intOf(value, "lc", 1);
  item.join = intOf(value, "lj", 1);
  item.miterLimit = numberOf(value, "ml", 4);
  if (const Json* limit = find(value, "ml2")) item.miterLimit = propertyOf(*limit, {4}).number(0, 4);
  for (const Json& part : listOf(value, "d")) {
    const std::string name = stringOf(part, "n");
    if (item.dashes.size() >= 64 || name.empty()) continue;
    item.dashes.push_back({name[0], property(part, "v", {0})});
  }
}

bool Reader::shape(const Json& value, ShapeItem& item, size_t depth) {
  const std::string type = stringOf(value, "ty");
  item.backwards = intOf(value, "d", 1) == 3;
  const auto numbers = [&](std::initializer_list<std::pair<const char*, double>> names) {
    size_t i = 0;
    for (const auto& [name, otherwise] : names) item.numbers[i++] = property(value, name, {otherwise});
  };
  if (type == "gr") {
    const Json& items = listOf(value, "it");
    item.kind = ShapeKind::Group;
    item.transform = transform(orNothing(nullptr));
    for (const Json& part : items)
      if (stringOf(part, "ty") == "tr") item.transform = transform(part);
    item.items = shapes(items, depth + 1);
  } else if (type == "sh") {
    item.kind = ShapeKind::Path;
    item.path = property(value, "ks");
  } else if (type == "rc") {
    item.kind = ShapeKind::Rectangle;
    item.position = property(value, "p", {0, 0});
    item.size = property(value, "s", {0, 0});
    numbers({{"r", 0}});
  } else if (type == "el") {
    item.kind = ShapeKind::Ellipse;
    item.position = property(value, "p", {0, 0});
    item.size = property(value, "s", {0, 0});
  } else if (type == "sr") {
    item.kind = ShapeKind::Star;
    item.mode = intOf(value, "sy", 1);
    item.position = property(value, "p", {0, 0});
    numbers({{"pt", 5}, {"r", 0}, {"ir", 0}, {"or", 0}, {"is", 0}, {"os", 0}});
  } else if (type == "fl" || type == "gf") {
    item.kind = ShapeKind::Fill;
    item.evenOdd = intOf(value, "r", 1) == 2;
  } else if (type == "st" || type == "gs") {
    stroke(value, item);
  } else if (type == "tm") {
    item.kind = ShapeKind::Trim;
    item.mode = intOf(value, "m", 1);
    numbers({{"s", 0}, {"e", 100}, {"o", 0}});
  } else if (type == "rp") {
    item.kind = ShapeKind::Repeater;
    item.mode = intOf(value, "m", 1);
    item.transform = transform(orNothing(find(value, "tr")));
    numbers({{"c", 1}, {"o", 0}});
  } else if (type == "rd") {
    item.kind = ShapeKind::Round;
    numbers({{"r", 0}});
  } else if (type == "pb") {
    item.kind = ShapeKind::Pucker;
    numbers({{"a", 0}});
  } else if (type == "tw") {
    item.kind = ShapeKind::Twist;
    item.position = property(value, "c", {0, 0});
    numbers({{"a", 0}});
  } else if (type == "zz") {
    item.kind = ShapeKind::Zigzag;
    numbers({{"s", 0}, {"r", 0}});
    item.mode = static_cast<int>(property(value, "pt", {1}).number(0, 1));
  } else if (type == "mm") {
    item.kind = ShapeKind::Merge;
    item.mode = intOf(value, "mm", 1);
    if (item.mode == 3 || item.mode == 4)
      unsupported(value, std::string("merge paths: ") + (item.mode == 3 ? "subtract" : "intersect") +
                             " is not supported: the paths are drawn as they are");
  } else if (type == "tr") {
    return false; // of the group
  } else {
    unsupported(value, type == "op"   ? std::string("offset paths are not supported: paths keep their size")
                       : type.empty() ? std::string("a shape without a type is left out")
                                      : "the shape '" + type.substr(0, 20) + "' is not supported");
    return false;
  }
  if (item.kind == ShapeKind::Fill || item.kind == ShapeKind::Stroke) {
    item.color = property(value, "c", {0, 0, 0});
    unitColor(item.color);
    item.opacity = property(value, "o", {100});
    if (type == "gf" || type == "gs") gradient(value, item);
    if (intOf(value, "bm") != 0) unsupported(value, "blend modes of a fill or stroke are not supported");
  }
  if (item.kind == ShapeKind::Group && intOf(value, "bm") != 0)
    unsupported(value, "blend modes of a group of shapes are not supported");
  return true;
}

std::vector<ShapeItem> Reader::shapes(const Json& list, size_t depth) {
  std::vector<ShapeItem> result;
  if (depth > kMaxShapeDepth) throw Refusal{&list, "groups of shapes are more than 64 deep"};
  if (list.size() > kMaxItems) throw Refusal{&list, "a list has more than 65536 shapes"};
  for (const Json& value : list) {
    if (!value.is_object() || numberOf(value, "hd") != 0) continue;
    ShapeItem item;
    if (shape(value, item, depth)) result.push_back(std::move(item));
  }
  return result;
}

} // namespace gpgp::vector::lottie
