// A Poisson-disk pattern on the whole plane, of which any rectangle can be had by itself (gpgp/scatter.h).
//
// The plane is cut into cells that hold at most one point: their diagonal is the distance. Each cell makes a few tries,
// a place drawn by cell and try. A try and a phase, which is one of 3 x 3 places of a cell in its group, go together:
// cells of one phase are too far apart to meet, so that all of them may be decided at once, in any order (Wei 2008). A
// decision looks two cells far. Around a rectangle, as many rings of cells are decided with it as there are decisions
// in a row: beyond, nothing can make a difference. The pattern is therefore a function of the seed and nothing else.
#pragma once
#include <gpgp/scatter.h>

#include <vector>

namespace gpgp::spawn {

bool isValid(const GpgpScatterInfo& info);
/// All axioms of the rectangle. Throws std::bad_alloc.
std::vector<GpgpAxiom> scatter(const GpgpScatterInfo& info);

} // namespace gpgp::spawn
