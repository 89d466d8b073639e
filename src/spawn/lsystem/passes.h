// The passes of an L-system recorder, a list that is made once (core/passes.h).
//
//   begin                                                  the axioms' strings
//   [depths, leaves, nodes] choose, place steps, write     each step of rewriting
//   finish, measure, place marks, mark, plan               the last string
//   count, sum, sort depths; again if deep                 every branch in a row
//   join, place, spread frames; branches, join branches    the turtle as a scan,
//   walk                                                   or by walking
//   [polygons, cylinders]                                  corners
//   count, sum, sort terminals; emit, draws                output
#pragma once
#include "core/passes.h"
#include "spawn/lsystem/layout.h"

namespace gpgp::spawn::lsystem {

/// How much a recorder has room for.
struct Sizes {
  uint32_t maxModules = 0, maxParameters = 0, maxSteps = 0, maxHostAxioms = 0, rounds = 0;
  bool contexts = false; ///< takes systems with contexts or cuts

  uint32_t leaves() const;
  uint32_t maxBranches() const { return maxModules / 2 + 1; }
};

enum Groups : uint32_t { kOneGroup, kAxiomGroups, kNodeGroups, kTopNodeGroups, kRowGroups };
enum Conditions : uint32_t { kStructured, kScanned, kWalked, kWithPolygons, kWithCylinders, kWithPaths };

core::PassList describePasses(const Sizes& sizes, std::pmr::memory_resource* memory);

} // namespace gpgp::spawn::lsystem
