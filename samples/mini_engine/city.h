// The city: gpgp spawn derives a grammar into the engine's instance and indirect buffers; the forward pass draws them.
#pragma once
#include "forward.h"
#include "gpgp_glue.h"
#include "grammar_watch.h"

namespace mini {

struct CityOptions {
  std::string grammarFile;
  bool watch = false;  ///< the grammar follows its file while the engine runs
  uint32_t budget = 0; ///< instances; rules then see the camera, and its detail is chosen so that they are enough
};

class City {
public:
  City(Device& device, Gpgp& gpgp, const Forward& forward, const CityOptions& options);
  /// Another grammar from this frame on; before its uploads.
  void use(gpgp::Grammar grammar);
  /// Outside render passes. Nothing is drawn until this has recorded something. height: of the picture, in pixels.
  void prepare(VkCommandBuffer commands, const GpgpFrame& frame, const Camera& camera, uint32_t height);
  /// Inside the forward pass.
  void draw(VkCommandBuffer commands, const Camera& camera);
  /// Takes reports that have become ready.
  void collect();
  const GpgpSpawnReport& report() const { return report_; }
  uint32_t reports() const { return reports_; }
  uint32_t buildings() const { return axiomCount_; }
  uint32_t budget() const { return budget_.instances; }
  uint32_t exceeded() const { return exceeded_; } ///< reports with more instances

private:
  void makeMaterials();
  Gpgp& gpgp_;
  gpgp::Grammar grammar_;
  gpgp::Spawner spawner_;
  std::unique_ptr<GrammarWatch> watch_;
  Buffer axioms_, instances_, draws_, corners_, indices_;
  Pipeline pipeline_;
  std::vector<glm::vec4> materials_; // a bucket each: colour, and how much a building tints it
  uint32_t axiomCount_ = 0, reports_ = 0, exceeded_ = 0;
  GpgpDetailBudget budget_ = GPGP_DETAIL_BUDGET_INIT;
  GpgpDetail detail_{};
  bool prepared_ = false;
  GpgpSpawnReport report_{};
};

} // namespace mini
