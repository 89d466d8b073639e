// The queue: from an axiom to its leaves.
#include "spawn/cga/deriver.h"
#include "spawn/shared/shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gpgp::spawn::cga {

namespace {
constexpr uint32_t kFirstPoolWords = 1u << 18, kMostPoolWords = 0xfff00000u, kMostWorkWords = 1u << 24;
} // namespace

Deriver::Deriver(const Program& program, const DeriveOptions& options)
    : program_(program), options_(options), words_(program.words.data()), strings_(program.strings),
      pool_(kFirstPoolWords), poolWords_(kFirstPoolWords) {
  frames_.resize(2 * (options.maxFunctionDepth + 1));
}

void Deriver::warnAt(uint32_t at, bool isError, const std::string& kind, const std::string& text) {
  const SourceOf* source = program_.sourceOf(at);
  const std::string file = source ? program_.files[source->file] : program_.folder;
  const Place place = source ? source->place : Place{};
  if (isError)
    messages_->error(file, place, text);
  else
    messages_->once(kind, file, place, text);
}

void Deriver::warn(const std::string& kind, const std::string& text) { warnAt(at_, false, kind, text); }

/// Ends this axiom's derivation.
void Deriver::fail(const std::string& what) {
  if (!stopped_)
    warnAt(at_, true, {}, what + (axiom_->where.empty() ? std::string() : " (axiom " + axiom_->where + ")"));
  stopped_ = true;
}

void Deriver::clear() {
  noRoom_ = stopped_ = false;
  shapes_ = printCount_ = 0;
  deepest_ = 0;
  strings_.clear();
  queue_.clear();
  queueValues_.clear();
  leaves_.clear();
  blocks_.assign(1, {});
  changes_.assign(1, {});
  projections_.assign(1, {});
  trims_.assign(1, {});
  arrays_.clear();
  arrayValues_ = 0;
  labels_.clear();
  tagNames_.clear();
  stackBase_ = nested_ = 0;
  reports_.clear();
  prints_.clear();
  assetForms_.clear();
  pool_.clear();
  pool_.steps = 0;
  pool_.mostSteps = options_.maxWork;
  operation_ = {};
  boxes_.write(pool_);
  boxes_.areUsed = !program_.asksOwnTags;
}

std::vector<FirstValue> Deriver::firstValues(const Axiom& axiom, Messages& messages) {
  axiom_ = &axiom;
  messages_ = &messages;
  clear();
  std::vector<FirstValue> values(program_.attributes.size());
  if (!start(axiom, 0) || stopped_ || noRoom_) return values;
  attributes(axiom, program_.wholeOrder);
  for (size_t slot = 0; slot < values.size(); ++slot) {
    const CgaValue& value = blocks_[shape_.values + slot];
    values[slot] = {value.type, static_cast<double>(cgaNumber(value)), text(value), {}};
    if (value.type == kCgaArray)
      for (const CgaValue& element : ArrayValue(arrayOf(value)).values) values[slot].elements.push_back(text(element));
  }
  return values;
}

void Deriver::run(const Axiom& axiom, uint32_t number, Derivation& result, Messages& messages) {
  axiom_ = &axiom;
  messages_ = &messages;
  around_ = options_.surroundings;
  axiomNumber_ = options_.firstAxiom + number;
  for (;;) {
    clear();
    const size_t firstLeaf = result.leaves.size(), firstVertex = result.vertices.size();
    const size_t firstIndex = result.indices.size();
    if (!start(axiom, number)) return;
    derive();
    if (!noRoom_) writeLeaves(result, number, firstLeaf);
    if (!noRoom_) break;
    // The pool had no room for this axiom's geometry: once more, in a larger one.
    result.leaves.resize(firstLeaf);
    if (options_.keepScopes) result.scopes.resize(firstLeaf);
    result.vertices.resize(firstVertex);
    result.indices.resize(firstIndex);
    if (!growPool()) return;
  }
  result.shapes += shapes_;
  result.depth = std::max(result.depth, deepest_);
  result.work = std::max<uint64_t>(result.work, pool_.steps);
  for (const auto& [name, report] : reports_) {
    Report& to = result.reports[strings_.text(name)];
    to.least = to.count ? std::min(to.least, report.least) : report.least;
    to.most = to.count ? std::max(to.most, report.most) : report.most;
    to.count += report.count;
    to.sum += report.sum;
  }
  for (const uint32_t print : prints_)
    if (result.prints.size() < Derivation::kMostPrints) result.prints.push_back(strings_.text(print));
  result.printed += printCount_;
}

