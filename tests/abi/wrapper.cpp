// Compiled, never run, as C++17 and C++20: every member of the headers that gpgp.hpp includes, and that its handles are
// move-only and no larger than the C handles.
#include <gpgp/gpgp.hpp>

#include <type_traits>

namespace {
template <class T> constexpr bool isHandle() {
  return !std::is_copy_constructible_v<T> && !std::is_copy_assignable_v<T> && std::is_nothrow_move_constructible_v<T> &&
         std::is_nothrow_move_assignable_v<T> && std::is_nothrow_default_constructible_v<T> &&
         sizeof(T) == sizeof(void*);
}
static_assert(isHandle<gpgp::Context>() && isHandle<gpgp::Grammar>() && isHandle<gpgp::Spawner>());
static_assert(isHandle<gpgp::Drawing>() && isHandle<gpgp::GlyphSet>() && isHandle<gpgp::Canvas>() &&
              isHandle<gpgp::CanvasHistory>() && isHandle<gpgp::List>());
static_assert(isHandle<gpgp::Atlas>() && isHandle<gpgp::AtlasRecorder>());
static_assert(isHandle<gpgp::GeometrySet>() && isHandle<gpgp::VisibilityRecorder>() && isHandle<gpgp::CameraHistory>());
static_assert(isHandle<gpgp::GrammarBuilder>());
static_assert(isHandle<gpgp::Evaluator>() && isHandle<gpgp::Evaluation>());
static_assert(isHandle<gpgp::Font>() && isHandle<gpgp::Shaper>() && isHandle<gpgp::Layout>());
static_assert(!std::is_copy_constructible_v<gpgp::Blob> && std::is_nothrow_move_constructible_v<gpgp::Blob>);
static_assert(!std::is_convertible_v<gpgp::Grammar, gpgp::Drawing>);

GpgpResult useCore(gpgp::Context& context, const GpgpFrame& frame, VkCommandBuffer cmd) {
  if (const GpgpResult code = context.advance(frame)) return code;
  const auto pending = context.recordUpload(cmd, frame, 1 << 20);
  if (!pending) return pending.code();
  const auto memory = context.memoryReport();
  size_t size = static_cast<size_t>(memory->blockBytes + *pending);
  if (const GpgpResult code = context.pipelineCacheData(size, nullptr)) return code;
  context.notifyDeviceLost();
  gpgp::Context other = std::move(context);
  context = std::move(other);
  return GPGP_SUCCESS;
}

GpgpResult useRecorder(gpgp::Recorder& recorder, const gpgp::Asset& asset) {
  if (const GpgpResult code = recorder.prewarm()) return code;
  if (const GpgpResult code = recorder.prewarm(gpgp::init<GpgpPrewarmInfo>())) return code;
  uint32_t count = 0;
  if (const GpgpResult code = recorder.passes(count, nullptr)) return code;
  const auto scratch = recorder.scratchSize();
  const auto resident = asset.resident();
  return scratch && scratch->size && resident && *resident ? GPGP_SUCCESS : GPGP_NOT_READY;
}

GpgpResult useSpawn(GpgpContext context, const GpgpFrame& frame, VkCommandBuffer cmd) {
  auto blob = gpgp::compileGrammar(gpgp::init<GpgpGrammarSource>());
  if (!blob) return blob.code();
  auto info = gpgp::init<GpgpGrammarCreateInfo>();
  info.data = blob->data();
  info.size = blob->size();
  auto grammar = gpgp::Grammar::create(context, info);
  auto spawner = gpgp::Spawner::create(context, gpgp::init<GpgpSpawnerCreateInfo>());
  if (!grammar || !spawner) return grammar.code();
  uint32_t count = 0;
  if (const GpgpResult code = grammar->terminals(count, nullptr)) return code;
  if (const GpgpResult code = useRecorder(*spawner, *grammar)) return code;
  auto spawn = gpgp::init<GpgpSpawnInfo>();
  spawn.grammar = *grammar;
  if (const GpgpResult code = spawner->recordPrepare(cmd, frame, spawn)) return code;
  while (const auto report = spawner->report())
    if (report->base.status) return report->base.status;
  gpgp::Spawner taken = *std::move(spawner);
  return taken ? GPGP_SUCCESS : GPGP_NOT_READY;
}

GpgpResult useLsystem(GpgpContext context, const GpgpFrame& frame, VkCommandBuffer cmd) {
  auto blob = gpgp::compileLsystem(gpgp::init<GpgpLsystemSource>());
  if (!blob) return blob.code();
  auto info = gpgp::init<GpgpLsystemCreateInfo>();
  info.data = blob->data();
  info.size = blob->size();
  auto lsystem = gpgp::Lsystem::create(context, info);
  auto recorder = gpgp::LsystemRecorder::create(context, gpgp::init<GpgpLsystemRecorderCreateInfo>());
  if (!lsystem || !recorder) return lsystem.code();
  uint32_t count = 0;
  if (const GpgpResult code = lsystem->terminals(count, nullptr)) return code;
  if (const GpgpResult code = lsystem->symbols(count, nullptr)) return code;
  if (const GpgpResult code = useRecorder(*recorder, *lsystem)) return code;
  auto recording = gpgp::init<GpgpLsystemInfo>();
  recording.lsystem = *lsystem;
  if (const GpgpResult code = recorder->recordPrepare(cmd, frame, recording)) return code;
  while (const auto report = recorder->report())
    if (report->base.status) return report->base.status;
  return GPGP_SUCCESS;
}

GpgpResult useGrammarBuilder() {
  auto made = gpgp::GrammarBuilder::create();
  if (!made) return made.code();
  gpgp::GrammarBuilder g = *std::move(made);
  using gpgp::Axis;
  const auto v = g.variable("v", 3);
  const auto all =
      g.random(1, v) + g.shapePos(Axis::x) - g.shapeNormal(Axis::y) * g.shapeRotation(Axis::x, Axis::z) / 2;
  const auto test = (g.shapeSeed() < 0.5 && all > 1) || (v <= 2 && v >= 1) || v == 2 || 3 != v;
  g.axiom(GPGP_SHAPE_DYNAMIC_POLYGON, {g.corner(0, 0), g.corner(v, 0), g.corner(0, 1)}, "A").axiom(GPGP_SHAPE_BOX, "A");
  g.terminal("T U", 1, 0).rule("B", "T");
  g.rule("A", g.subDiv(Axis::x, {{-1, "B"}, {v * 0.5f, g.discard()}, {1, g.generate()}}));
  g.rule("C", g.translate(0, g.shapeSize(Axis::y), 0, g.rotate(0, 90, 0, g.scale(-1, all, -1, g.extrude(2, "A")))));
  g.rule("D", g.swapSize(Axis::y, Axis::x, Axis::z, g.compSplit(g.compSplit("A", "B", "C"))));
  g.rule("E", g.ifElse(test, g.repeat(Axis::y, 1, "A"), g.ifSizeLess(Axis::z, g.shapeCustomAttribute(), "A", "B")));
  g.rule("F", g.randomRule(g.shapeSeed(), {{1, "A"}, {2, g.replicate({"A", "B", g.discard()})}}));
  g.rule("G", g.setAsDynamic(GPGP_OPERATOR_SET_AS_DYNAMIC_CONVEX_POLYGON,
                             {g.corner(0, 0), g.corner(1, 0), g.corner(0, 1)}, "A"));
  g.rule("H", g.resizeCorner(
                  g.min(1, g.shapeSize(Axis::x)), g.max(1, all), g.floor(all, 2),
                  g.growAlong(Axis::y, 3, g.turnCorner(0, 90, 0, g.toFace(0, g.setAttribute(g.noise(all, 1), "A"))))));
  return g.compile().code();
}

GpgpResult useUi(GpgpContext context, const gpgp::GlyphSet& set, const gpgp::Drawing& drawing) {
  auto list = gpgp::List::create(context);
  if (!list) return list.code();
  const float map[6] = {1, 0, 0, 1, 0, 0}, box[4] = {0, 0, 8, 8};
  GpgpListShape shape = GpgpListShape();
  const GpgpGlyphInstance glyph = {1, 0, 0, 12, {0, 0, 0, 1}};
  const GpgpResult codes[] = {list->clear(),
                              list->pushTransform(map),
                              list->pushClip(box),
                              list->pushOpacity(1),
                              list->pushGroup(1),
                              list->add(shape),
                              list->add(&shape, 1),
                              list->add(drawing),
                              list->pop(),
                              list->add(set, &glyph, 1),
                              list->add(set.get(), &glyph, 1)};
  for (const GpgpResult code : codes)
    if (code) return code;
  GpgpCanvasItem item = GpgpCanvasItem();
  item.list = *list;
  auto info = gpgp::init<GpgpHitTestInfo>();
  info.items = &item;
  return gpgp::hitTest(context, info).code();
}

GpgpResult useVector(GpgpContext context, const GpgpFrame& frame, VkCommandBuffer cmd) {
  auto blob = gpgp::compileSvg(gpgp::init<GpgpSvgSource>());
  if (!blob) return blob.code();
  auto drawing = gpgp::Drawing::create(context, gpgp::init<GpgpDrawingCreateInfo>());
  auto canvas = gpgp::Canvas::create(context, gpgp::init<GpgpCanvasCreateInfo>());
  auto history = gpgp::CanvasHistory::create(context, gpgp::init<GpgpCanvasHistoryCreateInfo>());
  if (!drawing || !canvas || !history || !drawing->info()) return drawing.code();
  const auto glyphs = gpgp::GlyphSet::create(context, gpgp::init<GpgpGlyphSetCreateInfo>());
  if (!glyphs) return glyphs.code();
  if (const GpgpResult code = useUi(context, *glyphs, *drawing)) return code;
  auto prepare = gpgp::init<GpgpCanvasInfo>();
  prepare.history = *history;
  if (const GpgpResult code = canvas->recordPrepare(cmd, frame, prepare)) return code;
  auto draw = gpgp::init<GpgpCanvasDrawInfo>();
  draw.history = *history;
  if (const GpgpResult code = canvas->recordDraw(cmd, frame, draw)) return code;
  return canvas->report().code();
}

GpgpResult useTiles(GpgpContext context, const GpgpFrame& frame, VkCommandBuffer cmd) {
  auto set = gpgp::TileSet::create(context, gpgp::init<GpgpTileSetCreateInfo>());
  const auto stride = gpgp::tileStride(nullptr, nullptr);
  if (!set || !stride) return set.code();
  GpgpTile tile = 0;
  if (const GpgpResult code = set->record(cmd, frame, gpgp::init<GpgpTileInfo>(), tile)) return code;
  if (const auto range = set->range(tile); !range) return range.code();
  if (const GpgpResult code = set->trim(tile, 1)) return code;
  if (const GpgpResult code = set->recordFree(cmd, frame, tile)) return code;
  return set->report().code();
}

GpgpResult useEvaluator() {
  auto evaluator = gpgp::Evaluator::create(gpgp::init<GpgpEvaluatorCreateInfo>());
  if (!evaluator) return evaluator.code();
  auto evaluation = evaluator->evaluation();
  if (!evaluation) return evaluation.code();
  uint32_t count = 0;
  if (const GpgpResult code = evaluator->terminals(count, nullptr)) return code;
  if (const GpgpResult code = evaluator->starts(count, nullptr)) return code;
  if (const auto start = evaluator->start("house"); !start) return start.code();
  if (const GpgpResult code = evaluation->derive(gpgp::init<GpgpEvaluationInfo>())) return code;
  return evaluation->result().code();
}

GpgpResult useCga() {
  auto program = gpgp::CgaProgram::create(gpgp::init<GpgpCgaProgramCreateInfo>());
  if (!program) return program.code();
  uint32_t count = 0;
  if (const GpgpResult code = program->attributes(count, nullptr)) return code;
  if (const auto graph = program->graph(nullptr, 0); !graph) return graph.code();
  auto derivation = program->derivation();
  if (!derivation) return derivation.code();
  if (const GpgpResult code = derivation->derive(gpgp::init<GpgpCgaDerivationInfo>())) return code;
  return derivation->result().code();
}

GpgpResult useText() {
  auto font = gpgp::Font::create(gpgp::init<GpgpFontCreateInfo>());
  auto shaper = gpgp::Shaper::create();
  if (!font || !shaper || !font->info() || !shaper->report()) return font.code();
  auto layout = shaper->layout();
  if (!layout) return layout.code();
  const GpgpFont chain[] = {*font};
  auto text = gpgp::init<GpgpTextInfo>();
  text.style.fonts = chain;
  if (const GpgpResult code = layout->set(text)) return code;
  uint32_t count = 0;
  if (const GpgpResult code = layout->selection(0, 1, count, nullptr)) return code;
  const auto hit = layout->hitTest(0, 0);
  if (!hit || !layout->caret(hit->insertion) || !layout->moveCaret(0, GPGP_CARET_NEXT)) return hit.code();
  auto outline = gpgp::init<GpgpGlyphOutlineInfo>();
  outline.glyph = *font->glyph('A');
  uint32_t paths = 0;
  const auto take = [&](const GpgpGlyphOutline& glyph) { paths += glyph.pathCount; };
  if (const GpgpResult code = font->outline(outline, take)) return code;
  return paths ? layout->info().code() : GPGP_NOT_READY;
}

GpgpResult useVisibility(GpgpContext context, const GpgpFrame& frame, VkCommandBuffer cmd) {
  auto set = gpgp::GeometrySet::create(context, gpgp::init<GpgpGeometrySetCreateInfo>());
  auto recorder = gpgp::VisibilityRecorder::create(context, gpgp::init<GpgpVisibilityRecorderCreateInfo>());
  auto history = gpgp::CameraHistory::create(context, gpgp::init<GpgpCameraHistoryCreateInfo>());
  if (!set || !recorder || !history) return set.code();
  auto info = gpgp::init<GpgpVisibilityInfo>();
  info.geometrySet = *set;
  info.history = *history;
  if (const GpgpResult code = recorder->recordPrepare(cmd, frame, info)) return code;
  const auto report = recorder->report();
  gpgpDestroyHistory(history->release());
  return report.name() ? report.code() : GPGP_SUCCESS;
}

GpgpResult useAtlas(GpgpContext context, const GpgpFrame& frame, VkCommandBuffer cmd) {
  auto atlas = gpgp::Atlas::create(context, gpgp::init<GpgpAtlasCreateInfo>());
  auto recorder = gpgp::AtlasRecorder::create(context, gpgp::init<GpgpAtlasRecorderCreateInfo>());
  if (!atlas || !recorder) return atlas.code();
  auto info = gpgp::init<GpgpAtlasInfo>();
  info.atlas = *atlas;
  if (const GpgpResult code = recorder->recordPrepare(cmd, frame, info)) return code;
  return recorder->report().code();
}
} // namespace

GpgpResult useEverything(const GpgpContextCreateInfo& info, VkCommandBuffer cmd);

GpgpResult useEverything(const GpgpContextCreateInfo& info, VkCommandBuffer cmd) {
  auto context = gpgp::Context::create(info);
  if (!context) return context.code();
  const GpgpFrame frame = {1, 0};
  if (const GpgpResult code = useCore(*context, frame, cmd)) return code;
  if (const GpgpResult code = useSpawn(*context, frame, cmd)) return code;
  if (const GpgpResult code = useLsystem(*context, frame, cmd)) return code;
  if (const GpgpResult code = useGrammarBuilder()) return code;
  if (const GpgpResult code = useVector(*context, frame, cmd)) return code;
  if (const GpgpResult code = useEvaluator()) return code;
  if (const GpgpResult code = useCga()) return code;
  if (const GpgpResult code = useTiles(*context, frame, cmd)) return code;
  if (const GpgpResult code = useText()) return code;
  if (const GpgpResult code = useAtlas(*context, frame, cmd)) return code;
  return useVisibility(*context, frame, cmd);
}
