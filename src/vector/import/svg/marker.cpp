// Markers (SVG 2, 13.7): the vertices of a shape with the directions there, and what a <marker> shows at each.
#include "vector/import/svg/importer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::vector::svg {
namespace {

struct Vertex {
  Point at;
  bool drawn = true;      ///< false: where a contour goes on after a "Z" without a command of its own
  double in = 0, out = 0; ///< directions, in radians
  bool hasIn = false, hasOut = false;
};

/// Of a segment, where it begins and where it ends; none where it has no length.
struct Directions {
  Point begin, end;
  bool known = false;
};

Directions directionsOf(Point from, const Point* p, size_t count) {
  Point all[4] = {from};
  std::copy_n(p, count, all + 1);
  Directions d;
  for (size_t i = 1; i <= count && !d.known; ++i)
    if (all[i] != from) d.begin = all[i] - from, d.known = true;
  for (size_t i = count; i-- > 0 && d.known;)
    if (all[i] != all[count]) {
      d.end = all[count] - all[i];
      break;
    }
  if (d.end == Point{}) d.end = d.begin;
  return d;
}

/// One contour's vertices from its points and the segments between them (SVG 2, 9.6.2 and 13.7.4).
void finish(std::vector<Directions>& segments, std::vector<Vertex>& vertices, size_t first, bool closed) {
  for (size_t i = 1; i < segments.size(); ++i)
    if (!segments[i].known && segments[i - 1].known) segments[i] = {segments[i - 1].end, segments[i - 1].end, true};
  for (size_t i = segments.size(); i-- > 1;)
    if (!segments[i - 1].known && segments[i].known) segments[i - 1] = {segments[i].begin, segments[i].begin, true};
  const auto angle = [](Point d) { return std::atan2(d.y, d.x); };
  for (size_t i = 0; i < segments.size(); ++i) {
    if (!segments[i].known) continue;
    Vertex &from = vertices[first + i], &to = vertices[first + i + 1];
    from.out = angle(segments[i].begin), from.hasOut = true;
    to.in = angle(segments[i].end), to.hasIn = true;
  }
  if (closed && !segments.empty() && segments.front().known) {
    Vertex &begin = vertices[first], &end = vertices.back();
    begin.in = end.in, begin.hasIn = true;
    end.out = begin.out, end.hasOut = true;
  }
  segments.clear();
}

/// `silent`: the verbs that end where the path has no vertex, ascending.
std::vector<Vertex> verticesOf(const Shape& shape, const std::vector<size_t>& silent) {
  std::vector<Vertex> vertices;
  std::vector<Directions> segments;
  size_t first = 0;
  auto next = silent.begin();
  const Point* p = shape.points.data();
  Point start, at;
  Directions whole; // of an arc that is several curves
  for (size_t i = 0; i < shape.verbs.size(); ++i) {
    const bool isSilent = next != silent.end() && *next == i;
    if (isSilent) ++next;
    const GpgpPathVerb verb = shape.verbs[i];
    if (verb == GPGP_PATH_MOVE) {
      finish(segments, vertices, first, false);
      first = vertices.size();
      start = at = *p++;
      vertices.push_back({at, !isSilent});
      continue;
    }
    const bool closes = verb == GPGP_PATH_CLOSE;
    const size_t count = verb == GPGP_PATH_QUAD ? 2 : verb == GPGP_PATH_CUBIC ? 3 : 1;
    const Directions own = directionsOf(at, closes ? &start : p, count);
    at = closes ? start : p[count - 1];
    if (!closes) p += count;
    if (own.known) whole = {whole.known ? whole.begin : own.begin, own.end, true};
    if (isSilent) continue;
    segments.push_back(whole);
    whole = {};
    vertices.push_back({at});
    if (closes) {
      finish(segments, vertices, first, true);
      first = vertices.size();
    }
  }
  finish(segments, vertices, first, false);
  return vertices;
}

/// Of a vertex between two segments, halfway between their directions. Where the path turns right back both sides are
/// as near: the mean of the angles from 0 to 2 pi counts, as in other renderers.
double directionAt(const Vertex& v) {
  if (!v.hasIn || !v.hasOut) return v.hasIn ? v.in : v.hasOut ? v.out : 0;
  constexpr double pi = std::numbers::pi;
  const auto positive = [](double angle) { return angle < 0 ? angle + 2 * pi : angle; };
  const double in = positive(v.in), half = (positive(v.out) - in) / 2;
  return in + half - (std::fabs(half) > pi / 2 ? pi : 0);
}

} // namespace

/// What a marker is, apart from where it stands.
struct Importer::Marker {
  pugi::xml_node node;
  Style style;
  double width = 3, height = 3, scale = 1, angle = 0; ///< the last in radians, unless it follows the path
  bool follows = false, turnsAtStart = false;
  std::optional<ViewBox> box;
  Affine fit;      ///< from its coordinates into the viewport of its size
  Point reference; ///< in that viewport
};

double Importer::referenceAlong(pugi::xml_node node, const char* name, const LengthContext& lengths, LengthAxis axis,
                                double from, double size) {
  constexpr std::string_view words[2][3] = {{"left", "center", "right"}, {"top", "center", "bottom"}};
  const auto& names = words[axis == LengthAxis::Y];
  const std::string_view text = trim(node.attribute(name).value());
  const auto* found = std::find(std::begin(names), std::end(names), text);
  if (found != std::end(names)) return from + size * 0.5 * static_cast<double>(found - std::begin(names));
  return length(node, {}, name, lengths, axis, 0);
}

