#include "picture_options.h"

#include <octafront/picture.h>

#include <string>
#include <utility>

namespace octafront::cli {

namespace {

constexpr std::string_view kPicture = "picture", kPictureGroup = "Picture";

/// One of a few names.
template <class Value>
Add named_choice(const std::vector<std::pair<std::string, Value>>& names, Value PictureOptions::*field) {
  return [choice = Choice<Value>{names}, field](CLI::App& app, const LineOption& o, Arguments& a) {
    return app
        .add_option_function<std::string>(
            std::string(o.names),
            [&a, choice, field, option = std::string(o.names)](const std::string& typed) {
              a.picture.*field = choice.value_of(option, typed);
            },
            o.help)
        ->type_name(choice.listed("|"));
  };
}

Add picture_flag(bool PictureOptions::*field) {
  return [field](CLI::App& app, const LineOption& o, Arguments& a) {
    return app.add_flag(std::string(o.names), a.picture.*field, o.help);
  };
}

/// WxH
void set_pixels(PictureOptions& picture, const std::string& typed) {
  const std::size_t by = typed.find('x');
  if (by == std::string::npos || !CLI::detail::lexical_cast(typed.substr(0, by), picture.width) ||
      !CLI::detail::lexical_cast(typed.substr(by + 1), picture.height))
    throw CLI::ValidationError("--size",
                               "\"" + typed + "\" is no size: write pixels across and down, such as 1200x900");
}

}  // namespace

std::vector<LineOption> picture_options() {
  return {
      {kPicture, kPictureGroup, "--color", "",
       "What colours tell: quality, beta from 0 (dark) to 1 (light) whatever the mesh; region; size, the mean edge "
       "length; patch; none [region where there are several, else quality; of surfaces region or patch]",
       named_choice(picture_colors(), &PictureOptions::color), "What colours tell"},
      {kPicture, kPictureGroup, "--cut", "PLANE",
       "Cut open, elements stay whole: x, -y, z=12.5, x=30%, a normal NX,NY,NZ, or NX,NY,NZ:X,Y,Z through a point; "
       "what lies beyond goes",
       each([](Arguments& a, const std::string& typed) { a.picture.cut = picture_cut(typed); }),
       "Cut open: x, -y, z=12.5, x=30%, or a normal"},
      {kPicture, kPictureGroup, "--view", "VIEW",
       "From where: iso, front, back, left, right, top, bottom, or the direction X,Y,Z in which the viewer is [iso, or "
       "where the cut or what is highlighted is seen]",
       each([](Arguments& a, const std::string& typed) { a.picture.view = picture_view(typed); }), "From where"},
      {kPicture, kPictureGroup, "--up", "X,Y,Z", "Which way is up: an axis, y or -z, or a direction [z]",
       each([](Arguments& a, const std::string& typed) { a.picture.up = picture_up(typed); })},
      {kPicture, kPictureGroup, "--highlight", "PLACE",
       "Show where a place is, all else grey: the name of a region, patch, curve or set, box:..., sphere:...; what is "
       "behind something shines through; may be repeated",
       each([](Arguments& a, const std::string& typed) { a.picture.highlight.push_back(typed); }),
       "Show where a region, patch, curve or set is"},
      {kPicture, kPictureGroup, "--names", "",
       "Write the names of faces, or of regions where these are coloured, beside them",
       picture_flag(&PictureOptions::names), "Write the names of faces, or regions, beside them"},
      {kPicture, kPictureGroup, "--worst", "",
       "A close-up of the worst element of a mesh, what is before it taken away", picture_flag(&PictureOptions::worst),
       "A close-up of the worst element"},
      {kPicture, kPictureGroup, "--edges", "",
       "Which edges are drawn: elements; features, where patches or regions meet or faces at more than 40 degrees; "
       "none "
       "[elements; of CAD and images features]",
       named_choice(picture_edges(), &PictureOptions::edges)},
      {kPicture, kPictureGroup, "--size", "WxH", "Pixels across and down, 64 to 8192 [1200x900]",
       each([](Arguments& a, const std::string& typed) { set_pixels(a.picture, typed); }), "Pixels across and down"},
      {kPicture, kPictureGroup, "--bare", "", "Without axes, scale bar, legend and caption",
       [](CLI::App& app, const LineOption& o, Arguments& a) {
         return app.add_flag_callback(
             std::string(o.names), [&a] { a.picture.furniture = false; }, o.help);
       }},
  };
}

}  // namespace octafront::cli
