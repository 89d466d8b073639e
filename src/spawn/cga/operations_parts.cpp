// Operations that make shapes of parts of the current one: split, comp, setback and their like, scatter.
#include "spawn/cga/deriver.h"
#include "spawn/cga/split_layout.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace gpgp::spawn::cga {

namespace {

constexpr size_t kMostPieces = 1'000'000;

struct Selection {
  Selector selector;
  bool known = true;
};
Selection selectorOf(std::string_view word) {
  const size_t dot = word.find('.');
  const std::string_view last = dot == std::string_view::npos ? word : word.substr(dot + 1);
  constexpr std::pair<std::string_view, Selector> kNames[] = {
      {"front", Selector::Front},   {"south", Selector::Front},       {"back", Selector::Back},
      {"north", Selector::Back},    {"left", Selector::Left},         {"west", Selector::Left},
      {"right", Selector::Right},   {"east", Selector::Right},        {"top", Selector::Top},
      {"up", Selector::Top},        {"bottom", Selector::Bottom},     {"down", Selector::Bottom},
      {"side", Selector::Side},     {"vertical", Selector::Vertical}, {"horizontal", Selector::Horizontal},
      {"aslant", Selector::Aslant}, {"nutant", Selector::Nutant},     {"border", Selector::Border},
      {"inside", Selector::Inside}, {"eave", Selector::Eave},         {"hip", Selector::Hip},
      {"valley", Selector::Valley}, {"ridge", Selector::Ridge},       {"all", Selector::All}};
  for (const auto& [name, selector] : kNames)
    if (name == last) return {selector};
  return {Selector::All, false};
}

/// Of a box's face, which lies along the scope's axes: as matches() says.
bool matchesNormal(vec3 n, Selector selector, const Axes& axes) {
  const float x = glm::dot(n, axes.x), y = glm::dot(n, axes.y), z = glm::dot(n, axes.z);
  const float ax = std::fabs(x), ay = std::fabs(y), az = std::fabs(z);
  const float up = 0.98078528f, flat = 0.19509032f; // sine of 78.75 and 11.25 degrees
  switch (selector) {
  case Selector::Front: return z > 0 && az >= ax && az >= ay;
  case Selector::Back: return z < 0 && az >= ax && az >= ay;
  case Selector::Left: return x < 0 && ax > az && ax >= ay;
  case Selector::Right: return x > 0 && ax > az && ax >= ay;
  case Selector::Top: return y > 0 && ay > ax && ay > az;
  case Selector::Bottom: return y < 0 && ay > ax && ay > az;
  case Selector::Side: return ay <= up;
  case Selector::Vertical: return ay <= flat;
  case Selector::Horizontal: return ay > up;
  case Selector::Aslant: return y > flat && y <= up;
  case Selector::Nutant: return y < -flat && y >= -up;
  case Selector::Inside:
  case Selector::All: return true;
  default: return false;
  }
}

} // namespace

// ---------------------------------------------------------------- split

bool Deriver::split_(const Arguments& a, uint32_t table, uint32_t base) {
  const std::string_view axisName = word(a[0]);
  if (axisName == "u" || axisName == "v") return splitUv(a, table, base);
  const uint32_t axis = axisName == "y" ? 1u : axisName == "z" ? 2u : 0u;
  const bool adjust = word(a[1]) != "noAdjust";
  const Form whole = shape_.form;
  const float length = whole.scope.size[static_cast<int>(axis)];
  std::vector<Piece> pieces;
  const std::vector<SplitPart> parts = readParts(words_, table, a.values, length);
  const bool isPlain = layOutPlain(parts, length, shape_.key, kMostPieces, pieces);
  if (!isPlain && !layOut(parts, length, kMostPieces, pieces)) {
    fail("a split has more than " + std::to_string(kMostPieces) + " parts");
    return false;
  }
  const bool isBox = boxes_.is(whole);
  for (uint32_t i = 0; i < pieces.size(); ++i) {
    if (!works(1)) return false;
    const Piece& p = pieces[i];
    Form form;
    if (isBox) {
      form = sliceBox(whole, axis, p.from, isPlain ? p.extent : p.to - p.from);
    } else if (whole.mesh == 0) {
      form = sliceBox(whole, axis, p.from, p.to - p.from);
      form.mesh = 0;
    } else {
      const Status status = slice(pool_, whole, axis, p.from, p.to, adjust, form);
      if (status == kGeometryEmpty) continue;
      if (status != kGeometryOk) {
        if (!check(status, "split")) return false;
        continue;
      }
    }
    Shape& part = child();
    if (isPlain) part.key = p.key;
    part.form = form;
    part.splitIndex = i;
    part.splitTotal = static_cast<uint32_t>(pieces.size());
    if (!addChild(part, p.body, base)) return false;
  }
  return true;
}

