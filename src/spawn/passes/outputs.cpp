// What terminals become: vertices and indices, or instances sorted by bucket; buckets; and their bounds.
#include "spawn/passes/builder.h"

#include "shaders/spawn_bounds.spv.h"
#include "shaders/spawn_emit.spv.h"
#include "shaders/spawn_expand.spv.h"
#include "shaders/spawn_expand_subgroups.spv.h"
#include "shaders/spawn_measure.spv.h"
#include "shaders/spawn_place.spv.h"

#include "spawn/outputs/measure.h"

#include <algorithm>

namespace gpgp::spawn {
using enum core::UseKind;

namespace {
/// Of shaders/spawn/outputs/expand.comp: the stride, all attributes, and whether turns of loops count.
std::array<uint32_t, core::kMaxSpecialization> specialization(const core::Device& device, const VertexLayout& layout) {
  std::array<uint32_t, core::kMaxSpecialization> all;
  all.fill(shader::kNoAttribute);
  all[0] = layout.strideWords;
  std::copy_n(layout.attributes.begin(), layout.attributeCount, all.begin() + 1);
  all.back() = device.software;
  return all;
}
static_assert(core::kMaxSpecialization == 2 + shader::kMaxVertexAttributes);
} // namespace

void addExpand(PassBuilder& b) {
  const Spirv spirv = b.subgroups ? Spirv(spawn_expand_subgroups) : Spirv(spawn_expand);
  const uint32_t expand =
      b.list.add(core::ShaderDesc{"expand", spirv, specialization(b.device, b.sizes.layout), core::kMaxSpecialization});
  b.list
      .dispatch("expand", expand,
                {{shader::kBindGraph, read},
                 {shader::kBindAxioms, read},
                 {shader::kBindDraws, read},
                 {shader::kBindRecords, read},
                 {shader::kBindCounters, readWrite},
                 {shader::kBindBuckets, readWrite},
                 {shader::kBindConstants, read},
                 {shader::kBindVertices, write},
                 {shader::kBindIndices, write},
                 {shader::kBindOrder, read}},
                kExpandGroups)
      .condition = kExpanded;
}

void addPlace(PassBuilder& b) {
  const uint32_t place = b.list.add(core::ShaderDesc{"place", spawn_place, {b.sizes.vertices()}, 1});
  b.list
      .dispatch("place", place,
                {{shader::kBindGraph, read},
                 {shader::kBindDraws, readWrite},
                 {shader::kBindCount, write},
                 {shader::kBindCounters, readWrite},
                 {shader::kBindBuckets, readWrite},
                 {shader::kBindConstants, read},
                 {shader::kBindNeeded, write},
                 {shader::kBindOrder, read}},
                kOneGroup)
      .condition = kPlaced;
}

void addEmit(PassBuilder& b) {
  const uint32_t emit = b.list.add(core::ShaderDesc{"emit", spawn_emit, {b.sizes.ordered, b.sizes.compact}, 2});
  b.list
      .dispatchIndirect("emit", emit,
                        {{shader::kBindGraph, read},
                         {shader::kBindAxioms, read},
                         {shader::kBindRecords, read},
                         {shader::kBindInstances, write},
                         {shader::kBindDraws, read},
                         {shader::kBindCounters, read},
                         {shader::kBindBuckets, readWrite},
                         {shader::kBindConstants, read},
                         {shader::kBindOrder, read}},
                        shader::kBindCounters, b.perRecord())
      .condition = kSorted;
}

void addBounds(PassBuilder& b) {
  const auto bounds = [&](const char* name, uint32_t decodes, std::initializer_list<core::Use> used, uint32_t groups) {
    const uint32_t shader = b.list.add(core::ShaderDesc{name, spawn_bounds, {decodes}, 1});
    b.list.dispatch(name, shader, used, groups).condition = kBounded;
  };
  bounds("bounds", 0,
         {{shader::kBindGraph, read},
          {shader::kBindAxioms, read},
          {shader::kBindInstances, read},
          {shader::kBindDraws, read},
          {shader::kBindRecords, read},
          {shader::kBindCounters, read},
          {shader::kBindBuckets, read},
          {shader::kBindConstants, read},
          {shader::kBindBoundKeys, readWrite}},
         kBoundGroups);
  bounds("write bounds", 1, {{shader::kBindGraph, read}, {shader::kBindBoundKeys, read}, {shader::kBindBounds, write}},
         kOneGroup);
}

void addMeasures(PassBuilder& b) {
  b.list.fill("clear measures", shader::kBindMeasured, 0).condition = kMeasured;
  const auto measure = [&](const char* name, uint32_t finishes, std::initializer_list<core::Use> uses,
                           uint32_t groups) {
    const uint32_t shader = b.list.add(core::ShaderDesc{name, spawn_measure, {finishes}, 1});
    b.list.dispatch(name, shader, uses, groups).condition = kMeasured;
  };
  measure("measure", 0,
          {{shader::kBindGraph, read},
           {shader::kBindAxioms, read},
           {shader::kBindRecords, read},
           {shader::kBindCounters, read},
           {shader::kBindConstants, read},
           {shader::kBindMeasured, readWrite},
           {shader::kBindMeasuring, read}},
          kMeasureGroups);
  measure("finish measures", 1, {{shader::kBindMeasured, readWrite}, {shader::kBindMeasuring, read}}, kMeasuredGroups);
}

} // namespace gpgp::spawn
