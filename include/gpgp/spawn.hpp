/* gpgp spawn.hpp: C++17 wrapper of spawn.h and spawn_builder.h. The rules of the wrapper are in core.hpp.
 *
 *   auto blob = gpgp::compileGrammar(source);                // or GrammarBuilder::compile, or baked bytes
 *   auto grammar = gpgp::Grammar::create(context, info);
 *   auto spawner = gpgp::Spawner::create(context, gpgp::init<GpgpSpawnerCreateInfo>());
 *   spawner->recordPrepare(commandBuffer, frame, spawnInfo);
 */
#ifndef GPGP_SPAWN_HPP
#define GPGP_SPAWN_HPP

#include <gpgp/core.hpp>
#include <gpgp/spawn.h>
#include <gpgp/spawn_builder.h>

#include <cstdint>
#include <initializer_list>
#include <type_traits>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpGrammarSource, GPGP_STRUCTURE_GRAMMAR_SOURCE);
GPGP_STRUCTURE_OF(GpgpGrammarCreateInfo, GPGP_STRUCTURE_GRAMMAR_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpSpawnerCreateInfo, GPGP_STRUCTURE_SPAWNER_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpSpawnInfo, GPGP_STRUCTURE_SPAWN_INFO);
GPGP_STRUCTURE_OF(GpgpSpawnReport, GPGP_STRUCTURE_SPAWN_REPORT);

namespace detail {
template <> struct Destroy<GpgpGrammarBuilder> {
  void operator()(GpgpGrammarBuilder handle) const noexcept { gpgpDestroyGrammarBuilder(handle); }
};
} // namespace detail

/// A compiled grammar on the device (gpgpCreateGrammar).
class Grammar : public Asset {
public:
  using Asset::Asset;
  static Result<Grammar> create(GpgpContext context, const GpgpGrammarCreateInfo& info) noexcept {
    return detail::create<Grammar>(gpgpCreateGrammar, context, info);
  }
  /// gpgpGetGrammarTerminals. count: in, the capacity of terminals; out, the number of all terminals. terminals nullptr
  /// asks for the count.
  [[nodiscard]] GpgpResult terminals(uint32_t& count, GpgpGrammarTerminal* terminals) const noexcept {
    return gpgpGetGrammarTerminals(get(), &count, terminals);
  }
  /// gpgpGetGrammarStarts, with count as for terminals(). GpgpAxiom::start is an index into this list.
  [[nodiscard]] GpgpResult starts(uint32_t& count, GpgpGrammarStart* starts) const noexcept {
    return gpgpGetGrammarStarts(get(), &count, starts);
  }
  /// gpgpGetGrammarFields, with count as for terminals().
  [[nodiscard]] GpgpResult fields(uint32_t& count, const char** names) const noexcept {
    return gpgpGetGrammarFields(get(), &count, names);
  }
  /// gpgpFindGrammarStart: the value for GpgpAxiom::start of a rule, or of a grammar that was linked, by its name.
  Result<uint32_t> start(const char* name) const noexcept {
    uint32_t value = 0;
    const GpgpResult code = gpgpFindGrammarStart(get(), name, &value);
    return Result<uint32_t>(code, value);
  }
};

/// Derives grammars on the GPU (gpgpCreateSpawner).
class Spawner : public Recorder {
public:
  using Recorder::Recorder;
  static Result<Spawner> create(GpgpContext context, const GpgpSpawnerCreateInfo& info) noexcept {
    return detail::create<Spawner>(gpgpCreateSpawner, context, info);
  }
  /// gpgpPrewarmGrammar: compiles the pipelines of the kernels that the grammar was baked with.
  [[nodiscard]] GpgpResult prewarm(const Grammar& grammar) noexcept { return gpgpPrewarmGrammar(get(), grammar.get()); }
  using Recorder::prewarm;
  /// gpgpRecordPrepareSpawn: records a derivation, outside render passes.
  [[nodiscard]] GpgpResult recordPrepare(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                         const GpgpSpawnInfo& info) noexcept {
    return gpgpRecordPrepareSpawn(get(), commandBuffer, &frame, &info);
  }
  /// gpgpGetSpawnReport: the oldest report that was not taken yet, or GPGP_NOT_READY.
  Result<GpgpSpawnReport> report() noexcept { return detail::report(gpgpGetSpawnReport, get()); }
};

