// Meshes and cameras made by hand; matrices are made here so that tests do not depend on a library's conventions.
#include "scenes.h"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/ext/matrix_transform.hpp>
#include <random>
#include <stdexcept>

namespace gpgp::test {

uint32_t Scene::addVertex(float x, float y, float z) {
  positions.insert(positions.end(), {x, y, z});
  return static_cast<uint32_t>(positions.size() / 3 - 1);
}

uint32_t Scene::addMesh(uint32_t firstIndex, uint32_t vertexOffset) {
  meshes.push_back({firstIndex, static_cast<uint32_t>(indices.size()) - firstIndex, vertexOffset});
  return static_cast<uint32_t>(meshes.size() - 1);
}

shader::Draw& Scene::addDraw(uint32_t mesh, const glm::mat4& transform, uint32_t flags, uint32_t firstTriangle) {
  shader::Draw draw{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) draw.transform[row * 4 + column] = transform[column][row];
  draw.mesh = mesh;
  draw.flags = flags;
  draw.firstTriangle = firstTriangle == UINT32_MAX ? params.triangleCount : firstTriangle;
  params.triangleCount = std::max(params.triangleCount, draw.firstTriangle + meshes[mesh].indexCount / 3);
  draws.push_back(draw);
  return draws.back();
}

void Scene::setCamera(const glm::mat4& viewProjection, uint32_t width, uint32_t height, bool reversed) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) params.viewProjection[column * 4 + row] = viewProjection[column][row];
  params.cameraCount = 1;
  params.width = width;
  params.height = height;
  params.reversedDepth = reversed;
}

void Scene::addCamera(const glm::mat4& viewProjection) {
  float* matrix = params.viewProjection + params.cameraCount++ * 16;
  for (int i = 0; i < 16; ++i) matrix[i] = viewProjection[i / 4][i % 4];
}

visibility::CpuInput Scene::input() {
  if (params.positionFormat == shader::kFloats) {
    positionWords.resize(positions.size());
    for (size_t i = 0; i < positions.size(); ++i) positionWords[i] = std::bit_cast<uint32_t>(positions[i]);
  }
  const auto split = [](const std::vector<glm::dvec3>& places, float* parts) {
    for (size_t i = 0; i < places.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        float* part = parts + i * 8 + static_cast<size_t>(k);
        part[0] = static_cast<float>(places[i][k]);
        part[4] = static_cast<float>(places[i][k] - static_cast<double>(part[0]));
      }
  };
  split(origins, params.origins);
  split(cameraOrigins, params.cameraOrigins);
  params.originCount = static_cast<uint32_t>(origins.size());
  params.hasOrigins = !origins.empty() || !cameraOrigins.empty();
  params.allLayers = 0;
  for (uint32_t i = 0; i < std::max(params.cameraCount, 1u); ++i) {
    const uint32_t layers = params.cameraLayers[i];
    params.allLayers = i && (!layers || !params.allLayers) ? 0 : params.allLayers | layers;
  }
  params.gridShift = 8;
  params.gridX = params.gridY = 128;
  params.drawCount = static_cast<uint32_t>(draws.size());
  params.meshCount = static_cast<uint32_t>(meshes.size());
  if (params.maxItems == 0) params.maxItems = 1u << 22;
  params.indexCount = static_cast<uint32_t>(indices.size());
  params.shortIndices = useShort;
  if (params.cameraCount == 0) params.cameraCount = 1;
  if (params.maxEntries == 0) params.maxEntries = 65536;
  params.hasCommands = !commands.empty();
  params.commandWords = 5;
  params.commandCount = static_cast<uint32_t>(commands.size() / 5);
  params.entryCount =
      params.hasCommands ? params.maxEntries / params.cameraCount * params.cameraCount : params.drawCount;
  params.hasNumbers = !numbers.empty();
  params.numberCount = static_cast<uint32_t>(numbers.size());
  params.drawListCapacity = params.drawCommandCapacity = UINT32_MAX;
  if (params.positionStride == 0) params.positionStride = 12;
  if (params.positionFormat == shader::kFloats)
    params.vertexCount = static_cast<uint32_t>(positions.size() * 4 / params.positionStride);
  if (useShort) {
    shortIndices.assign((indices.size() + 1) / 2, 0);
    for (size_t i = 0; i < indices.size(); ++i) shortIndices[i / 2] |= (indices[i] & 0xffffu) << (i % 2 * 16);
    params.indexCount = static_cast<uint32_t>(shortIndices.size() * 2);
  }
  params.alphaTestCount = static_cast<uint32_t>(textures.size());
  for (size_t i = 0; i < textures.size(); ++i) params.alphaTests[i * 2] = textures[i].cutoff;
  params.textureStride = 8;
  params.textureCount = static_cast<uint32_t>(coordinates.size() / 2);
  coordinateWords.resize(coordinates.size());
  for (size_t i = 0; i < coordinates.size(); ++i) coordinateWords[i] = std::bit_cast<uint32_t>(coordinates[i]);
  const auto alphaAt = [this](uint32_t test, glm::vec2 place) {
    const AlphaTexture& texture = textures[test];
    const auto texel = [](float at, uint32_t size) {
      const float scaled = at * static_cast<float>(size);
      return static_cast<uint32_t>(static_cast<int64_t>(std::floor(scaled)) & int64_t(size - 1)); // powers of two
    };
    const size_t x = texel(place.x, texture.width), y = texel(place.y, texture.height);
    return static_cast<float>(texture.alpha[y * texture.width + x]) / 255.0f;
  };
  return {params,
          positionWords,
          useShort ? shortIndices : indices,
          draws,
          meshes,
          commands,
          numbers,
          coordinateWords,
          alphaAt,
          drawCount,
          {}};
}

