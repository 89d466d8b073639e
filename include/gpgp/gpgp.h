/* gpgp: the whole C API. Include one service's header instead where that is all you use. */
#ifndef GPGP_H
#define GPGP_H
#include <gpgp/atlas.h>
#include <gpgp/cga.h>
#include <gpgp/core.h>
#include <gpgp/detail.h>
#include <gpgp/evaluator.h>
#include <gpgp/fit.h>
#include <gpgp/lottie.h>
#include <gpgp/lsystem.h>
#include <gpgp/scatter.h>
#include <gpgp/spawn.h>
#include <gpgp/spawn_builder.h>
#include <gpgp/text.h>
#include <gpgp/tiles.h>
#include <gpgp/ui.h>
#include <gpgp/vector.h>
#include <gpgp/visibility.h>
#endif