bool Deriver::growPool() {
  const uint32_t most = static_cast<uint32_t>(
      std::clamp<uint64_t>(uint64_t{options_.maxGeometryMiB} << 18, kFirstPoolWords, kMostPoolWords));
  if (poolWords_ >= most) {
    fail(ruleAndOperation() + ": the meshes of one axiom need more than " + std::to_string(most >> 18) +
         " MiB; maxGeometryMiB (--max-geometry) allows more");
    return false;
  }
  poolWords_ = static_cast<uint32_t>(std::min<uint64_t>(4ull * poolWords_, most));
  pool_ = GeometryPool(poolWords_, std::min(poolWords_, kMostWorkWords));
  return true;
}

std::vector<Occluder> Deriver::seen(const Axiom& axiom, uint32_t number, Messages& messages) {
  axiom_ = &axiom;
  messages_ = &messages;
  around_ = nullptr;
  axiomNumber_ = options_.firstAxiom + number;
  std::vector<Occluder> shapes;
  unlabelled_ = program_.asksUnlabelled ? &shapes : nullptr;
  for (;;) {
    clear();
    shapes.clear();
    if (!start(axiom, number)) break;
    derive();
    for (const Shape& leaf : leaves_)
      if (!noRoom_) noteUnlabelled(leaf.form);
    if (!noRoom_ || !growPool()) break;
  }
  unlabelled_ = nullptr;
  for (Labelled& shape : labels_) shapes.push_back({strings_.text(shape.label), std::move(shape.hull), shape.area});
  return shapes;
}

bool Deriver::start(const Axiom& axiom, uint32_t number) {
  Shape shape;
  if (axiom.points.empty()) {
    Scope scope;
    scope.origin = axiom.origin;
    scope.axisX = axiom.axisX;
    scope.axisY = axiom.axisY;
    scope.axisZ = axiom.axisZ;
    scope.size = axiom.size;
    shape.form = boxes_.make(scope, axiom.size.y > 0 ? boxes_.box : boxes_.flat);
  } else {
    const Status status = makePolygon(pool_, axiom.points, axiom.loopSizes, shape.form);
    if (status != kGeometryOk) {
      if (status == kGeometryNoRoom) {
        noRoom_ = true;
        return true;
      }
      messages_->warning(axiom.where, {}, "this polygon is left out: " + std::string(describeStatus(status)));
      return false;
    }
  }
  shape_ = shape;
  if (!axiom.streetWidths.empty()) tagStreets(axiom);
  shape.form = shape_.form;
  start_ = shape.form;
  shape.key = childKey(uvec2(axiom.seed, 0u), 0u);
  (void)number;
  resetPivot(shape);
  shape_ = shape;
  ruleScope_ = shape.form.scope;
  attributes(axiom, program_.order);
  if (stopped_ || noRoom_) return true;
  const RuleInfo& rule = program_.rules[program_.start];
  shape = shape_;
  shape.draws = 0;
  shape.chunk = rule.chunk;
  queue_.push_back(shape);
  return true;
}

