// Fields of the world for --field: PNG files that grammars read by name.
#pragma once
#include "cli/shared/command.h"
#include "cli/tune/deriver.h"
#include "spawn/schedule/fields.h"

#include <deque>
#include <string>
#include <vector>

namespace gpgp::cli {

/// The option --field.
void addFields(CLI::App& command, std::vector<std::string>& texts);

class WorldFields {
public:
  /// Of texts NAME=FILE.png[,X0,Z0,X1,Z1[,SCALE]]. Throws Usage with the text.
  explicit WorldFields(const std::vector<std::string>& texts);
  /// Bound as well.
  WorldFields(const std::vector<std::string>& texts, const spawn::Graph& graph) : WorldFields(texts) { bind(graph); }
  WorldFields(const WorldFields&) = delete; // fields point to their names and values
  WorldFields& operator=(const WorldFields&) = delete;

  /// Finds those that a graph reads. Throws Usage where one is not there.
  void bind(const spawn::Graph& graph);
  /// For the device: what `options` of a Deriver take.
  void give(DeriverOptions& options) const;
  /// For the CPU, once bound.
  const spawn::BoundFields& bound() const { return bound_; }
  /// With their values.
  const std::vector<GpgpSpawnField>& all() const { return fields_; }

private:
  std::deque<std::string> names_;
  std::vector<GpgpSpawnField> fields_;
  std::vector<float> values_;
  spawn::BoundFields bound_;
};

} // namespace gpgp::cli
