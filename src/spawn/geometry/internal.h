// What the operators share on the host: places that vertices share, edges that faces share.
#pragma once
#include "spawn/geometry/clip.h"
#include "spawn/geometry/extrude.h"
#include "spawn/geometry/geometry.h"
#include "spawn/geometry/polygon.h"

namespace gpgp::spawn {

/// Takes back what an operator put into the pool, and its workspace, unless it succeeded.
class Attempt {
public:
  explicit Attempt(MeshPool& pool) : pool_(pool), used_(pool.used), work_(pool.workUsed) {}
  ~Attempt() {
    pool_.workUsed = work_;
    if (!kept_) pool_.used = used_;
  }
  Attempt(const Attempt&) = delete;
  Attempt& operator=(const Attempt&) = delete;
  /// The status of the operator; what it made stays where that is kGeometryOk or kGeometryEmpty.
  Status end(Status status) {
    kept_ = status <= shader::kGeometryEmpty;
    return status;
  }

private:
  MeshPool& pool_;
  uint32_t used_, work_;
  bool kept_ = false;
};

/// Reading functions take a pool that they could write; they do not.
inline MeshPool& readable(const MeshPool& pool) { return const_cast<MeshPool&>(pool); }

/// For each vertex the first one at its place. Places are one within 2e-6 of the largest extent.
std::vector<uint32_t> weldVertices(const MeshPool& pool, const Form& form);

/// In the order of the corners that have them first.
std::vector<MeshEdge> meshEdges(const MeshPool& pool, const Form& form);
/// The face of each corner.
std::vector<uint32_t> cornerFaces(const MeshPool& pool, uint32_t mesh);

/// Triangles of a face as corners of the mesh, three each, counter-clockwise.
Status triangulateFace(MeshPool& pool, const Form& form, uint32_t face, std::vector<uint32_t>& corners);

} // namespace gpgp::spawn
