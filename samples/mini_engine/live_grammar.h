// Live editing of a grammar (.pga), with its variables as attributes.
//
// Both are seen in the frame in which update() finds them: it compiles, which takes milliseconds, before the frame's
// uploads. A file with errors changes nothing: the last good grammar stays, and errors() tells what is wrong and where.
//
// Variables are read from the text. A comment behind one says its range and its group:
//
//   var floorHeight = 3; // 2.5 to 5, storeys
#pragma once
#include "live_file.h"

#include <gpgp/gpgp.hpp>

namespace mini {

/// The variables of a text, in its order. Without a range in a comment: from 0 to twice the value.
std::vector<LiveAttribute> attributesOf(const std::string& text);

class LiveGrammar final : public LiveFile {
public:
  LiveGrammar(GpgpContext context, std::string file);

  /// Once a frame, between gpgpAdvance and the uploads: the grammar to use from this frame on, if it is another one.
  std::optional<gpgp::Grammar> update();

private:
  std::optional<gpgp::Grammar> compile(const std::string& text, const std::vector<LiveAttribute>& attributes);

  const GpgpContext context_;
  std::string good_, tried_; // texts: shown, and found last
};

} // namespace mini
