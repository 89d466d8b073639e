// Sample grammars that are derived anew for a camera, on the CPU, and a small rasteriser of their instances: what
// levels of detail look like is compared pixel by pixel. For popping_test and popping_bench.
#pragma once
#include <gpgp/detail.hpp>
#include <gpgp/evaluator.hpp>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace gpgp::test {

constexpr int kWidth = 256, kHeight = 160, kTile = 8;

/// Of each pixel the material that is seen (GpgpGrammarTerminal::index) and 1, 0 where there is none.
using Picture = std::vector<uint8_t>;

struct Eye {
  glm::vec3 from, to;

  glm::mat4 matrix() const {
    return glm::perspective(glm::radians(50.0f), float(kWidth) / kHeight, 0.1f, 1000.0f) *
           glm::lookAt(from, to, glm::vec3(0, 1, 0));
  }
};

/// Whether an instance keeps a pixel: as many as its share says, the same ones in every frame.
inline bool keeps(const GpgpInstance& instance, int x, int y) {
  uint32_t h = instance.key[0] ^ (uint32_t(x) * 0x9e3779b1u) ^ (uint32_t(y) * 0x85ebca77u);
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return float((h ^ (h >> 15)) >> 8) / 16777216.0f < instance.attribute;
}

/// Boxes, and polygons as quads; other shapes as their boxes.
class Rasteriser {
public:
  Rasteriser(const glm::mat4& matrix, const std::vector<uint8_t>& materials) : matrix_(matrix), materials_(materials) {}
  void draw(const GpgpInstance& instance) {
    std::array<glm::vec4, 8> corners;
    const float* t = instance.transform;
    const bool flat = instance.shape < GPGP_SHAPE_PRISM3;
    for (int c = 0; c < 8; ++c) {
      const glm::vec4 p(c & 1 ? 0.5f : -0.5f, c & 2 ? 0.5f : -0.5f, flat ? 0.0f : c & 4 ? 0.5f : -0.5f, 1);
      glm::vec4 world(1);
      for (int row = 0; row < 3; ++row)
        world[row] = t[4 * row] * p.x + t[4 * row + 1] * p.y + t[4 * row + 2] * p.z + t[4 * row + 3];
      corners[size_t(c)] = matrix_ * world;
    }
    static constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                         {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
    for (int face = 0; face < (flat ? 1 : 6); ++face)
      quad(instance, {corners[size_t(kFaces[face][0])], corners[size_t(kFaces[face][1])],
                      corners[size_t(kFaces[face][2])], corners[size_t(kFaces[face][3])]});
  }
  Picture picture = Picture(kWidth * kHeight, 0);

private:
  /// What lies in front of the camera.
  void quad(const GpgpInstance& instance, const std::array<glm::vec4, 4>& corners) {
    constexpr float kNear = 0.1f;
    std::array<glm::vec4, 5> kept;
    size_t count = 0;
    for (size_t i = 0; i < 4; ++i) {
      const glm::vec4 &a = corners[i], &b = corners[(i + 1) % 4];
      const auto add = [&](const glm::vec4& clip) {
        kept[count++] = {(clip.x / clip.w * 0.5f + 0.5f) * kWidth, (0.5f - clip.y / clip.w * 0.5f) * kHeight,
                         clip.z / clip.w, 0};
      };
      if (a.w >= kNear) add(a);
      if ((a.w >= kNear) != (b.w >= kNear)) add(a + (b - a) * ((kNear - a.w) / (b.w - a.w)));
    }
    for (size_t i = 2; i < count; ++i) triangle(instance, kept[0], kept[i - 1], kept[i]);
  }
  void triangle(const GpgpInstance& instance, const glm::vec4& a, const glm::vec4& b, const glm::vec4& c) {
    const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area == 0) return;
    const auto clamped = [](float v, int most) { return int(std::clamp(std::floor(v), 0.0f, float(most))); };
    const int left = clamped(std::min({a.x, b.x, c.x}), kWidth), right = clamped(std::max({a.x, b.x, c.x}) + 1, kWidth);
    const int top = clamped(std::min({a.y, b.y, c.y}), kHeight),
              bottom = clamped(std::max({a.y, b.y, c.y}) + 1, kHeight);
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) {
        const float px = float(x) + 0.5f, py = float(y) + 0.5f;
        const float u = ((b.x - px) * (c.y - py) - (c.x - px) * (b.y - py)) / area;
        const float v = ((c.x - px) * (a.y - py) - (a.x - px) * (c.y - py)) / area;
        if (u < 0 || v < 0 || u + v > 1) continue;
        const float depth = u * a.z + v * b.z + (1 - u - v) * c.z;
        const size_t at = size_t(y) * kWidth + size_t(x);
        if (depth >= depths_[at] || !keeps(instance, x, y)) continue;
        depths_[at] = depth;
        picture[at] = materials_[instance.terminal];
      }
  }
  const glm::mat4 matrix_;
  const std::vector<uint8_t>& materials_; ///< by terminal, and 1
  std::vector<float> depths_ = std::vector<float>(kWidth * kHeight, 1e9f);
};