bool Deriver::splitArea_(const Arguments& a, uint32_t table, uint32_t base) {
  const std::string_view axisName = word(a[0]);
  const uint32_t axis = axisName == "y" ? 1u : axisName == "z" ? 2u : 0u;
  const bool adjust = a.count < 2 || word(a[1]) != "noAdjust";
  const Form whole = shape_.form;
  if (whole.mesh == 0) return true;
  const float all = boxes_.is(whole) ? boxes_.area(whole) : area(pool_, whole);
  std::vector<Piece> pieces;
  if (!layOut(readParts(words_, table, a.values, all), all, kMostPieces, pieces)) {
    fail("a split has more than " + std::to_string(kMostPieces) + " parts");
    return false;
  }
  std::vector<double> areas;
  for (const Piece& p : pieces) areas.insert(areas.end(), {p.from, p.to >= all * 0.999999f ? all * 2.0 : p.to});
  const std::vector<float> places = placesOfAreas(pool_, whole, axis, areas);
  for (uint32_t i = 0; i < pieces.size(); ++i) {
    if (!works(1)) return false;
    const float from = places[2 * i], to = places[2 * i + 1];
    if (!(to > from)) continue;
    Form form;
    if (boxes_.is(whole)) {
      form = sliceBox(whole, axis, from, to - from);
    } else {
      const Status status = slice(pool_, whole, axis, from, to, adjust, form);
      if (status == kGeometryEmpty) continue;
      if (status != kGeometryOk) {
        if (!check(status, "splitArea")) return false;
        continue;
      }
    }
    Shape& part = child();
    part.form = form;
    part.splitIndex = i;
    part.splitTotal = static_cast<uint32_t>(pieces.size());
    if (!addChild(part, pieces[i].body, base)) return false;
  }
  return true;
}

bool Deriver::splitUv(const Arguments& a, uint32_t table, uint32_t base) {
  const uint32_t axis = word(a[0]) == "v" ? 1u : 0u;
  const bool isUnit = word(a[1]) == "unitSpace";
  const uint32_t set = uvSet(a[2]);
  if (boxes_.is(shape_.form) &&
      !check(projectUv(pool_, shape_.form, set,
                       setupProjection(shape_.form,
                                       shape_.form.mesh == boxes_.upright ? UvAxes::ScopeXY : UvAxes::ScopeXZ, 0, 0)),
             "split"))
    return false;
  vec2 low, high;
  uvBounds(pool_, shape_.form, set, low, high);
  const float begin = low[static_cast<int>(axis)], range = high[static_cast<int>(axis)] - begin;
  if (!(range > 0)) {
    warn("split uv", "split along u or v: the shape has no texture coordinates of set " + std::to_string(set));
    return true;
  }
  // In units, the mean length that a texture's unit has on the shape.
  const float unit =
      isUnit
          ? divide(axis == 0 ? number(geometry_du_({a.values + 2, 1})) : number(geometry_dv_({a.values + 2, 1})), range)
          : 1.0f;
  const float scale = unit > 0 ? unit : 1.0f;
  std::vector<Piece> pieces;
  if (!layOut(readParts(words_, table, a.values, range * scale), range * scale, kMostPieces, pieces)) {
    fail("a split has more than " + std::to_string(kMostPieces) + " parts");
    return false;
  }
  const Form whole = shape_.form;
  for (uint32_t i = 0; i < pieces.size(); ++i) {
    if (!works(1)) return false;
    Form form;
    const Status status =
        sliceUv(pool_, whole, set, axis, begin + pieces[i].from / scale, begin + pieces[i].to / scale, form);
    if (status == kGeometryEmpty) continue;
    if (status != kGeometryOk) {
      if (!check(status, "split")) return false;
      continue;
    }
    Shape& part = child();
    part.form = form;
    part.splitIndex = i;
    part.splitTotal = static_cast<uint32_t>(pieces.size());
    resetPivot(part);
    if (!addChild(part, pieces[i].body, base)) return false;
  }
  return true;
}

// ---------------------------------------------------------------- components

