#include "vector/import/lottie/shapes.h"

#include "vector/import/lottie/evaluate.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace gpgp::vector::lottie {
namespace {
constexpr size_t kWorkOfRidge = 16; ///< each is looked for by length: as much as so many points take

class Shapes {
public:
  Shapes(double frame, const std::function<bool(size_t)>& spend, PaintTree& tree)
      : frame_(frame), spend_(spend), tree_(tree) {}

  struct List {
    std::vector<uint32_t> entries;
    std::vector<PaintNode> nodes;
  };
  List run(const std::vector<ShapeItem>& items) {
    List list;
    for (const ShapeItem& item : items) {
      switch (item.kind) {
      case ShapeKind::Path:
      case ShapeKind::Rectangle:
      case ShapeKind::Ellipse:
      case ShapeKind::Star: addPath(item, list); break;
      case ShapeKind::Group: addGroup(item, list); break;
      case ShapeKind::Fill:
      case ShapeKind::Stroke:
        if (!spend_(list.entries.size())) break;
        list.nodes.push_back({&item, 1, {}, list.entries, {}});
        break;
      case ShapeKind::Repeater: repeat(item, list); break;
      case ShapeKind::Merge: merge(item, list); break;
      default: modify(item, list);
      }
    }
    return list;
  }

private:
  double number(const ShapeItem& item, size_t i, double otherwise = 0) const {
    return item.numbers[i].number(frame_, otherwise);
  }

  void addPath(const ShapeItem& item, List& list) {
    const Point position = item.position.point(frame_);
    Contour contour;
    switch (item.kind) {
    case ShapeKind::Rectangle:
      contour = rectangleOf(position, item.size.point(frame_), number(item, 0), item.backwards);
      break;
    case ShapeKind::Ellipse: contour = ellipseOf(position, item.size.point(frame_), item.backwards); break;
    case ShapeKind::Star:
      contour = starOf({item.mode == 2, item.backwards, position, number(item, 0), number(item, 1), number(item, 2),
                        number(item, 3), number(item, 4), number(item, 5)});
      break;
    default: contour = contourOf(item.path.at(frame_), item.path.closed);
    }
    if (contour.vertices.empty() || !spend_(contour.vertices.size())) return;
    list.entries.push_back(static_cast<uint32_t>(tree_.entries.size()));
    tree_.entries.push_back({{std::move(contour)}, {}, false});
  }

  static void place(PaintNode& node, const Affine& map) {
    node.map = map * node.map;
    for (PaintNode& child : node.children) place(child, map);
  }

  void addGroup(const ShapeItem& item, List& list) {
    List inner = run(item.items);
    const Affine map = matrixOf(item.transform, frame_);
    const double opacity = std::clamp(item.transform.opacity.number(frame_, 100) / 100, 0.0, 1.0);
    for (const uint32_t entry : inner.entries) tree_.entries[entry].map = map * tree_.entries[entry].map;
    for (PaintNode& node : inner.nodes) place(node, map);
    list.entries.insert(list.entries.end(), inner.entries.begin(), inner.entries.end());
    fade(std::move(inner.nodes), opacity, list.nodes);
  }

  /// Appends what is shown less than whole.
  static void fade(std::vector<PaintNode> nodes, double opacity, std::vector<PaintNode>& to) {
    if (opacity <= 0 || nodes.empty()) return;
    if (opacity < 1 && nodes.size() > 1) {
      PaintNode group;
      group.opacity = opacity;
      group.children = std::move(nodes);
      to.push_back(std::move(group));
      return;
    }
    for (PaintNode& node : nodes) {
      node.opacity *= opacity;
      to.push_back(std::move(node));
    }
  }

  size_t pointsOf(const List& list) const {
    size_t points = 0;
    for (const uint32_t entry : list.entries)
      for (const Contour& contour : tree_.entries[entry].contours) points += contour.vertices.size();
    return points;
  }
  static size_t sizeOf(const std::vector<PaintNode>& nodes) {
    size_t size = nodes.size();
    for (const PaintNode& node : nodes) size += node.entries.size() + sizeOf(node.children);
    return size;
  }

