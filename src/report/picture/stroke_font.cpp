#include "report/picture/canvas.h"

#include <algorithm>
#include <array>
#include <map>

namespace octafront::stroke_font {

namespace {

// A glyph is strokes with blanks between; a stroke is points, two characters each: x as a digit, y as a letter, D on
// the line, K as high as x, N as high as a capital. A small letter is a control point: a quadratic arc goes by it, and
// between two of them through their middle. Lengths are tenths of a capital's height.
constexpr const char* kGlyphs[] = {"A0D3N6D 1G5G",
                                   "B0D0N3N5n5i3I0I 3I6i6d3D0D",
                                   "C6L6n3N0n0d3D6d6F",
                                   "D0D0N2N6n6d2D0D",
                                   "E5N0N0D5D 0I4I",
                                   "F5N0N0D 0I4I",
                                   "G6L6n3N0n0d3D6d6I4I",
                                   "H0D0N 6D6N 0I6I",
                                   "I0D0N",
                                   "J4N4G4d2D0d0F",
                                   "K0D0N 6N0G 2I6D",
                                   "L0N0D5D",
                                   "M0D0N4F8N8D",
                                   "N0D0N6D6N",
                                   "O4N0n0d4D8d8n4N",
                                   "P0D0N3N6n6h3H0H",
                                   "Q4N0n0d4D8d8n4N 5G8C",
                                   "R0D0N3N6n6h3H0H 3H6D",
                                   "S6L6n3N0n0i3I6i6d3D0d0F",
                                   "T0N6N 3N3D",
                                   "U0N0G0d3D6d6G6N",
                                   "V0N3D6N",
                                   "W0N2D4L6D8N",
                                   "X0D6N 0N6D",
                                   "Y0N3I6N 3I3D",
                                   "Z0N6N0D6D",
                                   "a5K5D 5I5k3K0k0d3D5d5F",
                                   "b0N0D 0F0d2D5d5k2K0k0I",
                                   "c5J5k3K0k0d3D5d5E",
                                   "d5N5D 5I5k3K0k0d3D5d5F",
                                   "e0H5H5k3K0k0d3D5d5E",
                                   "f4N2n2L2D 0K4K",
                                   "g5K5C5a3A0a0B 5I5k3K0k0d3D5d5F",
                                   "h0N0D 0I0k3K5k5I5D",
                                   "i0K0D 0N",
                                   "j2K2C2a0A 2N",
                                   "k0N0D 5K0F 2H5D",
                                   "l0N0F0d2D",
                                   "m0K0D 0I0k2K4k4I4D 4I4k6K8k8I8D",
                                   "n0K0D 0I0k3K5k5I5D",
                                   "o3K0k0d3D6d6k3K",
                                   "p0K0A 0I0k2K5k5d2D0d0F",
                                   "q5K5A 5I5k3K0k0d3D5d5F",
                                   "r0K0D 0I0k3K",
                                   "s4J4k2K0k0h2H4h4d2D0d0E",
                                   "t1N1F1d3D 0K3K",
                                   "u0K0G0d2D5d5G 5K5D",
                                   "v0K2D4K",
                                   "w0K2D4J6D8K",
                                   "x0K5D 5K0D",
                                   "y0K2D 4K2D1A0A",
                                   "z0K4K0D4D",
                                   "03N0n0d3D6d6n3N",
                                   "11L3N3D 1D5D",
                                   "20L0n3N6n6K6i0D6D",
                                   "30L0n3N6n6i3I2I 3I6i6d3D0d0F",
                                   "44D4N0G6G",
                                   "55N0N0I1j3J6j6d3D0d0F",
                                   "65M4n3N0n0G0d3D6d6j3J0j0G",
                                   "70N6N2D",
                                   "83N1n1i3I5i5n3N 3I0i0d3D6d6i3I",
                                   "91E2d3D6d6K6n3N0n0h3H6h6K",
                                   ".0D",
                                   ",1D0B",
                                   ":0D 0J",
                                   ";1D0B 1J",
                                   "!0N0G 0D",
                                   "?0L0n2N5n5j2I2G 2D",
                                   "-0H4H",
                                   "_0B6B",
                                   "+0H6H 3E3K",
                                   "=0J6J 0F6F",
                                   "/0C4O",
                                   "\\0O4C",
                                   "|0P0A",
                                   "(2P0m0d2A",
                                   ")0P2m2d0A",
                                   "[2O0O0B2B",
                                   "]0O2O2B0B",
                                   "{3O1o1L1i0I1i1F1b3B",
                                   "}0O2o2L2i3I2i2F2b0B",
                                   "<5K0H5E",
                                   ">0K5H0E",
                                   "*2N2J 0M4K 0K4M",
                                   "#1D2N 4D5N 0K6K 0G6G",
                                   "%0D6N 1N0n0j1J2j2n1N 5H4h4d5D6d6h5H",
                                   "&6D1K1n3N5n5K0H0d2D5d6H",
                                   "@5I5k3K2k2g3G5g5I 5K5G7g7K7o4O0o0b4B6B",
                                   "$6L6n3N0n0i3I6i6d3D0d0F 3O3C",
                                   "'0N0L",
                                   "\"0N0L 2N2L",
                                   "^0K2N4K",
                                   "`0N1L",
                                   "~0H1j2I3g4H",
                                   "\xc2\xb0"
                                   "1N0n0k1K2k2n1N",
                                   "\xc3\x97"
                                   "0J4F 0F4J",
                                   "\xc2\xb7"
                                   "0H",
                                   "\xce\xb2"
                                   "0A0L0n2N4n4i2I 2I5i5d2D0d0E",
                                   "\xe2\x80\xa6"
                                   "0D 2D 4D",
                                   "\xc2\xb5"
                                   "0K0A 0G0d2D5d5G 5K5D",
                                   "\xc2\xb2"
                                   "0M1n2M2l0I3I",
                                   "\xc2\xb1"
                                   "0J6J 3G3M 0E6E",
                                   "\xe2\x89\xa4"
                                   "5K0H5E 0C5C",
                                   "\xe2\x89\xa5"
                                   "0K5H0E 0C5C",
                                   "\xc3\xb8"
                                   "3K0k0d3D6d6k3K 0C6L",
                                   "\xc3\x98"
                                   "4N0n0d4D8d8n4N 0C8O",
                                   "\xc3\x9f"
                                   "0D0L0n2N4n4j2I5i5d3D2D",
                                   "\xe2\x80\x93"
                                   "0H5H",
                                   "\xe2\x88\x92"
                                   "0H6H"};
constexpr const char* kMissing = "0D0N5N5D0D";

// Letters of Latin-1 with a mark, in the order of their numbers from 0xC0 on; '.' has none, or a glyph of its own.
constexpr std::string_view kLatinBases = "AAAAAA.CEEEEIIII.NOOOOO..UUUUY..aaaaaa.ceeeeiiii.nooooo..uuuuy.y";
constexpr std::string_view kLatinMarks = "`'^~:o.,`'^:`'^:.~`'^~:..`'^:'..`'^~:o.,`'^:`'^:.~`'^~:..`'^:'.:";
/// Above a small letter, around x = 2; beneath one for ','.
const char* mark_glyph(char mark) {
  switch (mark) {
    case '`':
      return "1N3M";
    case '\'':
      return "1M3N";
    case '^':
      return "0M2N4M";
    case '~':
      return "0M1o2N3l4N";
    case ':':
      return "1N 3N";
    case 'o':
      return "2N1n1l2L3l3n2N";
    default:
      return "2D3C2A1A";
  }
}

constexpr double kUnit = 0.1, kGap = 2.6, kBlank = 4;

struct Glyph {
  std::vector<Stroke> strokes;  ///< in tenths
  double width = 0;
};

struct GlyphPoint {
  Point at;
  bool is_control = false;
};

std::vector<GlyphPoint> glyph_points(std::string_view text) {
  std::vector<GlyphPoint> points;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2) {
    const bool is_control = text[i + 1] >= 'a';
    points.push_back({{static_cast<double>(text[i] - '0'), static_cast<double>(text[i + 1] - (is_control ? 'd' : 'D'))},
                      is_control});
  }
  return points;
}

Point middle(Point a, Point b) {
  return {(a.x + b.x) / 2, (a.y + b.y) / 2};
}

/// The arc from the last point of the stroke, by `control`, to `end`.
void add_arc(Stroke& stroke, Point control, Point end) {
  constexpr int kSteps = 6;
  const Point from = stroke.back();
  for (int i = 1; i <= kSteps; ++i) {
    const double t = static_cast<double>(i) / kSteps, a = (1 - t) * (1 - t), b = 2 * t * (1 - t), c = t * t;
    stroke.push_back({a * from.x + b * control.x + c * end.x, a * from.y + b * control.y + c * end.y});
  }
}

/// REQUIRES ends that are no control points.
Stroke stroke_through(const std::vector<GlyphPoint>& points) {
  Stroke stroke{points.front().at};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (!points[i].is_control) {
      stroke.push_back(points[i].at);
      continue;
    }
    const GlyphPoint& next = points[i + 1];
    add_arc(stroke, points[i].at, next.is_control ? middle(points[i].at, next.at) : next.at);
    if (!next.is_control) ++i;
  }
  return stroke;
}

