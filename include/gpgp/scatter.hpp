/* gpgp scatter.hpp: C++17 wrapper of scatter.h, whose function takes no handle and is called as it is. */
#ifndef GPGP_SCATTER_HPP
#define GPGP_SCATTER_HPP

#include <gpgp/scatter.h>
#include <gpgp/spawn.hpp>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpScatterInfo, GPGP_STRUCTURE_SCATTER_INFO);

} // namespace gpgp

#endif