// ---------------------------------------------------------------- compiler (libgpgp_compiler)

/// gpgpCompileGrammar: the grammar as bytes for GpgpGrammarCreateInfo::data.
inline Result<Blob> compileGrammar(const GpgpGrammarSource& source) noexcept {
  GpgpBlob blob = GpgpBlob();
  const GpgpResult code = gpgpCompileGrammar(&source, &blob);
  return Result<Blob>(code, Blob(blob));
}

/// gpgpLinkGrammars: compiles several sources to one grammar.
inline Result<Blob> linkGrammars(const GpgpGrammarSource* sources, uint32_t sourceCount) noexcept {
  GpgpBlob blob = GpgpBlob();
  const GpgpResult code = gpgpLinkGrammars(sources, sourceCount, &blob);
  return Result<Blob>(code, Blob(blob));
}

// ---------------------------------------------------------------- builder (libgpgp_compiler)

/// A value in a grammar: a number, or an expression that a GrammarBuilder made. Arithmetic and comparison operators
/// make new values; at least one of their operands must come from a builder.
class GrammarValue {
public:
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
  GrammarValue(Number number) noexcept : value_{GPGP_VALUE_NUMBER, static_cast<float>(number)} {}
  GrammarValue(GpgpGrammarValue value, GpgpGrammarBuilder builder) noexcept : value_(value), builder_(builder) {}
  const GpgpGrammarValue& get() const noexcept { return value_; }

  friend GrammarValue operator+(GrammarValue a, GrammarValue b) noexcept { return join(GPGP_EXPRESSION_ADD, a, b); }
  friend GrammarValue operator-(GrammarValue a, GrammarValue b) noexcept {
    return join(GPGP_EXPRESSION_SUBTRACT, a, b);
  }
  friend GrammarValue operator-(GrammarValue a) noexcept { return GrammarValue(0) - a; }
  friend GrammarValue operator*(GrammarValue a, GrammarValue b) noexcept {
    return join(GPGP_EXPRESSION_MULTIPLY, a, b);
  }
  friend GrammarValue operator/(GrammarValue a, GrammarValue b) noexcept { return join(GPGP_EXPRESSION_DIVIDE, a, b); }
  friend GrammarValue operator==(GrammarValue a, GrammarValue b) noexcept { return join(GPGP_EXPRESSION_EQUAL, a, b); }
  friend GrammarValue operator!=(GrammarValue a, GrammarValue b) noexcept {
    return join(GPGP_EXPRESSION_NOT_EQUAL, a, b);
  }
  friend GrammarValue operator<(GrammarValue a, GrammarValue b) noexcept { return join(GPGP_EXPRESSION_LESS, a, b); }
  friend GrammarValue operator>(GrammarValue a, GrammarValue b) noexcept { return join(GPGP_EXPRESSION_GREATER, a, b); }
  friend GrammarValue operator<=(GrammarValue a, GrammarValue b) noexcept {
    return join(GPGP_EXPRESSION_LESS_EQUAL, a, b);
  }
  friend GrammarValue operator>=(GrammarValue a, GrammarValue b) noexcept {
    return join(GPGP_EXPRESSION_GREATER_EQUAL, a, b);
  }
  friend GrammarValue operator&&(GrammarValue a, GrammarValue b) noexcept { return join(GPGP_EXPRESSION_AND, a, b); }
  friend GrammarValue operator||(GrammarValue a, GrammarValue b) noexcept { return join(GPGP_EXPRESSION_OR, a, b); }

private:
  static GrammarValue join(GpgpExpressionKind kind, GrammarValue a, GrammarValue b) noexcept {
    const GpgpGrammarBuilder builder = a.builder_ ? a.builder_ : b.builder_;
    return GrammarValue(gpgpAddExpression(builder, kind, a.value_, b.value_), builder);
  }
  GpgpGrammarValue value_;
  GpgpGrammarBuilder builder_ = nullptr;
};