/// components: none: the faces of a box.
bool Deriver::selects(std::string_view selector, const Components* components, uint32_t index, uint32_t count,
                      const CgaValue& value) {
  if (value.type == kCgaFloat) {
    const float wanted = number(value);
    return static_cast<float>(index) == (wanted < 0 ? wanted + static_cast<float>(count) : wanted);
  }
  if (value.type == kCgaBool) return value.bits != 0;
  const bool isStreet = selector.starts_with("street.");
  if (isStreet && axiom_->streetWidths.empty())
    warn("street", "nothing is known of streets (streetWidth); '" + std::string(selector) + "' is taken as 'object." +
                       std::string(selector.substr(7)) + "'");
  if (selector.starts_with("tag:")) {
    const uint32_t bits = tagBits(selector.substr(5));
    if (!components) return false; // a box has no tags
    return (selector[4] == 'e' ? components->tagsOfEdges(index) & bits : components->tags(index) & bits) != 0;
  }
  Selection what = selectorOf(selector);
  if (!what.known) {
    warn("selector " + std::string(selector), std::string("'").append(selector) + "' selects no components");
    return false;
  }
  const Axes system = axes(isStreet ? "object" : selector);
  if (isStreet && !axiom_->streetWidths.empty()) {
    constexpr std::pair<Selector, Selector> kStreets[] = {{Selector::Front, Selector::StreetFront},
                                                          {Selector::Back, Selector::StreetBack},
                                                          {Selector::Left, Selector::StreetLeft},
                                                          {Selector::Right, Selector::StreetRight},
                                                          {Selector::Side, Selector::StreetSide}};
    for (const auto& [side, street] : kStreets)
      if (what.selector == side) return components && components->matches(index, street, system);
  }
  if (!components) {
    if (what.selector == Selector::Border) return shape_.form.mesh != boxes_.box;
    if (what.selector == Selector::Inside) return shape_.form.mesh == boxes_.box;
    return matchesNormal(boxes_.normal(shape_.form, index), what.selector, system);
  }
  return components->matches(index, what.selector, system);
}

/// A shape has one material, so that it is itself the one component.
bool Deriver::compMaterial(const Arguments& a, uint32_t table, uint32_t base) {
  for (uint32_t p = 0; p < words_[table]; ++p) {
    const uint32_t record = words_[table + 1 + p];
    const CgaValue& value = a.values[words_[record + kCgaPartSelector]];
    const float index = value.type == kCgaFloat ? number(value) : -2.0f;
    const bool isIt = index == 0 || index == -1 || (value.type == kCgaBool && value.bits) || word(value) == "all";
    if (!isIt) {
      if (value.type == kCgaWord)
        warn("comp(m)",
             "comp(m): a shape has one material, which 'all' and 0 select, and not '" + std::string(word(value)) + "'");
      continue;
    }
    Shape& part = child();
    part.compIndex = 0;
    part.compTotal = 1;
    part.compSelector = value.type == kCgaWord ? value.bits : strings_.number(text(value));
    return addChild(part, words_[record + kCgaPartBody], base);
  }
  return true;
}

bool Deriver::comp_(const Arguments& a, uint32_t table, uint32_t base) {
  noteUnlabelled(shape_.form);
  const std::string_view kindName = word(a[0]);
  Component kind = Component::Faces;
  if (kindName == "e") kind = Component::Edges;
  if (kindName == "fe") kind = Component::FaceEdges;
  if (kindName == "v") kind = Component::Vertices;
  if (kindName == "g") kind = Component::Groups;
  if (kindName == "h") kind = Component::Holes;
  if (shape_.form.mesh == 0) return true;
  if (kindName == "m") return compMaterial(a, table, base);
  const bool isBox = boxes_.is(shape_.form) && kind == Component::Faces;
  std::optional<Components> components;
  if (!isBox) components.emplace(pool_, shape_.form, kind);
  const uint32_t count = isBox ? boxes_.faces(shape_.form) : components->count();
  const uint32_t parts = words_[table];
  const std::vector<std::vector<uint32_t>> selected = selectedBy(components ? &*components : nullptr, count, a, table);
  std::vector<std::vector<TrimPlane>> trims;
  if (!isBox && kind == Component::Faces) trims = trimPlanes(pool_, shape_.form);
  for (uint32_t p = 0; p < parts; ++p) {
    if (selected[p].empty()) continue;
    const uint32_t record = words_[table + 1 + p];
    const CgaValue& value = a.values[words_[record + kCgaPartSelector]];
    const bool together = words_[record + kCgaPartKind] != kCgaPartEach;
    std::optional<Components> connected;
    Form all;
    if (words_[record + kCgaPartKind] == kCgaPartConnected) { // as many shapes as hang together
      const Status status = toComponents(pool_, shape_.form, kind, selected[p], all);
      if (status == kGeometryEmpty) continue;
      if (status != kGeometryOk) {
        if (!check(status, "comp")) return false;
        continue;
      }
      connected.emplace(pool_, all, Component::Groups);
    }
    const uint32_t total = connected ? connected->count() : together ? 1u : static_cast<uint32_t>(selected[p].size());
    for (uint32_t i = 0; i < total; ++i) {
      Form form;
      Status status = kGeometryOk;
      if (connected)
        status = connected->take(i, form);
      else if (together)
        status = toComponents(pool_, shape_.form, kind, selected[p], form);
      else if (isBox)
        form = boxes_.face(shape_.form, selected[p][i]);
      else
        status = components->take(selected[p][i], form);
      if (status == kGeometryEmpty) continue;
      if (status != kGeometryOk) {
        if (!check(status, "comp")) return false;
        continue;
      }
      Shape& part = child();
      if (isBox && !together) part.key = childKey(shape_.key, boxes_.number(shape_.form, selected[p][i]));
      part.form = form;
      part.compIndex = i;
      part.compTotal = total;
      part.compSelector = value.type == kCgaWord ? value.bits : strings_.number(text(value));
      if (!together) resetPivot(part);
      if (!together && !trims.empty())
        setTrims(part, trims[selected[p][i]]);
      else
        part.trims = 0;
      if (!addChild(part, words_[record + kCgaPartBody], base)) return false;
    }
  }
  return true;
}

