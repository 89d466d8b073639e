// Regular polygons, scaled so that each spans [-0.5, 0.5] on both axes, counter-clockwise from the top corner.
#include "spawn/graph/graph.h"

#include <array>

namespace gpgp::spawn {

uint32_t addPolygon(Graph& graph, const float* corners, uint32_t count) {
  const uint32_t number = static_cast<uint32_t>(graph.polygons.size());
  graph.polygons.push_back({static_cast<uint32_t>(graph.vertices.size() / 2), count});
  graph.vertices.insert(graph.vertices.end(), corners, corners + 2 * size_t(count));
  graph.polygons.push_back({static_cast<uint32_t>(graph.vertices.size() / 2), count});
  for (uint32_t i = count; i-- > 0;) {
    graph.vertices.push_back(corners[2 * i]);
    graph.vertices.push_back(0.0f - corners[2 * i + 1]);
  }
  return number;
}

void addRegularPolygons(Graph& graph) {
  static constexpr std::array<float, 6> kTriangle{0.0f, 0.5f, -0.5f, -0.5f, 0.5f, -0.5f};
  static constexpr std::array<float, 8> kQuad{-0.5f, 0.5f, -0.5f, -0.5f, 0.5f, -0.5f, 0.5f, 0.5f};
  static constexpr std::array<float, 10> kPentagon{0.0f,  0.5f,         -0.5f, 0.118033989f, -0.309016994f,
                                                   -0.5f, 0.309016994f, -0.5f, 0.5f,         0.118033989f};
  static constexpr std::array<float, 12> kHexagon{0.0f, 0.5f,  -0.5f, 0.25f,  -0.5f, -0.25f,
                                                  0.0f, -0.5f, 0.5f,  -0.25f, 0.5f,  0.25f};
  static constexpr std::array<float, 14> kHeptagon{0.0f,          0.5f,          -0.400968868f, 0.301937736f, -0.5f,
                                                   -0.143104135f, -0.222520934f, -0.5f,         0.222520934f, -0.5f,
                                                   0.5f,          -0.143104135f, 0.400968868f,  0.301937736f};
  static constexpr std::array<float, 16> kOctagon{
      -0.207106781f, 0.5f,  -0.5f, 0.207106781f,  -0.5f, -0.207106781f, -0.207106781f, -0.5f,
      0.207106781f,  -0.5f, 0.5f,  -0.207106781f, 0.5f,  0.207106781f,  0.207106781f,  0.5f};
  addPolygon(graph, kTriangle.data(), 3);
  addPolygon(graph, kQuad.data(), 4);
  addPolygon(graph, kPentagon.data(), 5);
  addPolygon(graph, kHexagon.data(), 6);
  addPolygon(graph, kHeptagon.data(), 7);
  addPolygon(graph, kOctagon.data(), 8);
}

} // namespace gpgp::spawn
