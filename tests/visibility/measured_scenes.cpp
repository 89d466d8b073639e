// Generators of the measured scenes; all numbers come from std::mt19937's raw output, which is the same everywhere.
#include "measured_scenes.h"

#include <algorithm>
#include <cmath>
#include <glm/ext/matrix_transform.hpp>
#include <random>

namespace gpgp::test {
namespace {
constexpr float kPi = 3.14159265358979f;

struct Dice {
  std::mt19937 engine;
  explicit Dice(uint32_t seed) : engine(seed) {}
  float unit() { return static_cast<float>(engine() >> 8) * 0x1p-24f; }
  float between(float a, float b) { return a + (b - a) * unit(); }
};

/// Collects the triangles of one mesh.
struct Maker {
  Scene& scene;
  uint32_t firstIndex, firstVertex;
  explicit Maker(Scene& s)
      : scene(s), firstIndex(static_cast<uint32_t>(s.indices.size())),
        firstVertex(static_cast<uint32_t>(s.positions.size() / 3)) {}
  uint32_t vertex(glm::vec3 p) { return scene.addVertex(p.x, p.y, p.z) - firstVertex; }
  void triangle(uint32_t a, uint32_t b, uint32_t c) { scene.indices.insert(scene.indices.end(), {a, b, c}); }
  /// Corners counter-clockwise as seen from outside.
  void quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d) {
    const uint32_t i = vertex(a), j = vertex(b), k = vertex(c), l = vertex(d);
    triangle(i, j, k);
    triangle(i, k, l);
  }
  void box(glm::vec3 low, glm::vec3 high) {
    uint32_t v[8];
    for (uint32_t i = 0; i < 8; ++i)
      v[i] = vertex({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
    for (const auto& f : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 4, 6, 2},
                          std::array{1, 3, 7, 5}, std::array{0, 1, 5, 4}, std::array{2, 6, 7, 3}}) {
      triangle(v[f[0]], v[f[1]], v[f[2]]);
      triangle(v[f[0]], v[f[2]], v[f[3]]);
    }
  }
  /// A wall in the plane through `origin`, `right` and `up`, cut into cells: each with a window of a frame and a pane
  /// that lie deeper.
  void wall(glm::vec3 origin, glm::vec3 right, glm::vec3 up, uint32_t columns, uint32_t rows, Dice& dice) {
    const glm::vec3 in = -glm::normalize(glm::cross(right, up)) * 0.15f;
    for (uint32_t y = 0; y < rows; ++y)
      for (uint32_t x = 0; x < columns; ++x) {
        const glm::vec3 r = right / static_cast<float>(columns), u = up / static_cast<float>(rows);
        const glm::vec3 c = origin + r * static_cast<float>(x) + u * static_cast<float>(y);
        const float a = dice.between(0.2f, 0.3f), b = dice.between(0.7f, 0.8f);
        const auto at = [&](float s, float t) { return c + r * s + u * t; };
        const glm::vec3 outer[4] = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
        const glm::vec3 inner[4] = {at(a, a), at(b, a), at(b, b), at(a, b)};
        for (int i = 0; i < 4; ++i) {
          const int j = (i + 1) % 4;
          quad(outer[i], outer[j], inner[j], inner[i]);
          quad(inner[i], inner[j], inner[j] + in, inner[i] + in);
        }
        const glm::vec3 middle = r * 0.02f, low = inner[0] + in, high = inner[3] + in;
        const glm::vec3 half = (inner[1] - inner[0]) * 0.5f;
        quad(low, low + half - middle, high + half - middle, high); // two panes and the bar between them, in front
        quad(low + half + middle, inner[1] + in, inner[2] + in, high + half + middle);
        quad(low + half - middle - in * 0.3f, low + half + middle - in * 0.3f, high + half + middle - in * 0.3f,
             high + half - middle - in * 0.3f);
      }
  }
  /// A closed tube along y; flutes: how deep its grooves are.
  void column(uint32_t segments, uint32_t rings, float radius, float height, float flutes) {
    std::vector<uint32_t> v;
    for (uint32_t y = 0; y <= rings; ++y)
      for (uint32_t i = 0; i < segments; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / static_cast<float>(segments);
        const float r = radius * (1 + flutes * std::cos(angle * 20));
        v.push_back(vertex(
            {r * std::cos(angle), height * static_cast<float>(y) / static_cast<float>(rings), -r * std::sin(angle)}));
      }
    for (uint32_t y = 0; y < rings; ++y)
      for (uint32_t i = 0; i < segments; ++i) {
        const uint32_t j = (i + 1) % segments;
        const uint32_t a = v[y * segments + i], b = v[y * segments + j];
        const uint32_t c = v[(y + 1) * segments + j], d = v[(y + 1) * segments + i];
        triangle(a, b, c);
        triangle(a, c, d);
      }
  }
  void leaf(glm::vec3 at, float size, Dice& dice) {
    const glm::vec3 axis = glm::normalize(glm::vec3(dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1.01f)));
    const glm::vec3 side = glm::normalize(glm::cross(axis, glm::vec3(0.3f, 0.9f, 0.31f))) * (size * 0.4f);
    quad(at, at + axis * (size * 0.5f) + side, at + axis * size, at + axis * (size * 0.5f) - side);
  }
  uint32_t mesh() { return scene.addMesh(firstIndex, firstVertex); }
};

