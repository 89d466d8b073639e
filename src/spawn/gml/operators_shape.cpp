// Operators on shapes: each is a node of the graph, with an edge for what it makes of the shape.
#include "spawn/gml/machine.h"

#include "core/math.h"

#include <algorithm>

namespace gpgp::spawn::gml {
using namespace shader;

namespace {
std::optional<uint32_t> axisOf(Machine& m, const Value& value) {
  const std::string& name = m.nameText(std::get<Name>(value).name);
  if (name == "X" || name == "Y" || name == "Z") return static_cast<uint32_t>(name[0] - 'X');
  m.fail("expected an axis, X, Y or Z; found /" + name.substr(0, 64));
  return std::nullopt;
}

/// An operator that passes on one shape, as its row in the graph's table says.
void passing(Machine& m, Arguments& a) {
  const Shape shape = std::get<Shape>(a[0]);
  if (shape->ends.empty()) return m.push(shape);
  Flattener::NewNode node;
  node.op = m.code();
  std::vector<Value> values(a.begin() + 1, a.end());
  if (const auto* v = std::get_if<std::shared_ptr<const Vector>>(&values[0])) {
    const Vector vector = **v;
    values.assign(vector.components.begin(), vector.components.end()); // a third one that is missing is 0
  }
  uint32_t axes = 0, at = 0;
  for (const char letter : spawn::kOperators[node.op].inParentheses()) {
    if (letter == 'a')
      node.argument |= axisOf(m, values[at++]).value_or(0) << (2 * axes++);
    else
      node.parameters.push_back(m.parameter(std::get<Number>(values[at++]), shape));
  }
  const uint32_t made = m.graph().addNode(shape, std::move(node), m.place());
  m.push(m.graph().edgeOf(made, 0, shape));
}

void attribute(Machine& m, Arguments& a) {
  const Shape& shape = std::get<Shape>(a[0]);
  const Attribute& row = attributeAt(m.code());
  auto formula = std::make_shared<Formula>();
  formula->expression.kind = ExpressionKind::call;
  formula->expression.place = m.place();
  formula->expression.name = row.name;
  for (uint32_t i = 0; i < row.axes; ++i) {
    const auto axis = axisOf(m, a[1 + i]);
    if (!axis) {
      m.push(std::move(a[0]));
      return m.push(Broken{});
    }
    Expression name;
    name.kind = ExpressionKind::name;
    name.place = m.place();
    name.name = m.nameText(std::get<Name>(a[1 + i]).name);
    formula->expression.arguments.push_back(std::move(name));
  }
  const Quality quality = row.code == kCodePosition                              ? kPosition
                          : row.code == kCodeShapeSize                           ? kSize
                          : row.code == kCodeRotation || row.code == kCodeNormal ? kRotation
                          : row.code == kCodeSeed                                ? kSeed
                                                                                 : kNeverChanges;
  formula->reads.push_back({quality, quality == kNeverChanges ? 0 : shape->versions[quality], m.place()});
  m.push(std::move(a[0]));
  m.push(Number{0, std::move(formula)});
}

// ---------------------------------------------------------------- one shape to several

/// [value {procedure} ...] or [value ...]: the values, and the procedures where there are some.
struct Parts {
  std::vector<Number> values;
  std::vector<Value> procedures;
};
std::optional<Parts> partsOf(Machine& m, const Value& value, bool needsProcedures) {
  const std::vector<Value>& items = std::get<Items>(value)->items;
  Parts parts;
  const auto isProcedure = [](const Value& v) {
    return std::holds_alternative<Procedure>(v) || std::holds_alternative<RuleName>(v) ||
           std::holds_alternative<TerminalName>(v);
  };
  const bool pairs = needsProcedures || (items.size() > 1 && isProcedure(items[1]));
  for (size_t i = 0; i < items.size(); ++i) {
    const bool isValue = !pairs || i % 2 == 0;
    const Number* number = std::get_if<Number>(&items[i]);
    if (std::holds_alternative<Broken>(items[i])) return std::nullopt;
    if (isValue ? !number : !isProcedure(items[i])) {
      m.fail(std::string(m.operatorName()) + " takes an array of " +
             (pairs ? "a number and a procedure for each part" : "numbers, one for each part") + "; its item " +
             std::to_string(i) + " is " + kindOf(items[i]));
      return std::nullopt;
    }
    if (isValue)
      parts.values.push_back(*number);
    else
      parts.procedures.push_back(items[i]);
  }
  const size_t count = parts.values.size();
  if (count >= 1 && count <= kMaxSuccessors && (!pairs || parts.procedures.size() == count)) return parts;
  m.fail(count < 1 || count > kMaxSuccessors
             ? std::string(m.operatorName()) + " makes 1 to " + std::to_string(kMaxSuccessors) + " parts, found " +
                   std::to_string(count)
             : "the last part has no procedure");
  return std::nullopt;
}

void divide(Machine& m, Arguments& a) {
  const Shape shape = std::get<Shape>(a[0]);
  const auto axis = axisOf(m, a[1]);
  const auto parts = partsOf(m, a[2], false);
  if (!axis || !parts) {
    m.graph().discard(shape);
    return m.push(Broken{});
  }
  std::vector<Value> made(parts->values.size(), shape);
  if (!shape->ends.empty()) {
    Flattener::NewNode node{kOpSubDiv, *axis, 0, {}, static_cast<uint32_t>(made.size())};
    for (const Number& value : parts->values) node.parameters.push_back(m.parameter(value, shape));
    const uint32_t number = m.graph().addNode(shape, std::move(node), m.place());
    for (uint32_t i = 0; i < made.size(); ++i) made[i] = m.graph().edgeOf(number, i, shape);
  }
  if (parts->procedures.empty()) return m.pushArray(std::move(made));
  for (size_t i = 0; i < made.size() && !m.hasStopped(); ++i) {
    m.push(made[i]);
    m.execute(parts->procedures[i], m.place());
  }
}

std::vector<Value> facesOf(Machine& m, const Shape& shape) {
  std::vector<Value> made(3, shape);
  if (shape->ends.empty()) return made;
  const uint32_t node = m.graph().addNode(shape, {kOpCompSplit, 0, 0, {}, 3}, m.place());
  for (uint32_t i = 0; i < 3; ++i) made[i] = m.graph().edgeOf(node, i, shape);
  return made;
}

/// One shape for several, whose edges lead on together.
Shape merged(Machine& m, std::span<const Value> shapes) {
  auto all = std::make_shared<ShapeState>();
  all->branch = m.branch();
  bool isFirst = true;
  for (const Value& value : shapes) {
    const Shape& shape = std::get<Shape>(value);
    if (shape->ends.empty()) continue;
    if (isFirst) all->versions = shape->versions, all->rule = shape->rule;
    for (uint32_t q = 0; q < kQualityCount; ++q)
      if (all->versions[q] != shape->versions[q]) all->versions[q] = m.graph().newVersion();
    isFirst = false;
    all->ends.insert(all->ends.end(), shape->ends.begin(), shape->ends.end());
  }
  m.spend(all->ends.size());
  return all;
}

void components(Machine& m, Arguments& a) {
  const std::vector<Value> procedures = std::get<Items>(a[1])->items;
  const Shape& shape = std::get<Shape>(a[0]);
  if (procedures.size() != 3 && procedures.size() != 1) {
    m.fail("compsplit takes procedures for top, bottom and sides, or one for all faces, found " +
           std::to_string(procedures.size()) + " values");
    return m.graph().discard(shape);
  }
  std::vector<Value> faces = facesOf(m, shape);
  if (procedures.size() == 1) faces = {merged(m, faces)};
  for (size_t i = 0; i < faces.size() && !m.hasStopped(); ++i) {
    m.push(faces[i]);
    m.execute(procedures[i], m.place());
  }
}

void tile(Machine& m, Arguments& a) {
  const Shape shape = std::get<Shape>(a[0]);
  const auto axis = axisOf(m, a[1]);
  uint32_t mode = kRepeatAdjustToFill;
  if (a.size() > 3) {
    const std::string& name = m.nameText(std::get<Name>(a[3]).name);
    if (name == "ANCHOR_TO_START")
      mode = kRepeatAnchorToStart;
    else if (name == "ANCHOR_TO_END")
      mode = kRepeatAnchorToEnd;
    else if (name != "ADJUST_TO_FILL")
      m.fail("expected ADJUST_TO_FILL, ANCHOR_TO_START or ANCHOR_TO_END, found /" + name.substr(0, 64));
  }
  if (shape->ends.empty()) return m.push(shape);
  const Parameter extent = m.parameter(std::get<Number>(a[2]), shape);
  const uint32_t node = m.graph().addNode(shape, {kOpRepeat, axis.value_or(0), mode, {extent}, 1}, m.place());
  m.push(m.graph().edgeOf(node, 0, shape));
}

void replicate(Machine& m, Arguments& a) {
  const Shape shape = std::get<Shape>(a[0]);
  const float count = std::get<Number>(a[1]).known;
  if (count < 1 || count > static_cast<float>(kMaxSuccessors)) {
    m.fail("replicate makes 1 to " + std::to_string(kMaxSuccessors) + " copies");
    m.graph().discard(shape);
    return m.push(Broken{});
  }
  std::vector<Value> made(static_cast<size_t>(count), shape);
  if (!shape->ends.empty()) {
    const uint32_t edges = static_cast<uint32_t>(count);
    const uint32_t node = m.graph().addNode(shape, {kOpReplicate, 0, 0, {}, edges}, m.place());
    for (uint32_t i = 0; i < edges; ++i) made[i] = m.graph().edgeOf(node, i, shape);
  }
  m.pushArray(std::move(made));
}

void merge(Machine& m, Arguments& a) {
  const std::vector<Value>& items = std::get<Items>(a[0])->items;
  for (const Value& item : items) {
    const Shape* shape = std::get_if<Shape>(&item);
    if (!shape && !std::holds_alternative<Broken>(item))
      m.fail(std::string("merge takes an array of shapes; it holds ") + kindOf(item));
    if (!shape || !m.mayTake(*shape)) return m.push(Broken{});
  }
  m.push(merged(m, items));
}

// ---------------------------------------------------------------- choices

void chooseByChance(Machine& m, Arguments& a) {
  const Shape shape = std::get<Shape>(a[0]);
  const auto parts = partsOf(m, a.back(), true);
  if (!parts || shape->ends.empty()) return m.graph().discard(shape);
  bool any = false;
  for (const Number& weight : parts->values) {
    if (!weight.formula && weight.known < 0) m.fail("a probability must not be negative");
    any = any || weight.formula || weight.known > 0;
  }
  if (!any) m.fail("these probabilities are all 0; expected one that is more");
  Flattener::NewNode node{kOpRandomRule, 0, 0, {}, static_cast<uint32_t>(parts->values.size())};
  Number chance;
  if (a.size() == 3)
    chance = std::get<Number>(a[1]);
  else
    chance = combined(m, kCodeRandom, {0, nullptr}, {1, nullptr}).value_or(Number{});
  node.parameters.push_back(m.parameter(chance, shape));
  for (const Number& weight : parts->values) node.parameters.push_back(m.parameter(weight, shape));
  const uint32_t number = m.graph().addNode(shape, std::move(node), m.place());
  const size_t at = m.stack().size();
  m.push(parts->procedures.size() == 1 ? m.graph().edgeOf(number, 0, shape) : shape);
  if (parts->procedures.size() == 1)
    m.execute(parts->procedures[0], m.place());
  else if (!m.hasStopped())
    m.branchOn(at, number, parts->procedures, nullptr);
}

uint32_t tagOf(Machine& m, const Value& value) {
  if (const Name* name = std::get_if<Name>(&value)) return m.graph().tagNamed(m.nameText(name->name));
  const float number = std::get<Number>(value).known;
  if (number <= 16777216.0f) return static_cast<uint32_t>(number);
  m.fail("a tag is a name or a whole number from 0");
  return 0;
}

void collider(Machine& m, Arguments& a) {
  const Shape shape = std::get<Shape>(a[0]);
  if (shape->ends.empty()) return m.push(shape);
  const uint32_t node = m.graph().addNode(shape, {kOpCollider, tagOf(m, a[1]), 0, {}, 1}, m.place());
  m.push(m.graph().edgeOf(node, 0, shape));
}

void ifCollides(Machine& m, Arguments& a) {
  const Shape shape = std::get<Shape>(a[0]);
  if (shape->ends.empty()) return;
  const uint32_t node = m.graph().addNode(shape, {kOpIfCollides, tagOf(m, a[1]), 0, {}, 2}, m.place());
  const size_t at = m.stack().size();
  m.push(shape);
  if (!m.hasStopped()) m.branchOn(at, node, std::span(a).subspan(2), nullptr);
}

// ---------------------------------------------------------------- polygons of vertices

bool isConvex(const std::vector<std::array<float, 2>>& p) {
  bool left = false, right = false;
  for (size_t i = 0; i < p.size(); ++i) {
    const auto &a = p[i], &b = p[(i + 1) % p.size()], &c = p[(i + 2) % p.size()];
    const double turn = (double(b[0]) - a[0]) * (double(c[1]) - b[1]) - (double(b[1]) - a[1]) * (double(c[0]) - b[0]);
    left |= turn > 0;
    right |= turn < 0;
  }
  return !(left && right);
}

std::optional<std::vector<std::array<float, 2>>> pointsOf(Machine& m, const Value& array) {
  std::vector<std::array<float, 2>> points;
  for (const Value& item : std::get<Items>(array)->items) {
    const auto* v = std::get_if<std::shared_ptr<const Vector>>(&item);
    if (std::holds_alternative<Broken>(item)) return std::nullopt;
    if (!v || ((*v)->size == 3 && ((*v)->components[2].formula || (*v)->components[2].known != 0))) {
      m.fail(std::string(m.operatorName()) + " takes an array of corners as (x, y); it holds " +
             (v ? "a vector with a z that is not 0" : kindOf(item)));
      return std::nullopt;
    }
    std::array<float, 2> point{};
    for (uint32_t i = 0; i < 2; ++i) {
      if ((*v)->components[i].formula) {
        m.fail("corners must be known; this one depends on the shape");
        return std::nullopt;
      }
      point[i] = (*v)->components[i].known;
    }
    if (!isCorner(point[0], point[1])) {
      m.fail(kExpectedCorner);
      return std::nullopt;
    }
    points.push_back(point);
  }
  return points;
}

/// Several vertices become one polygon. All of their operators had known numbers, so it is one node.
void setPolygon(Machine& m, Arguments& a) {
  const Shape shape = std::get<Shape>(a[0]);
  const auto points = pointsOf(m, a[1]);
  const bool convex = points && isConvex(*points), prism = m.code() == kShapeDynamicRightPrism;
  const auto polygon = points ? m.polygonOf(*points, convex) : std::nullopt;
  if (!polygon || shape->ends.empty()) return m.push(shape);
  const uint32_t type = prism ? (convex ? kShapeDynamicConvexRightPrism : kShapeDynamicRightPrism)
                              : (convex ? kShapeDynamicConvexPolygon : kShapeDynamicPolygon);
  const uint32_t node = m.graph().addNode(shape, {kOpSetGeometry, type, *polygon, {}, 1}, m.place());
  m.push(m.graph().edgeOf(node, 0, shape));
}

// Operators on vertices are those on shapes: a vertex that a chain of them has moved is a corner of a polygon.
template <uint32_t op> void vertex(Machine& m, Arguments& a) {
  const auto& v = std::get<std::shared_ptr<const Vector>>(a[0]);
  const auto& by = std::get<std::shared_ptr<const Vector>>(a[1]);
  Vector result = *v;
  for (uint32_t i = 0; i < result.size; ++i) {
    const auto part = combined(m, op, v->components[i], i < by->size ? by->components[i] : Number{});
    if (!part) return m.push(Broken{});
    result.components[i] = *part;
  }
  m.push(std::make_shared<const Vector>(result));
}

/// About Z, in degrees.
void turnVertex(Machine& m, Arguments& a) {
  Vector result = *std::get<std::shared_ptr<const Vector>>(a[0]);
  const vec2 turn = sineCosineDegrees(std::get<Number>(a[1]).known);
  const Number x = result.components[0], y = result.components[1], s{turn.x, nullptr}, c{turn.y, nullptr};
  const auto cx = combined(m, kCodeMultiply, c, x), sy = combined(m, kCodeMultiply, s, y),
             sx = combined(m, kCodeMultiply, s, x), cy = combined(m, kCodeMultiply, c, y);
  const auto first = cx && sy ? combined(m, kCodeSubtract, *cx, *sy) : std::nullopt;
  const auto second = sx && cy ? combined(m, kCodeAdd, *sx, *cy) : std::nullopt;
  if (!first || !second) return m.push(Broken{});
  result.components[0] = *first;
  result.components[1] = *second;
  m.push(std::make_shared<const Vector>(result));
}
} // namespace

std::optional<uint32_t> Machine::cornersOf(const Value& corners, bool convex) {
  const auto points = pointsOf(*this, corners);
  return points ? polygonOf(*points, convex) : std::nullopt;
}

std::span<const Builtin> shapeOperators() {
  static constexpr Builtin kOperators[] = {
      {"translate", "Snnn", 1, passing, kOpTranslate},
      {"translate", "Sv", 1, passing, kOpTranslate},
      {"translate", "vv", 1, vertex<kCodeAdd>},
      {"rotate", "Snnn", 1, passing, kOpRotate},
      {"rotate", "Sv", 1, passing, kOpRotate},
      {"rotate", "vk", 1, turnVertex},
      {"scale", "Snnn", 1, passing, kOpScale},
      {"scale", "Sv", 1, passing, kOpScale},
      {"scale", "vv", 1, vertex<kCodeMultiply>},
      {"extrude", "Sn", 1, passing, kOpExtrude},
      {"swapsize", "Sttt", 1, passing, kOpSwapSize},
      {"resizecorner", "Snnn", 1, passing, kOpResizeCorner},
      {"resizecorner", "Sv", 1, passing, kOpResizeCorner},
      {"growalong", "Stn", 1, passing, kOpGrowAlong},
      {"turncorner", "Snnn", 1, passing, kOpTurnCorner},
      {"turncorner", "Sv", 1, passing, kOpTurnCorner},
      {"toface", "Sn", 1, passing, kOpToFace},
      {"subdiv", "Sta", 1, divide},
      {"tile", "Stn", 1, tile},
      {"tile", "Stnt", 1, tile},
      {"compsplit", "Sa", 0, components},
      {"compsplit", "S", 1, [](Machine& m, Arguments& a) { m.pushArray(facesOf(m, std::get<Shape>(a[0]))); }},
      {"replicate", "Si", 1, replicate},
      {"merge", "a", 1, merge},
      {"nothing", "", 1, [](Machine& m, Arguments&) { m.push(merged(m, {})); }},
      {"choose", "Sa", 0, chooseByChance},
      {"choose", "Sna", 0, chooseByChance},
      {"collider", "Sr", 1, collider},
      {"ifcollides", "Srpp", 0, ifCollides},
      {"polygon", "Sa", 1, setPolygon, kShapeDynamicPolygon},
      {"prism", "Sa", 1, setPolygon, kShapeDynamicRightPrism},
      {"generate", "S", 0, [](Machine& m, Arguments& a) { m.emitDefault(std::get<Shape>(a[0])); }},
      {"size", "St", 2, attribute, kCodeShapeSize},
      {"position", "St", 2, attribute, kCodePosition},
      {"normal", "St", 2, attribute, kCodeNormal},
      {"rotation", "Stt", 2, attribute, kCodeRotation},
      {"seed", "S", 2, attribute, kCodeSeed},
      {"attribute", "S", 2, attribute, kCodeCustom},
  };
  return kOperators;
}

} // namespace gpgp::spawn::gml
