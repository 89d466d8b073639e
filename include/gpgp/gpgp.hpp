/* gpgp.hpp: the C API as C++17 types. Header-only, thin, no power beyond the C API.
 *
 * Handles are move-only and destroy what they hold; nothing throws; what can fail returns a GpgpResult or a Result<T>.
 * Each member calls the C function that its comment or name says: threading, lifetimes, render-pass rules and
 * command-buffer state are those of the C headers. Nothing is allocated here.
 *
 *   auto info = gpgp::init<GpgpSpawnerCreateInfo>();      // sType set, all else zero
 *   auto spawner = gpgp::Spawner::create(context, info);  // Result<Spawner>
 *   if (!spawner) return spawner.code();
 *   spawner->prewarm();
 *
 * Destroy order: a Context destroys all that was made from it, so let it outlive the other handles: declare it first.
 */
#ifndef GPGP_HPP
#define GPGP_HPP

#include <gpgp/gpgp.h>

#include <initializer_list>
#include <memory>
#include <type_traits>
#include <utility>

namespace gpgp {

/// A value, or the result code that says why there is none: an error, or a status such as GPGP_NOT_READY.
template <class T> class [[nodiscard]] Result {
public:
  explicit Result(GpgpResult code, T value = T()) noexcept : code_(code), value_(std::move(value)) {}
  /// Whether there is a value.
  explicit operator bool() const noexcept { return code_ == GPGP_SUCCESS; }
  GpgpResult code() const noexcept { return code_; }
  /// The code's name, static.
  const char* name() const noexcept { return gpgpResultString(code_); }
  /// Empty (a null handle, a zeroed struct) where there is no value.
  T& operator*() & noexcept { return value_; }
  const T& operator*() const& noexcept { return value_; }
  T&& operator*() && noexcept { return std::move(value_); }
  T* operator->() noexcept { return &value_; }
  const T* operator->() const noexcept { return &value_; }

private:
  GpgpResult code_;
  T value_;
};

// ---------------------------------------------------------------- structs

/// The sType of a descriptor struct. Not defined for types that have none.
template <class T> struct StructureType;
#define GPGP_STRUCTURE_OF(Type, enumerator)                                                                            \
  template <> struct StructureType<Type> { static constexpr GpgpStructureType value = enumerator; }
GPGP_STRUCTURE_OF(GpgpContextCreateInfo, GPGP_STRUCTURE_CONTEXT_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpRequirementsInfo, GPGP_STRUCTURE_REQUIREMENTS_INFO);
GPGP_STRUCTURE_OF(GpgpRequirements, GPGP_STRUCTURE_REQUIREMENTS);
GPGP_STRUCTURE_OF(GpgpPrewarmInfo, GPGP_STRUCTURE_PREWARM_INFO);
GPGP_STRUCTURE_OF(GpgpTargetInfo, GPGP_STRUCTURE_TARGET_INFO);
GPGP_STRUCTURE_OF(GpgpMemoryReport, GPGP_STRUCTURE_MEMORY_REPORT);
GPGP_STRUCTURE_OF(GpgpGrammarSource, GPGP_STRUCTURE_GRAMMAR_SOURCE);
GPGP_STRUCTURE_OF(GpgpGrammarCreateInfo, GPGP_STRUCTURE_GRAMMAR_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpSpawnerCreateInfo, GPGP_STRUCTURE_SPAWNER_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpSpawnInfo, GPGP_STRUCTURE_SPAWN_INFO);
GPGP_STRUCTURE_OF(GpgpSpawnReport, GPGP_STRUCTURE_SPAWN_REPORT);
GPGP_STRUCTURE_OF(GpgpSvgSource, GPGP_STRUCTURE_SVG_SOURCE);
GPGP_STRUCTURE_OF(GpgpDrawingCreateInfo, GPGP_STRUCTURE_DRAWING_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpDrawingInfo, GPGP_STRUCTURE_DRAWING_INFO);
GPGP_STRUCTURE_OF(GpgpGlyphSource, GPGP_STRUCTURE_GLYPH_SOURCE);
GPGP_STRUCTURE_OF(GpgpGlyphSetCreateInfo, GPGP_STRUCTURE_GLYPH_SET_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpGlyphSetInfo, GPGP_STRUCTURE_GLYPH_SET_INFO);
GPGP_STRUCTURE_OF(GpgpListCreateInfo, GPGP_STRUCTURE_LIST_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpHitTestInfo, GPGP_STRUCTURE_HIT_TEST_INFO);
GPGP_STRUCTURE_OF(GpgpCanvasCreateInfo, GPGP_STRUCTURE_CANVAS_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpCanvasInfo, GPGP_STRUCTURE_CANVAS_INFO);
GPGP_STRUCTURE_OF(GpgpCanvasDrawInfo, GPGP_STRUCTURE_CANVAS_DRAW_INFO);
GPGP_STRUCTURE_OF(GpgpCanvasReport, GPGP_STRUCTURE_CANVAS_REPORT);
GPGP_STRUCTURE_OF(GpgpCanvasHistoryCreateInfo, GPGP_STRUCTURE_CANVAS_HISTORY_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpGeometrySetCreateInfo, GPGP_STRUCTURE_GEOMETRY_SET_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpVisibilityRecorderCreateInfo, GPGP_STRUCTURE_VISIBILITY_RECORDER_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpVisibilityInfo, GPGP_STRUCTURE_VISIBILITY_INFO);
GPGP_STRUCTURE_OF(GpgpVisibilityReport, GPGP_STRUCTURE_VISIBILITY_REPORT);
GPGP_STRUCTURE_OF(GpgpVisibilityMetricsInfo, GPGP_STRUCTURE_VISIBILITY_METRICS_INFO);
GPGP_STRUCTURE_OF(GpgpViewCellInfo, GPGP_STRUCTURE_VIEW_CELL_INFO);
GPGP_STRUCTURE_OF(GpgpCameraHistoryCreateInfo, GPGP_STRUCTURE_CAMERA_HISTORY_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpFontCreateInfo, GPGP_STRUCTURE_FONT_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpFontInfo, GPGP_STRUCTURE_FONT_INFO);
GPGP_STRUCTURE_OF(GpgpGlyphOutlineInfo, GPGP_STRUCTURE_GLYPH_OUTLINE_INFO);
GPGP_STRUCTURE_OF(GpgpShaperCreateInfo, GPGP_STRUCTURE_SHAPER_CREATE_INFO);
GPGP_STRUCTURE_OF(GpgpShaperReport, GPGP_STRUCTURE_SHAPER_REPORT);
GPGP_STRUCTURE_OF(GpgpTextInfo, GPGP_STRUCTURE_TEXT_INFO);
GPGP_STRUCTURE_OF(GpgpLayoutInfo, GPGP_STRUCTURE_LAYOUT_INFO);
#undef GPGP_STRUCTURE_OF

/// A descriptor struct as its _INIT macro makes it.
template <class T> T init() noexcept {
  T value = T();
  value.sType = StructureType<T>::value;
  return value;
}

// ---------------------------------------------------------------- handles

namespace detail {
inline void destroy(GpgpContext handle) noexcept { gpgpDestroyContext(handle); }
inline void destroy(GpgpAsset handle) noexcept { gpgpDestroyAsset(handle); }
inline void destroy(GpgpRecorder handle) noexcept { gpgpDestroyRecorder(handle); }
inline void destroy(GpgpHistory handle) noexcept { gpgpDestroyHistory(handle); }
inline void destroy(GpgpList handle) noexcept { gpgpDestroyList(handle); }
inline void destroy(GpgpGrammarBuilder handle) noexcept { gpgpDestroyGrammarBuilder(handle); }
inline void destroy(GpgpFont handle) noexcept { gpgpDestroyFont(handle); }
inline void destroy(GpgpShaper handle) noexcept { gpgpDestroyShaper(handle); }
inline void destroy(GpgpLayout handle) noexcept { gpgpDestroyLayout(handle); }
} // namespace detail

/// Owns one C handle. Converts to it, so that it can be put in the C structs.
template <class Raw> class Handle {
public:
  Handle() noexcept = default;
  explicit Handle(Raw raw) noexcept : raw_(raw) {}
  Handle(Handle&& other) noexcept : raw_(other.release()) {}
  Handle& operator=(Handle&& other) noexcept {
    if (this != &other) reset(other.release());
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { reset(); }

  Raw get() const noexcept { return raw_; }
  operator Raw() const noexcept { return raw_; }
  /// Gives the C handle away; the caller destroys it.
  [[nodiscard]] Raw release() noexcept { return std::exchange(raw_, Raw()); }
  /// Destroys what is held and takes another.
  void reset(Raw raw = Raw()) noexcept {
    if (raw_) detail::destroy(raw_);
    raw_ = raw;
  }

private:
  Raw raw_ = Raw();
};

namespace detail {
template <class T, class Raw, class Info>
Result<T> create(GpgpResult(GPGP_CALL* function)(GpgpContext, const Info*, Raw*), GpgpContext context,
                 const Info& info) noexcept {
  Raw raw = Raw();
  const GpgpResult code = function(context, &info, &raw);
  return Result<T>(code, T(raw));
}
template <class Report>
Result<Report> report(GpgpResult(GPGP_CALL* function)(GpgpRecorder, Report*), GpgpRecorder recorder) noexcept {
  Report value = init<Report>();
  const GpgpResult code = function(recorder, &value);
  return Result<Report>(code, value);
}
} // namespace detail

/// gpgpCreateContext and what takes a context.
class Context : public Handle<GpgpContext> {
public:
  using Handle::Handle;
  static Result<Context> create(const GpgpContextCreateInfo& info) noexcept {
    GpgpContext raw = nullptr;
    const GpgpResult code = gpgpCreateContext(&info, &raw);
    return Result<Context>(code, Context(raw));
  }
  [[nodiscard]] GpgpResult advance(const GpgpFrame& frame) noexcept { return gpgpAdvance(get(), &frame); }
  void notifyDeviceLost() noexcept { gpgpNotifyDeviceLost(get()); }
  /// gpgpRecordUpload; the value is the bytes still pending.
  Result<VkDeviceSize> recordUpload(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                    VkDeviceSize byteBudget = 0) noexcept {
    VkDeviceSize pending = 0;
    const GpgpResult code = gpgpRecordUpload(get(), commandBuffer, &frame, byteBudget, &pending);
    return Result<VkDeviceSize>(code, pending);
  }
  [[nodiscard]] GpgpResult pipelineCacheData(size_t& size, void* data) const noexcept {
    return gpgpGetPipelineCacheData(get(), &size, data);
  }
  Result<GpgpMemoryReport> memoryReport() const noexcept {
    GpgpMemoryReport value = init<GpgpMemoryReport>();
    const GpgpResult code = gpgpGetMemoryReport(get(), &value);
    return Result<GpgpMemoryReport>(code, value);
  }
};

/// What all assets have in common.
class Asset : public Handle<GpgpAsset> {
public:
  using Handle::Handle;
  Result<bool> resident() const noexcept {
    VkBool32 value = VK_FALSE;
    const GpgpResult code = gpgpGetResidency(get(), &value);
    return Result<bool>(code, value != VK_FALSE);
  }
};

/// Scratch that one record of a recorder needs.
struct ScratchSize {
  VkDeviceSize size = 0, alignment = 0;
  VkBufferUsageFlags usage = 0;
};

/// What all recorders have in common.
class Recorder : public Handle<GpgpRecorder> {
public:
  using Handle::Handle;
  /// For recorders that do not draw.
  [[nodiscard]] GpgpResult prewarm() noexcept { return gpgpPrewarm(get(), nullptr); }
  [[nodiscard]] GpgpResult prewarm(const GpgpPrewarmInfo& info) noexcept { return gpgpPrewarm(get(), &info); }
  Result<ScratchSize> scratchSize() const noexcept {
    ScratchSize value;
    const GpgpResult code = gpgpGetScratchSize(get(), &value.size, &value.alignment, &value.usage);
    return Result<ScratchSize>(code, value);
  }
  /// count in: capacity of names, out: passes. names nullptr asks for the count.
  [[nodiscard]] GpgpResult passes(uint32_t& count, const char** names) const noexcept {
    return gpgpGetPasses(get(), &count, names);
  }
};

class View : public Handle<GpgpHistory> {
public:
  using Handle::Handle;
};

// ---------------------------------------------------------------- spawn

class Grammar : public Asset {
public:
  using Asset::Asset;
  static Result<Grammar> create(GpgpContext context, const GpgpGrammarCreateInfo& info) noexcept {
    return detail::create<Grammar>(gpgpCreateGrammar, context, info);
  }
  /// count in: capacity, out: all. terminals nullptr asks for the count.
  [[nodiscard]] GpgpResult terminals(uint32_t& count, GpgpGrammarTerminal* terminals) const noexcept {
    return gpgpGetGrammarTerminals(get(), &count, terminals);
  }
  /// As terminals(). Places in the list are what GpgpAxiom::start takes.
  [[nodiscard]] GpgpResult starts(uint32_t& count, GpgpGrammarStart* starts) const noexcept {
    return gpgpGetGrammarStarts(get(), &count, starts);
  }
  /// A rule, or a grammar that was linked, for GpgpAxiom::start.
  Result<uint32_t> start(const char* name) const noexcept {
    uint32_t rule = 0;
    const GpgpResult code = gpgpFindGrammarStart(get(), name, &rule);
    return Result<uint32_t>(code, rule);
  }
};

class Spawner : public Recorder {
public:
  using Recorder::Recorder;
  static Result<Spawner> create(GpgpContext context, const GpgpSpawnerCreateInfo& info) noexcept {
    return detail::create<Spawner>(gpgpCreateSpawner, context, info);
  }
  /// Makes the kernels that the grammar was baked with ready.
  [[nodiscard]] GpgpResult prewarm(const Grammar& grammar) noexcept { return gpgpPrewarmGrammar(get(), grammar.get()); }
  using Recorder::prewarm;
  [[nodiscard]] GpgpResult recordPrepare(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                         const GpgpSpawnInfo& info) noexcept {
    return gpgpRecordPrepareSpawn(get(), commandBuffer, &frame, &info);
  }
  /// The oldest report not yet taken; GPGP_NOT_READY: none.
  Result<GpgpSpawnReport> report() noexcept { return detail::report(gpgpGetSpawnReport, get()); }
};

// ---------------------------------------------------------------- vector

class Drawing : public Asset {
public:
  using Asset::Asset;
  static Result<Drawing> create(GpgpContext context, const GpgpDrawingCreateInfo& info) noexcept {
    return detail::create<Drawing>(gpgpCreateDrawing, context, info);
  }
  Result<GpgpDrawingInfo> info() const noexcept {
    GpgpDrawingInfo value = init<GpgpDrawingInfo>();
    const GpgpResult code = gpgpGetDrawingInfo(get(), &value);
    return Result<GpgpDrawingInfo>(code, value);
  }
};

class GlyphSet : public Asset {
public:
  using Asset::Asset;
  static Result<GlyphSet> create(GpgpContext context, const GpgpGlyphSetCreateInfo& info) noexcept {
    return detail::create<GlyphSet>(gpgpCreateGlyphSet, context, info);
  }
  /// GPGP_BUDGET_EXCEEDED: not all found room.
  [[nodiscard]] GpgpResult add(const GpgpGlyph* glyphs, uint32_t count, uint32_t* indices) noexcept {
    return gpgpAddGlyphs(get(), glyphs, count, indices);
  }
  /// GPGP_INCOMPLETE: not all are there.
  [[nodiscard]] GpgpResult find(const uint64_t* keys, uint32_t count, uint32_t* indices) noexcept {
    return gpgpFindGlyphs(get(), keys, count, indices);
  }
  Result<GpgpGlyphSetInfo> info() const noexcept {
    GpgpGlyphSetInfo value = init<GpgpGlyphSetInfo>();
    const GpgpResult code = gpgpGetGlyphSetInfo(get(), &value);
    return Result<GpgpGlyphSetInfo>(code, value);
  }
};

/// What a user interface adds every frame (ui.h).
///
///   list.clear();
///   list.pushTransform(map);
///   list.add(shape);
///   list.pop();
class List : public Handle<GpgpList> {
public:
  using Handle::Handle;
  static Result<List> create(GpgpContext context,
                             const GpgpListCreateInfo& info = init<GpgpListCreateInfo>()) noexcept {
    return detail::create<List>(gpgpCreateList, context, info);
  }
  /// gpgpResetList
  GpgpResult clear() noexcept { return gpgpResetList(get()); }
  /// transform: 6 numbers; perspective: 3, or nullptr.
  GpgpResult pushTransform(const float* transform, const float* perspective = nullptr) noexcept {
    return gpgpPushTransform(get(), transform, perspective);
  }
  /// box: left, top, right, bottom; radii: 4, or nullptr.
  GpgpResult pushClip(const float* box, const float* radii = nullptr) noexcept {
    return gpgpPushClip(get(), box, radii);
  }
  GpgpResult pushOpacity(float opacity) noexcept { return gpgpPushOpacity(get(), opacity); }
  GpgpResult pushGroup(float opacity) noexcept { return gpgpPushGroup(get(), opacity); }
  /// gpgpPopState
  GpgpResult pop() noexcept { return gpgpPopState(get()); }
  GpgpResult add(const GpgpListShape& shape) noexcept { return gpgpAddShapes(get(), &shape, 1); }
  GpgpResult add(const GpgpListShape* shapes, uint32_t count) noexcept { return gpgpAddShapes(get(), shapes, count); }
  /// gpgpAddText: a GlyphSet, or its C handle.
  GpgpResult add(GpgpAsset glyphSet, const GpgpGlyphInstance* glyphs, uint32_t count, uint64_t id = 0) noexcept {
    return gpgpAddText(get(), glyphSet, glyphs, count, id);
  }
  /// gpgpAddDrawing: a Drawing, or its C handle.
  GpgpResult add(GpgpAsset drawing, uint32_t firstImage = 0, uint64_t id = 0) noexcept {
    return gpgpAddDrawing(get(), drawing, firstImage, id);
  }
};

/// gpgpHitTest; item is GPGP_HIT_NONE where nothing is hit.
inline Result<GpgpHit> hitTest(GpgpContext context, const GpgpHitTestInfo& info) noexcept {
  GpgpHit value = GpgpHit();
  const GpgpResult code = gpgpHitTest(context, &info, &value);
  return Result<GpgpHit>(code, value);
}

class CanvasHistory : public View {
public:
  using View::View;
  static Result<CanvasHistory> create(GpgpContext context, const GpgpCanvasHistoryCreateInfo& info) noexcept {
    return detail::create<CanvasHistory>(gpgpCreateCanvasHistory, context, info);
  }
};

class Canvas : public Recorder {
public:
  using Recorder::Recorder;
  static Result<Canvas> create(GpgpContext context, const GpgpCanvasCreateInfo& info) noexcept {
    return detail::create<Canvas>(gpgpCreateCanvas, context, info);
  }
  [[nodiscard]] GpgpResult recordPrepare(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                         const GpgpCanvasInfo& info) noexcept {
    return gpgpRecordPrepareCanvas(get(), commandBuffer, &frame, &info);
  }
  [[nodiscard]] GpgpResult recordDraw(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                      const GpgpCanvasDrawInfo& info) noexcept {
    return gpgpRecordDrawCanvas(get(), commandBuffer, &frame, &info);
  }
  /// The oldest report not yet taken; GPGP_NOT_READY: none.
  Result<GpgpCanvasReport> report() noexcept { return detail::report(gpgpGetCanvasReport, get()); }
};

// ---------------------------------------------------------------- visibility

class GeometrySet : public Asset {
public:
  using Asset::Asset;
  static Result<GeometrySet> create(GpgpContext context, const GpgpGeometrySetCreateInfo& info) noexcept {
    return detail::create<GeometrySet>(gpgpCreateGeometrySet, context, info);
  }
};

class CameraHistory : public View {
public:
  using View::View;
  static Result<CameraHistory> create(GpgpContext context, const GpgpCameraHistoryCreateInfo& info) noexcept {
    return detail::create<CameraHistory>(gpgpCreateCameraHistory, context, info);
  }
};

class VisibilityRecorder : public Recorder {
public:
  using Recorder::Recorder;
  static Result<VisibilityRecorder> create(GpgpContext context, const GpgpVisibilityRecorderCreateInfo& info) noexcept {
    return detail::create<VisibilityRecorder>(gpgpCreateVisibilityRecorder, context, info);
  }
  [[nodiscard]] GpgpResult recordPrepare(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                         const GpgpVisibilityInfo& info) noexcept {
    return gpgpRecordPrepareVisibility(get(), commandBuffer, &frame, &info);
  }
  [[nodiscard]] GpgpResult recordPrepareMetrics(VkCommandBuffer commandBuffer, const GpgpFrame& frame,
                                                const GpgpVisibilityMetricsInfo& info) noexcept {
    return gpgpRecordPrepareVisibilityMetrics(get(), commandBuffer, &frame, &info);
  }
  /// The oldest report not yet taken; GPGP_NOT_READY: none.
  Result<GpgpVisibilityReport> report() noexcept { return detail::report(gpgpGetVisibilityReport, get()); }
};

// ---------------------------------------------------------------- libgpgp_compiler

/// Bytes from a compiler.
class Blob {
public:
  Blob() noexcept = default;
  explicit Blob(GpgpBlob blob) noexcept : blob_(blob) {}
  Blob(Blob&& other) noexcept : blob_(std::exchange(other.blob_, GpgpBlob())) {}
  Blob& operator=(Blob&& other) noexcept {
    if (this != &other) {
      reset();
      blob_ = std::exchange(other.blob_, GpgpBlob());
    }
    return *this;
  }
  Blob(const Blob&) = delete;
  Blob& operator=(const Blob&) = delete;
  ~Blob() { reset(); }
  const void* data() const noexcept { return blob_.data; }
  size_t size() const noexcept { return blob_.size; }
  void reset() noexcept {
    if (blob_.data) gpgpFreeBlob(&blob_);
  }

private:
  GpgpBlob blob_ = GpgpBlob();
};

inline Result<Blob> compileGrammar(const GpgpGrammarSource& source) noexcept {
  GpgpBlob blob = GpgpBlob();
  const GpgpResult code = gpgpCompileGrammar(&source, &blob);
  return Result<Blob>(code, Blob(blob));
}

/// gpgpLinkGrammars: sources to one grammar.
inline Result<Blob> linkGrammars(const GpgpGrammarSource* sources, uint32_t sourceCount) noexcept {
  GpgpBlob blob = GpgpBlob();
  const GpgpResult code = gpgpLinkGrammars(sources, sourceCount, &blob);
  return Result<Blob>(code, Blob(blob));
}

// ---------------------------------------------------------------- grammars in code (libgpgp_compiler)

/// A value in a grammar: a number, or what a GrammarBuilder made. Sums and comparisons of values are values, too; at
/// least one of the two comes from a builder.
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

/// What a GrammarBuilder's operators return, to be handed to one other operator or rule.
struct GrammarOperator {
  GpgpGrammarOperator id = 0;
};

/// Where shapes go: a name or an operator; { value, name } or { value, operator } in SubDiv and RandomRule.
struct GrammarSuccessor : GpgpGrammarSuccessor {
  GrammarSuccessor(const char* to) noexcept : GpgpGrammarSuccessor{{GPGP_VALUE_NONE, 0}, to, 0} {}
  GrammarSuccessor(GrammarOperator to) noexcept : GpgpGrammarSuccessor{{GPGP_VALUE_NONE, 0}, nullptr, to.id} {}
  GrammarSuccessor(const GrammarValue& before, const char* to) noexcept : GpgpGrammarSuccessor{before.get(), to, 0} {}
  GrammarSuccessor(const GrammarValue& before, GrammarOperator to) noexcept
      : GpgpGrammarSuccessor{before.get(), nullptr, to.id} {}
};
static_assert(sizeof(GrammarSuccessor) == sizeof(GpgpGrammarSuccessor), "lists of them are lists of the C struct");

/// A polygon's corner, from GrammarBuilder::corner.
struct GrammarCorner : GpgpGrammarValue {};
static_assert(sizeof(GrammarCorner) == sizeof(GpgpGrammarValue), "lists of them are lists of the C struct");

enum class Axis : uint32_t { x, y, z };

/// gpgpCreateGrammarBuilder and what takes a builder. Operators read as in the language:
///
///   GrammarBuilder g = *GrammarBuilder::create();
///   g.axiom(GPGP_SHAPE_BOX, "Tower").terminal("Floor Roof", 1, 0);
///   const auto height = g.variable("height", 3);
///   g.rule("Tower", g.subDiv(Axis::y, {{-1, g.repeat(Axis::y, height, "Floor")}, {height * 0.5f, "Roof"}}));
///   auto blob = g.compile();
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
  /// gpgpCompileGrammar. source: all but its text.
  Result<Blob> compile(GpgpGrammarSource source = init<GpgpGrammarSource>()) const noexcept {
    source.builder = get();
    return compileGrammar(source);
  }

  GrammarBuilder& axiom(GpgpShape shape, const char* rule) noexcept {
    gpgpAddAxiom(get(), shape, nullptr, 0, rule);
    return *this;
  }
  /// For dynamic shapes.
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
  Value tag(const char* name) const noexcept { return own(gpgpAddTag(get(), name)); }
  Value shapePos(Axis axis) const noexcept { return own(attribute(GPGP_VALUE_SHAPE_POS_X, axis)); }
  Value shapeSize(Axis axis) const noexcept { return own(attribute(GPGP_VALUE_SHAPE_SIZE_X, axis)); }
  Value shapeNormal(Axis axis) const noexcept { return own(attribute(GPGP_VALUE_SHAPE_NORMAL_X, axis)); }
  Value shapeRotation(Axis axis, Axis component) const noexcept {
    return own(attribute(GPGP_VALUE_SHAPE_ROTATION_XX + 3 * static_cast<uint32_t>(axis), component));
  }
  Value shapeSeed() const noexcept { return own({GPGP_VALUE_SHAPE_SEED, 0}); }
  Value shapeCustomAttribute() const noexcept { return own({GPGP_VALUE_SHAPE_CUSTOM_ATTRIBUTE, 0}); }

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
  Operator compSplit(const Successor& faces) noexcept { return add(GPGP_OPERATOR_COMP_SPLIT, {}, {faces}); }
  Operator compSplit(const Successor& top, const Successor& bottom, const Successor& sides) noexcept {
    return add(GPGP_OPERATOR_COMP_SPLIT, {}, {top, bottom, sides});
  }
  Operator subDiv(Axis axis, Successors parts) noexcept { return add(GPGP_OPERATOR_SUB_DIV, {axisValue(axis)}, parts); }
  /// mode: GPGP_VALUE_ADJUST_TO_FILL, ANCHOR_TO_START or ANCHOR_TO_END
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
  /// kind: one of GPGP_OPERATOR_SET_AS_DYNAMIC_...
  Operator setAsDynamic(GpgpOperatorKind kind, Corners corners, const Successor& to) noexcept {
    return Operator{gpgpAddOperator(get(), kind, corners.begin(), static_cast<uint32_t>(corners.size()), &to, 1)};
  }

private:
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

inline Result<Blob> compileSvg(const GpgpSvgSource& source) noexcept {
  GpgpBlob blob = GpgpBlob();
  const GpgpResult code = gpgpCompileSvg(&source, &blob);
  return Result<Blob>(code, Blob(blob));
}

inline Result<Blob> compileGlyphs(const GpgpGlyphSource& source) noexcept {
  GpgpBlob blob = GpgpBlob();
  const GpgpResult code = gpgpCompileGlyphs(&source, &blob);
  return Result<Blob>(code, Blob(blob));
}

// ---------------------------------------------------------------- text (libgpgp_text)

class Font : public Handle<GpgpFont> {
public:
  using Handle::Handle;
  static Result<Font> create(const GpgpFontCreateInfo& info) noexcept {
    GpgpFont raw = nullptr;
    const GpgpResult code = gpgpCreateFont(&info, &raw);
    return Result<Font>(code, Font(raw));
  }
  Result<GpgpFontInfo> info() const noexcept {
    GpgpFontInfo value = init<GpgpFontInfo>();
    const GpgpResult code = gpgpGetFontInfo(get(), &value);
    return Result<GpgpFontInfo>(code, value);
  }
  Result<uint32_t> glyph(uint32_t character) const noexcept {
    uint32_t value = 0;
    const GpgpResult code = gpgpGetNominalGlyph(get(), character, &value);
    return Result<uint32_t>(code, value);
  }
  /// gpgpGetGlyphClosure
  GpgpResult closure(const GpgpCharacterRange* ranges, uint32_t rangeCount, uint32_t& count,
                     uint32_t* glyphs) const noexcept {
    return gpgpGetGlyphClosure(get(), ranges, rangeCount, &count, glyphs);
  }
  /// gpgpGetGlyphOutline. take: called once with a const GpgpGlyphOutline&.
  template <class Take> GpgpResult outline(const GpgpGlyphOutlineInfo& info, Take&& take) const noexcept {
    auto* taker = std::addressof(take); // of anything that can be called, const ones and functions too
    return gpgpGetGlyphOutline(
        get(), &info,
        [](void* user, const GpgpGlyphOutline* glyph) { (**static_cast<decltype(taker)*>(user))(*glyph); }, &taker);
  }
};

/// A text laid out. Made by a Shaper, which it needs for each new text.
class Layout : public Handle<GpgpLayout> {
public:
  using Handle::Handle;
  /// gpgpSetLayoutText
  GpgpResult set(const GpgpTextInfo& info) noexcept { return gpgpSetLayoutText(get(), &info); }
  Result<GpgpLayoutInfo> info() const noexcept {
    GpgpLayoutInfo value = init<GpgpLayoutInfo>();
    const GpgpResult code = gpgpGetLayoutInfo(get(), &value);
    return Result<GpgpLayoutInfo>(code, value);
  }
  /// gpgpGetSelection
  GpgpResult selection(uint32_t begin, uint32_t end, uint32_t& count, GpgpTextRect* rects) const noexcept {
    return gpgpGetSelection(get(), begin, end, &count, rects);
  }
  Result<GpgpCaret> caret(uint32_t offset, bool trailing = false) const noexcept {
    GpgpCaret value = GpgpCaret();
    const GpgpResult code = gpgpGetCaret(get(), offset, trailing, &value);
    return Result<GpgpCaret>(code, value);
  }
  /// gpgpHitTestLayout
  Result<GpgpTextHit> hitTest(float x, float y) const noexcept {
    GpgpTextHit value = GpgpTextHit();
    const GpgpResult code = gpgpHitTestLayout(get(), x, y, &value);
    return Result<GpgpTextHit>(code, value);
  }
  /// gpgpMoveCaret
  Result<uint32_t> moveCaret(uint32_t offset, GpgpCaretMove move, VkBool32* trailing = nullptr) const noexcept {
    uint32_t value = 0;
    const GpgpResult code = gpgpMoveCaret(get(), offset, move, &value, trailing);
    return Result<uint32_t>(code, value);
  }
};

class Shaper : public Handle<GpgpShaper> {
public:
  using Handle::Handle;
  static Result<Shaper> create(const GpgpShaperCreateInfo& info = init<GpgpShaperCreateInfo>()) noexcept {
    GpgpShaper raw = nullptr;
    const GpgpResult code = gpgpCreateShaper(&info, &raw);
    return Result<Shaper>(code, Shaper(raw));
  }
  /// gpgpCreateLayout
  Result<Layout> layout() const noexcept {
    GpgpLayout raw = nullptr;
    const GpgpResult code = gpgpCreateLayout(get(), &raw);
    return Result<Layout>(code, Layout(raw));
  }
  Result<GpgpShaperReport> report() const noexcept {
    GpgpShaperReport value = init<GpgpShaperReport>();
    const GpgpResult code = gpgpGetShaperReport(get(), &value);
    return Result<GpgpShaperReport>(code, value);
  }
};

} // namespace gpgp

#endif