glm::mat4 placed(glm::vec3 at, float turn = 0, glm::vec3 scale = glm::vec3(1)) {
  return glm::scale(glm::rotate(glm::translate(glm::mat4(1.0f), at), turn, glm::vec3(0, 1, 0)), scale);
}

glm::vec3 transformed(const shader::Draw& draw, const float* p) {
  glm::vec3 r;
  for (int i = 0; i < 3; ++i)
    r[i] = draw.transform[i * 4] * p[0] + draw.transform[i * 4 + 1] * p[1] + draw.transform[i * 4 + 2] * p[2] +
           draw.transform[i * 4 + 3];
  return r;
}
} // namespace

void setOrbitCamera(Scene& scene, uint32_t k, uint32_t n, float distance, uint32_t width, uint32_t height,
                    bool reversed) {
  glm::vec3 low(1e30f), high(-1e30f);
  for (const shader::Draw& draw : scene.draws) {
    const shader::Mesh& mesh = scene.meshes[draw.mesh];
    for (uint32_t i = 0; i < mesh.indexCount; ++i) {
      const glm::vec3 p =
          transformed(draw, &scene.positions[size_t(mesh.vertexOffset + scene.indices[mesh.firstIndex + i]) * 3]);
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }
  const glm::vec3 centre = (low + high) * 0.5f;
  const float radius = glm::length(high - low) * 0.5f, turn = 2 * kPi * static_cast<float>(k) / static_cast<float>(n);
  const float rise = 20 * kPi / 180;
  const glm::vec3 direction(std::cos(rise) * std::sin(turn), std::sin(rise), std::cos(rise) * std::cos(turn));
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  scene.setCamera(
      perspective(kPi / 3, aspect, std::max(distance - 1.2f, 0.01f) * radius, (distance + 1.2f) * radius, reversed) *
          lookAt(centre + direction * (distance * radius), centre),
      width, height, reversed);
}

void setWalkingCamera(Scene& scene, glm::vec3 eye, glm::vec3 target, uint32_t width, uint32_t height, bool reversed) {
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  scene.setCamera(perspective(kPi / 3, aspect, 0.1f, 2000.0f, reversed) * lookAt(eye, target), width, height, reversed);
}

Scene bunnyGrid(uint32_t nx, uint32_t nz) {
  Scene scene = bunny(64, 64);
  scene.draws.clear();
  scene.params.triangleCount = 0;
  Dice dice(5);
  for (uint32_t z = 0; z < nz; ++z)
    for (uint32_t x = 0; x < nx; ++x)
      scene.addDraw(0, placed({static_cast<float>(x) * 1.6f, 0, static_cast<float>(z) * 1.6f}, dice.between(0, 6.28f)));
  return scene;
}

Scene colonnadeWithWires(float detail) {
  Scene scene;
  Dice dice(7);
  const auto n = [&](float v) { return static_cast<uint32_t>(std::max(3.0f, v * detail)); };
  Maker columnMaker(scene);
  columnMaker.column(n(60), n(16), 0.35f, 4.0f, 0.06f);
  const uint32_t column = columnMaker.mesh();
  Maker wireMaker(scene);
  wireMaker.column(4, n(8), 0.006f, 1.0f, 0);
  const uint32_t wire = wireMaker.mesh();
  Maker treeMaker(scene);
  for (uint32_t i = 0, leaves = n(900); i < leaves; ++i) {
    const float turn = dice.between(0, 2 * kPi), up = dice.between(-1, 1), r = std::cbrt(dice.unit());
    const float flat = std::sqrt(1 - up * up);
    treeMaker.leaf(glm::vec3(std::cos(turn) * flat, up + 1.6f, std::sin(turn) * flat) * r, 0.09f / std::sqrt(detail),
                   dice);
  }
  const uint32_t tree = treeMaker.mesh();
  Maker gratingMaker(scene);
  for (uint32_t i = 0, bars = n(40); i < bars; ++i) {
    const float x = static_cast<float>(i) / static_cast<float>(bars), w = 0.3f / static_cast<float>(bars);
    gratingMaker.box({x, 0, 0}, {x + w, 1, w});
    gratingMaker.box({0, x, w}, {1, x + w, 2 * w});
  }
  const uint32_t grating = gratingMaker.mesh();
  Maker groundMaker(scene);
  for (int z = 0; z < 40; ++z)
    for (int x = -10; x < 10; ++x) {
      const auto fx = static_cast<float>(x), fz = static_cast<float>(-z);
      groundMaker.quad({fx * 2, 0, fz * 2 + 4}, {fx * 2 + 2, 0, fz * 2 + 4}, {fx * 2 + 2, 0, fz * 2 + 2},
                       {fx * 2, 0, fz * 2 + 2});
    }
  scene.addDraw(groundMaker.mesh());
  for (int row = 0; row < 20; ++row)
    for (const float side : {-1.0f, 1.0f}) {
      const auto z = static_cast<float>(-3 * row);
      scene.addDraw(column, placed({side * 2.5f, 0, z}, dice.unit()));
      if (row % 4 == 1) scene.addDraw(tree, placed({side * 5, 0.2f, z}, dice.between(0, 6)), shader::kTwoSided);
      if (row % 3 == 2) scene.addDraw(grating, placed({side * 2.5f, 0.2f, z}, kPi / 2, {3, 2.5f, 3}));
      for (int k = 0; k < 6; ++k) { // wires along and across
        const glm::mat4 along =
            glm::rotate(glm::translate(glm::mat4(1.0f), {side * dice.between(0.5f, 2.4f), dice.between(2.5f, 4), z}),
                        k % 2 ? -kPi / 2 : side * (kPi / 2 - dice.between(0, 0.3f)),
                        k % 2 ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1));
        scene.addDraw(wire, glm::scale(along, {1, k % 2 ? 3 : 5, 1}));
      }
    }
  return scene;
}

