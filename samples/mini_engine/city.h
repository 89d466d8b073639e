// The city: gpgp spawn derives a grammar into the engine's instance and indirect buffers; the forward pass draws them.
#pragma once
#include "forward.h"
#include "gpgp_glue.h"
#include "grammar_watch.h"

namespace mini {

class City {
public:
  /// watch: the grammar follows its file while the engine runs.
  City(Device& device, Gpgp& gpgp, const Forward& forward, const std::string& grammarFile, bool watch);
  /// Outside render passes. Nothing is drawn until this has recorded something.
  /// Another grammar from this frame on; before its uploads.
  void use(gpgp::Grammar grammar);
  void prepare(VkCommandBuffer commands, const GpgpFrame& frame);
  /// Inside the forward pass.
  void draw(VkCommandBuffer commands, const Camera& camera);
  /// Takes reports that have become ready.
  void collect();
  const GpgpSpawnReport& report() const { return report_; }
  uint32_t reports() const { return reports_; }
  uint32_t buildings() const { return axiomCount_; }

private:
  void makeMaterials();
  Gpgp& gpgp_;
  gpgp::Grammar grammar_;
  gpgp::Spawner spawner_;
  std::unique_ptr<GrammarWatch> watch_;
  Buffer axioms_, instances_, draws_, corners_, indices_;
  Pipeline pipeline_;
  std::vector<glm::vec4> materials_; // a bucket each: colour, and how much a building tints it
  uint32_t axiomCount_ = 0, reports_ = 0;
  bool prepared_ = false;
  GpgpSpawnReport report_{};
};

} // namespace mini
