#include "spawn/codegen/table.h"

#include "spawn/kernel/table_format.h"
#include "spawn/shared/operators.h"

#include <algorithm>
#include <array>
#include <optional>

namespace gpgp::spawn {
namespace {
using namespace shader;

/// Children that a family on a static edge may add: more would fill workgroups with shapes of one kind, and tables.
constexpr uint32_t kMostChildren = 64, kMostSteps = 12, kMostEntries = 128;
/// A family goes through a choice whose successors make on average this share of what most of them make.
constexpr double kBusyShare = 0.8;

/// A component: (a + d * n) * f + c, with n the number that it draws.
struct Term {
  float a = 0, d = 0, c = 0;
  uint32_t factor = kFrameNoFactor;
  bool draws = false; ///< of the whole

  bool isNumber() const { return isFactor() && d == 0; }
  bool isSize() const { return a == 1 && d == 0 && c == 0 && factor != kFrameNoFactor; }
  bool isFactor() const { return c == 0 && factor == kFrameNoFactor; }
};
using Terms = std::array<Term, 3>;
Term sizeTerm(uint32_t code) { return {1, 0, 0, code - kCodeShapeSize}; }
bool isSizeCode(uint32_t code) { return code >= kCodeShapeSize && code < kCodeShapeSize + 3; }

/// a op b in the evaluator's arithmetic, where the form allows it.
std::optional<Term> combine(uint32_t code, const Term& a, const Term& b) {
  switch (code) {
  case kCodeRandom:
    if (a.isNumber() && b.isNumber()) return Term{a.a, subtract(b.a, a.a)};
    break;
  case kCodeMultiply:
    if (a.isSize() && b.isFactor()) return Term{b.a, b.d, 0, a.factor};
    if (b.isSize() && a.isFactor()) return Term{a.a, a.d, 0, b.factor};
    break;
  case kCodeAdd:
    if (b.isNumber() && a.c == 0) return Term{a.a, a.d, b.a, a.factor};
    if (a.isNumber() && b.c == 0) return Term{b.a, b.d, a.a, b.factor};
    break;
  case kCodeSubtract:
    if (b.isNumber() && a.c == 0) return Term{a.a, a.d, -b.a, a.factor};
    break;
  default: break;
  }
  return std::nullopt;
}

class TableMaker {
public:
  TableMaker(const Graph& graph, const std::vector<bool>& waits, bool throughChoices)
      : graph_(graph), waits_(waits), throughChoices_(throughChoices), frames_(graph.nodes.size()),
        extents_(graph.nodes.size()) {}

  KernelTable run() {
    const auto count = static_cast<uint32_t>(graph_.nodes.size());
    table_.family.assign(count, false);
    table_.entered.assign(count, false);
    table_.chooses.assign(count, false);
    table_.words.assign((count + 3) / 4 * 4, 0);
    for (uint32_t n = 0; n < count; ++n) makeFrame(n);
    // In small workgroups, which others have, the copies of a Repeat with all that is behind them are too many at once.
    const bool uneven = isUneven(graph_);
    for (uint32_t n = 0; n < count; ++n)
      if (multipliesByKnown(graph_.nodes[n]) || (uneven && graph_.nodes[n].op == kOpRepeat)) makeFamily(n);
    return std::move(table_);
  }

private:
  /// A run of operators from a node on, and the edge behind it.
  struct Frame {
    uint32_t row = 0; ///< 0: none
    const Edge* edge = nullptr;
  };

  const Edge& edgeOf(uint32_t node, uint32_t index) const { return graph_.edges[graph_.nodes[node].firstEdge + index]; }
  uint32_t here() const { return static_cast<uint32_t>(table_.words.size() / 4); }
  static uint32_t offsetOf(uint32_t node) { return node == kNoNode ? 0 : kHeaderSize + node * kNodeSize; }

  // ---------------------------------------------------------------- frames

