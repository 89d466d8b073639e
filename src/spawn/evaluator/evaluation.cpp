#include "spawn/evaluator/evaluation.h"

#include "spawn/schedule/camera.h"
#include "spawn/schedule/measuring.h"

#include <cmath>
#include <limits>
#include <optional>

namespace gpgp::spawn {
using namespace shader;

namespace {
constexpr uint64_t kShapesBetweenQuestions = 65536;

/// The keys and the region of a GpgpEvaluationInfo.
class TerminalFilter final : public Filter {
public:
  TerminalFilter(const GpgpEvaluationInfo& info, std::pmr::memory_resource* memory)
      : byKey_(info.keys != nullptr), keys_(memory), region_(info.region) {
    keys_.reserve(info.keyCount);
    for (uint32_t i = 0; i < info.keyCount; ++i) keys_.emplace_back(info.keys[i][0], info.keys[i][1]);
    std::sort(keys_.begin(), keys_.end());
  }
  bool keeps(const GpgpInstance& instance) const override {
    if (byKey_ && !std::binary_search(keys_.begin(), keys_.end(), std::pair(instance.key[0], instance.key[1])))
      return false;
    if (!region_) return true;
    const GpgpSpawnBounds box = boundsOf(instance);
    for (int axis = 0; axis < 3; ++axis)
      if (!(box.min[axis] <= region_->max[axis] && box.max[axis] >= region_->min[axis])) return false;
    return true;
  }

private:
  const bool byKey_;
  std::pmr::vector<std::pair<uint32_t, uint32_t>> keys_;
  const GpgpSpawnBounds* const region_;
};

/// What all ranges of a derivation share. Only `ended` is written while they run.
struct Task {
  const EvaluatorGrammar& grammar;
  const GpgpEvaluationInfo& info;
  WalkOptions options;
  uint64_t maxShapes;
  GpgpEvaluatedAxiom* axioms;
  const Measuring* measuring; ///< null: nothing is measured
  GpgpAxiomMeasures* measures;
  LinkedColliders linked;
  std::atomic<bool> cancelled{false}, outOfMemory{false};

  bool ended() const {
    return cancelled.load(std::memory_order_relaxed) || outOfMemory.load(std::memory_order_relaxed);
  }
};
} // namespace

GpgpSpawnBounds boundsOf(const GpgpInstance& instance) {
  GpgpSpawnBounds box;
  for (int axis = 0; axis < 3; ++axis) {
    const float* of = instance.transform + 4 * axis;
    const vec4 row(of[0], of[1], of[2], of[3]);
    box.min[axis] = boxLow(row, instance.size[2] == 0);
    box.max[axis] = boxHigh(row, instance.size[2] == 0);
  }
  return box;
}

class AxiomRange final : public Store {
public:
  explicit AxiomRange(std::pmr::memory_resource& memory)
      : memory_(&memory), instances_(&memory), words_(&memory), segments_(&memory), grid_(&memory) {}
  virtual ~AxiomRange() = default;

  void begin(Task& task, uint32_t first, uint32_t count) {
    task_ = &task;
    first_ = first;
    count_ = count;
    instances_.clear();
    words_.clear();
    segments_.clear();
    walker_.emplace(task.grammar.words.data(), task.grammar.program, std::span(task.info.axioms, task.info.axiomCount),
                    task.linked, *this, task.options, nullptr, memory_);
    walker_->next = instances_.next;
    walker_->end = instances_.end;
  }
  /// All of the range's shapes of a phase.
  void runPhase(uint32_t phase) {
    if (phase == 0) {
      for (uint32_t a = first_; a < first_ + count_ && !task_->ended(); ++a)
        runSegment(a, [&] { walker_->deriveAxiom(a); });
      return;
    }
    const std::pmr::vector<Shape> due = walker_->context.begin(phase);
    for (size_t i = 0; i < due.size() && !task_->ended();) {
      const uint32_t axiom = walker_->context.axiomNumber(due[i].axiom);
      runSegment(axiom, [&] {
        for (; i < due.size() && walker_->context.axiomNumber(due[i].axiom) == axiom; ++i) walker_->deriveShape(due[i]);
      });
    }
  }
  void publish(LinkedColliders& linked) { walker_->context.publish(linked); }
  /// Phases put together, by axiom.
  void finish(uint32_t phases) {
    walker_.reset();
    if (phases > 1) gather();
    for (uint32_t a = first_; a < first_ + count_; ++a) {
      GpgpEvaluatedAxiom& axiom = task_->axioms[a];
      axiom.indexCount = axiom.vertexCount / 4 * 6;
      if (axiom.droppedShapes || axiom.unfinishedShapes) axiom.status = GPGP_BUDGET_EXCEEDED;
      if (task_->info.flags & GPGP_EVALUATION_BOUNDS) axiom.bounds = boundsOfAll(axiom);
      if (task_->measuring) task_->measures[a] = measuresOf(axiom);
    }
  }

