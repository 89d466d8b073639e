// A triangle's index within its row, among a workgroup's 256 of one round, in the order of their numbers.
//
// RANKED_ROWS: rows there are at most. All invocations call clearRanks, enterRank and rankOf with barriers between
// them. rowStart holds where each row's next entry of this workgroup lies.
shared uint rankBits[RANKED_ROWS * 8];
shared uint rowStart[RANKED_ROWS];

void clearRanks(uint rowCount, uint lane) {
  for (uint i = lane; i < rowCount * 8u; i += 256u) rankBits[i] = 0u;
}
void enterRank(uint row, uint lane) { atomicOr(rankBits[row * 8u + lane / 32u], 1u << (lane % 32u)); }
uint rankOf(uint row, uint lane) {
  uint rank = uint(bitCount(rankBits[row * 8u + lane / 32u] & ((1u << (lane % 32u)) - 1u)));
  for (uint i = 0u; i < lane / 32u; ++i) rank += uint(bitCount(rankBits[row * 8u + i]));
  return rank;
}
void advanceRanks(uint rowCount, uint lane) {
  for (uint row = lane; row < rowCount; row += 256u)
    for (uint i = 0u; i < 8u; ++i) rowStart[row] += uint(bitCount(rankBits[row * 8u + i]));
}
