#include "spawn/cga/attributes.h"
#include "core/suggest.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>

namespace gpgp::spawn::cga {

namespace {

constexpr struct {
  const char* name;
  GpgpCgaAttributeFlags flag;
} kFlags[] = {{"Hidden", GPGP_CGA_ATTRIBUTE_HIDDEN},     {"Color", GPGP_CGA_ATTRIBUTE_COLOR},
              {"File", GPGP_CGA_ATTRIBUTE_FILE},         {"Directory", GPGP_CGA_ATTRIBUTE_DIRECTORY},
              {"Percent", GPGP_CGA_ATTRIBUTE_PERCENT},   {"Angle", GPGP_CGA_ATTRIBUTE_ANGLE},
              {"Distance", GPGP_CGA_ATTRIBUTE_DISTANCE}, {"MaterialFile", GPGP_CGA_ATTRIBUTE_MATERIAL_FILE}};

/// @Range(0, 10), @Range(min=0, max=10, stepsize=0.5). An older form lists texts: these are choices.
void readRange(const AttributeAnnotation& annotation, AttributeDisplay& display) {
  double* const places[] = {&display.min, &display.max, &display.step};
  const char* const names[] = {"min", "max", "stepsize"};
  size_t next = 0;
  for (const AnnotationValue& v : annotation.values) {
    if (v.name.empty() && !v.number) display.choices.push_back(v.text);
    if (!v.number) continue;
    for (size_t i = 0; i < std::size(places); ++i)
      if (v.name.empty() ? i == next : v.name == names[i]) *places[i] = *v.number;
    next += v.name.empty();
  }
}

void read(const AttributeAnnotation& annotation, AttributeDisplay& display) {
  for (const auto& known : kFlags)
    if (annotation.name == known.name) display.flags |= known.flag;
  const bool isEnum = annotation.name == "Enum", isRange = annotation.name == "Range";
  if (isRange) readRange(annotation, display);
  for (const AnnotationValue& v : annotation.values) {
    if ((isEnum || isRange) && v.name == "restricted" && v.text == "false")
      display.flags |= GPGP_CGA_ATTRIBUTE_UNRESTRICTED;
    if (isEnum && v.name == "valuesAttr") display.choicesFrom = v.text;
    if (!v.name.empty()) continue;
    if (isEnum) display.choices.push_back(v.text);
    if (annotation.name == "File") display.extensions.push_back(v.text);
    if (annotation.name == "Group" && !v.number) display.groups.push_back(v.text);
    if (annotation.name == "Group" && v.number) display.groupOrder = *v.number;
    if (annotation.name == "Order" && v.number) display.order = *v.number;
    if (annotation.name == "Description") display.description = v.text;
    if (annotation.name == "DisplayName") display.name = v.text;
  }
}

/// Whether the file gives the attribute a number as it stands.
bool isNumberBy(const Program& program, const AttributeInfo& attribute) {
  if (!attribute.chunk) return false;
  const uint32_t* code = &program.words[attribute.chunk + shader::kCgaChunkHeader];
  return code[0] == shader::kCgaPushFloatCode && code[2] == shader::kCgaReturnCode;
}

} // namespace

AttributeDisplay displayOf(const AttributeInfo& attribute) {
  AttributeDisplay display;
  display.min = display.max = display.step = std::numeric_limits<double>::quiet_NaN();
  display.groupOrder = display.order = std::numeric_limits<double>::infinity();
  bool hasRange = false;
  for (const AttributeAnnotation& annotation : attribute.annotations) {
    read(annotation, display);
    hasRange = hasRange || annotation.name == "Range";
  }
  // @Angle and @Percent have ranges of their own, beyond which values are as good.
  const GpgpCgaAttributeFlags kinds = GPGP_CGA_ATTRIBUTE_ANGLE | GPGP_CGA_ATTRIBUTE_PERCENT;
  if (!hasRange && (display.flags & kinds)) {
    display.min = 0;
    display.max = display.flags & GPGP_CGA_ATTRIBUTE_ANGLE ? 360 : 1;
    display.flags |= GPGP_CGA_ATTRIBUTE_UNRESTRICTED;
  }
  return display;
}

GpgpCgaType typeOf(const FirstValue& value) {
  switch (value.type) {
  case shader::kCgaBool: return GPGP_CGA_BOOLEAN;
  case shader::kCgaString: return GPGP_CGA_STRING;
  case shader::kCgaArray: return GPGP_CGA_ARRAY;
  default: return GPGP_CGA_NUMBER;
  }
}

std::vector<ListedAttribute> listAttributes(const Program& program) {
  Messages atRunTime; // the derivation says them again, where they happen
  const std::vector<FirstValue> values = firstValues(program, {}, atRunTime);
  std::vector<ListedAttribute> all;
  for (size_t slot = 0; slot < values.size(); ++slot) {
    const AttributeInfo& info = program.attributes[slot];
    if (info.isConstant || info.isMaterial) continue;
    ListedAttribute& listed = all.emplace_back(ListedAttribute{&info, values[slot], displayOf(info)});
    if (listed.display.choicesFrom.empty()) continue;
    const std::string prefix = info.name.substr(0, info.name.rfind('.') + 1); // npos + 1 is 0
    for (size_t other = 0; other < values.size(); ++other) {
      if (program.attributes[other].name != prefix + listed.display.choicesFrom) continue;
      listed.display.choices = values[other].elements;
      if (values[other].type != shader::kCgaArray) listed.display.choices = {values[other].text};
    }
  }
  const std::vector<std::string>& files = program.files; // the main file is the first
  const auto place = [&](const ListedAttribute& a) {
    return std::tuple(std::find(files.begin(), files.end(), a.info->file) - files.begin(), a.info->place.line,
                      a.info->place.column);
  };
  std::stable_sort(all.begin(), all.end(),
                   [&](const ListedAttribute& a, const ListedAttribute& b) { return place(a) < place(b); });
  return all;
}

std::string missingField(const Program& program, const std::vector<WorldField>& fields) {
  for (const FieldRead& read : program.fields) {
    if (std::any_of(fields.begin(), fields.end(), [&](const WorldField& f) { return f.name == read.name; })) continue;
    core::Suggestion suggestion(read.name);
    for (const WorldField& field : fields) suggestion.offer(field.name);
    return read.file + ":" + std::to_string(read.place.line) + ":" + std::to_string(read.place.column) + ": field \"" +
           read.name + "\" is read, and is not among the fields" + suggestion.text();
  }
  return {};
}

std::string whyNotSet(const AttributeValue& value, const Program& program) {
  const auto isIt = [&](const AttributeInfo& a) { return a.name == value.name && !a.isMaterial; };
  const auto found = std::find_if(program.attributes.begin(), program.attributes.end(), isIt);
  if (found == program.attributes.end()) {
    core::Suggestion suggestion(value.name);
    for (const AttributeInfo& a : program.attributes)
      if (!a.isConstant && !a.isMaterial) suggestion.offer(a.name);
    return ": there is no such attribute" + suggestion.text();
  }
  if (found->isConstant) return ": it is a const, which cannot be set";
  if (isNumberBy(program, *found) && !numberIn(value.text) && value.text != "true" && value.text != "false")
    return ": it is a number in the file; \"" + value.text + "\" is none";
  return {};
}

} // namespace gpgp::spawn::cga