  void makeRoom(GpgpInstance*& next, GpgpInstance*& end) override {
    instances_.next = next;
    instances_.makeRoom();
    next = instances_.next;
    end = instances_.end;
  }
  uint32_t* addVertices(uint32_t, size_t words) override {
    if (static_cast<size_t>(words_.end - words_.next) < words) words_.makeRoom(words);
    uint32_t* const added = words_.next;
    words_.next += words;
    return added;
  }
  uint64_t goesOn(uint64_t shapes, uint32_t axiom) override {
    if (task_->info.isCancelled && task_->info.isCancelled(task_->info.cancelUserData))
      task_->cancelled.store(true, std::memory_order_relaxed);
    if (task_->ended()) return 0;
    if (shapes < left_) return std::min(left_, shapes + kShapesBetweenQuestions);
    task_->axioms[axiom].status = GPGP_BUDGET_EXCEEDED;
    return 0;
  }

private:
  /// What an axiom became in a phase.
  struct Segment {
    uint32_t axiom, phase;
    const GpgpInstance* instances;
    size_t instanceCount;
    const uint32_t* words;
    size_t wordCount;
  };

  template <class Run> void runSegment(uint32_t number, const Run& run) {
    Walker& walker = *walker_;
    GpgpEvaluatedAxiom& axiom = task_->axioms[number];
    instances_.next = walker.next;
    instances_.begin();
    words_.begin();
    walker.counts = {};
    walker.limit = 0;
    left_ = task_->maxShapes - axiom.shapes;
    run();
    const Counts& counts = walker.counts;
    axiom.terminals += static_cast<uint32_t>(counts.terminals);
    axiom.shapes += static_cast<uint32_t>(counts.shapes);
    axiom.droppedShapes += counts.droppedShapes;
    axiom.unfinishedShapes += counts.unfinishedShapes;
    axiom.depth = std::max(axiom.depth, counts.depth);
    axiom.keyHash[0] += counts.keyHash[0];
    axiom.keyHash[1] += counts.keyHash[1];
    const Segment made{number,
                       walker.context.phase(),
                       instances_.start(),
                       static_cast<size_t>(walker.next - instances_.start()),
                       words_.start(),
                       static_cast<size_t>(words_.next - words_.start())};
    if (task_->grammar.words[kHeaderPhases] <= 1)
      give(made);
    else
      segments_.push_back(made);
  }

  void give(const Segment& made) const {
    GpgpEvaluatedAxiom& axiom = task_->axioms[made.axiom];
    axiom.instances = made.instances;
    axiom.instanceCount = static_cast<uint32_t>(made.instanceCount);
    if (!task_->options.vertices) return;
    axiom.vertices = made.words;
    axiom.vertexCount = static_cast<uint32_t>(made.wordCount / task_->options.vertices->strideWords);
  }

  void gather() {
    std::sort(segments_.begin(), segments_.end(), [](const Segment& a, const Segment& b) {
      return a.axiom != b.axiom ? a.axiom < b.axiom : a.phase < b.phase;
    });
    instances_.next = instances_.end; // nothing that was written may be overwritten
    words_.next = words_.end;
    for (size_t i = 0; i < segments_.size();) {
      Segment whole{segments_[i].axiom, 0, nullptr, 0, nullptr, 0};
      instances_.begin();
      words_.begin();
      for (; i < segments_.size() && segments_[i].axiom == whole.axiom; ++i) {
        append(instances_, segments_[i].instances, segments_[i].instanceCount);
        append(words_, segments_[i].words, segments_[i].wordCount);
        whole.instanceCount += segments_[i].instanceCount;
        whole.wordCount += segments_[i].wordCount;
      }
      whole.instances = instances_.start();
      whole.words = words_.start();
      give(whole);
    }
  }
  template <class T> static void append(Pieces<T>& pieces, const T* from, size_t count) {
    if (!count) return;
    if (static_cast<size_t>(pieces.end - pieces.next) < count) pieces.makeRoom(count);
    std::memcpy(static_cast<void*>(pieces.next), from, count * sizeof(T));
    pieces.next += count;
  }

