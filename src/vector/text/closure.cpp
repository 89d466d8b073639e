// Which glyphs a text of given characters may need. Besides the characters' own: what Unicode makes of them (canonical
// composition and decomposition, mirrored brackets, variation sequences), what HarfBuzz takes for them where a font has
// no GSUB (Arabic presentation forms, Thai forms in private use), what layouts add by themselves, and whatever any
// lookup of GSUB makes of all these, whichever feature it belongs to (hb_ot_layout_lookups_substitute_closure).
#include "vector/text/closure.h"

#include <hb-aat.h>
#include <hb-ot.h>

namespace gpgp::text {
namespace {

struct SetDeleter {
  void operator()(hb_set_t* set) const { hb_set_destroy(set); }
};
using Set = std::unique_ptr<hb_set_t, SetDeleter>;

/// Calls with each member; the set may not change.
template <class Take> void each(const Set& set, Take&& take) {
  for (hb_codepoint_t c = HB_SET_VALUE_INVALID; hb_set_next(set.get(), &c);) take(c);
}

struct Characters {
  Set have{hb_set_create()};   // by the font
  Set wanted{hb_set_create()}; // by the text
  hb_unicode_funcs_t* unicode = hb_unicode_funcs_get_default();

  bool wants(hb_codepoint_t c) const { return hb_set_has(wanted.get(), c) != 0; }
  /// The parts of a character, those of its parts included.
  template <class Take> void parts(hb_codepoint_t c, Take&& take) const {
    hb_codepoint_t a = 0, b = 0;
    if (!hb_unicode_decompose(unicode, c, &a, &b)) return;
    take(a);
    if (b) take(b);
    parts(a, take);
    if (b) parts(b, take);
  }
  /// What is composed of nothing but wanted characters, or parts of them.
  bool composed(hb_codepoint_t c) const {
    if (wants(c)) return true;
    hb_codepoint_t a = 0, b = 0;
    return hb_unicode_decompose(unicode, c, &a, &b) && composed(a) && (!b || composed(b));
  }
};

/// Forms that HarfBuzz finds by characters where the font has no GSUB.
constexpr struct {
  GpgpCharacterRange of, forms;
} kForms[] = {{{0x600, 0x6ff}, {0xfe70, 0xfefc}},  // Arabic
              {{0xe00, 0xe7f}, {0xf700, 0xf71a}},  // Thai, as Windows fonts have them
              {{0xe00, 0xe7f}, {0xf880, 0xf89e}}}; // and as those of the Macintosh

} // namespace

void glyphClosure(const Font& font, std::span<const GpgpCharacterRange> ranges, std::vector<uint32_t>& glyphs) {
  hb_font_t* shaping = font.shaping();
  hb_face_t* face = hb_font_get_face(shaping);
  const bool substitutes = hb_ot_layout_has_substitution(face) != 0;
  Set found(hb_set_create());
  hb_set_add(found.get(), 0);
  if (hb_aat_layout_has_substitution(face)) { // of which HarfBuzz tells no closure
    if (font.info().glyphCount) hb_set_add_range(found.get(), 0, font.info().glyphCount - 1);
  } else {
    Characters characters;
    hb_set_t* wanted = characters.wanted.get();
    hb_face_collect_unicodes(face, characters.have.get());
    for (const GpgpCharacterRange& range : ranges) hb_set_add_range(wanted, range.first, range.last);
    // Space, for invisible characters too; dotted circle, for marks that stand alone; hyphens; ellipsis.
    for (const hb_codepoint_t own : {0x20u, 0x2du, 0x2eu, 0x2010u, 0x2026u, 0x25ccu}) hb_set_add(wanted, own);
    const Set more(hb_set_create());
    each(characters.have, [&](hb_codepoint_t c) {
      if (characters.composed(c)) hb_set_add(more.get(), c);
    });
    if (!substitutes)
      for (const auto& [of, forms] : kForms) {
        hb_codepoint_t first = of.first - 1;
        if (hb_set_next(wanted, &first) && first <= of.last) hb_set_add_range(more.get(), forms.first, forms.last);
      }
    each(characters.wanted, [&](hb_codepoint_t c) {
      if (hb_unicode_general_category(characters.unicode, c) == HB_UNICODE_GENERAL_CATEGORY_UNASSIGNED) return;
      characters.parts(c, [&](hb_codepoint_t part) { hb_set_add(more.get(), part); });
      hb_set_add(more.get(), hb_unicode_mirroring(characters.unicode, c));
    });
    hb_set_union(wanted, more.get());
    hb_set_intersect(characters.have.get(), wanted);
    each(characters.have, [&](hb_codepoint_t c) {
      hb_codepoint_t glyph = 0;
      if (hb_font_get_nominal_glyph(shaping, c, &glyph)) hb_set_add(found.get(), glyph);
    });
    const Set selectors(hb_set_create());
    hb_face_collect_variation_selectors(face, selectors.get());
    hb_set_intersect(selectors.get(), wanted);
    each(selectors, [&](hb_codepoint_t selector) {
      const Set varied(hb_set_create());
      hb_face_collect_variation_unicodes(face, selector, varied.get());
      hb_set_intersect(varied.get(), wanted);
      each(varied, [&](hb_codepoint_t c) {
        hb_codepoint_t glyph = 0;
        if (hb_font_get_variation_glyph(shaping, c, selector, &glyph)) hb_set_add(found.get(), glyph);
      });
    });
    if (substitutes) {
      const Set lookups(hb_set_create());
      const unsigned count = hb_ot_layout_table_get_lookup_count(face, HB_OT_TAG_GSUB);
      if (count) hb_set_add_range(lookups.get(), 0, count - 1);
      hb_ot_layout_lookups_substitute_closure(face, lookups.get(), found.get());
    }
  }
  each(found, [&](hb_codepoint_t glyph) {
    if (glyph < font.info().glyphCount) glyphs.push_back(glyph);
  });
}

} // namespace gpgp::text
