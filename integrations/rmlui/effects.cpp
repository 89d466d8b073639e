#include "effects.h"

#include <RmlUi/Core/Factory.h>
#include <RmlUi/Core/FontEffectInstancer.h>
#include <RmlUi/Core/PropertyDefinition.h>

#include <deque>
#include <vector>

namespace gpgp::rmlui {
namespace {

/// Lengths that an effect takes, in the order of its shorthand.
enum Length { stroke, blur, offsetX, offsetY };
struct Description {
  const char* name;
  struct Parameter {
    const char *name, *value;
    Length length;
  };
  std::vector<Parameter> parameters;
};

const std::vector<Description>& descriptions() {
  static const std::vector<Description> all{
      {"shadow", {{"offset-x", "0px", offsetX}, {"offset-y", "0px", offsetY}}},
      {"outline", {{"width", "1px", stroke}}},
      {"glow",
       {{"width-outline", "1px", stroke},
        {"width-blur", "-1px", blur},
        {"offset-x", "0px", offsetX},
        {"offset-y", "0px", offsetY}}},
      {"blur", {{"width", "1px", blur}}},
  };
  return all;
}

class Instancer final : public Rml::FontEffectInstancer {
public:
  explicit Instancer(const Description& description) : description_(description) {
    Rml::String shorthand;
    for (const Description::Parameter& parameter : description.parameters) {
      ids_.push_back(RegisterProperty(parameter.name, parameter.value, true).AddParser("length").GetId());
      shorthand += Rml::String(parameter.name) + ", ";
    }
    color_ = RegisterProperty("color", "white", false).AddParser("color").GetId();
    RegisterShorthand("font-effect", shorthand + "color", Rml::ShorthandType::FallThrough);
  }

  Rml::SharedPtr<Rml::FontEffect> InstanceFontEffect(const Rml::String&,
                                                     const Rml::PropertyDictionary& given) override {
    float lengths[4] = {};
    for (size_t i = 0; i < ids_.size(); ++i)
      lengths[description_.parameters[i].length] = given.GetProperty(ids_[i])->Get<float>();
    auto effect = Rml::MakeShared<Effect>();
    effect->style.stroke = std::max(lengths[stroke], 0.0f);
    // RmlUi's kernel is no Gaussian: this is one of the same variance.
    effect->style.blur = 0.45f * (lengths[blur] < 0 ? lengths[stroke] : lengths[blur]);
    effect->x = lengths[offsetX];
    effect->y = lengths[offsetY];
    effect->SetColour(given.GetProperty(color_)->Get<Rml::Colourb>());
    effect->SetLayer(Rml::FontEffect::Layer::Back);
    return effect;
  }

private:
  const Description& description_;
  std::vector<Rml::PropertyId> ids_;
  Rml::PropertyId color_;
};

} // namespace

struct EffectInstancers::Impl {
  std::deque<Instancer> all;
};

EffectInstancers::EffectInstancers() : impl_(std::make_unique<Impl>()) {
  for (const Description& description : descriptions())
    Rml::Factory::RegisterFontEffectInstancer(description.name, &impl_->all.emplace_back(description));
}
EffectInstancers::~EffectInstancers() = default;

} // namespace gpgp::rmlui
