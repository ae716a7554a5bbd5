// Pictures, by octafront/picture.h.

#include <octafront/error.h>
#include <octafront/io.h>
#include <octafront/picture.h>
#include <octafront/report_page.h>

#include "doors/c_api/job.h"
#include "doors/c_api/json_keys.h"

#include <map>
#include <optional>
#include <utility>

namespace octafront::c_api {

namespace {

using Json = nlohmann::ordered_json;

template <class Value>
std::map<std::string, Value> choices_in(const std::vector<std::pair<std::string, Value>>& names) {
  return {names.begin(), names.end()};
}

PictureOptions picture_from(const std::string& asked) {
  const Json json = Json::parse(asked, nullptr, false);
  if (!json.is_object()) throw OptionError("what is asked of a picture is an object in JSON");
  PictureOptions o;
  const auto text = [&](const char* key, const auto& take) {
    with(json, key, [&](const Json& value) { take(value.get<std::string>()); });
  };
  text("color", [&](const std::string& name) { o.color = one_of(choices_in(picture_colors()), name, "color"); });
  text("edges", [&](const std::string& name) { o.edges = one_of(choices_in(picture_edges()), name, "edges"); });
  text("cut", [&](const std::string& cut) { o.cut = picture_cut(cut); });
  text("view", [&](const std::string& view) { o.view = picture_view(view); });
  text("up", [&](const std::string& up) { o.up = picture_up(up); });
  text("title", [&](const std::string& title) { o.title = title; });
  text("unit", [&](const std::string& unit) { o.unit = unit; });
  with(json, "width", [&](const Json& value) { o.width = value.get<int>(); });
  with(json, "height", [&](const Json& value) { o.height = value.get<int>(); });
  with(json, "highlight", [&](const Json& value) { o.highlight = value.get<std::vector<std::string>>(); });
  with(json, "names", [&](const Json& value) { o.names = value.get<bool>(); });
  with(json, "worst", [&](const Json& value) { o.worst = value.get<bool>(); });
  with(json, "furniture", [&](const Json& value) { o.furniture = value.get<bool>(); });
  return o;
}

Picture drawn(const octafront_mesh* mesh, const octafront_surface* surface, const PictureOptions& options,
              const RunContext& context) {
  if (mesh != nullptr) {
    require_indices(mesh->mesh);
    return draw_picture(mesh->mesh, options, context);
  }
  require_indices(surface->domain.surface);
  return draw_picture(surface->domain.surface, options, context);
}

}  // namespace

}  // namespace octafront::c_api

using namespace octafront;
using namespace octafront::c_api;

octafront_job* octafront_picture(const octafront_mesh* mesh, const octafront_surface* surface, const char* json,
                                 const char* file, int threads) {
  return started(
      [=, text = std::string(json),
       target = file != nullptr ? std::optional<std::string>(file) : std::nullopt](octafront_job& job) {
        if (target) check_text_target(*target);
        const Picture picture = drawn(mesh, surface, picture_from(text), job.context());
        job.bytes = to_png(picture);
        job.report = {{"width", picture.width}, {"height", picture.height}, {"notes", picture.notes}};
        if (target) write_text(*target, job.bytes);
      },
      threads);
}