/// An operator of a GrammarBuilder. It can be the successor of exactly one other operator or rule.
struct GrammarOperator {
  GpgpGrammarOperator id = 0;
};

/// Where an operator sends its shapes: the name of a rule or terminal, or an operator. SubDiv and RandomRule take a
/// value as well: { value, name } or { value, operator }.
struct GrammarSuccessor : GpgpGrammarSuccessor {
  GrammarSuccessor(const char* to) noexcept : GpgpGrammarSuccessor{{GPGP_VALUE_NONE, 0}, to, 0} {}
  GrammarSuccessor(GrammarOperator to) noexcept : GpgpGrammarSuccessor{{GPGP_VALUE_NONE, 0}, nullptr, to.id} {}
  GrammarSuccessor(const GrammarValue& before, const char* to) noexcept : GpgpGrammarSuccessor{before.get(), to, 0} {}
  GrammarSuccessor(const GrammarValue& before, GrammarOperator to) noexcept
      : GpgpGrammarSuccessor{before.get(), nullptr, to.id} {}
};
static_assert(sizeof(GrammarSuccessor) == sizeof(GpgpGrammarSuccessor),
              "an array of these is an array of the C struct");

/// A corner of a polygon, made by GrammarBuilder::corner.
struct GrammarCorner : GpgpGrammarValue {};
static_assert(sizeof(GrammarCorner) == sizeof(GpgpGrammarValue), "an array of these is an array of the C struct");

/// An axis of a shape's own space.
enum class Axis : uint32_t { x, y, z };

/// Builds a grammar in code instead of text (gpgpCreateGrammarBuilder). Operators have the names of the language:
///
///     GrammarBuilder g = *GrammarBuilder::create();
///     g.axiom(GPGP_SHAPE_BOX, "Tower").terminal("Floor Roof", 1, 0);
///     const auto height = g.variable("height", 3);
///     g.rule("Tower", g.subDiv(Axis::y, {{-1, g.repeat(Axis::y, height, "Floor")}, {height * 0.5f, "Roof"}}));
///     auto blob = g.compile();
class GrammarBuilder : public Handle<GpgpGrammarBuilder> {
public:
  using Handle::Handle;
  using Value = GrammarValue;
  using Operator = GrammarOperator;
  using Successor = GrammarSuccessor;
  using Successors = std::initializer_list<GrammarSuccessor>;
  using Corners = std::initializer_list<GrammarCorner>;

  static Result<GrammarBuilder> create() noexcept {
    GpgpGrammarBuilder raw = nullptr;
    const GpgpResult code = gpgpCreateGrammarBuilder(&raw);
    return Result<GrammarBuilder>(code, GrammarBuilder(raw));
  }
  /// gpgpCompileGrammar. source holds the options; its text and baked stay NULL.
  Result<Blob> compile(GpgpGrammarSource source = init<GpgpGrammarSource>()) const noexcept {
    source.builder = get();
    return compileGrammar(source);
  }

  GrammarBuilder& axiom(GpgpShape shape, const char* rule) noexcept {
    gpgpAddAxiom(get(), shape, nullptr, 0, rule);
    return *this;
  }
  /// An axiom with a polygon, for dynamic shapes.
  GrammarBuilder& axiom(GpgpShape shape, Corners corners, const char* rule) noexcept {
    gpgpAddAxiom(get(), shape, corners.begin(), static_cast<uint32_t>(corners.size()), rule);
    return *this;
  }
  GrammarBuilder& terminal(const char* names, uint32_t kind, uint32_t index) noexcept {
    gpgpAddTerminal(get(), names, kind, index);
    return *this;
  }
  GrammarBuilder& rule(const char* name, const Successor& to) noexcept {
    gpgpAddRule(get(), name, to.name, to.op);
    return *this;
  }
  GrammarBuilder& priority(const char* rule, uint32_t priority) noexcept {
    gpgpSetRulePriority(get(), rule, priority);
    return *this;
  }
  Value variable(const char* name, const Value& value) noexcept {
    return own(gpgpAddVariable(get(), name, value.get()));
  }

