/* volk's implementation, compiled once for our own programs. Never part of the libraries: its global names collide with
 * an engine's. */
#define VOLK_IMPLEMENTATION
#include <volk.h>