  static GpgpSpawnBounds boundsOfAll(const GpgpEvaluatedAxiom& axiom) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    GpgpSpawnBounds all{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (uint32_t i = 0; i < axiom.instanceCount; ++i) {
      const GpgpSpawnBounds box = boundsOf(axiom.instances[i]);
      for (int a = 0; a < 3; ++a) {
        all.min[a] = std::min(all.min[a], box.min[a]);
        all.max[a] = std::max(all.max[a], box.max[a]);
      }
    }
    return all;
  }

  GpgpAxiomMeasures measuresOf(const GpgpEvaluatedAxiom& axiom) {
    const Measuring& measuring = *task_->measuring;
    grid_.assign(measuring.gridWords, 0);
    std::array<uint32_t, kMeasuredWords> words{};
    for (uint32_t i = 0; i < axiom.instanceCount; ++i)
      measure(measuring, axiom.instances[i], words.data(), grid_.data());
    const uint32_t* const target = measuring.gridWords ? task_->info.measures->occupancy->target : nullptr;
    return finishMeasures(measuring, target, words.data(), grid_.data());
  }

  std::pmr::memory_resource* const memory_;
  Task* task_ = nullptr;
  uint32_t first_ = 0, count_ = 0;
  uint64_t left_ = 0; // shapes that the axiom may still become
  Pieces<GpgpInstance> instances_;
  Pieces<uint32_t> words_;
  std::pmr::vector<Segment> segments_;
  std::pmr::vector<uint32_t> grid_; // of the axiom that is measured
  std::optional<Walker> walker_;
};

Evaluation::Evaluation(const EvaluatorGrammar& grammar, const GpgpJobSystem& jobs, core::HostMemory& memory)
    : grammar_(grammar), jobs_(jobs), memory_(memory), ranges_(&memory), axioms_(&memory), measures_(&memory),
      indices_(&memory) {}
Evaluation::~Evaluation() = default;

void Evaluation::clear() {
  axioms_.clear();
  measures_.clear();
  result_ = GPGP_EVALUATION_RESULT_INIT;
}

core::Result<void> Evaluation::derive(const GpgpEvaluationInfo& info, const VertexLayout* layout) {
  clear();
  try {
    auto ran = run(info, layout);
    if (!ran) clear();
    return ran;
  } catch (...) {
    clear();
    throw;
  }
}

namespace {
/// What an axiom has that is context: what went wrong with its colliders, and no terminals.
GpgpEvaluatedAxiom contextOf(const GpgpEvaluatedAxiom& derived) {
  GpgpEvaluatedAxiom axiom{};
  axiom.status = derived.status;
  axiom.shapes = derived.shapes;
  axiom.droppedShapes = derived.droppedShapes;
  axiom.unfinishedShapes = derived.unfinishedShapes;
  axiom.depth = derived.depth;
  for (int k = 0; k < 3; ++k) {
    axiom.bounds.min[k] = std::numeric_limits<float>::infinity();
    axiom.bounds.max[k] = -std::numeric_limits<float>::infinity();
  }
  return axiom;
}
} // namespace

core::Result<void> Evaluation::run(const GpgpEvaluationInfo& info, const VertexLayout* layout) {
  axioms_.resize(info.axiomCount, GpgpEvaluatedAxiom{});
  const TerminalFilter filter(info, &memory_);
  const auto view = viewOf(info.camera);
  if (!view) return view.error();
  const auto fields = bindFields(grammar_.graph, {info.fields, info.fieldCount});
  if (!fields) return fields.error();
  Measuring measuring{};
  if (info.measures) {
    const auto checked = measuringOf(*info.measures, static_cast<uint32_t>(grammar_.graph.terminals.size()));
    if (!checked) return checked.error();
    measuring = *checked;
    measures_.resize(info.axiomCount);
    result_.measures = measures_.data();
  }
  Task task{grammar_,
            info,
            {.maxDepth = info.maxDepth ? info.maxDepth : 64,
             .keeps = !(info.flags & GPGP_EVALUATION_COUNT_ONLY),
             .filter = info.keys || info.region ? &filter : nullptr,
             .vertices = layout,
             .view = &*view,
             .fields = &*fields},
            info.maxShapesPerAxiom ? info.maxShapesPerAxiom : 1u << 27,
            axioms_.data(),
            info.measures ? &measuring : nullptr,
            measures_.data(),
            LinkedColliders(&memory_)};
  const uint32_t wanted = info.rangeCount ? info.rangeCount : jobs_.parallelFor ? 64 : 1;
  const uint32_t ranges = std::max(1u, std::min(wanted, info.axiomCount));
  while (ranges_.size() < ranges) ranges_.push_back(core::makeUnique<AxiomRange>(memory_, memory_));
  for (uint32_t r = 0; r < ranges; ++r) {
    const auto firstOf = [&](uint64_t range) { return static_cast<uint32_t>(range * info.axiomCount / ranges); };
    ranges_[r]->begin(task, firstOf(r), firstOf(r + 1) - firstOf(r));
  }
  const auto forAll = [&](void (AxiomRange::*step)(uint32_t), uint32_t argument) -> core::Result<void> {
    struct Work {
      Evaluation* evaluation;
      Task* task;
      void (AxiomRange::*step)(uint32_t);
      uint32_t argument;
    } work{this, &task, step, argument};
    const GpgpJobFn job = [](void* user, uint32_t range) {
      const Work& w = *static_cast<const Work*>(user);
      try {
        ((*w.evaluation->ranges_[range]).*w.step)(w.argument);
      } catch (...) { // nothing is thrown into the engine's jobs
        w.task->outOfMemory.store(true, std::memory_order_relaxed);
      }
    };
    if (jobs_.parallelFor && ranges > 1)
      jobs_.parallelFor(jobs_.userData, ranges, job, &work);
    else
      for (uint32_t r = 0; r < ranges; ++r) job(&work, r);
    if (task.outOfMemory) throw std::bad_alloc();
    if (task.cancelled) return core::makeError(GPGP_CANCELLED, "the derivation was cancelled");
    return {};
  };
  const uint32_t phases = std::max(1u, grammar_.words[kHeaderPhases]);
  for (uint32_t phase = 0; phase < phases; ++phase) {
    if (auto ok = forAll(&AxiomRange::runPhase, phase); !ok) return ok;
    for (uint32_t r = 0; r < ranges; ++r) ranges_[r]->publish(task.linked);
    if (phase + 1 < phases) task.linked.link();
  }
  if (auto ok = forAll(&AxiomRange::finish, phases); !ok) return ok;
  result_.rangeCount = ranges;
  result_.colliders = task.linked.colliders.size();
  for (uint32_t i = info.axiomCount - info.contextCount; i < info.axiomCount; ++i) {
    axioms_[i] = contextOf(axioms_[i]);
    if (info.measures) measures_[i] = {};
  }
  merge();
  return {};
}

void Evaluation::merge() {
  uint32_t quads = 0;
  for (const GpgpEvaluatedAxiom& axiom : axioms_) {
    if (axiom.status != GPGP_SUCCESS) result_.status = axiom.status;
    result_.instances += axiom.instanceCount;
    result_.terminals += axiom.terminals;
    result_.shapes += axiom.shapes;
    result_.droppedShapes += axiom.droppedShapes;
    result_.unfinishedShapes += axiom.unfinishedShapes;
    result_.depth = std::max(result_.depth, axiom.depth);
    result_.keyHash[0] += axiom.keyHash[0];
    result_.keyHash[1] += axiom.keyHash[1];
    quads = std::max(quads, axiom.vertexCount / 4);
  }
  for (uint32_t quad = static_cast<uint32_t>(indices_.size() / 6); quad < quads; ++quad)
    for (const uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) indices_.push_back(4 * quad + corner);
  result_.axiomCount = static_cast<uint32_t>(axioms_.size());
  result_.axioms = axioms_.data();
  result_.indices = indices_.data();
  result_.indexCount = 6 * quads;
}

} // namespace gpgp::spawn
