// The clusters of the geometry set's meshes, one mesh after the other. Needs `params`, and CLUSTER_ACCESS.
#include "visibility/shared/cluster.h"
layout(std430, set = 0, binding = kBindMeshes) readonly buffer MeshWordBuffer { uint meshWords[]; };
layout(std430, set = 0, binding = kBindClusters) CLUSTER_ACCESS buffer ClusterBuffer { Cluster clusters[]; };

/// Of a mesh; behind the mesh table.
uint firstCluster(uint mesh) { return meshWords[params.meshCount * 3u + mesh]; }
