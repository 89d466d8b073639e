#include "spawn/lsystem/passes.h"

#include "shaders/lsystem_begin.spv.h"
#include "shaders/lsystem_branch.spv.h"
#include "shaders/lsystem_choose.spv.h"
#include "shaders/lsystem_draws.spv.h"
#include "shaders/lsystem_emit.spv.h"
#include "shaders/lsystem_finish.spv.h"
#include "shaders/lsystem_leaves.spv.h"
#include "shaders/lsystem_mark.spv.h"
#include "shaders/lsystem_measure.spv.h"
#include "shaders/lsystem_nodes.spv.h"
#include "shaders/lsystem_paths.spv.h"
#include "shaders/lsystem_plan.spv.h"
#include "shaders/lsystem_prefix.spv.h"
#include "shaders/lsystem_sort.spv.h"
#include "shaders/lsystem_tiles.spv.h"
#include "shaders/lsystem_walk.spv.h"
#include "shaders/lsystem_write.spv.h"

#include <gpgp/spawn.h>

#include <algorithm>
#include <bit>

namespace gpgp::spawn::lsystem {
namespace {

using namespace shader;
using enum core::ResourceKind;
using enum core::UseKind;

constexpr uint32_t kLeastLeaves = 65536; // two passes of eight levels

class Builder {
public:
  Builder(const Sizes& sizes, std::pmr::memory_resource* memory) : list(memory), sizes_(sizes) {}

  core::PassList list;

  void run() {
    addResources();
    list.fill("clear", kLsysBindCounters, 0);
    const uint32_t begin = shader("begin", lsystem_begin);
    direct("begin", begin, kAxiomGroups,
           {{kLsysBindAxioms, read}, {kLsysBindModules, readWrite}, {kLsysBindParameters, readWrite}});
    addSteps();
    addMarks();
    addOrder();
    addFrames();
    addPaths();
    addOutput();
    list.report = kLsysBindCounters;
    list.reportBytes = sizeof(LsysState);
  }

private:
  uint32_t shader(const char* name, const core::ShaderCode& spirv) { return list.add(core::ShaderDesc{name, spirv}); }

  /// All shaders read the table, the constants and the counters, and may count.
  core::Pass& direct(const char* name, uint32_t shader, uint32_t groups, std::initializer_list<core::Use> uses,
                     std::initializer_list<uint32_t> constants = {}) {
    return complete(list.dispatch(name, shader, uses, groups, constants));
  }
  core::Pass& indirect(const char* name, uint32_t shader, uint32_t slot, std::initializer_list<core::Use> uses,
                       std::initializer_list<uint32_t> constants = {}) {
    core::Pass& pass = list.dispatchIndirect(name, shader, uses, kLsysBindCounters,
                                             sizeof(LsysState) + VkDeviceSize(16) * slot, constants);
    return complete(pass);
  }
  static core::Pass& complete(core::Pass& pass) {
    for (const core::Use use :
         {core::Use{kLsysBindTable, read}, {kLsysBindConstants, read}, {kLsysBindCounters, readWrite}})
      pass.uses[pass.useCount++] = use;
    return pass;
  }

  void addResources() {
    const VkDeviceSize modules = sizes_.maxModules, tiles = (modules + kLsysTile - 1) / kLsysTile;
    const VkDeviceSize frameTiles = (modules + kLsysFrameTile - 1) / kLsysFrameTile;
    list.add({"lsystem", buffer});
    list.add({"axioms", buffer, sizeof(GpgpAxiom) * VkDeviceSize(sizes_.maxHostAxioms), true});
    list.add({"instances", buffer, 0, true});
    list.add({"draws", buffer, 0, true});
    list.add({"corners", buffer, 0, true});
    list.add({"modules", buffer, 0, true});
    list.add({"parameters", buffer, 0, true});
    list.add({"count", buffer, 0, true});
    list.add({"strings", scratch, 2 * 16 * modules});
    list.add({"string parameters", scratch, VkDeviceSize(2 * 4) * sizes_.maxParameters});
    list.add({"chosen", scratch, 4 * modules});
    list.add({"tiles", scratch, std::max(16 * tiles, 80 * frameTiles)});
    list.add({"counters", scratch, sizeof(LsysState) + VkDeviceSize(16) * (kLsysArgsWalks + sizes_.rounds + 1)});
    list.add({"constants", uniforms, sizeof(LsysConstants)});
    list.add({"nodes", scratch, sizes_.contexts ? VkDeviceSize(32) * sizes_.leaves() : 16});
    list.add({"marks", scratch, 16 * modules});
    list.add({"order", scratch, 4 * 4 * modules});
    list.add({"histogram", scratch, VkDeviceSize(4) * kLsysDigits * (tiles + 1)});
    list.add({"frames", scratch, 64 * modules});
    list.add({"branches", scratch, VkDeviceSize(2 * 64) * sizes_.maxBranches()});
    list.add({"parents", scratch, VkDeviceSize(4) * (VkDeviceSize(2) * sizes_.maxBranches() + 3 * modules)});
  }