glm::mat4 perspective(float fieldOfView, float aspect, float nearPlane, float farPlane, bool reversed) {
  const float f = 1.0f / std::tan(fieldOfView / 2);
  glm::mat4 m(0.0f);
  m[0][0] = f / aspect;
  m[1][1] = -f;
  m[2][3] = -1.0f;
  if (reversed) std::swap(nearPlane, farPlane);
  m[2][2] = farPlane / (nearPlane - farPlane);
  m[3][2] = nearPlane * farPlane / (nearPlane - farPlane);
  return m;
}

glm::mat4 lookAt(glm::vec3 eye, glm::vec3 target) {
  const glm::vec3 back = glm::normalize(eye - target), right = glm::normalize(glm::cross({0, 1, 0}, back));
  const glm::vec3 up = glm::cross(back, right);
  glm::mat4 m(1.0f);
  for (int i = 0; i < 3; ++i) m[i][0] = right[i], m[i][1] = up[i], m[i][2] = back[i];
  m[3] = glm::vec4(-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(back, eye), 1.0f);
  return m;
}

Scene randomSoup(uint32_t seed, uint32_t triangles, uint32_t width, uint32_t height, bool twoSided, bool reversed) {
  Scene scene;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  for (uint32_t i = 0; i < triangles; ++i) {
    const glm::vec3 centre(unit(random) * 6, unit(random) * 6, -3.0f + unit(random) * 9);
    const float size = std::exp2(unit(random) * 5 - 1);
    for (int k = 0; k < 3; ++k) {
      const glm::vec3 p = centre + size * glm::vec3(unit(random), unit(random), unit(random));
      scene.indices.push_back(scene.addVertex(p.x, p.y, p.z));
    }
  }
  const uint32_t mesh = scene.addMesh(0);
  scene.addDraw(mesh, glm::mat4(1.0f), twoSided ? shader::kTwoSided : 0);
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  scene.setCamera(perspective(1.2f, aspect, 0.25f, 20.0f, reversed) * lookAt({0, 0, 3}, {0.3f, 0.1f, 0}), width, height,
                  reversed);
  return scene;
}