Scene foliage(uint32_t leaves) {
  Scene scene;
  Dice dice(9);
  Maker hedge(scene);
  for (uint32_t i = 0; i < leaves; ++i)
    hedge.leaf({dice.between(-4, 4), dice.between(0, 3), dice.between(-1, 1)}, dice.between(0.04f, 0.1f), dice);
  scene.addDraw(hedge.mesh(), glm::mat4(1.0f), shader::kTwoSided);
  Maker wall(scene);
  wall.wall({-6, 0, -2}, {12, 0, 0}, {0, 5, 0}, 60, 25, dice);
  wall.quad({-8, 0, 4}, {8, 0, 4}, {8, 0, -4}, {-8, 0, -4});
  scene.addDraw(wall.mesh());
  return scene;
}

Scene city(uint32_t blocks) {
  Scene scene;
  Dice dice(11);
  std::vector<uint32_t> houses;
  for (int kind = 0; kind < 8; ++kind) {
    Maker maker(scene);
    const float w = dice.between(7, 9), d = dice.between(7, 9), h = dice.between(6, 24);
    const auto rows = static_cast<uint32_t>(h / 3) + 1;
    maker.wall({-w / 2, 0, d / 2}, {w, 0, 0}, {0, h, 0}, 4, rows, dice);
    maker.wall({w / 2, 0, d / 2}, {0, 0, -d}, {0, h, 0}, 4, rows, dice);
    maker.wall({w / 2, 0, -d / 2}, {-w, 0, 0}, {0, h, 0}, 4, rows, dice);
    maker.wall({-w / 2, 0, -d / 2}, {0, 0, d}, {0, h, 0}, 4, rows, dice);
    maker.box({-w / 2, h, -d / 2}, {w / 2, h + 0.5f, d / 2});
    maker.box({-w / 4, h, -d / 4}, {0, h + 2.0f, 0});
    houses.push_back(maker.mesh());
  }
  Maker ground(scene);
  const float size = static_cast<float>(blocks) * 12;
  ground.quad({-6, 0, size}, {size, 0, size}, {size, 0, -6}, {-6, 0, -6});
  scene.addDraw(ground.mesh());
  for (uint32_t z = 0; z < blocks; ++z)
    for (uint32_t x = 0; x < blocks; ++x)
      scene.addDraw(houses[dice.engine() % houses.size()],
                    placed({static_cast<float>(x) * 12, 0, static_cast<float>(z) * 12},
                           static_cast<float>(dice.engine() % 4) * kPi / 2, {1, dice.between(0.7f, 1.5f), 1}));
  return scene;
}