/// Each draws from a key of its own, so that values do not depend on which of them the program needs.
void Deriver::attributes(const Axiom& axiom, const std::vector<uint32_t>& order) {
  const uint32_t count = static_cast<uint32_t>(program_.attributes.size());
  shape_.values = static_cast<uint32_t>(blocks_.size());
  blocks_.resize(blocks_.size() + count);
  const uvec2 key = shape_.key;
  for (uint32_t slot = 0; slot < count; ++slot)
    if (program_.attributes[slot].isMaterial)
      blocks_[shape_.values + slot] = firstOfMaterial(program_.attributes[slot].name);
  std::unordered_map<std::string_view, const std::string*> given;
  for (const AttributeValue& value : options_.attributes) given[value.name] = &value.text;
  for (const AttributeValue& value : axiom.attributes) given.try_emplace(value.name, &value.text);
  for (const uint32_t slot : order) {
    const AttributeInfo& info = program_.attributes[slot];
    CgaValue value = cgaFloatValue(0);
    const auto found = info.isConstant || given.empty() ? given.end() : given.find(info.name);
    if (found != given.end()) {
      const std::string& text = *found->second;
      // What is a string by the program stays one, though it reads as a number.
      const bool isString = words_[info.chunk + kCgaChunkHeader] == kCgaPushStringCode;
      const std::optional<float> parsed = numberIn(text);
      if (!isString && (text == "true" || text == "false"))
        value = cgaBoolValue(text == "true");
      else if (!isString && text == "NaN")
        value = cgaMake(kCgaNothing, 0);
      else if (!isString && parsed)
        value = cgaFloatValue(*parsed);
      else
        value = stringValue(text);
    } else if (const WorldField* field = info.isConstant || info.isMaterial ? nullptr : fieldNamed(info.name)) {
      const Scope& s = shape_.form.scope;
      value = cgaFloatValue(
          fieldAt(*field, s.origin + (s.axisX * s.size.x + s.axisY * s.size.y + s.axisZ * s.size.z) * 0.5f));
    } else if (info.chunk) {
      attributeSlot_ = slot;
      shape_.draws = 0;
      hasHull_ = false;
      chunk_ = info.chunk;
      at_ = info.chunk;
      const uint32_t how = cgaRun(info.chunk, 0);
      attributeSlot_ = kNoSlot;
      if (how != kCgaDone) {
        if (!stopped_ && !noRoom_)
          fail(how == kCgaTooDeep
                   ? "functions call each other deeper than " + std::to_string(options_.maxFunctionDepth) +
                         " for the value of '" + info.name + "'"
                   : "the value of '" + info.name + "' needs more than " + std::to_string(options_.maxInstructions) +
                         " steps");
        return;
      }
      value = stack_[0];
    }
    blocks_[shape_.values + slot] = value;
  }
  shape_.key = key;
  shape_.draws = 0;
  drawn_ = false;
}

float Deriver::cgaRandom() {
  drawn_ = true;
  if (attributeSlot_ == kNoSlot) return drawnNumber(shape_.key, shape_.draws++);
  // Of attributes, by what each shape of a graph knows of its axiom (axiomShape() in shape.h).
  const float own = unitFloat(childSeed(axiom_->seed, 0u));
  return noise(own, static_cast<float>(kDrawsOfSlot * attributeSlot_ + shape_.draws++));
}

void Deriver::settleDraws() {
  if (drawn_) shape_.key = drawnKey(shape_.key);
  drawn_ = false;
  shape_.draws = 0;
}

bool Deriver::path(Operation operation, const Arguments& a) {
  switch (operation) {
  case Operation::path_fork:
    forks_.push_back(shape_.key);
    shape_.key = childKey(shape_.key, 0);
    shape_.children = 0;
    break;
  case Operation::path_rest:
    if (forks_.empty()) break; // the compiler makes pairs
    shape_.key = childKey(forks_.back(), 1);
    shape_.children = 0;
    forks_.pop_back();
    break;
  case Operation::path_drawsFrom:
    shape_.draws = static_cast<uint32_t>(number(a[0])) << shader::kDrawsOfParameter;
    return true;
  default: settleDraws(); return true;
  }
  shape_.draws = 0;
  drawn_ = false;
  return true;
}

void Deriver::derive() {
  while (!queue_.empty() && !stopped_ && !noRoom_) {
    next_.clear();
    nextValues_.clear();
    for (const Shape& shape : queue_) {
      if (stopped_ || noRoom_) return;
      if (!runRule(shape) && (stopped_ || noRoom_)) return;
    }
    queue_.swap(next_);
    queueValues_.swap(nextValues_);
  }
}

