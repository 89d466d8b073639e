// The attributes of a .cga file, as `gpgp spawn` lists them.
#include "cli/shared/messages.h"
#include "cli/spawn/cga.h"
#include "spawn/cga/attributes.h"

#include <cmath>
#include <sstream>

namespace gpgp::cli {

using namespace spawn::cga;

namespace {

struct Kind {
  GpgpCgaAttributeFlags flag;
  const char* name;
};
constexpr Kind kKinds[] = {
    {GPGP_CGA_ATTRIBUTE_COLOR, "color"},         {GPGP_CGA_ATTRIBUTE_FILE, "file"},
    {GPGP_CGA_ATTRIBUTE_DIRECTORY, "directory"}, {GPGP_CGA_ATTRIBUTE_MATERIAL_FILE, "material file"},
    {GPGP_CGA_ATTRIBUTE_PERCENT, "percent"},     {GPGP_CGA_ATTRIBUTE_ANGLE, "angle"},
    {GPGP_CGA_ATTRIBUTE_DISTANCE, "distance"}};

const char* kindOf(GpgpCgaAttributeFlags flags) {
  for (const Kind& kind : kKinds)
    if (flags & kind.flag) return kind.name;
  return "";
}

const char* nameOf(GpgpCgaType type) {
  return type == GPGP_CGA_BOOLEAN  ? "boolean"
         : type == GPGP_CGA_STRING ? "string"
         : type == GPGP_CGA_ARRAY  ? "array"
                                   : "number";
}

Json listOf(const std::vector<std::string>& texts) {
  Json list = Json::array();
  for (const std::string& text : texts) list.push_back(printable(text));
  return list;
}
/// Null for what nobody said.
Json finite(double number) { return std::isfinite(number) ? Json(number) : Json(); }

Json annotationsOf(const AttributeInfo& attribute) {
  Json list = Json::array();
  for (const AttributeAnnotation& a : attribute.annotations) {
    Json values = Json::array();
    for (const AnnotationValue& v : a.values) {
      const Json value = v.number ? Json(*v.number) : Json(printable(v.text));
      values.push_back(v.name.empty() ? value : Json{{"name", printable(v.name)}, {"value", value}});
    }
    list.push_back({{"name", printable(a.name)}, {"values", values}});
  }
  return list;
}

Json valueOf(const FirstValue& value) {
  switch (typeOf(value)) {
  case GPGP_CGA_BOOLEAN: return value.number != 0;
  case GPGP_CGA_STRING: return printable(value.text);
  case GPGP_CGA_ARRAY: return listOf(value.elements);
  default: return value.text == "NaN" ? Json() : Json(value.number);
  }
}

} // namespace

Json attributesOf(const Program& program) {
  Json list = Json::array();
  for (const ListedAttribute& a : listAttributes(program)) {
    const AttributeDisplay& d = a.display;
    const std::string kind = kindOf(d.flags);
    list.push_back({{"name", printable(a.info->name)},
                    {"display_name", d.name.empty() ? Json() : Json(printable(d.name))},
                    {"type", nameOf(typeOf(a.value))},
                    {"value", valueOf(a.value)},
                    {"min", finite(d.min)},
                    {"max", finite(d.max)},
                    {"step", finite(d.step)},
                    {"restricted", !(d.flags & GPGP_CGA_ATTRIBUTE_UNRESTRICTED)},
                    {"choices", listOf(d.choices)},
                    {"kind", kind.empty() ? Json() : Json(kind)},
                    {"extensions", listOf(d.extensions)},
                    {"groups", listOf(d.groups)},
                    {"group_order", finite(d.groupOrder)},
                    {"order", finite(d.order)},
                    {"hidden", (d.flags & GPGP_CGA_ATTRIBUTE_HIDDEN) != 0},
                    {"description", d.description.empty() ? Json() : Json(printable(d.description))},
                    {"file", printable(a.info->file)},
                    {"line", a.info->place.line},
                    {"annotations", annotationsOf(*a.info)}});
  }
  return list;
}

std::string attributesText(const Program& program) {
  std::ostringstream text;
  std::string group;
  for (const ListedAttribute& a : listAttributes(program)) {
    const AttributeDisplay& d = a.display;
    if (d.flags & GPGP_CGA_ATTRIBUTE_HIDDEN) continue;
    std::string own;
    for (const std::string& level : d.groups) own += (own.empty() ? "" : " / ") + level;
    if (own != group && !own.empty()) text << printable(own) << '\n';
    if (own.empty() && !group.empty()) text << "without a group\n";
    group = own;
    const bool isString = typeOf(a.value) == GPGP_CGA_STRING;
    text << "  " << printable(a.info->name) << " = " << (isString ? "\"" : "") << printable(a.value.text)
         << (isString ? "\"" : "");
    if (!std::isnan(d.min) || !std::isnan(d.max)) {
      text << "  [";
      if (!std::isnan(d.min)) text << d.min;
      text << " .. ";
      if (!std::isnan(d.max)) text << d.max;
      if (d.step > 0) text << " by " << d.step;
      text << ']';
    }
    if (!d.choices.empty()) {
      text << "  {";
      for (size_t i = 0; i < d.choices.size(); ++i) text << (i ? ", " : "") << printable(d.choices[i]);
      text << '}';
    }
    if (const std::string kind = kindOf(d.flags); !kind.empty()) text << "  " << kind;
    if (!d.description.empty()) text << "  " << printable(d.description);
    text << '\n';
  }
  return text.str();
}

} // namespace gpgp::cli
