/* gpgp fit.hpp: C++17 wrapper of fit.h, whose functions take no handle and are called as they are. */
#ifndef GPGP_FIT_HPP
#define GPGP_FIT_HPP

#include <gpgp/fit.h>
#include <gpgp/spawn.hpp>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpFit, GPGP_STRUCTURE_FIT);
GPGP_STRUCTURE_OF(GpgpFitTarget, GPGP_STRUCTURE_FIT_TARGET);

} // namespace gpgp

#endif
