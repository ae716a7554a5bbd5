#pragma once

#include "report/picture/canvas.h"
#include "report/picture/raster.h"
#include "report/picture/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace octafront {

/// Where what stands around the mesh goes.
struct Layout {
  double text = 12;                  ///< the height of a capital, in pixels
  Rectangle window;                  ///< that the mesh fits into
  Rectangle picture;                 ///< where nothing else is
  Rectangle legend, caption, strip;  ///< `strip`: axes and scale bar
};

Layout layout_for(int width, int height, const Legend& legend, std::size_t lines_of_caption, bool furniture);

void draw_axes(Canvas& canvas, const Layout& layout, const Camera& camera);
/// A round length.
void draw_scale_bar(Canvas& canvas, const Layout& layout, const Camera& camera, const std::string& unit);
void draw_legend(Canvas& canvas, const Layout& layout, const Legend& legend);
void draw_caption(Canvas& canvas, const Layout& layout, const std::vector<std::string>& lines);

/// Names of parts beside what is seen of them. `faces`: per pixel, as rasterise() leaves it. Returns what was not
/// named: parts that are hidden, and those for which there was no place.
std::vector<std::string> draw_names(Canvas& canvas, const Layout& layout, const Scene& scene,
                                    const std::vector<std::uint32_t>& faces);

}  // namespace octafront