bool Deriver::runRule(const Shape& shape) {
  shape_ = shape;
  chunk_ = shape.chunk;
  at_ = shape.chunk;
  if (!enters(chunk_, shape.depth)) return false;
  ruleScope_ = shape_.form.scope;
  made_ = hasHull_ = drawn_ = false;
  states_.clear();
  forks_.clear();
  for (uint32_t i = 0; i < shape.count; ++i) stack_[stackBase_ + i] = queueValues_[shape.first + i];
  const uint32_t how = cgaRun(chunk_, stackBase_);
  if (how == kCgaDone) return true;
  if (stopped_ || noRoom_) return false;
  const std::string rule = "rule '" + program_.strings[words_[chunk_]] + "'";
  switch (how) {
  case kCgaTooDeep:
    fail("functions call each other deeper than " + std::to_string(options_.maxFunctionDepth) + " in " + rule);
    break;
  case kCgaTooLong: fail(rule + " needs more than " + std::to_string(options_.maxInstructions) + " steps"); break;
  case kCgaStackFull: fail("values of " + rule + " need more than " + std::to_string(kStackSize) + " places"); break;
  case kCgaBadCode: fail("the program is damaged in " + rule); break;
  default: break;
  }
  return false;
}

/// Counts a rule that is run, within the limits.
bool Deriver::enters(uint32_t chunk, uint32_t depth) {
  deepest_ = std::max(deepest_, depth);
  if (depth > options_.maxDepth) {
    fail("rule '" + program_.strings[words_[chunk]] + "' is " + std::to_string(options_.maxDepth) +
         " rules behind the axiom; maxDepth (--max-depth) allows more");
    return false;
  }
  if (++shapes_ > options_.maxShapes) {
    fail("an axiom has more than " + std::to_string(options_.maxShapes) +
         " shapes; maxShapes (--max-shapes) allows more");
    return false;
  }
  return true;
}

std::string Deriver::ruleAndOperation() const {
  if (!chunk_) return "drawing";
  std::string text = "rule '" + program_.strings[words_[chunk_]] + "'";
  if (!operation_.empty()) text.append(", '").append(operation_).append("'");
  return text;
}

bool Deriver::isWithin(const Form& form) {
  const uint32_t faces = meshFaces(pool_, form.mesh), vertices = meshVertices(pool_, form.mesh);
  if (faces <= options_.maxFaces && vertices <= options_.maxVertices) return true;
  const bool isFaces = faces > options_.maxFaces;
  fail(ruleAndOperation() + ": a shape has " + std::to_string(isFaces ? faces : vertices) +
       (isFaces ? " faces, more than " : " vertices, more than ") +
       std::to_string(isFaces ? options_.maxFaces : options_.maxVertices) +
       (isFaces ? "; maxFaces (--max-faces) allows more" : "; maxVertices (--max-vertices) allows more"));
  return false;
}

bool Deriver::works(uint64_t steps) {
  if (countSteps(pool_, steps)) return true;
  fail(ruleAndOperation() + ": the geometry of one axiom takes more than " +
       std::to_string(options_.maxWork / 1'000'000) + " million steps; maxWork (--max-work) allows more");
  return false;
}

CgaValue Deriver::cgaAttribute(uint32_t slot) const {
  for (uint32_t at = shape_.changes; at; at = changes_[at].next)
    if (changes_[at].slot == slot) return changes_[at].value;
  return blocks_[shape_.values + slot];
}

void Deriver::cgaSetAttribute(uint32_t slot, const CgaValue& v) {
  if (shape_.changeCount == kLongestChain) { // a block of its own again
    const uint32_t count = static_cast<uint32_t>(program_.attributes.size());
    const uint32_t block = static_cast<uint32_t>(blocks_.size());
    blocks_.resize(block + count);
    std::copy_n(blocks_.begin() + shape_.values, count, blocks_.begin() + block);
    std::vector<uint32_t> chain;
    for (uint32_t at = shape_.changes; at; at = changes_[at].next) chain.push_back(at);
    for (auto it = chain.rbegin(); it != chain.rend(); ++it) blocks_[block + changes_[*it].slot] = changes_[*it].value;
    shape_.values = block;
    shape_.changes = shape_.changeCount = 0;
  }
  changes_.push_back({slot, shape_.changes, v});
  shape_.changes = static_cast<uint32_t>(changes_.size() - 1);
  ++shape_.changeCount;
}

