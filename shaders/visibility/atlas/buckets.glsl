// The engine's bucket of a triangle: a byte each, the last bucket for numbers that are too large. Needs `buckets`.
uint bucketOf(uint triangle) {
  if (params.hasBuckets == 0u) return 0u;
  return min((buckets[triangle >> 2u] >> ((triangle & 3u) * 8u)) & 255u, params.bucketCount - 1u);
}
