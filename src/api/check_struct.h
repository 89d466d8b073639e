// What every C function asks of a struct, in all the libraries.
#pragma once
#include "core/result.h"

#include <gpgp/core.h>

namespace gpgp::api {

/// A descriptor struct: not NULL, the right sType, an empty pNext chain.
template <class T> core::Result<void> checkStruct(const T* info, GpgpStructureType type, const char* name) {
  if (!info) return core::makeError(GPGP_ERROR_INVALID_ARGUMENT, "%s is NULL", name);
  if (info->sType != type)
    return core::makeError(GPGP_ERROR_INVALID_STRUCT, "%s->sType is %d; expected %d", name, info->sType, type);
  if (info->pNext)
    return core::makeError(GPGP_ERROR_INVALID_STRUCT, "%s->pNext must be NULL: no extension struct is known here",
                           name);
  return {};
}

} // namespace gpgp::api