Shape& Deriver::child() {
  next_.push_back(shape_);
  Shape& shape = next_.back();
  shape.key = childKey(shape_.key, shape_.children++);
  shape.draws = shape.children = 0;
  shape.depth = shape_.depth + 1;
  return shape;
}

bool Deriver::addChild(Shape& shape, uint32_t body, uint32_t base) {
  shape.chunk = body;
  shape.first = static_cast<uint32_t>(nextValues_.size());
  shape.count = words_[body + kCgaChunkParameters];
  for (uint32_t i = 0; i < shape.count; ++i) nextValues_.push_back(stack_[base + i]);
  made_ = true;
  if (!isWithin(shape.form) || !works()) return false;
  if (shapes_ + next_.size() > options_.maxShapes) {
    fail("an axiom has more than " + std::to_string(options_.maxShapes) +
         " shapes; maxShapes (--max-shapes) allows more");
    return false;
  }
  return true;
}

bool Deriver::cgaInvoke(uint32_t chunk, uint32_t first, uint32_t count) {
  (void)count;
  settleDraws();
  Shape& shape = child();
  shape.key = shape_.key; // a way of its own leads here, or nothing follows
  return addChild(shape, chunk, first);
}

bool Deriver::cgaGoOn(uint32_t chunk) {
  settleDraws();
  ++shape_.depth;
  chunk_ = chunk;
  ruleScope_ = shape_.form.scope;
  made_ = false;
  return enters(chunk, shape_.depth);
}

void Deriver::addLeaf(uint32_t name) {
  leaves_.push_back(shape_);
  leaves_.back().chunk = name;
  made_ = true;
}

bool Deriver::cgaLeaf(uint32_t name) {
  addLeaf(name);
  return true;
}

bool Deriver::cgaEnd() {
  if (!made_) addLeaf(words_[chunk_ + kCgaChunkName]);
  return true;
}

bool Deriver::cgaPushShape() {
  if (states_.size() == kMostStates) {
    fail("[ is nested more than " + std::to_string(kMostStates) + " deep");
    return false;
  }
  states_.push_back(shape_);
  return true;
}

bool Deriver::cgaPopShape() {
  if (states_.empty()) return true; // the compiler said so
  const Shape& saved = states_.back();
  const uint32_t children = shape_.children;
  shape_ = saved;
  shape_.children = children;
  states_.pop_back();
  hasHull_ = false;
  return true;
}

void Deriver::writeTriangles(const Form& form, float softAngle, Derivation& result) {
  if (boxes_.is(form) && !(softAngle > 90)) {
    for (uint32_t f = 0; f < boxes_.faces(form); ++f) {
      const Scope s = boxes_.face(form, f).scope;
      const vec3 x = s.axisX * s.size.x, y = s.axisY * s.size.y;
      result.triangles += 2;
      if (!options_.keepTriangles) continue;
      const uint32_t first = static_cast<uint32_t>(result.vertices.size());
      result.vertices.push_back({s.origin, s.axisZ, {0, 0}});
      result.vertices.push_back({s.origin + x, s.axisZ, {1, 0}});
      result.vertices.push_back({s.origin + x + y, s.axisZ, {1, 1}});
      result.vertices.push_back({s.origin + y, s.axisZ, {0, 1}});
      for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) result.indices.push_back(first + i);
    }
    return;
  }
  std::vector<OutputVertex> vertices;
  std::vector<uint32_t> indices;
  const Status status = triangulate(pool_, form, vertices, indices);
  if (!works()) return;
  softenNormals(vertices, softAngle);
  if (status == kGeometryNoRoom) noRoom_ = true;
  if (status != kGeometryOk && status != kGeometryEmpty && status != kGeometryNoRoom)
    warn("triangulate", "a shape is not drawn: " + std::string(describeStatus(status)));
  result.triangles += indices.size() / 3;
  if (!options_.keepTriangles) return;
  const uint32_t first = static_cast<uint32_t>(result.vertices.size());
  for (const OutputVertex& v : vertices) result.vertices.push_back({v.position, v.normal, v.uv});
  for (const uint32_t i : indices) result.indices.push_back(first + i);
}