// ---------------------------------------------------------------- setbacks and wings

/// Pieces of edges by the part whose selector has them, then what remains.
bool Deriver::setbackBy(const std::vector<float>& distances, const Arguments& a, uint32_t table, uint32_t base) {
  std::vector<Form> pieces;
  Form remainder;
  const Status status = setback(pool_, shape_.form, distances, pieces, remainder);
  if (status != kGeometryOk && status != kGeometryEmpty) return check(status, "setback");
  const Components components(pool_, shape_.form, Component::FaceEdges);
  const uint32_t edges = components.count();
  std::vector<bool> taken(edges);
  for (uint32_t p = 0; p < words_[table]; ++p) {
    const uint32_t record = words_[table + 1 + p];
    if (words_[record + kCgaPartSelector] == kCgaNoSelector) continue; // the distance of setbackPerEdge
    const CgaValue& value = a.values[words_[record + kCgaPartSelector]];
    const std::string_view selector = word(value);
    std::vector<Form> forms;
    if (selector == "remainder") {
      if (remainder.mesh) forms.push_back(remainder);
    } else {
      for (uint32_t i = 0; i < edges; ++i) {
        if (taken[i] || pieces[i].mesh == 0 || !selects(selector, &components, i, edges, value)) continue;
        taken[i] = true;
        forms.push_back(pieces[i]);
      }
      if (words_[record + kCgaPartKind] == kCgaPartTogether && forms.size() > 1) {
        Form all;
        if (!check(combine(pool_, forms, all), "setback")) return false;
        forms.assign(1, all);
      }
    }
    for (uint32_t i = 0; i < forms.size(); ++i) {
      Shape& part = child();
      part.form = forms[i];
      part.compIndex = i;
      part.compTotal = static_cast<uint32_t>(forms.size());
      part.compSelector = value.type == kCgaWord ? value.bits : strings_.number(text(value));
      resetPivot(part);
      if (!addChild(part, words_[record + kCgaPartBody], base)) return false;
    }
  }
  return true;
}

bool Deriver::setback_(const Arguments& a, uint32_t table, uint32_t base) {
  if (shape_.form.mesh == 0) return true;
  std::vector<float> each;
  if (a[0].type == kCgaArray) {
    for (const CgaValue& v : arrayOf(a[0]).values) each.push_back(number(v));
  } else {
    each.push_back(number(a[0]));
  }
  if (each.empty()) return true;
  return setbackEach(a[0].type == kCgaArray, each, a, table, base);
}

