// Gradients: those of boxes with round corners are shapes of the list, conic ones wedges of triangles.
#include "gpgp_srgb.hpp"
#include "writer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gpgp::rmlui {
using integration::linearFromSrgb;
namespace {

constexpr int kSubdivision = 12; // of the curve between two stops: within 1/255 of it

/// Positions at which a straight line between colours begins, within a range.
std::vector<float> positionsOf(const Gradient& gradient, float from, float to) {
  std::vector<float> positions{from};
  for (size_t i = 0; i < gradient.stops.size(); ++i) {
    const float here = gradient.stops[i].position;
    const float next = i + 1 < gradient.stops.size() ? gradient.stops[i + 1].position : here;
    const bool even = i + 1 < gradient.stops.size() && gradient.stops[i].color == gradient.stops[i + 1].color;
    for (int k = 0; k < (next > here && !even ? kSubdivision : 1); ++k) {
      const float at = here + (next - here) * static_cast<float>(k) / kSubdivision;
      if (at > from && at < to) positions.push_back(at);
    }
  }
  positions.push_back(to);
  return positions;
}

} // namespace

std::array<float, 4> colorAt(const Gradient& gradient, float position) {
  std::array<float, 4> color = gradient.stops.front().color;
  for (size_t i = 1; i < gradient.stops.size(); ++i) {
    const float a = gradient.stops[i - 1].position, b = gradient.stops[i].position;
    const float t = b > a ? std::clamp((position - a) / (b - a), 0.0f, 1.0f) : (position < b ? 0.0f : 1.0f);
    const float weight = t * t * (3 - 2 * t);
    for (size_t c = 0; c < 4; ++c) color[c] += (gradient.stops[i].color[c] - color[c]) * weight;
  }
  return color;
}

void Writer::gradient(const Operation& operation) {
  const Geometry& geometry = *operation.geometry;
  const Gradient& gradient = operation.paint->gradient;
  if (geometry.vertices.empty() || gradient.stops.empty()) return;
  const GpgpListVertex& first = geometry.vertices.front();
  const float x = first.x - first.u, y = first.y - first.v; // where gradient space begins
  for (const GpgpListVertex& v : geometry.vertices)
    if (std::abs(v.x - v.u - x) > 0.05f || std::abs(v.y - v.v - y) > 0.05f ||
        !std::equal(v.color, v.color + 4, first.color)) {
      painter_.unsupported("a gradient whose texture coordinates are not pixels, or with colours that differ");
      return;
    }
  const float alpha = static_cast<float>(first.color[3]) / 255;
  const float move[6] = {1, 0, 0, 1, operation.x, operation.y};
  if (geometry.shape) {
    did(list_.pushTransform(move));
    fillGradient(gradient, geometry.shape->box, geometry.shape->radii, x, y, alpha);
    did(list_.pop());
    return;
  }
  if (operation.state.transform && operation.state.transform->projective()) {
    painter_.unsupported("a gradient in perspective whose shape is no box: it is left out");
    return;
  }
  GpgpListLayer layer{};
  layer.opacity = 1;
  layer.maskKind = GPGP_MASK_ALPHA;
  layer.mask = maskOf({ClipOperation::set, operation.geometry, operation.x, operation.y, nullptr});
  did(list_.pushLayer(layer));
  did(list_.pushTransform(move));
  fillGradient(gradient, boundsOf(geometry), {}, x, y, alpha);
  did(list_.pop());
  did(list_.pop());
}

