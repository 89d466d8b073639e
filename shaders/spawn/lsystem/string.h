// A string of modules and how shared functions read it: through a struct of pointers in C++, from bound buffers in
// GLSL.
//
// A module is (symbol, its first parameter, path key x, path key y). Nodes are a pyramid over the modules, for searches
// of context: a binary tree in heap order whose leaves begin at the number of leaves, a power of two. With depth, the
// number of brackets around a module (a bracket has that of its outside), a node holds
//   x  the least depth of its modules
//   y  the least depth of those that contexts see and that lie in no branch that ends within the node
//   z  the least of 2 * depth of modules that contexts see and 2 * depth + 1 of brackets
//   w  as y, of modules that cut
// So a search takes two steps a level, whatever lies between.
#ifndef GPGP_SHADERS_SPAWN_LSYSTEM_STRING_H
#define GPGP_SHADERS_SPAWN_LSYSTEM_STRING_H
#include "core/math.h"
#include "core/random.h"
#include "spawn/lsystem/format.h"

#ifdef __cplusplus
#define LSYS_STRING const ::gpgp::shader::LsysString &string,
#define LSYS_STRING_ONLY const ::gpgp::shader::LsysString& string
#define LSYS_S string,
#define LSYS_S_ONLY string
#endif

GPGP_SHADER_BEGIN

GPGP_CONST uint kLsysNowhere = 0xffffffffu;
GPGP_CONST uint kLsysInfinite = 0xffffffffu;

#ifdef __cplusplus
struct LsysString {
  const uint* table;
  const uvec4* modules;
  const float* parameters;
  const uvec4* nodes;
  uint leaves;
};
inline uint lsysWord(const LsysString& string, uint at) { return string.table[at]; }
inline uvec4 lsysModule(const LsysString& string, uint at) { return string.modules[at]; }
inline float lsysParameter(const LsysString& string, uint at) { return string.parameters[at]; }
inline uvec4 lsysNode(const LsysString& string, uint at) { return string.nodes[at]; }
inline uint lsysLeaves(const LsysString& string) { return string.leaves; }
#else
// bindings.glsl has the same functions, without the string.
#define LSYS_STRING
#define LSYS_STRING_ONLY
#define LSYS_S
#define LSYS_S_ONLY
#endif

/// Word of an entry's field in a section whose entries have `size` words.
GPGP_FN uint lsysEntry(LSYS_STRING uint section, uint index, uint size) {
  return lsysWord(LSYS_S kLsysHeadSections + 2u * section + 1u) + index * size;
}
GPGP_FN uint lsysSymbolAt(LSYS_STRING uint symbol) {
  return lsysEntry(LSYS_S kLsysSectionSymbols, symbol, kSymbolSize);
}

GPGP_FN uint lsysTurtleOf(LSYS_STRING uint symbol) {
  return lsysWord(LSYS_S lsysSymbolAt(LSYS_S symbol) + kSymbolTurtle);
}
/// What a module adds to the depth of what follows.
GPGP_FN int lsysDepthStep(uint symbol) { return symbol == kSymbolOpen ? 1 : (symbol == kSymbolClose ? -1 : 0); }

/// The leaf of a module; depth: of what stands at its place.
GPGP_FN uvec4 lsysLeaf(LSYS_STRING uint symbol, uint depth) {
  const bool bracket = symbol <= kSymbolClose;
  const uint own = symbol == kSymbolClose ? depth - 1u : depth;
  const uint at = lsysSymbolAt(LSYS_S symbol);
  const bool seen = !bracket && (lsysWord(LSYS_S at + kSymbolFlags) & kSymbolIgnored) == 0u;
  const bool cuts = lsysWord(LSYS_S at + kSymbolTurtle) == kTurtleCut;
  return uvec4(own, seen ? own : kLsysInfinite, bracket ? 2u * own + 1u : (seen ? 2u * own : kLsysInfinite),
               cuts ? own : kLsysInfinite);
}
/// Of a place behind the last module.
GPGP_FN uvec4 lsysNoLeaf() { return uvec4(kLsysInfinite); }

GPGP_FN uvec4 lsysJoin(uvec4 left, uvec4 right) {
  return uvec4(min(left.x, right.x), min(right.y, left.y <= right.x ? left.y : kLsysInfinite), min(left.z, right.z),
               min(right.w, left.w <= right.x ? left.w : kLsysInfinite));
}

/// The nearest module before `at` that contexts see and that is on the way from the root to it: in its branch or in one
/// around that. depth is that of `at`, and becomes the found one's.
GPGP_FN uint lsysBefore(LSYS_STRING uint at, GPGP_INOUT(uint) depth) {
  const uint leaves = lsysLeaves(LSYS_S_ONLY);
  uint node = leaves + at;
  bool found = false;
  while (node > 1u && !found) {
    if ((node & 1u) != 0u) {
      const uvec4 sibling = lsysNode(LSYS_S node - 1u);
      if (sibling.y <= depth) {
        node -= 1u;
        found = true;
      } else {
        depth = min(depth, sibling.x);
      }
    }
    if (!found) node >>= 1;
  }
  if (!found) return kLsysNowhere;
  while (node < leaves) {
    const uvec4 right = lsysNode(LSYS_S 2u * node + 1u);
    if (right.y <= depth) {
      node = 2u * node + 1u;
    } else {
      depth = min(depth, right.x);
      node = 2u * node;
    }
  }
  depth = lsysNode(LSYS_S node).x;
  return node - leaves;
}

/// Whether a module that cuts stands before `at`, in its branch or in one around that.
GPGP_FN bool lsysIsCut(LSYS_STRING uint at) {
  uint node = lsysLeaves(LSYS_S_ONLY) + at;
  const uvec4 own = lsysNode(LSYS_S node);
  uint depth = own.x;
  if (own.w != kLsysInfinite) return true; // it has done its work
  while (node > 1u) {
    if ((node & 1u) != 0u) {
      const uvec4 sibling = lsysNode(LSYS_S node - 1u);
      if (sibling.w <= depth) return true;
      depth = min(depth, sibling.x);
    }
    node >>= 1;
  }
  return false;
}

/// The nearest place behind `at` whose z is at most most.
GPGP_FN uint lsysBehind(LSYS_STRING uint at, uint most) {
  const uint leaves = lsysLeaves(LSYS_S_ONLY);
  uint node = leaves + at;
  bool found = false;
  while (node > 1u && !found) {
    if ((node & 1u) == 0u && lsysNode(LSYS_S node + 1u).z <= most) {
      node += 1u;
      found = true;
    } else {
      node >>= 1;
    }
  }
  if (!found) return kLsysNowhere;
  while (node < leaves) {
    node = 2u * node;
    if (lsysNode(LSYS_S node).z > most) node += 1u;
  }
  return node - leaves;
}

GPGP_SHADER_END
#endif
