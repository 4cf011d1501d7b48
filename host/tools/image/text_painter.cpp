// SPDX-License-Identifier: MIT
#include "tools/image/text_painter.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <cmath>
#include <utility>

namespace quincunx::tools {

namespace {

constexpr const char* kSansPath = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr const char* kSansBoldPath = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
constexpr int kSubpixels = 64;  // FreeType's unit: 26.6 fixed point

// Returns the character at `at`, which moves behind it. Bytes that are not UTF-8 become the replacement character.
char32_t next_character(const std::string& text, std::size_t& at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(i < text.size() ? text[i] : 0); };
  const unsigned char lead = byte(at);
  const int more = lead < 0x80   ? 0
                   : lead < 0xC2 ? -1
                   : lead < 0xE0 ? 1
                   : lead < 0xF0 ? 2
                   : lead < 0xF5 ? 3
                                 : -1;
  ++at;
  if (more == 0) return lead;
  if (more < 0) return U'\uFFFD';
  char32_t character = lead & (0x3FU >> more);
  for (int i = 0; i < more; ++i, ++at) {
    if ((byte(at) & 0xC0U) != 0x80U) return U'\uFFFD';
    character = character << 6U | (byte(at) & 0x3FU);
  }
  return character;
}

// Coverage is applied to the encoded values: light text on dark looks right so, as screens have always drawn
// it.
void blend(Canvas& canvas, int x, int y, Rgb colour, int coverage) {
  if (x < 0 || y < 0 || x >= canvas.extent.width || y >= canvas.extent.height) return;
  std::uint8_t* texel = &canvas.rgb[(static_cast<std::size_t>(y) * canvas.extent.width + x) * 3];
  const auto mix = [coverage](int below, int ink) {
    return static_cast<std::uint8_t>((below * (255 - coverage) + ink * coverage + 127) / 255);
  };
  texel[0] = mix(texel[0], colour.r);
  texel[1] = mix(texel[1], colour.g);
  texel[2] = mix(texel[2], colour.b);
}

void blend_glyph(Canvas& canvas, int x, int y, const FT_GlyphSlot glyph, Rgb colour) {
  const FT_Bitmap& bitmap = glyph->bitmap;
  for (int row = 0; row < static_cast<int>(bitmap.rows); ++row) {
    const unsigned char* coverage = bitmap.buffer + static_cast<std::ptrdiff_t>(row) * bitmap.pitch;
    for (int column = 0; column < static_cast<int>(bitmap.width); ++column) {
      blend(canvas, x + glyph->bitmap_left + column, y - glyph->bitmap_top + row, colour, coverage[column]);
    }
  }
}

}  // namespace

Canvas::Canvas(Extent size, Rgb background) : extent(size), rgb(static_cast<std::size_t>(size.area()) * 3) {
  fill(0, 0, size, background);
}

void Canvas::fill(int x, int y, Extent size, Rgb colour) {
  const int right = std::min(x + size.width, extent.width);
  const int bottom = std::min(y + size.height, extent.height);
  for (int row = std::max(y, 0); row < bottom; ++row) {
    for (int column = std::max(x, 0); column < right; ++column)
      blend(*this, column, row, colour, 255);
  }
}

struct TextPainter::Fonts {
  FT_Library library = nullptr;
  FT_Face sans = nullptr;
  FT_Face bold = nullptr;

  Fonts() {
    if (FT_Init_FreeType(&library) != 0) {
      library = nullptr;
      return;
    }
    if (FT_New_Face(library, kSansPath, 0, &sans) != 0) sans = nullptr;
    if (FT_New_Face(library, kSansBoldPath, 0, &bold) != 0) bold = nullptr;
  }
  ~Fonts() {
    if (library != nullptr) FT_Done_FreeType(library);  // and the faces with it
  }
  Fonts(const Fonts&) = delete;
  Fonts& operator=(const Fonts&) = delete;

  // Calls visit(pen, glyph slot) for each character; returns the end of the pen's way. All in 1/64 px.
  template <typename Visit>
  long walk(const std::string& text, int size_px, Face which, Visit visit) const {
    const FT_Face face = which == Face::kSansBold ? bold : sans;
    FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size_px));
    long pen = 0;
    FT_UInt previous = 0;
    for (std::size_t at = 0; at < text.size();) {
      const FT_UInt index = FT_Get_Char_Index(face, next_character(text, at));
      FT_Vector kerning{};
      if (previous != 0 && FT_Get_Kerning(face, previous, index, FT_KERNING_DEFAULT, &kerning) == 0) {
        pen += kerning.x;
      }
      previous = index;
      if (FT_Load_Glyph(face, index, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT) != 0) continue;
      visit(pen, face->glyph);
      pen += face->glyph->advance.x;
    }
    return pen;
  }
};

const char* font_path(Face face) {
  return face == Face::kSans ? kSansPath : kSansBoldPath;
}

TextPainter::TextPainter() : fonts_(std::make_unique<Fonts>()) {}

TextPainter::~TextPainter() = default;

bool TextPainter::available() const {
  return fonts_->sans != nullptr && fonts_->bold != nullptr;
}

int TextPainter::width(const std::string& text, int size_px, Face face) const {
  if (!available()) return 0;
  const long end = fonts_->walk(text, size_px, face, [](long, FT_GlyphSlot) {});
  return static_cast<int>((end + kSubpixels - 1) / kSubpixels);
}

void TextPainter::draw(Canvas& canvas, int x, int y, const std::string& text, int size_px, Face face,
                       Rgb colour, Align align) const {
  if (!available()) return;
  const int left = align == Align::kLeft ? x : x - width(text, size_px, face);
  fonts_->walk(text, size_px, face, [&](long pen, FT_GlyphSlot glyph) {
    const int offset = static_cast<int>((pen + kSubpixels / 2) / kSubpixels);
    blend_glyph(canvas, left + offset, y, glyph, colour);
  });
}

}  // namespace quincunx::tools