Scene sheet(uint32_t seed, uint32_t n, float jitter) {
  Scene scene;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(-jitter, jitter);
  const float step = 2.0f / static_cast<float>(n);
  for (uint32_t y = 0; y <= n; ++y)
    for (uint32_t x = 0; x <= n; ++x) {
      const bool inner = x > 0 && y > 0 && x < n && y < n;
      const float dx = unit(random) * step, dy = unit(random) * step;
      scene.addVertex(-1 + step * static_cast<float>(x) + (inner ? dx : 0),
                      -1 + step * static_cast<float>(y) + (inner ? dy : 0), 0);
    }
  for (uint32_t y = 0; y < n; ++y)
    for (uint32_t x = 0; x < n; ++x) {
      const uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
      if ((x + y) % 2)
        scene.indices.insert(scene.indices.end(), {a, b, d, a, d, c});
      else
        scene.indices.insert(scene.indices.end(), {a, b, c, b, d, c});
    }
  scene.addMesh(0);
  return scene;
}

namespace {
/// A box from -1 to 1 as a mesh.
uint32_t addBox(Scene& scene) {
  const auto firstIndex = static_cast<uint32_t>(scene.indices.size());
  const auto firstVertex = static_cast<uint32_t>(scene.positions.size() / 3);
  for (int i = 0; i < 8; ++i) scene.addVertex(i & 1 ? 1.0f : -1.0f, i & 2 ? 1.0f : -1.0f, i & 4 ? 1.0f : -1.0f);
  for (const uint32_t i :
       {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3})
    scene.indices.push_back(i);
  return scene.addMesh(firstIndex, firstVertex);
}
} // namespace

Scene colonnade(uint32_t width, uint32_t height) {
  Scene scene;
  const uint32_t box = addBox(scene);
  const glm::mat4 one(1.0f);
  scene.addDraw(box,
                glm::scale(glm::translate(one, {0, -1.1f, 0}), {40, 0.1f, 40})); // ground, through the camera's plane
  for (int row = 0; row < 12; ++row)
    for (const float side : {-2.0f, 2.0f}) {
      const auto z = static_cast<float>(-3 * row);
      scene.addDraw(box, glm::scale(glm::translate(one, {side, 0.5f, z}), {0.3f, 1.5f, 0.3f}));
      scene.addDraw(box, glm::scale(glm::translate(one, {0, 2.0f + 0.1f * static_cast<float>(row), z}),
                                    {-2.0f, 0.004f, 0.004f})); // a wire; mirrored
    }
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  scene.setCamera(perspective(1.0f, aspect, 0.1f, 100.0f) * lookAt({0.4f, 0.3f, 4}, {0, 0.3f, -10}), width, height);
  return scene;
}

Scene bunny(uint32_t width, uint32_t height) {
  const char* data = std::getenv("GPGP_TEST_DATA"); // for programs that run elsewhere than they were built
  const std::string path = std::string(data ? data : GPGP_TEST_DATA) + "/fetched/models/bunny.obj";
  std::ifstream file(path);
  if (!file) throw std::runtime_error("cannot read " + path + "; run tests/data/fetch.sh --only models");
  Scene scene;
  for (std::string line; std::getline(file, line);) {
    float x, y, z;
    unsigned a, b, c;
    if (std::sscanf(line.c_str(), "v %f %f %f", &x, &y, &z) == 3)
      scene.addVertex(x, y, z);
    else if (std::sscanf(line.c_str(), "f %u %u %u", &a, &b, &c) == 3)
      scene.indices.insert(scene.indices.end(), {a - 1, b - 1, c - 1});
  }
  scene.addDraw(scene.addMesh(0));
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  scene.setCamera(perspective(1.0f, aspect, 0.1f, 100.0f) * lookAt({1, 1, 3}, {0, 0, 0}), width, height);
  return scene;
}

} // namespace gpgp::test
