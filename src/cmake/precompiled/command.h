// What most of the command's sources include, for builds with GPGP_PRECOMPILED_HEADERS.
#include "standard.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
