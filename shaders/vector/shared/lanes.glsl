// What invocations of a subgroup do together. Without subgroups each is one of its own.
#if SUBGROUPS
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#define kLanes gl_SubgroupSize
#define lane() gl_SubgroupInvocationID
#define of(x, lane) subgroupShuffle(x, lane)
#define anyOf(x) subgroupAny(x)
#define sumOver(x) subgroupInclusiveAdd(x)
#define lastOf(x) subgroupShuffle(x, gl_SubgroupSize - 1)
#define firstOf(x) subgroupBroadcastFirst(x)
#define isFirst() subgroupElect()
uint countOf(bool x) { return subgroupBallotBitCount(subgroupBallot(x)); }
uint ownerOf(uint end, uint i) { // the first invocation whose end lies behind i
  uint owner = 0;
  for (uint step = kLanes / 2; step > 0; step /= 2)
    if (subgroupShuffle(end, owner + step - 1) <= i) owner += step;
  return owner;
}
#else
#define kLanes 1u
#define lane() 0u
#define of(x, lane) x
#define anyOf(x) (x)
#define sumOver(x) (x)
#define lastOf(x) (x)
#define firstOf(x) (x)
#define isFirst() true
#define ownerOf(end, i) 0u
uint countOf(bool x) { return x ? 1 : 0; }
#endif
