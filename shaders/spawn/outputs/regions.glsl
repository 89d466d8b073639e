// Regions of the engine's buffers, one a bucket, as its draw commands say. Each reaches to the next one.

/// Where a bucket's region begins, and what it holds, in instances or quads.
uint regionStart(uint bucket, bool quads) {
  return quads ? draws[bucket * kDrawWords + 2] / 6 : draws[bucket * kDrawWords + 4];
}
uint regionCapacity(uint bucket, bool quads) {
  uint end = quads ? record.quadCapacity : record.instanceCapacity;
  if (bucket + 1 < graphWords[kHeaderBuckets]) end = min(end, regionStart(bucket + 1, quads));
  const uint capacity = end - min(end, regionStart(bucket, quads));
  return quads ? min(capacity, record.regionQuads) : capacity;
}