bool Importer::readMarker(const std::string& value, pugi::xml_node node, const State& state, Marker& marker) {
  if (value.empty()) return false;
  const std::string shown = std::string("'") + value.substr(0, 60) + "'";
  const std::string reference = referenceOf(value);
  const pugi::xml_node target = reference.empty() ? pugi::xml_node() : document_.find(reference);
  const auto refused = [&](const std::string& why, bool isError) {
    const std::string text = element(node) + " has the marker " + shown + ", which " + why + "; it is not drawn";
    isError ? reporter_.ignored(document_.place(node), text) : reporter_.warn(document_.place(node), text);
    return false;
  };
  if (reference.empty()) return refused("is not a <marker> of this file", false);
  if (!target) return refused("does not exist", true);
  if (document_.name(target) != "marker") return refused("is a " + element(target), true);
  if (std::find(used_.begin(), used_.end(), target) != used_.end()) return refused("contains itself", true);
  marker.node = target;
  marker.style = styleOf(target, state.lengths);
  LengthContext lengths = state.lengths;
  lengths.fontSize = marker.style.fontSize;
  const LengthContext around = lengths;
  const auto isOneOf = [&](const char* name, std::initializer_list<std::string_view> words) {
    const pugi::xml_attribute a = target.attribute(name);
    if (a && std::find(words.begin(), words.end(), trim(a.value())) == words.end()) ignored(target, a);
  };
  isOneOf("markerUnits", {"strokeWidth", "userSpaceOnUse"});
  if (trim(target.attribute("markerUnits").value()) != "userSpaceOnUse") marker.scale = state.style.strokeWidth;
  marker.width = extent(target, {}, "markerWidth", lengths, LengthAxis::X, 3, nullptr, 0);
  marker.height = extent(target, {}, "markerHeight", lengths, LengthAxis::Y, 3, nullptr, 0);
  if (!(marker.width > 0 && marker.height > 0 && marker.scale > 0)) return false; // nothing is shown
  const pugi::xml_attribute boxText = target.attribute("viewBox");
  marker.box = parseViewBox(boxText.value());
  if (boxText && !marker.box) ignored(target, boxText);
  if (marker.box && !(marker.box->width > 0 && marker.box->height > 0)) return false;
  if (marker.box) {
    marker.fit = fitViewBox(*marker.box, marker.width, marker.height, aspectRatio(target));
    lengths.width = marker.box->width, lengths.height = marker.box->height;
  }
  // Lengths in its coordinates, with percentages of the viewport around: browsers know none of SVG 2's words.
  const auto refer = [&](const char* name, LengthAxis axis) { return length(target, {}, name, around, axis, 0); };
  marker.reference = marker.fit({refer("refX", LengthAxis::X), refer("refY", LengthAxis::Y)});
  const pugi::xml_attribute orient = target.attribute("orient");
  const std::string_view how = trim(orient.value());
  marker.turnsAtStart = how == "auto-start-reverse";
  marker.follows = marker.turnsAtStart || how == "auto";
  if (orient && !marker.follows && !parseAngle(how, marker.angle)) ignored(target, orient);
  return true;
}

void Importer::drawMarkers(pugi::xml_node node, const Shape& shape, const std::vector<size_t>& silent,
                           const State& state) {
  const std::array<std::string, 3>& values = state.style.markers;
  if (std::all_of(values.begin(), values.end(), [](const std::string& v) { return v.empty(); })) return;
  std::array<Marker, 3> markers;
  std::array<bool, 3> known{};
  for (size_t i = 0; i < 3; ++i) {
    known[i] = readMarker(values[i], node, state, markers[i]);
    if (markers[i].turnsAtStart && i > 0) markers[i].turnsAtStart = false;
  }
  std::vector<Vertex> vertices = verticesOf(shape, silent);
  vertices.erase(std::remove_if(vertices.begin(), vertices.end(), [](const Vertex& v) { return !v.drawn; }),
                 vertices.end());
  const Context context{&state, node, used_.size(), state.transform};
  const auto draw = [&](size_t which, const Vertex& v) {
    if (!known[which] || stopped_) return;
    const Marker& marker = markers[which];
    const double angle = marker.follows ? directionAt(v) + (marker.turnsAtStart ? std::numbers::pi : 0) : marker.angle;
    const double c = marker.scale * std::cos(angle), s = marker.scale * std::sin(angle);
    State inner = state;
    inner.style = marker.style;
    inner.context = &context;
    ++inner.depth;
    const Affine frame = state.transform * Affine{c, s, -s, c, v.at.x, v.at.y} *
                         Affine{1, 0, 0, 1, -marker.reference.x, -marker.reference.y};
    inner.transform = frame * marker.fit;
    if (!inner.transform.finite()) return;
    inner.lengths.width = marker.box ? marker.box->width : marker.width;
    inner.lengths.height = marker.box ? marker.box->height : marker.height;
    if (stopped(marker.node)) return;
    used_.push_back(marker.node);
    grouped(marker.node, "marker", inner, [&](State& own) {
      if (own.style.overflowVisible) return visitChildren(marker.node, own);
      clipped(marker.node, frame, marker.width, marker.height, own, [&] { visitChildren(marker.node, own); });
    });
    used_.pop_back();
  };
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (i == 0) draw(0, vertices[i]);
    if (i > 0 && i + 1 < vertices.size()) draw(1, vertices[i]);
    if (i + 1 == vertices.size()) draw(2, vertices[i]);
  }
}

} // namespace gpgp::vector::svg