  std::optional<Term> termOf(const Parameter& parameter) const {
    if (parameter.kind == kParameterConstant) return Term{uintBitsToFloat(parameter.value)};
    if (parameter.kind == kParameterAttribute)
      return isSizeCode(parameter.value) ? std::optional(sizeTerm(parameter.value)) : std::nullopt;
    std::vector<Term> stack;
    bool draws = false;
    for (uint32_t at = parameter.value; graph_.code[at] != kCodeEnd; ++at) {
      const uint32_t code = graph_.code[at];
      if (code == kCodeNumber) {
        stack.push_back(Term{uintBitsToFloat(graph_.code[++at])});
      } else if (isSizeCode(code)) {
        stack.push_back(sizeTerm(code));
      } else if (code >= kCodeAttributes) {
        return std::nullopt;
      } else {
        const Term b = stack.back();
        stack.pop_back();
        const auto result = combine(code, stack.back(), b);
        if (!result || (code == kCodeRandom && draws)) return std::nullopt; // its second number is none of a frame's
        draws = draws || code == kCodeRandom;
        stack.back() = *result;
      }
    }
    stack.back().draws = draws;
    return stack.back();
  }
  std::optional<Terms> termsOf(uint32_t index) const {
    const Node& node = graph_.nodes[index];
    if (!isOfFrames(node.op)) return std::nullopt;
    Terms terms;
    for (uint32_t i = 0; i < 3; ++i) {
      const auto term = termOf(graph_.parameters[node.firstParameter + i]);
      if (!term || (node.op == kOpRotate && !term->isFactor())) return std::nullopt;
      terms[i] = *term;
    }
    return terms;
  }
  static void put(uint32_t* row, uint32_t at, float x, float y, float z) {
    row[at] = floatBitsToUint(x);
    row[at + 1] = floatBitsToUint(y);
    row[at + 2] = floatBitsToUint(z);
  }
  static void putOperator(uint32_t* row, uint32_t op, const Terms& terms) {
    uint32_t& flags = row[kFrameFlags];
    const uint32_t draws = (terms[0].draws ? 1u : 0u) | (terms[1].draws ? 2u : 0u) | (terms[2].draws ? 4u : 0u);
    flags |= draws * (op == kOpTranslate ? kFrameTranslationDraws
                      : op == kOpRotate  ? kFrameRotationDraws
                                         : kFrameScaleDraws);
    if (op == kOpRotate) {
      flags |= kFrameRotates;
      if (draws) {
        put(row, kFrameRotation, terms[0].a, terms[1].a, terms[2].a);
        put(row, kFrameRotation + 4, terms[0].d, terms[1].d, terms[2].d);
      } else {
        const Rotation r = rotationOf(vec3(terms[0].a, terms[1].a, terms[2].a));
        put(row, kFrameRotation, r.c0.x, r.c0.y, r.c0.z);
        put(row, kFrameRotation + 4, r.c1.x, r.c1.y, r.c1.z);
        put(row, kFrameRotation + 8, r.c2.x, r.c2.y, r.c2.z);
      }
      return;
    }
    const bool scale = op == kOpScale;
    const uint32_t first = scale ? kFrameScale : kFrameTranslation;
    flags |= scale ? kFrameScales : kFrameTranslates;
    if (terms[0].c != 0 || terms[1].c != 0 || terms[2].c != 0) flags |= kFrameAdded;
    put(row, first, terms[0].a, terms[1].a, terms[2].a);
    put(row, first + 4, terms[0].d, terms[1].d, terms[2].d);
    put(row, first + 8, terms[0].c, terms[1].c, terms[2].c);
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t shift = (scale ? 6 : 0) + 2 * i;
      flags = (flags & ~(3u << shift)) | (terms[i].factor << shift);
    }
  }

  void makeFrame(uint32_t first) {
    auto terms = termsOf(first);
    if (!terms) return;
    frames_[first].row = here();
    const size_t start = table_.words.size();
    table_.words.resize(start + kFrameWords);
    uint32_t* row = table_.words.data() + start;
    row[kFrameFlags] = kFrameFactors;
    for (uint32_t at = first;;) {
      const uint32_t op = graph_.nodes[at].op;
      putOperator(row, op, *terms);
      const Edge& edge = edgeOf(at, 0);
      if (edge.target != kNoNode && !edge.recursive && !waits_[edge.target] && graph_.nodes[edge.target].op > op &&
          (terms = termsOf(edge.target))) {
        at = edge.target;
        continue;
      }
      frames_[first].edge = &edge;
      return;
    }
  }
  /// What becomes of a shape that takes an edge.
  uint32_t endOf(const Edge& edge) const {
    if (edge.target == kNoNode) return kEndDiscarded;
    const Node& target = graph_.nodes[edge.target];
    if (target.op == kOpTerminal) return kEndTerminal;
    return waits_[edge.target] || multiplies(target) ? kEndWaits : kEndGoesOn;
  }

  // ---------------------------------------------------------------- families

