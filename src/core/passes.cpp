#include "core/passes.h"

#include <algorithm>
#include <cassert>

namespace gpgp::core {
namespace {
void setUses(Pass& pass, std::initializer_list<Use> uses) {
  assert(uses.size() <= kMaxUses);
  std::copy(uses.begin(), uses.end(), pass.uses.begin());
  pass.useCount = static_cast<uint32_t>(uses.size());
}
void setConstants(Pass& pass, std::initializer_list<uint32_t> constants) {
  assert(constants.size() <= kMaxPassConstants);
  std::copy(constants.begin(), constants.end(), pass.constants.begin());
  pass.constantCount = static_cast<uint32_t>(constants.size());
}
bool writes(UseKind kind) { return kind == UseKind::write || kind == UseKind::readWrite; }
} // namespace

Pass& PassList::dispatch(const char* name, uint32_t shader, std::initializer_list<Use> uses, uint32_t groups,
                         std::initializer_list<uint32_t> constants) {
  Pass& pass = passes.emplace_back(Pass{name, PassKind::dispatch});
  pass.shader = shader;
  pass.groups = groups;
  groupCounts = std::max(groupCounts, groups + 1);
  setUses(pass, uses);
  setConstants(pass, constants);
  return pass;
}

Pass& PassList::dispatchIndirect(const char* name, uint32_t shader, std::initializer_list<Use> uses,
                                 ResourceIndex arguments, VkDeviceSize offset,
                                 std::initializer_list<uint32_t> constants) {
  Pass& pass = passes.emplace_back(Pass{name, PassKind::dispatchIndirect});
  pass.shader = shader;
  pass.target = arguments;
  pass.offset = offset;
  setUses(pass, uses);
  assert(pass.useCount < kMaxUses);
  pass.uses[pass.useCount++] = {arguments, UseKind::indirect};
  setConstants(pass, constants);
  return pass;
}

Pass& PassList::fill(const char* name, ResourceIndex target, uint32_t value, VkDeviceSize offset, VkDeviceSize size) {
  Pass& pass = passes.emplace_back(Pass{name, PassKind::fill});
  pass.target = target;
  pass.value = value;
  pass.offset = offset;
  pass.size = size;
  setUses(pass, {{target, UseKind::write}});
  return pass;
}

void PassList::finish(VkDeviceSize alignment) {
  scratchOffsets.assign(resources.size(), 0);
  scratchBytes = constantsBytes = 0;
  const auto place = [&](size_t i, VkDeviceSize& end) {
    scratchOffsets[i] = end;
    end += (resources[i].bytes + alignment - 1) / alignment * alignment;
  };
  for (size_t i = 0; i < resources.size(); ++i) {
    const ResourceKind kind = resources[i].kind;
    if (kind == ResourceKind::scratch) place(i, scratchBytes);
    if (kind == ResourceKind::constants || kind == ResourceKind::uniforms) place(i, constantsBytes);
  }
  for (size_t i = 0; i < resources.size(); ++i) // behind the constants
    if (resources[i].kind == ResourceKind::buffer && resources[i].bytes) place(i, constantsBytes);
  std::pmr::vector<uint8_t> touched(resources.size(), 0, resources.get_allocator().resource()); // 1 read, 2 written
  for (Pass& pass : passes) {
    for (uint32_t i = 0; i < pass.useCount; ++i) {
      resources[pass.uses[i].resource].written |= writes(pass.uses[i].kind);
      const uint8_t before = touched[pass.uses[i].resource];
      if (!pass.beside && ((before & 2) || (before && writes(pass.uses[i].kind)))) pass.barrierBefore = true;
    }
    if (pass.barrierBefore) std::fill(touched.begin(), touched.end(), uint8_t(0));
    for (uint32_t i = 0; i < pass.useCount; ++i)
      touched[pass.uses[i].resource] |= writes(pass.uses[i].kind) ? uint8_t(3) : uint8_t(1);
  }
  uint32_t kinds = 0;
  for (auto pass = passes.rbegin(); pass != passes.rend(); ++pass) {
    pass->kindsAhead = kinds |= 1u << static_cast<uint32_t>(pass->kind);
    if (pass->barrierBefore) kinds = 0;
  }
}

} // namespace gpgp::core