/// A grammar file with some variables, and axioms.
class WalkScene {
public:
  WalkScene(const std::string& file, std::vector<GpgpVariable> variables, std::vector<GpgpAxiom> axioms)
      : axioms_(std::move(axioms)) {
    std::ifstream in(file, std::ios::binary);
    text_.assign(std::istreambuf_iterator<char>(in), {});
    auto source = gpgp::init<GpgpGrammarSource>();
    source.name = file.c_str();
    source.text = text_.data();
    source.size = text_.size();
    source.variables = variables.data();
    source.variableCount = uint32_t(variables.size());
    auto info = gpgp::init<GpgpEvaluatorCreateInfo>();
    info.sources = &source;
    info.sourceCount = 1;
    evaluator_ = *gpgp::Evaluator::create(info);
    evaluation_ = *evaluator_.evaluation();
    uint32_t count = 0;
    if (evaluator_.terminals(count, nullptr) < 0) throw std::runtime_error("gpgpGetEvaluatorTerminals");
    std::vector<GpgpGrammarTerminal> terminals(count);
    if (evaluator_.terminals(count, terminals.data()) < 0) throw std::runtime_error("gpgpGetEvaluatorTerminals");
    for (const GpgpGrammarTerminal& terminal : terminals) materials_.push_back(uint8_t(1 + terminal.index));
  }

  GpgpSpawnCamera cameraOf(const Eye& eye, float detail, uint32_t height = kHeight) const {
    const glm::mat4 matrix = eye.matrix();
    GpgpSpawnCamera camera{};
    for (int i = 0; i < 16; ++i) camera.viewProjection[i] = matrix[i / 4][i % 4];
    for (int i = 0; i < 3; ++i) camera.position[i] = eye.from[i];
    camera.height = height;
    camera.detail = detail;
    return camera;
  }
  /// What a camera sees with this detail. The instances are those of the last derivation.
  GpgpEvaluationResult derive(const Eye& eye, float detail = 1, uint32_t height = kHeight) {
    const GpgpSpawnCamera camera = cameraOf(eye, detail, height);
    auto info = gpgp::init<GpgpEvaluationInfo>();
    info.axioms = axioms_.data();
    info.axiomCount = uint32_t(axioms_.size());
    info.camera = &camera;
    if (evaluation_.derive(info) != GPGP_SUCCESS) throw std::runtime_error("gpgpEvaluate");
    return *evaluation_.result();
  }
  Picture from(const Eye& eye, float detail = 1) {
    const GpgpEvaluationResult result = derive(eye, detail);
    Rasteriser rasteriser(eye.matrix(), materials_);
    for (uint32_t a = 0; a < result.axiomCount; ++a)
      for (uint32_t i = 0; i < result.axioms[a].instanceCount; ++i) rasteriser.draw(result.axioms[a].instances[i]);
    last = result.terminals;
    instances += last;
    return std::move(rasteriser.picture);
  }
  uint64_t instances = 0, last = 0; ///< drawn: all, and in the last picture

private:
  std::string text_;
  gpgp::Evaluator evaluator_;
  gpgp::Evaluation evaluation_;
  std::vector<GpgpAxiom> axioms_;
  std::vector<uint8_t> materials_; ///< by terminal, and 1
};