  /// Calls for each child of such an operator, with its edge and number.
  template <class Call> void forChildren(uint32_t index, const Call& call) const {
    const Node& node = graph_.nodes[index];
    for (uint32_t e = 0; e < node.edgeCount; ++e) {
      const Edge& edge = edgeOf(index, e);
      if (edge.target == kNoNode || !isPart(index, e)) continue;
      if (node.op == kOpCompSplit && e == 2)
        for (uint32_t side = 2; side < 6; ++side) call(edge, side);
      else
        call(edge, e);
    }
  }
  /// Whether a part is there at all.
  bool isPart(uint32_t index, uint32_t number) const {
    const Node& node = graph_.nodes[index];
    if (node.op != kOpSubDiv) return true;
    const uint32_t* division = graph_.divisions.data() + node.division;
    return ((division[kDivisionFixedParts] | division[kDivisionWeightedParts]) >> number) & 1u;
  }
  /// A static edge to operators that are a frame.
  bool isFrame(const Edge& edge) const {
    return !edge.recursive && endOf(edge) == kEndGoesOn && frames_[edge.target].row;
  }
  const Edge& behindFrames(const Edge& first) const {
    const Edge* edge = &first;
    while (isFrame(*edge)) edge = frames_[edge->target].edge;
    return *edge;
  }
  /// A static edge to an operator that a family goes through. The graph has no cycle of edges that are not recursive.
  bool isInner(const Edge& edge) const {
    if (edge.target == kNoNode || edge.recursive || waits_[edge.target]) return false;
    const Node& node = graph_.nodes[edge.target];
    return (throughChoices_ && chooses(node.op)) || multipliesByKnown(node);
  }

  /// What a family's part behind a node takes: children, those that only some choices make included, and entries.
  struct Extent {
    uint32_t children = 0, entries = 0;
  };
  Extent extentOf(const Edge& first) {
    const Edge& edge = behindFrames(first);
    if (edge.target == kNoNode) return {};
    return isInner(edge) ? extentOf(edge.target) : Extent{1, 1};
  }
  Extent extentOf(uint32_t index) {
    Extent& known = extents_[index];
    if (known.entries) return known;
    Extent extent;
    const Node& node = graph_.nodes[index];
    if (chooses(node.op)) {
      uint32_t sum = 0;
      for (uint32_t e = 0; e < node.edgeCount; ++e) {
        const Extent branch = extentOf(edgeOf(index, e));
        extent.children = std::max(extent.children, branch.children);
        extent.entries += branch.entries;
        sum += branch.children;
      }
      extent.entries += extent.children * (1 + node.edgeCount);
      // Where some make far fewer, too many invocations would idle: shapes leave the family before such a choice.
      if (kBusyShare * extent.children * node.edgeCount > sum) extent = {1, 1};
    } else {
      forChildren(index, [&](const Edge& edge, uint32_t) {
        const Extent child = extentOf(edge);
        extent.children += child.children;
        extent.entries += child.entries;
      });
    }
    // Times 32 successors fits.
    return extents_[index] = {std::min(extent.children, 1u << 16), std::clamp(extent.entries, 1u, 1u << 20)};
  }

  struct Step {
    std::array<uint32_t, 4 * kStepSize> words{};
  };
  Step stepOf(uint32_t index, uint32_t number) {
    const Node& node = graph_.nodes[index];
    Step step;
    step.words[0] = node.op;
    step.words[1] = number;
    if (node.op == kOpSubDiv) {
      step.words[0] |= node.argument << kStepAxis;
      const uint32_t* division = graph_.divisions.data() + node.division;
      step.words[2] = division[0];
      if ((division[kDivisionWeightedParts] >> number) & 1u) step.words[0] |= kStepWeighted;
      for (uint32_t i = 0; i < kPartSize; ++i) step.words[4 + i] = division[kDivisionParts + number * kPartSize + i];
    }
    return step;
  }

