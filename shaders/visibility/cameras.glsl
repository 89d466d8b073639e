// The matrices of a record's cameras. Needs `params`.
mat4 viewProjection(uint camera) {
  return mat4(params.viewProjection[camera * 4u], params.viewProjection[camera * 4u + 1u],
              params.viewProjection[camera * 4u + 2u], params.viewProjection[camera * 4u + 3u]);
}