/// each: a distance for each edge, in order, 0 for those that it does not reach; or one for all.
bool Deriver::setbackEach(bool isArray, const std::vector<float>& each, const Arguments& a, uint32_t table,
                          uint32_t base) {
  const Components components(pool_, shape_.form, Component::FaceEdges);
  const uint32_t edges = components.count();
  std::vector<float> distances(edges, 0.0f);
  const auto distanceOf = [&](uint32_t i) { return !isArray ? each[0] : i < each.size() ? each[i] : 0.0f; };
  // An edge moves where a part other than the remainder selects it.
  bool any = false;
  for (uint32_t p = 0; p < words_[table]; ++p) {
    const uint32_t selector = words_[words_[table + 1 + p] + kCgaPartSelector];
    if (selector == kCgaNoSelector || word(a.values[selector]) == "remainder") continue;
    any = true;
    for (uint32_t i = 0; i < edges; ++i)
      if (selects(word(a.values[selector]), &components, i, edges, a.values[selector])) distances[i] = distanceOf(i);
  }
  for (uint32_t i = 0; i < edges && !any; ++i) distances[i] = distanceOf(i); // { remainder: ... } alone
  return setbackBy(distances, a, table, base);
}

/// The distance is worked out on each edge, as comp(fe) would make it.
bool Deriver::setbackPerEdge_(const Arguments& a, uint32_t table, uint32_t base) {
  if (shape_.form.mesh == 0) return true;
  const uint32_t chunk = words_[words_[table + words_[table]] + kCgaPartBody], top = topOf(a);
  const Components components(pool_, shape_.form, Component::FaceEdges);
  std::vector<float> each;
  for (uint32_t i = 0; i < components.count(); ++i) {
    Form edge;
    if (!check(components.take(i, edge), "setbackPerEdge")) return false;
    CgaValue distance;
    if (!valueOn(chunk, base, top, edge, i, components.count(), distance)) return false;
    each.push_back(number(distance));
  }
  return setbackEach(true, each, a, table, base);
}

/// The distance by which all selected edges move so that the remainder has an area, by halving.
bool Deriver::setbackToArea_(const Arguments& a, uint32_t table, uint32_t base) {
  if (shape_.form.mesh == 0) return true;
  const float wanted = number(a[0]);
  const Components components(pool_, shape_.form, Component::FaceEdges);
  const uint32_t edges = components.count();
  std::vector<bool> moves(edges, false);
  for (uint32_t p = 0; p < words_[table]; ++p) {
    const CgaValue& value = a.values[words_[words_[table + 1 + p] + kCgaPartSelector]];
    for (uint32_t i = 0; i < edges; ++i)
      if (word(value) != "remainder" && selects(word(value), &components, i, edges, value)) moves[i] = true;
  }
  const vec3 e = shape_.form.scope.size;
  float low = 0, high = std::max({e.x, e.y, e.z});
  std::vector<float> distances(edges, 0.0f);
  for (int i = 0; i < 24; ++i) {
    const float middle = 0.5f * (low + high);
    for (uint32_t k = 0; k < edges; ++k) distances[k] = moves[k] ? middle : 0.0f;
    std::vector<Form> pieces;
    Form remainder;
    const Status status = setback(pool_, shape_.form, distances, pieces, remainder);
    if (status != kGeometryOk && status != kGeometryEmpty) return check(status, "setbackToArea");
    (remainder.mesh && area(pool_, remainder) > wanted ? low : high) = middle;
  }
  for (uint32_t k = 0; k < edges; ++k) distances[k] = moves[k] ? low : 0.0f;
  return setbackBy(distances, a, table, base);
}

bool Deriver::shapeAndRemainder(const Form& inner, const Form& rest, const Arguments& a, uint32_t table,
                                uint32_t base) {
  for (uint32_t p = 0; p < words_[table]; ++p) {
    const uint32_t record = words_[table + 1 + p];
    const CgaValue& value = a.values[words_[record + kCgaPartSelector]];
    const std::string_view selector = word(value);
    const bool isRest = selector == "remainder";
    if (!isRest && selector != "shape" && selector != "all") {
      warn("part " + std::string(selector), "expected shape or remainder, not '" + std::string(selector) + "'");
      continue;
    }
    const Form& form = isRest ? rest : inner;
    if (form.mesh == 0) continue;
    Shape& part = child();
    part.form = form;
    part.compSelector = value.type == kCgaWord ? value.bits : 0;
    part.compTotal = 1;
    resetPivot(part);
    if (!addChild(part, words_[record + kCgaPartBody], base)) return false;
  }
  return true;
}

bool Deriver::wings(float front, float right, float back, float left, const Arguments& a, uint32_t table,
                    uint32_t base) {
  if (shape_.form.mesh == 0) return true;
  Form inner, rest;
  inner.mesh = rest.mesh = 0;
  const Status status = shapeWings(pool_, shape_.form, front, right, back, left, inner, rest);
  if (status != kGeometryOk && status != kGeometryEmpty) return check(status, "shapeL, shapeU, shapeO");
  return shapeAndRemainder(inner, rest, a, table, base);
}