  struct Child {
    std::vector<Step> steps;
    uint32_t target = 0, end = kEndDiscarded;
    std::vector<Child> branches; ///< by edge, where the last step chooses
  };
  /// What an edge leads to, behind a path of so many steps. most: children that an operator may add.
  std::vector<Child> collect(const Edge& first, std::vector<Step> path, uint32_t most, size_t depth) {
    const Edge* edge = &first;
    while (isFrame(*edge) && path.size() < kMostSteps) {
      if (path.empty() || path.back().words[3]) path.emplace_back();
      path.back().words[3] = frames_[edge->target].row;
      edge = frames_[edge->target].edge;
    }
    if (edge->target == kNoNode) return {};
    depth += path.size();
    if (isInner(*edge) && depth < kMostSteps) {
      const Extent extent = extentOf(edge->target);
      const bool fits = extent.children <= most && extent.entries <= kMostEntries;
      if (fits && chooses(graph_.nodes[edge->target].op)) {
        if (extent.children > 1) return choose(edge->target, std::move(path), most, depth);
      } else if (fits) {
        return multiply(edge->target, path, most / 2, depth);
      }
    }
    Child child;
    child.steps = std::move(path);
    child.target = offsetOf(edge->target) | (edge->recursive ? kEdgeRecursive : 0);
    child.end = endOf(*edge);
    return {std::move(child)};
  }
  std::vector<Child> multiply(uint32_t index, const std::vector<Step>& path, uint32_t most, size_t depth) {
    std::vector<Child> children;
    forChildren(index, [&](const Edge& edge, uint32_t number) {
      std::vector<Step> longer = path;
      longer.push_back(stepOf(index, number));
      for (Child& child : collect(edge, std::move(longer), most, depth - path.size()))
        children.push_back(std::move(child));
    });
    return children;
  }
  /// As many children as the choice that makes most; others discard those beyond theirs.
  std::vector<Child> choose(uint32_t index, std::vector<Step> path, uint32_t most, size_t depth) {
    table_.chooses[index] = true;
    Step step;
    step.words[0] = kOpIf;
    step.words[2] = offsetOf(index);
    path.push_back(step);
    std::vector<Child> children;
    const uint32_t edges = graph_.nodes[index].edgeCount;
    for (uint32_t e = 0; e < edges; ++e) {
      std::vector<Child> branch = collect(edgeOf(index, e), {}, most, depth + 1);
      if (branch.size() > children.size()) children.resize(branch.size());
      for (size_t i = 0; i < branch.size(); ++i) {
        children[i].branches.resize(edges);
        children[i].branches[e] = std::move(branch[i]);
      }
    }
    for (Child& child : children) child.steps = path;
    return children;
  }
  void makeFamily(uint32_t index) {
    const Node& node = graph_.nodes[index];
    const bool repeats = node.op == kOpRepeat;
    std::vector<Child> children;
    if (repeats)
      children = collect(edgeOf(index, 0), {}, kMostChildren / 2, 0);
    else
      children = multiply(index, {}, kMostChildren / 2, 0);
    // One that unites nothing is quicker by the graph's words.
    const auto isAlone = [](const Child& c) { return c.steps.size() == 1 && c.steps[0].words[3] == 0; };
    if (repeats ? children.size() < 2 : std::all_of(children.begin(), children.end(), isAlone)) return;
    const uint32_t row = here();
    table_.words[index] = row;
    table_.family[index] = true;
    table_.repeats = table_.repeats || repeats;
    table_.words.insert(table_.words.end(), {static_cast<uint32_t>(children.size()), repeats, 0, 0});
    place(children);
  }
  /// The number of the code that takes these steps.
  uint32_t programOf(const Child& child) {
    KernelTable::Program program;
    for (const Step& step : child.steps) {
      const uint32_t frame = step.words[3];
      const uint32_t flags = frame ? table_.words[4 * frame + kFrameFlags] : 0;
      uint32_t op = step.words[0];
      if ((op & kStepOperator) == kOpSubDiv && (step.words[2] | step.words[4] | step.words[6])) op |= kStepFixed;
      program.push_back({op, flags});
    }
    const auto at = std::find(table_.programs.begin(), table_.programs.end(), program);
    const auto number = static_cast<uint32_t>(at - table_.programs.begin());
    if (at == table_.programs.end()) table_.programs.push_back(std::move(program));
    return number;
  }
  /// Writes entries, then their steps and what those choose from. Returns where the entries are.
  uint32_t place(const std::vector<Child>& children) {
    const uint32_t at = here();
    table_.words.resize(table_.words.size() + 4 * children.size());
    for (size_t i = 0; i < children.size(); ++i) {
      const Child& child = children[i];
      if (child.end == kEndGoesOn || child.end == kEndWaits)
        table_.entered[((child.target & ~kEdgeRecursive) - kHeaderSize) / kNodeSize] = true;
      const uint32_t first = here();
      const uint32_t entry[] = {first, programOf(child) << kEntryProgram | static_cast<uint32_t>(child.steps.size()),
                                child.target, child.end};
      std::copy_n(entry, 4, table_.words.begin() + 4 * (at + i));
      for (const Step& step : child.steps) {
        table_.stepOperators |= 1u << (step.words[0] & kStepOperator);
        if (step.words[3]) table_.frameFlags |= table_.words[4 * step.words[3] + kFrameFlags];
        table_.words.insert(table_.words.end(), step.words.begin(), step.words.end());
      }
      if (child.branches.empty()) continue;
      const size_t last = table_.words.size() - 4 * kStepSize;
      const uint32_t branches = place(child.branches);
      table_.words[last + 1] = branches;
    }
    return at;
  }

  const Graph& graph_;
  const std::vector<bool>& waits_;
  const bool throughChoices_;
  KernelTable table_;
  std::vector<Frame> frames_;
  std::vector<Extent> extents_; // by node
};
} // namespace

bool multipliesByKnown(const Node& node) {
  return multiplies(node) && !isCutting(node) &&
         (node.op == kOpReplicate || (node.op == kOpSubDiv && node.division != UINT32_MAX) ||
          (node.op == kOpCompSplit && node.shapes == 1u << kShapeBox));
}

KernelTable makeTable(const Graph& graph, const std::vector<bool>& waits, bool throughChoices) {
  return TableMaker(graph, waits, throughChoices).run();
}

} // namespace gpgp::spawn
