// splitAndSetbackPerimeter: parts of a face's perimeter, each set back by a depth of its own.
#include "spawn/cga/deriver.h"
#include "spawn/cga/split_layout.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace gpgp::spawn::cga {

namespace {

constexpr size_t kMostParts = 100'000; // of one perimeter

/// Parts of the perimeter, by their bodies, with the chunks of their depths; least: the first value that is a size.
void depthsOf(const uint32_t* words, uint32_t table, std::unordered_map<uint32_t, uint32_t>& depths, uint32_t& least) {
  std::vector<uint32_t> bodies, values;
  for (uint32_t i = 0; i < words[table]; ++i) {
    const uint32_t record = words[table + 1 + i], selector = words[record + kCgaPartSelector];
    const uint32_t body = words[record + kCgaPartBody];
    if (words[record + kCgaPartKind] >= kCgaPartGroup) {
      depthsOf(words, body, depths, least);
    } else if (selector == kCgaNoSelector) {
      values.push_back(body);
    } else {
      bodies.push_back(body);
      least = std::min(least, selector);
    }
  }
  for (size_t i = 0; i < values.size(); ++i) depths[bodies[i]] = values[i];
}

/// The edges of a face from one of them on, around its loop and then around the others; only those of the mask.
std::vector<uint32_t> chainOf(MeshPool& pool, uint32_t mesh, uint32_t face, uint32_t firstEdge,
                              const std::function<bool(uint32_t)>& isSelected) {
  std::vector<uint32_t> chain;
  const auto add = [&](const Loop& loop, uint32_t begin) {
    for (uint32_t i = 0; i < loop.corners; ++i) {
      const uint32_t corner = loop.firstCorner + (begin - loop.firstCorner + i) % loop.corners;
      if (isSelected(corner)) chain.push_back(corner);
    }
  };
  const Face f = faceOf(pool, mesh, face);
  for (const bool isFirst : {true, false})
    for (uint32_t l = 0; l < f.loops; ++l) {
      const Loop loop = loopOf(pool, mesh, f.firstLoop + l);
      const bool isHere = firstEdge >= loop.firstCorner && firstEdge < loop.firstCorner + loop.corners;
      if (isHere == isFirst) add(loop, isHere ? firstEdge : loop.firstCorner);
    }
  return chain;
}

} // namespace

bool Deriver::splitAndSetbackPerimeter_(const Arguments& a, uint32_t table, uint32_t base) {
  if (shape_.form.mesh == 0) return true;
  std::unordered_map<uint32_t, uint32_t> depths;
  uint32_t values = a.count; // that are no sizes
  depthsOf(words_, table, depths, values);
  const Shape whole = shape_;
  const uint32_t mesh = whole.form.mesh;
  std::vector<bool> mask;
  if (values > 2)
    for (const CgaValue& v : arrayOf(a[2]).values) mask.push_back(cgaIsTrue(v));
  std::vector<Form> rests;
  for (uint32_t face = 0; face < meshFaces(pool_, mesh); ++face) {
    const Loop corners = faceCorners(pool_, mesh, face);
    const float first = values > 1 ? std::floor(std::clamp(number(a[1]), -1e6f, 1e6f)) : 0.0f;
    const int64_t count = corners.corners, index = ((static_cast<int64_t>(first) % count) + count) % count;
    const std::vector<uint32_t> chain =
        chainOf(pool_, mesh, face, corners.firstCorner + static_cast<uint32_t>(index),
                [&](uint32_t corner) { return values < 3 || (corner < mask.size() && mask[corner]); });
    float perimeter = 0;
    const Components edges(pool_, whole.form, Component::FaceEdges);
    for (const uint32_t corner : chain) {
      Form edge;
      if (!check(edges.take(corner, edge), "splitAndSetbackPerimeter")) return false;
      perimeter += edge.scope.size.x;
    }
    std::vector<Piece> pieces;
    if (!layOut(readParts(words_, table, a.values, perimeter), perimeter, kMostParts, pieces)) {
      fail("a perimeter has more than " + std::to_string(kMostParts) + " parts");
      return false;
    }
    const float offset = length(a[0], perimeter);
    std::vector<PerimeterPart> parts;
    for (uint32_t i = 0; i < pieces.size(); ++i) {
      const auto depth = depths.find(pieces[i].body);
      CgaValue value;
      shape_.splitIndex = i;
      shape_.splitTotal = static_cast<uint32_t>(pieces.size());
      const bool goesOn = depth == depths.end() || valueOn(depth->second, base, topOf(a), whole.form, i,
                                                           static_cast<uint32_t>(pieces.size()), value);
      shape_.splitIndex = whole.splitIndex;
      shape_.splitTotal = whole.splitTotal;
      if (!goesOn) return false;
      parts.push_back({offset + pieces[i].from, offset + pieces[i].to, depth == depths.end() ? 0.0f : number(value)});
    }
    std::vector<Form> forms;
    Form rest;
    const Status status = setbackPerimeter(pool_, whole.form, face, chain, parts, forms, rest);
    if (status != kGeometryOk) {
      if (!check(status, "splitAndSetbackPerimeter")) return false;
      continue;
    }
    if (rest.mesh) rests.push_back(rest);
    for (uint32_t i = 0; i < forms.size(); ++i) {
      if (forms[i].mesh == 0) continue;
      Shape& part = child();
      part.form = forms[i];
      part.splitIndex = i;
      part.splitTotal = static_cast<uint32_t>(forms.size());
      resetPivot(part);
      if (!addChild(part, pieces[i].body, base)) return false;
    }
  }
  if (rests.empty()) return true;
  Form rest = rests[0];
  if (rests.size() > 1 && !check(combine(pool_, rests, rest), "splitAndSetbackPerimeter")) return false;
  const uint32_t record = words_[table + words_[table]]; // behind the group of the parts
  const CgaValue& selector = a.values[words_[record + kCgaPartSelector]];
  Shape& part = child();
  part.form = rest;
  part.compIndex = 0;
  part.compTotal = 1;
  part.compSelector = selector.bits;
  resetPivot(part);
  return addChild(part, words_[record + kCgaPartBody], base);
}

} // namespace gpgp::spawn::cga
