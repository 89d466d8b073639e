// A .cga program by its operator graph beside the CPU evaluator of .cga files, for tests.
#pragma once
#include "cga_run.h"
#include "grammars.h"
#include "spawn/evaluator/evaluator.h"
#include "spawn/outputs/mesh.h"
#include "spawn/shared/operators.h"
#include "spawn/shared/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace gpgp::spawn::cga {

struct WithGraph {
  std::optional<Program> program;
  std::vector<uint32_t> words; ///< of the baked graph; empty: there is none
  std::string messages;
};

inline WithGraph withGraph(const std::string& text, const std::map<std::string, std::string>& files = {},
                           const std::vector<AttributeValue>& attributes = {}) {
  WithGraph result;
  Messages messages;
  CompileOptions options;
  options.path = "main.cga";
  options.graph = true;
  options.attributes = attributes;
  options.read = [&](const std::string& path, std::string& into) {
    const auto found = files.find(path);
    if (found != files.end()) into = found->second;
    return found != files.end();
  };
  result.program = compile(text, options, messages);
  result.messages = allOf(messages);
  if (!result.program) return result;
  const GraphText& graph = result.program->graph;
  EXPECT_EQ(graph.text.empty(), !graph.why.empty());
  if (!graph.text.empty()) result.words = test::bake(graph.text);
  return result;
}

/// By the CPU evaluator of .cga files.
inline Derivation onTheCpu(const Program& program, const std::vector<Axiom>& lots, std::string* said = nullptr) {
  DeriveOptions options;
  options.keepScopes = true;
  options.threads = 1;
  Messages messages;
  Derivation result = derive(program, lots, options, messages);
  if (said) *said = allOf(messages);
  return result;
}

/// Rectangles of a row, and the same for graphs.
struct Lots {
  std::vector<Axiom> lots;
  std::vector<GpgpAxiom> axioms;
  void add(float x, float z, uint32_t seed) {
    const float at = 100.0f * static_cast<float>(lots.size());
    Axiom axiom = lot(x, z, seed);
    axiom.origin = {at, 0, 0};
    GpgpAxiom same = makeAxiom(x, 0, z, seed, static_cast<uint32_t>(lots.size()));
    same.transform[3] = at + x * 0.5f;
    same.transform[11] = z * 0.5f;
    same.attribute = std::numeric_limits<float>::quiet_NaN();
    lots.push_back(axiom);
    axioms.push_back(same);
  }
};

/// A terminal, by either way.
struct Ended {
  uint32_t axiom, key[2];
  std::string what; ///< name, colour, texture, whether it is a rectangle
  float transform[12];
  auto order() const { return std::tie(axiom, key[0], key[1]); }
};

inline std::string described(const std::string& name, const glm::vec4& color, const std::string& texture, bool isQuad) {
  std::string text = name + " " + texture + (isQuad ? " quad" : " box");
  for (int i = 0; i < 4; ++i) text += " " + std::to_string(static_cast<int>(std::lround(color[i] * 255)));
  return text;
}

inline std::vector<Ended> endsOf(const Derivation& all) {
  std::vector<Ended> ends;
  for (size_t i = 0; i < all.leaves.size(); ++i) {
    const Leaf& leaf = all.leaves[i];
    const LeafScope& s = all.scopes.at(i);
    const shader::uvec2 key = shader::instanceKey(s.key, leaf.axiom);
    Ended end{
        leaf.axiom, {key.x, key.y}, described(all.names[leaf.name], leaf.color, all.names[leaf.texture], s.isQuad), {}};
    for (int row = 0; row < 3; ++row) {
      const float values[4] = {s.x[row], s.y[row], s.z[row], s.centre[row]};
      std::copy(values, values + 4, end.transform + 4 * row);
    }
    ends.push_back(end);
  }
  std::sort(ends.begin(), ends.end(), [](const Ended& a, const Ended& b) { return a.order() < b.order(); });
  return ends;
}

inline std::vector<Ended> endsOf(const std::vector<GpgpInstance>& instances, const GraphText& graph,
                                 std::map<std::string, Report>& reports) {
  std::vector<Ended> ends;
  for (const GpgpInstance& i : instances) {
    const GraphTerminal& terminal = graph.terminals.at(i.terminal);
    if (terminal.isReport) {
      Report& report = reports[terminal.name];
      const double value = static_cast<double>(i.attribute);
      report.least = report.count ? std::min(report.least, value) : value;
      report.most = report.count ? std::max(report.most, value) : value;
      report.sum += value;
      ++report.count;
      continue;
    }
    Ended end{i.axiomId,
              {i.key[0], i.key[1]},
              described(terminal.name, terminal.color, terminal.texture, shader::isFlat(i.shape & 0xff)),
              {}};
    std::copy(i.transform, i.transform + 12, end.transform);
    ends.push_back(end);
  }
  std::sort(ends.begin(), ends.end(), [](const Ended& a, const Ended& b) { return a.order() < b.order(); });
  return ends;
}