inline GpgpAxiom axiomAt(glm::vec3 foot, glm::vec3 size, uint32_t seed) {
  GpgpAxiom axiom{};
  axiom.transform[0] = axiom.transform[5] = axiom.transform[10] = 1;
  axiom.transform[3] = foot.x;
  axiom.transform[7] = foot.y + size.y / 2;
  axiom.transform[11] = foot.z;
  for (int i = 0; i < 3; ++i) axiom.size[i] = size[i];
  axiom.seed = seed;
  axiom.start = GPGP_AXIOM_DEFAULT_START;
  return axiom;
}

/// Rows of trees, the first one at z = 0.
inline std::vector<GpgpAxiom> woodAxioms() {
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 25; ++i)
    axioms.push_back(axiomAt({11 * (float(i % 5) - 2), 0, -9 * float(i / 5)}, {7, 10, 7}, 100 + i)); // NOLINT: rows
  return axioms;
}
/// Blocks, the streets of the middle column along x = 0.
inline std::vector<GpgpAxiom> townAxioms() {
  std::vector<GpgpAxiom> axioms;
  for (uint32_t i = 0; i < 20; ++i)
    axioms.push_back(
        axiomAt({27.5f + 64 * (float(i % 4) - 2), 0, -32 - 64 * float(i / 4)}, {64, 40, 64}, 300 + i)); // NOLINT: rows
  return axioms;
}

/// Where to walk.
struct Place {
  const char* name;
  std::string file;
  std::vector<GpgpAxiom> axioms;
  uint32_t budget;         ///< instances, fewer than a part of the walk has
  Eye (*walk)(float part); ///< from 0 to 1
};
/// Towards the wood, and from the fields through the town's middle street. folder: samples/world.
inline std::vector<Place> walkPlaces(const std::string& folder) {
  return {{"wood", folder + "/wood.pga", woodAxioms(), 1500,
           [](float part) {
             return Eye{{1.3f, 2, 160 - 150 * part}, {0, 3, -20}};
           }},
          {"town", folder + "/town.pga", townAxioms(), 1100, [](float part) {
             return Eye{{0, 1.7f, 150 - 270 * part}, {2, 4, 90 - 270 * part}};
           }}};
}

/// Pixels of each tile that two pictures show differently.
inline std::vector<int> changed(const Picture& a, const Picture& b) {
  std::vector<int> tiles(size_t(kWidth / kTile) * (kHeight / kTile));
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const size_t at = size_t(y) * kWidth + size_t(x);
      tiles[size_t(y / kTile) * (kWidth / kTile) + size_t(x / kTile)] += a[at] != b[at];
    }
  return tiles;
}

/// Pixels from where one picture shows something to the nearest place where the other shows the same: the farthest
/// such. outlines: something is as good as the same.
inline int farthest(const Picture& from, const Picture& to, bool outlines) {
  int worst = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const uint8_t shown = from[size_t(y) * kWidth + size_t(x)];
      if (!shown) continue;
      for (int reach = 0;; ++reach) { // squares around the pixel
        bool found = false;
        for (int dy = -reach; dy <= reach && !found; ++dy)
          for (int dx = -reach; dx <= reach && !found; dx += std::abs(dy) == reach ? 1 : std::max(2 * reach, 1)) {
            const int u = x + dx, v = y + dy;
            if (u < 0 || v < 0 || u >= kWidth || v >= kHeight) continue;
            const uint8_t there = to[size_t(v) * kWidth + size_t(u)];
            found = outlines ? there != 0 : there == shown;
          }
        if (found || reach > kWidth) {
          worst = std::max(worst, reach);
          break;
        }
      }
    }
  return worst;
}

/// What changes on a walk from one frame to the next, beyond what the finest level changes by.
struct Walk {
  int worstTile = 0;         ///< pixels of a tile that change, beyond the finest level's change
  uint64_t tilesThatPop = 0; ///< in which a quarter of the pixels does
  Picture before;

  void add(Picture now, const std::vector<int>& finest) {
    if (!before.empty()) {
      const std::vector<int> tiles = changed(before, now);
      for (size_t i = 0; i < tiles.size(); ++i) {
        worstTile = std::max(worstTile, tiles[i] - finest[i]);
        tilesThatPop += tiles[i] - finest[i] >= kTile * kTile / 4;
      }
    }
    before = std::move(now);
  }
};

} // namespace gpgp::test
