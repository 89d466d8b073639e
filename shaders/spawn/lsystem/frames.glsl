// Frames in buffers, and what modules are in the order by depth, where every branch lies in a row.
#include "spawn/lsystem/turtle.h"

LsysFrame frameAt(uint place) {
  LsysFrame f;
  f.h = frames[4u * place];
  f.l = frames[4u * place + 1u];
  f.u = frames[4u * place + 2u];
  f.p = frames[4u * place + 3u];
  return f;
}
void setFrame(uint place, LsysFrame f) {
  frames[4u * place] = f.h;
  frames[4u * place + 1u] = f.l;
  frames[4u * place + 2u] = f.u;
  frames[4u * place + 3u] = f.p;
}
LsysFrame branchFrame(uint side, uint branch) {
  const uint at = 4u * (side * record.maxBranches + branch);
  LsysFrame f;
  f.h = branches[at];
  f.l = branches[at + 1u];
  f.u = branches[at + 2u];
  f.p = branches[at + 3u];
  return f;
}
void setBranchFrame(uint side, uint branch, LsysFrame f) {
  const uint at = 4u * (side * record.maxBranches + branch);
  branches[at] = f.h;
  branches[at + 1u] = f.l;
  branches[at + 2u] = f.u;
  branches[at + 3u] = f.p;
}

/// Whether a module is the first of its branch.
bool isHead(uint module) { return module == 0u || lsysModule(module - 1u).x == kSymbolOpen; }

/// What tells branches apart: the depth, and the brackets that open before the branch does.
uint headOf(uint module) { return parents[branchAt(order[placeAt(module)])]; }

/// The frame before a module, from the root.
LsysFrame frameOf(uint module) {
  const uint place = order[placeAt(module)];
  const LsysFrame f = frameAt(place);
  if ((lsysWord(kLsysHeadFlags) & kLsysWalks) != 0u) {
    LsysFrame walked = f;
    walked.h.w = 0.0; // where elasticity was
    return walked;
  }
  return lsysCompose(lsysCompose(lsysStart(), branchFrame(state.jumps & 1u, parents[branchAt(place)])), f);
}