  Value random(const Value& low, const Value& high) noexcept {
    return own(gpgpAddExpression(get(), GPGP_EXPRESSION_RANDOM, low.get(), high.get()));
  }
  Value min(const Value& a, const Value& b) noexcept { return expression(GPGP_EXPRESSION_MIN, a, b); }
  Value max(const Value& a, const Value& b) noexcept { return expression(GPGP_EXPRESSION_MAX, a, b); }
  /// How many whole b fit into a, rounded down.
  Value floor(const Value& a, const Value& b) noexcept { return expression(GPGP_EXPRESSION_FLOOR, a, b); }
  /// A number in [0, 1) that depends on both values alone.
  Value noise(const Value& a, const Value& b) noexcept { return expression(GPGP_EXPRESSION_NOISE, a, b); }
  Value tag(const char* name) const noexcept { return own(gpgpAddTag(get(), name)); }
  Value shapePos(Axis axis) const noexcept { return own(attribute(GPGP_VALUE_SHAPE_POS_X, axis)); }
  Value shapeSize(Axis axis) const noexcept { return own(attribute(GPGP_VALUE_SHAPE_SIZE_X, axis)); }
  Value shapeNormal(Axis axis) const noexcept { return own(attribute(GPGP_VALUE_SHAPE_NORMAL_X, axis)); }
  Value shapeRotation(Axis axis, Axis component) const noexcept {
    return own(attribute(GPGP_VALUE_SHAPE_ROTATION_XX + 3 * static_cast<uint32_t>(axis), component));
  }
  Value shapeSeed() const noexcept { return own({GPGP_VALUE_SHAPE_SEED, 0}); }
  Value shapeCustomAttribute() const noexcept { return own({GPGP_VALUE_SHAPE_CUSTOM_ATTRIBUTE, 0}); }
  Value cameraDistance() const noexcept { return own({GPGP_VALUE_CAMERA_DISTANCE, 0}); }
  Value screenSize() const noexcept { return own({GPGP_VALUE_SCREEN_SIZE, 0}); }
  /// A field of the world, x and z metres along the shape's axes from its centre.
  Value field(const char* name, const Value& x = 0, const Value& z = 0) noexcept {
    return own(gpgpAddField(get(), name, x.get(), z.get()));
  }
  Value outOfView() const noexcept { return own({GPGP_VALUE_OUT_OF_VIEW, 0}); }