Glyph glyph_of(std::string_view text) {
  Glyph glyph;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(' '), text.size());
    glyph.strokes.push_back(stroke_through(glyph_points(text.substr(0, end))));
    for (const Point& p : glyph.strokes.back()) glyph.width = std::max(glyph.width, p.x);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return glyph;
}

/// How many bytes the first letter of a text has; 1 where it is no UTF-8.
std::size_t letter_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = first < 0x80 ? 1 : first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 1;
  return std::min(length, text.size());
}

void add_marked(std::map<std::string, Glyph, std::less<>>& all, std::size_t k) {
  Glyph glyph = all.at(std::string(1, kLatinBases[k]));
  const bool is_capital = kLatinBases[k] < 'a', is_beneath = kLatinMarks[k] == ',';
  if (kLatinBases[k] == 'i') glyph.strokes.pop_back();
  Glyph mark = glyph_of(mark_glyph(kLatinMarks[k]));
  for (Stroke& stroke : mark.strokes) {
    for (Point& p : stroke) p = {p.x + glyph.width / 2 - 2, p.y + (is_capital && !is_beneath ? 2.4 : 0)};
    glyph.strokes.push_back(stroke);
  }
  all[std::string{'\xc3', static_cast<char>(0x80 + k)}] = std::move(glyph);
}