LeafScope Deriver::scopeOf(const Shape& shape) const {
  const bool isBox = boxes_.is(shape.form);
  // Polygons in the ground plane are seen from above.
  const bool isFlat = isBox ? shape.form.mesh == boxes_.flat : shape.form.mesh != 0 && shape.form.scope.size.y == 0;
  // What else lies in a plane, a roof's face for one, faces z as well.
  const bool isQuad =
      isFlat || (isBox ? shape.form.mesh == boxes_.upright : shape.form.mesh != 0 && shape.form.scope.size.z == 0);
  Form flat = shape.form;
  flat.mesh = boxes_.flat;
  const Scope s = isFlat ? boxes_.face(flat, 0).scope : shape.form.scope;
  LeafScope leaf;
  leaf.x = s.axisX * s.size.x;
  leaf.y = s.axisY * s.size.y;
  leaf.z = s.axisZ * (isQuad && s.size.z == 0 ? 1.0f : s.size.z);
  leaf.centre = s.origin + (leaf.x + leaf.y + s.axisZ * s.size.z) * 0.5f;
  leaf.key = shape.key;
  leaf.isQuad = isQuad;
  return leaf;
}

void Deriver::writeLeaves(Derivation& result, uint32_t number, size_t firstLeaf) {
  (void)firstLeaf;
  const uint64_t before = result.triangles;
  const size_t firstVertex = result.vertices.size(), firstIndex = result.indices.size();
  chunk_ = at_ = 0; // no rule runs
  // What was derived before a limit is kept, and has a limit of its own.
  const bool wasStopped = std::exchange(stopped_, false);
  pool_.mostSteps = pool_.steps + options_.maxWork;
  for (const Shape& shape : leaves_) {
    Leaf leaf;
    leaf.name = shape.chunk;
    leaf.axiom = number;
    leaf.texture = shape.texture;
    leaf.color = shape.color;
    leaf.firstIndex = static_cast<uint32_t>(result.indices.size());
    if (shape.form.mesh) writeTriangles(shape.form, shape.softAngle, result);
    leaf.indexCount = static_cast<uint32_t>(result.indices.size()) - leaf.firstIndex;
    result.leaves.push_back(leaf);
    if (options_.keepScopes) result.scopes.push_back(scopeOf(shape));
    const uint64_t bytes = sizeof(Vertex) * (result.vertices.size() - firstVertex) +
                           sizeof(uint32_t) * (result.indices.size() - firstIndex);
    if (bytes > uint64_t{options_.maxGeometryMiB} << 20)
      fail("the triangles of one axiom need more than " + std::to_string(options_.maxGeometryMiB) +
           " MiB; maxGeometryMiB (--max-geometry) allows more");
    if (stopped_) break;
    if (noRoom_) {
      result.triangles = before;
      return;
    }
  }
  stopped_ = stopped_ || wasStopped;
  // Strings of the program keep their numbers, those that were made get new ones.
  std::unordered_map<uint32_t, uint32_t> made;
  const auto named = [&](uint32_t& name) {
    if (name < program_.strings.size()) return;
    const auto [found, isNew] = made.try_emplace(name, 0u);
    if (isNew) {
      const std::string& text = strings_.text(name);
      const auto at =
          std::find(result.names.begin() + static_cast<ptrdiff_t>(program_.strings.size()), result.names.end(), text);
      found->second = static_cast<uint32_t>(at - result.names.begin());
      if (at == result.names.end()) result.names.push_back(text);
    }
    name = found->second;
  };
  for (size_t i = firstLeaf; i < result.leaves.size(); ++i) {
    named(result.leaves[i].name);
    named(result.leaves[i].texture);
  }
}

} // namespace gpgp::spawn::cga