/// Empty where both are the same; else the first difference. worst: gets the largest distance of two transforms, by
/// their size. reportError: by which part of it a report may differ.
inline std::string difference(const Derivation& cpu, const std::vector<GpgpInstance>& instances, const GraphText& graph,
                              double& worst, double reportError = 0) {
  std::map<std::string, Report> reports;
  const std::vector<Ended> a = endsOf(cpu), b = endsOf(instances, graph, reports);
  if (a.size() != b.size())
    return std::to_string(a.size()) + " terminals on the CPU, " + std::to_string(b.size()) + " by the graph";
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].order() != b[i].order()) return "other keys, from " + a[i].what + " and " + b[i].what + " on";
    if (a[i].what != b[i].what) return a[i].what + " on the CPU, " + b[i].what + " by the graph";
    for (int t = 0; t < 12; ++t) {
      const double x = static_cast<double>(a[i].transform[t]), y = static_cast<double>(b[i].transform[t]);
      const double error = std::fabs(x - y) / (1 + std::fabs(x));
      worst = std::max(worst, error);
      if (!(error < 1e-4))
        return a[i].what + ": transform[" + std::to_string(t) + "] is " + std::to_string(x) + " on the CPU, " +
               std::to_string(y) + " by the graph";
    }
  }
  for (const auto& [name, report] : cpu.reports) {
    const Report& other = reports[name];
    const auto isSame = [&](double x, double y) { return std::fabs(x - y) <= reportError * std::fabs(x); };
    if (report.count != other.count || !isSame(report.least, other.least) || !isSame(report.most, other.most) ||
        std::fabs(report.sum - other.sum) > 1e-6 * (1 + std::fabs(report.sum)))
      return "report " + name + ": " + std::to_string(report.sum) + " (" + std::to_string(report.count) +
             ") on the CPU, " + std::to_string(other.sum) + " (" + std::to_string(other.count) + ") by the graph";
  }
  return reports.size() == cpu.reports.size() ? std::string() : "other reports";
}

/// Where the triangles of terminals differ from what the instances of the same keys look like: their corners, areas and
/// volumes. Empty: nowhere. Terminals of assets are left out.
inline std::string differenceOfShapes(const Derivation& cpu, const std::vector<GpgpInstance>& instances,
                                      const std::vector<uint32_t>& words, const GraphText& graph) {
  using namespace shader;
  struct Look {
    std::vector<glm::dvec3> corners;
    double area = 0, volume = 0, size = 0;
    void add(const std::array<glm::dvec3, 3>& t, const glm::dvec3& middle) {
      const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
      area += glm::length(normal) / 2;
      volume += glm::dot(normal, t[0] - middle) / 6;
      for (const glm::dvec3& p : t) {
        size = std::max(size, glm::length(p - middle));
        corners.push_back(p);
      }
    }
    double farthest(const Look& other) const { // of its corners from any of the other's
      double most = 0;
      for (const glm::dvec3& p : corners) {
        double least = 1e30;
        for (const glm::dvec3& q : other.corners) least = std::min(least, glm::length(p - q));
        most = std::max(most, least);
      }
      return most;
    }
  };
  std::map<std::tuple<uint32_t, uint32_t, uint32_t>, const GpgpInstance*> found;
  for (const GpgpInstance& i : instances) found[{i.axiomId, i.key[0], i.key[1]}] = &i;
  for (size_t n = 0; n < cpu.leaves.size(); ++n) {
    const Leaf& leaf = cpu.leaves[n];
    const uvec2 key = instanceKey(cpu.scopes.at(n).key, leaf.axiom);
    const GpgpInstance* instance = found[{leaf.axiom, key.x, key.y}];
    if (!instance) return "no instance of " + cpu.names[leaf.name];
    const GraphTerminal& terminal = graph.terminals.at(instance->terminal);
    if (!terminal.asset.empty()) continue;
    const glm::dvec3 middle(cpu.scopes[n].centre);
    Look a, b;
    for (uint32_t i = leaf.firstIndex; i < leaf.firstIndex + leaf.indexCount; i += 3) {
      const auto at = [&](uint32_t k) { return glm::dvec3(cpu.vertices[cpu.indices[i + k]].position); };
      a.add({at(0), at(1), at(2)}, middle);
    }
    const uint32_t type = instance->shape & 0xff;
    const uint32_t geometry = type > kShapeSphere ? instance->shape : type | kQuadPolygon << 8;
    const float* m = instance->transform;
    for (uint32_t quad = 0; quad < meshQuads(words.data(), geometry); ++quad)
      for (uint32_t half = 0; half < 6; half += 3) {
        std::array<glm::dvec3, 3> t;
        for (uint32_t k = 0; k < 3; ++k) {
          const glm::dvec3 p(meshVertex(words.data(), geometry, quad, quadIndex(half + k)).position);
          for (int row = 0; row < 3; ++row)
            t[k][row] = m[4 * row] * p.x + m[4 * row + 1] * p.y + m[4 * row + 2] * p.z + double(m[4 * row + 3]);
        }
        b.add(t, middle);
      }
    const double scale = a.size + 1, far = std::max(a.farthest(b), b.farthest(a));
    if (far > 1e-4 * scale || std::fabs(a.area - b.area) > 1e-4 * scale * scale ||
        std::fabs(a.volume - b.volume) > 1e-4 * scale * scale * scale)
      return cpu.names[leaf.name] + ": corners " + std::to_string(far) + " apart, areas " + std::to_string(a.area) +
             " and " + std::to_string(b.area) + ", volumes " + std::to_string(a.volume) + " and " +
             std::to_string(b.volume);
  }
  return {};
}

