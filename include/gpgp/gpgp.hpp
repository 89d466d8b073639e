/* gpgp.hpp: the whole C++17 wrapper. Include the header of one service where that is all you use.
 *
 * The wrapper is header-only. Functions of spawn_builder.h and lottie.hpp, compileGrammar, compileSvg and compileGlyphs
 * are in libgpgp_compiler, those of text.hpp in libgpgp_text, those of evaluator.hpp and cga.hpp in libgpgp_evaluator;
 * only programs that call them link these libraries.
 */
#ifndef GPGP_HPP
#define GPGP_HPP

#include <gpgp/atlas.hpp>
#include <gpgp/cga.hpp>
#include <gpgp/core.hpp>
#include <gpgp/detail.hpp>
#include <gpgp/evaluator.hpp>
#include <gpgp/fit.hpp>
#include <gpgp/gpgp.h>
#include <gpgp/lottie.hpp>
#include <gpgp/lsystem.hpp>
#include <gpgp/scatter.hpp>
#include <gpgp/spawn.hpp>
#include <gpgp/text.hpp>
#include <gpgp/tiles.hpp>
#include <gpgp/ui.hpp>
#include <gpgp/vector.hpp>
#include <gpgp/visibility.hpp>

#endif
