// What most tests include, for builds with GPGP_PRECOMPILED_HEADERS.
#include "standard.h"

#include <gtest/gtest.h>