  Operator translate(const Value& x, const Value& y, const Value& z, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_TRANSLATE, {x.get(), y.get(), z.get()}, {to});
  }
  Operator rotate(const Value& x, const Value& y, const Value& z, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_ROTATE, {x.get(), y.get(), z.get()}, {to});
  }
  Operator scale(const Value& x, const Value& y, const Value& z, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_SCALE, {x.get(), y.get(), z.get()}, {to});
  }
  Operator extrude(const Value& height, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_EXTRUDE, {height.get()}, {to});
  }
  Operator swapSize(Axis x, Axis y, Axis z, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_SWAP_SIZE, {axisValue(x), axisValue(y), axisValue(z)}, {to});
  }
  Operator resizeCorner(const Value& x, const Value& y, const Value& z, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_RESIZE_CORNER, {x.get(), y.get(), z.get()}, {to});
  }
  Operator growAlong(Axis axis, const Value& length, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_GROW_ALONG, {axisValue(axis), length.get()}, {to});
  }
  Operator turnCorner(const Value& x, const Value& y, const Value& z, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_TURN_CORNER, {x.get(), y.get(), z.get()}, {to});
  }
  Operator toFace(const Value& number, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_TO_FACE, {number.get()}, {to});
  }
  Operator setAttribute(const Value& value, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_SET_ATTRIBUTE, {value.get()}, {to});
  }
  Operator raiseRoof(const Value& form, const Value& measure, const Value& value, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_RAISE_ROOF, {form.get(), measure.get(), value.get()}, {to});
  }
  Operator toRoofFace(const Value& face, const Value& overhang, const Value& atGables, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_TO_ROOF_FACE, {face.get(), overhang.get(), atGables.get()}, {to});
  }
  Operator compSplit(const Successor& faces) noexcept { return add(GPGP_OPERATOR_COMP_SPLIT, {}, {faces}); }
  Operator compSplit(const Successor& top, const Successor& bottom, const Successor& sides) noexcept {
    return add(GPGP_OPERATOR_COMP_SPLIT, {}, {top, bottom, sides});
  }
  Operator subDiv(Axis axis, Successors parts) noexcept { return add(GPGP_OPERATOR_SUB_DIV, {axisValue(axis)}, parts); }
  /// mode: GPGP_VALUE_ADJUST_TO_FILL, GPGP_VALUE_ANCHOR_TO_START or GPGP_VALUE_ANCHOR_TO_END
  Operator repeat(Axis axis, const Value& extent, const Successor& to,
                  GpgpGrammarValueId mode = GPGP_VALUE_ADJUST_TO_FILL) noexcept {
    return add(GPGP_OPERATOR_REPEAT, {axisValue(axis), extent.get(), {mode, 0}}, {to});
  }
  Operator ifElse(const Value& condition, const Successor& yes, const Successor& no) noexcept {
    return add(GPGP_OPERATOR_IF, {condition.get()}, {yes, no});
  }
  Operator ifSizeLess(Axis axis, const Value& length, const Successor& yes, const Successor& no) noexcept {
    return add(GPGP_OPERATOR_IF_SIZE_LESS, {axisValue(axis), length.get()}, {yes, no});
  }
  Operator randomRule(const Value& chance, Successors parts) noexcept {
    return add(GPGP_OPERATOR_RANDOM_RULE, {chance.get()}, parts);
  }
  Operator replicate(Successors copies) noexcept { return add(GPGP_OPERATOR_REPLICATE, {}, copies); }
  Operator discard() noexcept { return add(GPGP_OPERATOR_DISCARD, {}, {}); }
  Operator generate() noexcept { return add(GPGP_OPERATOR_GENERATE, {}, {}); }
  Operator collider(const Value& tag, const Successor& to) noexcept {
    return add(GPGP_OPERATOR_COLLIDER, {tag.get()}, {to});
  }
  Operator ifCollides(const Value& tag, const Successor& yes, const Successor& no) noexcept {
    return add(GPGP_OPERATOR_IF_COLLIDES, {tag.get()}, {yes, no});
  }
  GrammarCorner corner(const Value& x, const Value& y) noexcept {
    return GrammarCorner{gpgpAddExpression(get(), GPGP_EXPRESSION_CORNER, x.get(), y.get())};
  }
  /// kind is one of GPGP_OPERATOR_SET_AS_DYNAMIC_...
  Operator setAsDynamic(GpgpOperatorKind kind, Corners corners, const Successor& to) noexcept {
    return Operator{gpgpAddOperator(get(), kind, corners.begin(), static_cast<uint32_t>(corners.size()), &to, 1)};
  }

private:
  Value expression(GpgpExpressionKind kind, const Value& a, const Value& b) noexcept {
    return own(gpgpAddExpression(get(), kind, a.get(), b.get()));
  }
  Value own(GpgpGrammarValue value) const noexcept { return Value(value, get()); }
  static GpgpGrammarValue attribute(GpgpGrammarValueId first, Axis axis) noexcept {
    return {first + static_cast<uint32_t>(axis), 0};
  }
  static GpgpGrammarValue axisValue(Axis axis) noexcept { return attribute(GPGP_VALUE_X, axis); }
  Operator add(GpgpOperatorKind kind, std::initializer_list<GpgpGrammarValue> values, Successors to) noexcept {
    return Operator{gpgpAddOperator(get(), kind, values.begin(), static_cast<uint32_t>(values.size()), to.begin(),
                                    static_cast<uint32_t>(to.size()))};
  }
};

} // namespace gpgp

#endif
