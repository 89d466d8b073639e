/* gpgp detail.hpp: C++17 wrapper of detail.h, whose function takes no handle and is called as it is. */
#ifndef GPGP_DETAIL_HPP
#define GPGP_DETAIL_HPP

#include <gpgp/detail.h>
#include <gpgp/spawn.hpp>

namespace gpgp {

GPGP_STRUCTURE_OF(GpgpDetailBudget, GPGP_STRUCTURE_DETAIL_BUDGET);

} // namespace gpgp

#endif