  void addSteps() {
    const uint32_t measure = shader("depths", lsystem_measure), leaves = shader("leaves", lsystem_leaves),
                   nodes = shader("nodes", lsystem_nodes), choose = shader("choose", lsystem_choose),
                   write = shader("write", lsystem_write);
    tiles_ = shader("place steps", lsystem_tiles);
    measure_ = measure;
    for (uint32_t step = 0; step < sizes_.maxSteps; ++step) {
      const uint32_t slot = kLsysArgsString + (step & 1);
      const auto structured = [&](core::Pass& pass) {
        pass.condition = kStructured;
        pass.level = step + 1;
      };
      if (sizes_.contexts) {
        structured(indirect("depths", measure, slot, {{kLsysBindModules, read}, {kLsysBindTiles, readWrite}},
                            {kLsysSumDepths, step}));
        structured(direct("place depths", tiles_, kOneGroup, {{kLsysBindTiles, readWrite}}, {kLsysSumDepths, step}));
        structured(indirect("leaves", leaves, slot,
                            {{kLsysBindModules, read}, {kLsysBindTiles, read}, {kLsysBindNodes, readWrite}}, {step}));
        structured(direct("nodes", nodes, kNodeGroups, {{kLsysBindNodes, readWrite}}, {step, 8}));
        if (sizes_.leaves() > kLeastLeaves)
          structured(direct("nodes", nodes, kTopNodeGroups, {{kLsysBindNodes, readWrite}}, {step, 16}));
      }
      indirect("choose", choose, slot,
               {{kLsysBindModules, read},
                {kLsysBindParameters, read},
                {kLsysBindNodes, read},
                {kLsysBindChosen, readWrite},
                {kLsysBindTiles, readWrite}},
               {step})
          .level = step + 1;
      direct("place steps", tiles_, kOneGroup, {{kLsysBindTiles, readWrite}}, {kLsysSumStep, step}).level = step + 1;
      indirect("write", write, slot,
               {{kLsysBindModules, readWrite},
                {kLsysBindParameters, readWrite},
                {kLsysBindNodes, read},
                {kLsysBindChosen, read},
                {kLsysBindTiles, read}},
               {step})
          .level = step + 1;
    }
  }

  void addMarks() {
    direct("finish", shader("finish", lsystem_finish), kOneGroup, {});
    indirect("measure", measure_, kLsysArgsLast, {{kLsysBindModules, read}, {kLsysBindTiles, readWrite}},
             {kLsysSumMarks, 0});
    direct("place marks", tiles_, kOneGroup, {{kLsysBindTiles, readWrite}}, {kLsysSumMarks, 0});
    indirect("mark", shader("mark", lsystem_mark), kLsysArgsLast,
             {{kLsysBindModules, read}, {kLsysBindTiles, read}, {kLsysBindMarks, readWrite}});
    direct("plan", shader("plan", lsystem_plan), kOneGroup, {});
  }

  void sort(const std::array<const char*, 3>& names, uint32_t key, uint32_t slot) {
    const auto uses = {core::Use{kLsysBindModules, read},
                       {kLsysBindMarks, read},
                       {kLsysBindOrder, readWrite},
                       {kLsysBindHistogram, readWrite}};
    indirect(names[0], sort_, slot, uses, {kLsysSortCount, key});
    direct(names[1], sort_, kRowGroups, uses, {kLsysSortRows, key});
    indirect(names[2], sort_, slot, uses, {kLsysSortScatter, key});
  }
  void addOrder() {
    sort_ = shader("sort", lsystem_sort);
    sort({"count depths", "sum depths", "sort depths"}, kLsysKeyDepth, kLsysArgsLast);
    sort({"count deep", "sum deep", "sort deep"}, kLsysKeyDeep, kLsysArgsDeep);
  }

