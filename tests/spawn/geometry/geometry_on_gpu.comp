// The skeleton of a polygon, or a slice of a mesh, on the GPU: an invocation a case, each with its own part of the
// buffer. Words of a case: capacity of the pool, of the workspace, where both begin; used words of both; what to do;
// its arguments; status. Results lie in the pool and the workspace as on the CPU.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 0) buffer Words { uint words[]; };

uint caseAt; // the case's words
uint poolAt;
uint poolCapacity;
uint poolUsed;
uint workAt;
uint workCapacity;
uint workUsed;

#include "spawn/geometry/clip.h"
#include "spawn/geometry/extrude.h"
#include "spawn/geometry/polygon.h"

uint poolWord(uint at) { return words[poolAt + at]; }
void setPoolWord(uint at, uint v) { words[poolAt + at] = v; }
uint takePool(uint count) {
  if (count > poolCapacity || poolUsed > poolCapacity - count) return 0u;
  poolUsed += count;
  return poolUsed - count;
}
uint workWord(uint at) { return words[workAt + at]; }
void setWorkWord(uint at, uint v) { words[workAt + at] = v; }
uint takeWork(uint count) {
  if (count > workCapacity || workUsed > workCapacity - count) return kNoWork;
  workUsed += count;
  return workUsed - count;
}
uint workMark() { return workUsed; }
void releaseWork(uint mark) { workUsed = mark; }

void main() {
  caseAt = gl_WorkGroupID.x * 32u;
  poolAt = words[caseAt];
  poolCapacity = words[caseAt + 1u];
  workAt = words[caseAt + 2u];
  workCapacity = words[caseAt + 3u];
  poolUsed = words[caseAt + 4u];
  workUsed = words[caseAt + 5u];
  Form form;
  form.scope.origin = vec3(0.0);
  form.scope.axisX = vec3(1.0, 0.0, 0.0);
  form.scope.axisY = vec3(0.0, 1.0, 0.0);
  form.scope.axisZ = vec3(0.0, 0.0, 1.0);
  form.scope.size = vec3(0.0);
  form.scale = vec3(1.0);
  form.mesh = words[caseAt + 6u];
  uint status;
  if (words[caseAt + 7u] == 0u) {
    const Outline o = outlineOf(form, 0u);
    status = o.status;
    if (status == kGeometryOk) {
      const Skeleton s =
          skeletonOf(o.points, o.count, o.loops, o.loopCount, uintBitsToFloat(words[caseAt + 8u]));
      status = s.status;
      words[caseAt + 10u] = s.nodeAt;
      words[caseAt + 11u] = s.nodes;
      words[caseAt + 12u] = s.sideAt;
      words[caseAt + 13u] = s.sides;
    }
  } else {
    status = extrudeFaces(form, kExtrudeFaceNormal, 2.0, vec3(0.0));
    Cut cut;
    cut.weight = vec4(1.0, 0.25, 0.0, -uintBitsToFloat(words[caseAt + 8u]));
    cut.coordinate = 0xffffffffu;
    cut.set = 0u;
    cut.sign = 1.0;
    cut.slack = 1.0e-5;
    if (status == kGeometryOk) status = cutForm(form, cut, true, true);
    words[caseAt + 10u] = form.mesh;
  }
  words[caseAt + 9u] = status;
  words[caseAt + 4u] = poolUsed;
  words[caseAt + 5u] = workUsed;
}