namespace {
float partOf(const CgaValue& v, float whole) {
  const float x = uintBitsToFloat(v.bits);
  return v.type == kCgaRelative ? multiply(x, whole) : v.type == kCgaFloat ? x : 0.0f;
}
} // namespace

bool Deriver::shapeL_(const Arguments& a, uint32_t table, uint32_t base) {
  const vec3 e = shape_.form.scope.size;
  const float depth = std::max(e.z, shape_.form.mesh == boxes_.upright ? e.y : e.z);
  return wings(partOf(a[0], depth), 0, 0, partOf(a[1], e.x), a, table, base);
}
bool Deriver::shapeU_(const Arguments& a, uint32_t table, uint32_t base) {
  const vec3 e = shape_.form.scope.size;
  return wings(partOf(a[0], e.z), partOf(a[1], e.x), 0, partOf(a[2], e.x), a, table, base);
}
bool Deriver::shapeO_(const Arguments& a, uint32_t table, uint32_t base) {
  const vec3 e = shape_.form.scope.size;
  return wings(partOf(a[0], e.z), partOf(a[1], e.x), partOf(a[2], e.z), partOf(a[3], e.x), a, table, base);
}

bool Deriver::innerRectangle_(const Arguments& a, uint32_t table, uint32_t base) {
  if (shape_.form.mesh == 0) return true;
  Form inner, rest;
  inner.mesh = rest.mesh = 0;
  const Status status = innerRectangle(pool_, shape_.form, word(a[0]) == "scope", inner);
  if (status != kGeometryOk && status != kGeometryEmpty) return check(status, "innerRectangle");
  for (uint32_t p = 0; p < words_[table]; ++p)
    if (word(a.values[words_[words_[table + 1 + p] + kCgaPartSelector]]) == "remainder" && inner.mesh &&
        !boxes_.is(shape_.form)) {
      const Status left = boolean(pool_, shape_.form, inner, Boolean::Difference, rest);
      if (left == kGeometryEmpty) rest.mesh = 0;
      if (left == kGeometryNotPlanar || left == kGeometryBadArgument)
        warn("innerRectangle", "innerRectangle of faces in several planes has no remainder");
      else if (left != kGeometryOk && left != kGeometryEmpty && !check(left, "innerRectangle"))
        return false;
    }
  return shapeAndRemainder(inner, rest, a, table, base);
}

// ---------------------------------------------------------------- scatter

bool Deriver::scatter_(const Arguments& a, uint32_t table, uint32_t base) {
  if (shape_.form.mesh == 0) return true;
  Scatter how;
  const std::string_view domain = word(a[0]);
  how.domain = domain == "volume"  ? ScatterDomain::Volume
               : domain == "scope" ? ScatterDomain::Scope
                                   : ScatterDomain::Surface;
  how.gaussian = word(a[2]) == "gaussian";
  const uint32_t values = words_[table] && words_[words_[table + 1] + kCgaPartSelector] == kCgaNoSelector ? a.count : 3;
  if (how.gaussian && values > 4) {
    const vec3 e = shape_.form.scope.size;
    const float whole = std::max({e.x, e.y, e.z, 1e-6f});
    // 'x is a part of the scope, as deviations are.
    const float deviation = a[4].type == kCgaRelative ? number(a[4]) * 0.16f : number(a[4]) / whole;
    how.deviation = vec3(std::clamp(deviation, 0.001f, 10.0f));
  }
  const float wanted = cgaRound(number(a[1]));
  if (wanted > 1e6f) {
    fail("scatter of more than 1000000 shapes");
    return false;
  }
  const uint32_t body = words_[words_[table + 1] + kCgaPartBody];
  for (uint32_t i = 0; static_cast<float>(i) < wanted; ++i) {
    Scope point;
    const Status status = scatterPoint(pool_, shape_.form, how, childKey(shape_.key, 0x20000000u), i, point);
    if (status == kGeometryEmpty) return true;
    if (status != kGeometryOk) return check(status, "scatter");
    Shape& part = child();
    part.form.scope = point;
    part.form.scale = vec3(1);
    part.form.mesh = 0;
    part.splitIndex = i;
    part.splitTotal = static_cast<uint32_t>(wanted);
    resetPivot(part);
    if (!addChild(part, body, base)) return false;
  }
  return true;
}

} // namespace gpgp::spawn::cga