const std::map<std::string, Glyph, std::less<>>& glyphs() {
  static const std::map<std::string, Glyph, std::less<>> made = [] {
    std::map<std::string, Glyph, std::less<>> all;
    for (const std::string_view row : kGlyphs) {
      const std::size_t length = letter_length(row);
      all[std::string(row.substr(0, length))] = glyph_of(row.substr(length));
    }
    all[" "] = {{}, kBlank - kGap};
    for (std::size_t k = 0; k < kLatinBases.size(); ++k)
      if (kLatinBases[k] != '.') add_marked(all, k);
    return all;
  }();
  return made;
}

template <class Visit>
void for_each_glyph(std::string_view text, const Visit& visit) {
  static const Glyph missing = glyph_of(kMissing);
  double x = 0;
  while (!text.empty()) {
    const std::size_t length = letter_length(text);
    const auto found = glyphs().find(text.substr(0, length));
    const Glyph& glyph = found == glyphs().end() ? missing : found->second;
    visit(glyph, x);
    x += glyph.width + kGap;
    text.remove_prefix(length);
  }
}

}  // namespace

std::vector<Stroke> strokes_of(std::string_view text) {
  std::vector<Stroke> all;
  for_each_glyph(text, [&](const Glyph& glyph, double x) {
    for (Stroke stroke : glyph.strokes) {
      for (Point& p : stroke) p = {kUnit * (p.x + x), kUnit * p.y};
      all.push_back(std::move(stroke));
    }
  });
  return all;
}

double width_of(std::string_view text) {
  double width = 0;
  for_each_glyph(text, [&](const Glyph& glyph, double x) { width = x + glyph.width; });
  return kUnit * width;
}

}  // namespace octafront::stroke_font