  void repeat(const ShapeItem& item, List& list) {
    const double count = std::clamp(std::floor(number(item, 0, 1)), 0.0, 10'000.0), offset = number(item, 1);
    const auto copies = static_cast<size_t>(count);
    const size_t each = pointsOf(list) + sizeOf(list.nodes) + 1;
    const double from = item.transform.startOpacity.number(frame_, 100) / 100,
                 to = item.transform.endOpacity.number(frame_, 100) / 100;
    std::vector<List> made;
    for (size_t i = 0; i < copies && spend_(each); ++i) {
      const auto step = static_cast<double>(i);
      const Affine map = repeatedMatrix(item.transform, frame_, step + offset);
      List copy;
      std::unordered_map<uint32_t, uint32_t> copyOf;
      for (const uint32_t entry : list.entries) {
        copy.entries.push_back(static_cast<uint32_t>(tree_.entries.size()));
        copyOf.emplace(entry, copy.entries.back());
        PathEntry same = tree_.entries[entry];
        same.map = map * same.map;
        tree_.entries.push_back(std::move(same));
      }
      std::vector<PaintNode> nodes = list.nodes;
      for (PaintNode& node : nodes) {
        place(node, map);
        renumber(node, copyOf);
      }
      const double part = copies > 1 ? step / (count - 1) : 0;
      fade(std::move(nodes), std::clamp(from + (to - from) * part, 0.0, 1.0), copy.nodes);
      made.push_back(std::move(copy));
    }
    list = {};
    if (item.mode == 2) std::reverse(made.begin(), made.end()); // the last copy is on top
    for (List& copy : made) {
      list.entries.insert(list.entries.end(), copy.entries.begin(), copy.entries.end());
      for (PaintNode& node : copy.nodes) list.nodes.push_back(std::move(node));
    }
  }
  static void renumber(PaintNode& node, const std::unordered_map<uint32_t, uint32_t>& copies) {
    for (uint32_t& entry : node.entries)
      if (const auto copy = copies.find(entry); copy != copies.end()) entry = copy->second;
    for (PaintNode& child : node.children) renumber(child, copies);
  }

  /// Contours of one entry, in the list's space: all turn the same way where they are joined, and count by turns where
  /// their overlaps are taken out.
  void merge(const ShapeItem& item, List& list) {
    if ((item.mode != 2 && item.mode != 5) || list.entries.empty() || !spend_(pointsOf(list))) return;
    PathEntry merged;
    merged.evenOdd = item.mode == 5;
    for (const uint32_t id : list.entries) {
      PathEntry& entry = tree_.entries[id];
      for (const Contour& contour : entry.contours) {
        Contour c = mapped(contour, entry.map);
        double area = 0;
        for (size_t i = 0; i < c.vertices.size(); ++i) {
          const Point a = c.vertices[i].at, b = c.vertices[(i + 1) % c.vertices.size()].at;
          area += a.x * b.y - b.x * a.y;
        }
        if (area < 0) {
          std::reverse(c.vertices.begin(), c.vertices.end());
          for (Contour::Vertex& v : c.vertices) std::swap(v.in, v.out);
        }
        merged.contours.push_back(std::move(c));
      }
      entry.contours.clear();
      entry.map = {};
    }
    tree_.entries[list.entries.back()] = std::move(merged); // where paints before it look, too
  }

  void modify(const ShapeItem& item, List& list) {
    if (!spend_(pointsOf(list))) return;
    if (item.kind == ShapeKind::Trim) return trim(item, list);
    const double amount = number(item, 0);
    if (amount == 0) return;
    for (const uint32_t entry : list.entries)
      for (Contour& contour : tree_.entries[entry].contours) {
        switch (item.kind) {
        case ShapeKind::Round: contour = roundedCorners(contour, amount); break;
        case ShapeKind::Pucker: contour = puckered(contour, amount); break;
        case ShapeKind::Twist: contour = twisted(contour, amount, item.position.point(frame_)); break;
        case ShapeKind::Zigzag:
          if (const double ridges = number(item, 1);
              spend_(kWorkOfRidge * contour.segments() * static_cast<size_t>(1 + std::clamp(ridges, 0.0, 1000.0))))
            contour = zigzagged(contour, amount, ridges, item.mode == 2);
          break;
        default: break;
        }
      }
  }

  void trim(const ShapeItem& item, List& list) {
    double start = std::clamp(number(item, 0) / 100, 0.0, 1.0), end = std::clamp(number(item, 1, 100) / 100, 0.0, 1.0);
    if (start > end) std::swap(start, end);
    if (end - start >= 1) return;
    double offset = std::fmod(number(item, 2) / 360, 1.0);
    if (offset < 0) offset += 1;
    start += offset, end += offset;
    if (start >= 1) start -= 1, end -= 1;
    const bool nothing = !(end > start);
    const bool sequential = item.mode == 2;
    double whole = 0, before = 0;
    std::vector<double> lengths;
    if (sequential)
      for (const uint32_t entry : list.entries)
        for (const Contour& contour : tree_.entries[entry].contours)
          lengths.push_back(contour.length()), whole += lengths.back();
    size_t index = 0;
    for (const uint32_t entry : list.entries) {
      std::vector<Contour> kept;
      for (const Contour& contour : tree_.entries[entry].contours) {
        const double length = sequential ? lengths[index++] : 0;
        if (nothing) continue;
        if (!sequential) {
          for (Contour& piece : trimmedAround(contour, start, end)) kept.push_back(std::move(piece));
        } else if (length > 0) { // what of both parts of a range that wraps lies in here
          const auto inside = [&](double a, double b) {
            const double low = std::clamp((a * whole - before) / length, 0.0, 1.0),
                         high = std::clamp((b * whole - before) / length, 0.0, 1.0);
            if (high > low) kept.push_back(trimmed(contour, low, high));
          };
          inside(start, std::min(end, 1.0));
          if (end > 1) inside(0, end - 1);
          before += length;
        }
      }
      tree_.entries[entry].contours = std::move(kept);
    }
  }

  double frame_;
  const std::function<bool(size_t)>& spend_;
  PaintTree& tree_;
};

} // namespace

PaintTree paintsOf(const std::vector<ShapeItem>& items, double frame, const std::function<bool(size_t)>& spend) {
  PaintTree tree;
  tree.nodes = Shapes(frame, spend, tree).run(items).nodes;
  return tree;
}

} // namespace gpgp::vector::lottie