/// A random program of what has operators in a graph. Rules call later ones alone, so that it ends; each is for shapes
/// of one form, so that most programs fit.
class RandomProgram {
public:
  explicit RandomProgram(uint32_t seed) : random_(seed) {}

  std::string text() {
    std::string program =
        "attr a = rand(2, 5)\nattr b = 40%: 1.5 35%: 2.25 else: 3\nattr c = 60%: \"#804020\" else: \"#20a0ff\"\n"
        "const d = 1.25\nattr e = case b > 2: rand(1, 2) else: d\nhalf(x) = x / 2\n"
        "pick = 25%: \"#ff0000\" 50%: \"#00ff00\" else: \"#0000ff\"\n";
    const uint32_t rules = 5 + below(5);
    for (uint32_t i = 0; i < rules; ++i) forms_.push_back(i == 0 ? Form::flat : static_cast<Form>(i % 3));
    for (rule_ = 0; rule_ < rules; ++rule_) {
      hasParameters_ = rule_ > 0;
      program += "R" + std::to_string(rule_) + (hasParameters_ ? "(n, c2)" : "") + " --> ";
      const Now now{forms_[rule_], true};
      program += (rule_ && below(4) == 0 ? choice(now) : body(2, now)) + "\n";
    }
    return program;
  }

private:
  enum class Form : uint8_t { flat, box, upright };
  struct Now {
    Form form;
    bool isStill; ///< center knows where the shape was
  };
  uint32_t below(uint32_t n) { return static_cast<uint32_t>(random_() % n); }
  std::string decimal(float low, float high) {
    const uint32_t steps = static_cast<uint32_t>((high - low) * 20);
    const float value = low + 0.05f * static_cast<float>(below(steps + 1));
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.2f", static_cast<double>(value));
    return buffer;
  }
  /// A positive length.
  std::string length() {
    switch (below(9)) {
    case 0: return "a";
    case 1: return "half(b)";
    case 2: return "e * " + decimal(0.5f, 2);
    case 3: return hasParameters_ ? "n" : "d";
    case 4: return "max(0.5, rint(a) - 1)";
    case 5: return "min(b, " + decimal(1, 3) + ")";
    default: return decimal(0.3f, 4);
    }
  }
  std::string drawnLength() { return below(3) ? length() : "rand(" + decimal(0.5f, 1) + ", " + decimal(1, 4) + ")"; }
  std::string size() {
    switch (below(4)) {
    case 0: return "'" + decimal(0.1f, 0.6f);
    case 1: return drawnLength();
    default: return "~" + length();
    }
  }
  std::string groupSize() { return (below(3) ? "~" : "") + length(); }
  std::string axis(Form form) {
    return std::string(1, (form == Form::flat      ? "xz"
                           : form == Form::upright ? "xy"
                                                   : "xyz")[below(form == Form::box ? 3 : 2)]);
  }
  std::string condition() {
    switch (below(7)) {
    case 0: return "scope.sx > " + decimal(1, 8);
    case 1: return "a < 3.5 && scope.sz <= " + decimal(1, 8);
    case 2: return "p(0.4)";
    case 3: return "rand(1) > 0.3 || b == 3";
    case 4: return "c == \"#804020\"";
    case 5: return hasParameters_ ? "n != 2" : "!(b > 2)";
    default: return "floor(scope.sx / d) > 3";
    }
  }
  std::string choice(Now now) {
    if (below(2))
      return "case " + condition() + ": " + body(1, now) + " case " + condition() + ": " + body(1, now) +
             " else: " + body(2, now);
    return "30%: " + body(1, now) + " 12.5%: " + body(1, now) + " else: " + body(2, now);
  }
  std::string rule(Form form) {
    std::vector<uint32_t> later;
    for (uint32_t i = rule_ + 1; i < forms_.size(); ++i)
      if (forms_[i] == form) later.push_back(i);
    if (later.empty() || below(6) == 0) return below(2) ? "Leaf." : "Shed.";
    return "R" + std::to_string(later[below(static_cast<uint32_t>(later.size()))]) + "(" +
           (below(2) ? decimal(1, 3) : std::string("half(a)")) + ", " + (below(2) ? "\"#102030\"" : "c") + ")";
  }
  std::string operation(Now& now) {
    const auto moves = [&](const std::string& text) {
      now.isStill = false;
      return text;
    };
    switch (below(12)) {
    case 0: return moves("t(" + decimal(-1, 1) + ", rand(-1, 1), '" + decimal(0, 1) + ") ");
    case 1:
      return std::string(now.isStill ? "t(0.5, 0, " + decimal(-1, 1) + ") center(xz) " : "") + "s('" +
             decimal(0.2f, 0.9f) + ", '1, '" + decimal(0.2f, 0.9f) + ") " + (now.isStill ? "center(xz) " : "");
    case 2:
      return moves("s(" + length() + ", '" + decimal(0.2f, 1.5f) + ", " +
                   (now.form == Form::upright ? "'1" : drawnLength()) + ") ");
    case 3: return moves("r(0, " + decimal(-90, 90) + ", 0) ");
    case 4: return moves("r(scopeCenter, " + decimal(-20, 20) + ", rand(0, 90), 10) ");
    case 5: return "color(" + std::string(below(2) ? "c" : "\"#ffcc00\"") + ") ";
    case 6: return "color(pick) ";
    case 7: return "report(\"area\", geometry.area) ";
    case 8: return "report(\"n\", " + (below(2) ? std::string("1") : std::string("a + scope.sx")) + ") ";
    case 9: return "set(b, " + decimal(1, 3) + ") ";
    default: return hasParameters_ ? "color(c2) " : "texture(\"wall.png\") ";
    }
  }
  std::string operations(Now& now) {
    std::string text;
    for (uint32_t i = below(3); i > 0; --i) text += operation(now);
    return text;
  }
  std::string split(uint32_t depth, Form form) {
    const Now now{form, true};
    const auto parts = [&](bool isGroup) {
      std::string text;
      for (uint32_t i = 1 + below(3); i > 0; --i)
        text += (text.empty() ? "" : " | ") + (isGroup ? groupSize() : size()) + ": " + body(depth - 1, now);
      return text;
    };
    std::string text = "split(" + axis(form) + ") { ";
    switch (below(4)) {
    case 0: return text + parts(true) + " }*";
    case 1:
      return text + "0.4: " + body(depth - 1, now) + " | { " + parts(true) + " }* | 0.3: " + body(depth - 1, now) +
             " }";
    default: return text + parts(false) + " }";
    }
  }
  std::string components(uint32_t depth) {
    const char* selectors[] = {"front", "back", "left", "right", "top", "bottom",
                               "side",  "all",  "0",    "4",     "-1",  "horizontal"};
    std::string text = "comp(f) { ";
    for (uint32_t i = 1 + below(3); i > 0; --i)
      text += std::string(selectors[below(12)]) + ": " + body(depth - 1, {Form::upright, true}) + (i > 1 ? " | " : "");
    return text + " }";
  }
  std::string body(uint32_t depth, Now now) {
    std::string text = operations(now);
    if (below(4) == 0) {
      Now inner = now;
      text += "[ " + operations(inner) + item(depth, inner) + " ] ";
    }
    if (now.form != Form::box && below(3)) {
      text += std::string("extrude(") + drawnLength() + ") ";
      now.form = Form::box;
      now.isStill = false;
    }
    if (below(4) == 0) {
      text += item(depth, now) + " ";
      text += operations(now);
    }
    if (below(16) == 0) return text + "NIL";
    return below(8) ? text + item(depth, now) : text;
  }
  std::string item(uint32_t depth, Now now) {
    if (depth == 0) return rule(now.form);
    switch (below(6)) {
    case 0:
    case 1: return split(depth, now.form);
    case 2:
    case 3: return components(depth);
    case 4: return "[ s(2, " + length() + ", 1) primitiveCube() " + rule(Form::box) + " ]";
    default: return rule(now.form);
    }
  }

  std::mt19937 random_;
  std::vector<Form> forms_;
  uint32_t rule_ = 0;
  bool hasParameters_ = false;
};

} // namespace gpgp::spawn::cga