void Writer::fillGradient(const Gradient& gradient, const Box& box, const std::array<float, 4>& radii, float x, float y,
                          float alpha) {
  if (gradient.kind == Gradient::Kind::conic) {
    did(list_.pushClip(box.data(), radii.data()));
    fillConic(gradient, box, x, y, alpha);
    did(list_.pop());
    return;
  }
  const bool radial = gradient.kind == Gradient::Kind::radial;
  float from = gradient.stops.front().position, to = std::max(gradient.stops.back().position, from + 1e-4f);
  GpgpGradient made{};
  made.interpolateSrgb = VK_TRUE;
  std::copy_n(std::array{1.0f, 0.0f, 0.0f, 1.0f, x, y}.data(), 6, made.transform);
  std::vector<float> positions = positionsOf(gradient, from, to);
  float shift = 0; // of circles: by whole periods, or where there are none to their first
  if (radial && gradient.repeating) shift = std::ceil(std::max(0.0f, -from) / (to - from)) * (to - from);
  if (radial && !gradient.repeating && from < 0) {
    to = std::max(to, 1e-4f);
    positions = positionsOf(gradient, from = 0, to);
  }
  if (radial) {
    const float rx = std::max(gradient.extent[0], 1e-4f), ry = std::max(gradient.extent[1], 1e-4f);
    made.kind = GPGP_GRADIENT_RADIAL;
    made.transform[0] = rx;
    made.transform[3] = ry;
    made.transform[4] += gradient.start[0];
    made.transform[5] += gradient.start[1];
    made.startRadius = from + shift;
    made.endRadius = to + shift;
  } else {
    made.kind = GPGP_GRADIENT_LINEAR;
    for (size_t axis = 0; axis < 2; ++axis) {
      made.start[axis] = gradient.start[axis] + gradient.extent[axis] * from;
      made.end[axis] = gradient.start[axis] + gradient.extent[axis] * to;
    }
  }
  made.spread = gradient.repeating ? GPGP_SPREAD_REPEAT : GPGP_SPREAD_PAD;
  std::vector<GpgpGradientStop> stops;
  for (const float at : positions) {
    const std::array<float, 4> color = colorAt(gradient, at);
    GpgpGradientStop& stop = stops.emplace_back();
    stop.offset = std::clamp((at - from) / (to - from), 0.0f, 1.0f);
    for (size_t c = 0; c < 3; ++c)
      stop.color[c] = color[3] > 0 ? linearFromSrgb(std::clamp(color[c] / color[3], 0.0f, 1.0f)) : 0;
    stop.color[3] = std::clamp(color[3], 0.0f, 1.0f);
  }
  // A stop that is not there has no colour of its own.
  for (size_t i = 0; i < stops.size(); ++i)
    if (stops[i].color[3] == 0 && stops.size() > 1) std::copy_n(stops[i > 0 ? i - 1 : 1].color, 3, stops[i].color);
  made.stops = stops.data();
  made.stopCount = static_cast<uint32_t>(stops.size());
  GpgpListShape shape{};
  shape.kind = GPGP_LIST_RECTANGLE;
  std::copy_n(box.begin(), 4, shape.box);
  std::copy_n(radii.begin(), 4, shape.radii);
  std::fill_n(shape.color, 3, 1.0f);
  shape.color[3] = alpha;
  shape.gradient = &made;
  shape.id = GPGP_ID_NOT_HIT;
  did(list_.add(shape));
}

/// Wedges from the centre beyond the box, with an edge at every stop.
void Writer::fillConic(const Gradient& gradient, const Box& box, float x, float y, float alpha) {
  constexpr float kStep = 1.0f / 120; // of a turn
  const float centerX = x + gradient.start[0], centerY = y + gradient.start[1];
  float reach = 0;
  for (int corner = 0; corner < 4; ++corner)
    reach = std::max(reach, std::hypot(box[corner & 1 ? 2 : 0] - centerX, box[corner & 2 ? 3 : 1] - centerY));
  reach = reach * 1.01f + 1;
  const float first = gradient.stops.front().position, last = gradient.stops.back().position;
  const float period = last - first;
  const bool repeating = gradient.repeating && period > 1e-3f;
  Geometry fan;
  const auto corner = [&](float turn, float distance, const std::array<float, 4>& color) {
    const float at = turn * 2 * std::numbers::pi_v<float> + gradient.angle;
    GpgpListVertex& v = fan.vertices.emplace_back();
    v.x = centerX + std::sin(at) * distance;
    v.y = centerY - std::cos(at) * distance;
    for (size_t c = 0; c < 4; ++c)
      v.color[c] = static_cast<uint8_t>(std::lround(std::clamp(color[c] * alpha, 0.0f, 1.0f) * 255));
    fan.indices.push_back(static_cast<uint32_t>(fan.vertices.size() - 1));
  };
  // One period after the other, from turn 0 to 1; minus `offset` a turn is a position of the stops.
  float offset = repeating ? std::floor(-first / period) * period : 0;
  for (bool more = true; more; offset += period) {
    const float from = repeating ? std::max(0.0f, first + offset) : 0,
                to = repeating ? std::min(1.0f, last + offset) : 1;
    more = repeating && last + offset < 1;
    if (to <= from) continue;
    const std::vector<float> positions = positionsOf(gradient, from - offset, to - offset);
    for (size_t i = 0; i + 1 < positions.size(); ++i) {
      const float span = positions[i + 1] - positions[i];
      if (span <= 0) continue;
      const int pieces = std::max(1, static_cast<int>(std::ceil(span / kStep)));
      const auto at = [&](int piece) {
        return positions[i] + span * static_cast<float>(piece) / static_cast<float>(pieces);
      };
      for (int piece = 0; piece < pieces; ++piece) {
        // Just inside both ends: where stops coincide they have a colour on each side.
        const float a = at(piece), b = at(piece + 1), inset = (b - a) * 1e-3f;
        const std::array<float, 4> colorA = colorAt(gradient, a + inset), colorB = colorAt(gradient, b - inset);
        std::array<float, 4> middle{};
        for (size_t c = 0; c < 4; ++c) middle[c] = (colorA[c] + colorB[c]) / 2;
        corner(a + offset, 0, middle);
        corner(a + offset, reach, colorA);
        corner(b + offset, reach, colorB);
      }
    }
  }
  triangles(fan, 0, 0, nullptr);
}

} // namespace gpgp::rmlui