  void addFrames() {
    const auto uses = {core::Use{kLsysBindModules, read},
                       {kLsysBindParameters, read},
                       {kLsysBindOrder, read},
                       {kLsysBindMarks, read},
                       {kLsysBindTiles, readWrite},
                       {kLsysBindFrames, readWrite},
                       {kLsysBindParents, readWrite},
                       {kLsysBindBranches, readWrite}};
    const uint32_t prefix = shader("frames", lsystem_prefix), branch = shader("branches", lsystem_branch),
                   walk = shader("walk", lsystem_walk);
    indirect("join frames", prefix, kLsysArgsFrames, uses, {0}).condition = kScanned;
    direct("place frames", prefix, kOneGroup, uses, {1}).condition = kScanned;
    indirect("spread frames", prefix, kLsysArgsFrames, uses, {2}).condition = kScanned;
    indirect("branches", branch, kLsysArgsLast, uses, {0, 0}).condition = kScanned;
    for (uint32_t round = 0; round < kLsysJumps; ++round)
      indirect("join branches", branch, kLsysArgsJumps + round, uses, {1, round}).condition = kScanned;
    for (uint32_t round = 0; round < sizes_.rounds; ++round)
      indirect("walk", walk, kLsysArgsWalks + round, uses, {round}).condition = kWalked;
  }

  void addPaths() {
    const uint32_t paths = shader("paths", lsystem_paths);
    const auto uses = {core::Use{kLsysBindModules, read}, {kLsysBindOrder, read},       {kLsysBindMarks, readWrite},
                       {kLsysBindTiles, readWrite},       {kLsysBindChosen, readWrite}, {kLsysBindParents, read}};
    list.fill("clear paths", kLsysBindChosen, 0).condition = kWithPaths;
    const auto add = [&](const std::array<const char*, 3>& names, uint32_t kind, uint32_t condition) {
      indirect(names[0], paths, kLsysArgsLast, uses, {0, kind}).condition = condition;
      direct(names[1], tiles_, kOneGroup, {{kLsysBindTiles, readWrite}}, {kind, 0}).condition = condition;
      indirect(names[2], paths, kLsysArgsLast, uses, {1, kind}).condition = condition;
    };
    add({"measure polygons", "place polygons", "polygons"}, kLsysSumPolygons, kWithPolygons);
    add({"measure cylinders", "place cylinders", "cylinders"}, kLsysSumCylinders, kWithCylinders);
  }

  void addOutput() {
    sort({"count terminals", "sum terminals", "sort terminals"}, kLsysKeyTerminal, kLsysArgsLast);
    indirect("emit", shader("emit", lsystem_emit), kLsysArgsLast,
             {{kLsysBindModules, read},
              {kLsysBindParameters, read},
              {kLsysBindAxioms, read},
              {kLsysBindMarks, read},
              {kLsysBindOrder, read},
              {kLsysBindFrames, read},
              {kLsysBindBranches, read},
              {kLsysBindParents, read},
              {kLsysBindChosen, read},
              {kLsysBindInstances, write},
              {kLsysBindCorners, write},
              {kLsysBindModulesOut, write},
              {kLsysBindParametersOut, write}});
    direct("draws", shader("draws", lsystem_draws), kOneGroup,
           {{kLsysBindHistogram, read}, {kLsysBindDraws, readWrite}, {kLsysBindCount, write}});
  }

  const Sizes& sizes_;
  uint32_t tiles_ = 0, measure_ = 0, sort_ = 0;
};

} // namespace

uint32_t Sizes::leaves() const { return std::max(std::bit_ceil(maxModules), kLeastLeaves); }

core::PassList describePasses(const Sizes& sizes, std::pmr::memory_resource* memory) {
  Builder builder(sizes, memory);
  builder.run();
  return std::move(builder.list);
}

} // namespace gpgp::spawn::lsystem