Scene houseFronts() {
  Scene scene;
  Maker maker(scene);
  const auto box = [&](glm::vec3 middle, glm::vec3 size) { maker.box(middle - size * 0.5f, middle + size * 0.5f); };
  for (int house = 0; house < 6; ++house) {
    const float z = -16.0f * static_cast<float>(house);
    box({-6, 9, z}, {12, 18, 14});
    box({-6, 17.85f, z}, {12.9f, 0.3f, 14.9f}); // its upper side in the plane of the walls' upper ends
    for (int floor = 0; floor < 5; ++floor) {
      const float y = 3.0f + 3.0f * static_cast<float>(floor);
      box({0, y, z}, {0.24f, 0.18f, 13}); // a ledge, half in the wall
      for (int window = 0; window < 4; ++window) {
        const float at = z - 4.8f + 3.2f * static_cast<float>(window);
        box({0, y + 1.4f, at}, {0.14f, 1.6f, 1.4f});
        for (const float side : {-0.3f, 0.3f})
          maker.quad({0.12f, y + 0.7f, at + side + 0.25f}, {0.12f, y + 0.7f, at + side - 0.25f},
                     {0.12f, y + 2.1f, at + side - 0.25f}, {0.12f, y + 2.1f, at + side + 0.25f});
        box({1.2f, y + 0.55f, at}, {0.07f, 0.07f, 2.6f}); // a rail, and posts with ends in the plane of its lower side
        for (int post = -3; post <= 3; ++post)
          box({1.2f, y + 0.77f, at + 0.4f * static_cast<float>(post)}, {0.05f, 0.51f, 0.05f});
      }
    }
  }
  scene.addDraw(maker.mesh());
  return scene;
}

Scene cropped(const Scene& scene, uint32_t left, uint32_t top, uint32_t width, uint32_t height, float margin) {
  Scene result;
  result.positions = scene.positions;
  result.params = scene.params;
  result.params.triangleCount = 0;
  result.params.width = width;
  result.params.height = height;
  float* matrix = result.params.viewProjection;
  const auto fit = [&](int row, uint32_t whole, uint32_t first, uint32_t part) {
    const float scale = static_cast<float>(whole) / static_cast<float>(part);
    const float shift = scale - 1 - 2 * static_cast<float>(first) / static_cast<float>(part);
    for (int column = 0; column < 4; ++column)
      matrix[column * 4 + row] = scale * matrix[column * 4 + row] + shift * matrix[column * 4 + 3];
  };
  fit(0, scene.params.width, left, width);
  fit(1, scene.params.height, top, height);

  std::array<glm::vec4, 4> planes; // of the sides, in metres
  for (int side = 0; side < 4; ++side) {
    glm::vec4& plane = planes[static_cast<size_t>(side)];
    for (int column = 0; column < 4; ++column)
      plane[column] = matrix[column * 4 + 3] + (side % 2 ? 1.0f : -1.0f) * matrix[column * 4 + side / 2];
    plane /= glm::length(glm::vec3(plane));
  }
  for (const shader::Draw& draw : scene.draws) {
    const shader::Mesh& mesh = scene.meshes[draw.mesh];
    const auto first = static_cast<uint32_t>(result.indices.size());
    for (uint32_t i = 0; i + 2 < mesh.indexCount; i += 3) {
      const uint32_t* corner = &scene.indices[mesh.firstIndex + i];
      std::array<glm::vec4, 3> at;
      for (size_t k = 0; k < 3; ++k)
        at[k] = glm::vec4(transformed(draw, &scene.positions[size_t(mesh.vertexOffset + corner[k]) * 3]), 1);
      const bool outside = std::any_of(planes.begin(), planes.end(), [&](const glm::vec4& plane) {
        return std::all_of(at.begin(), at.end(), [&](const glm::vec4& p) { return glm::dot(plane, p) < -margin; });
      });
      if (!outside) result.indices.insert(result.indices.end(), corner, corner + 3);
    }
    if (result.indices.size() == first) continue;
    const uint32_t own = result.addMesh(first, mesh.vertexOffset);
    shader::Draw& copy = result.addDraw(own);
    std::copy_n(draw.transform, 12, copy.transform);
    copy.flags = draw.flags;
  }
  return result;
}

} // namespace gpgp::test
